"""Who may change what a command writes."""

import os


def keep_others_from_writing() -> None:
    """Whatever wrote it from here on, no file is for others to change; who may read it is as it was."""
    os.umask(os.umask(0o022) | 0o022)
