"""Files that are there whole or not at all: a crash or a power cut leaves the old file or the new one."""

import contextlib
import errno
import json
import os
import stat
import uuid
from collections.abc import Iterator, Mapping
from pathlib import Path
from typing import Any

PARTIAL = ".partial-"
"""What the names of files begin with that are not in their place yet."""
READABLE = 0o644
"""What a file allows that is made anew, less what the umask forbids: to be read, and to be written by its owner."""


@contextlib.contextmanager
def whole_file(path: Path) -> Iterator[Path]:
    """A file beside `path` to write into, which takes its place in one step, or is removed if anything goes wrong.

    A link stays one and its target is replaced; a file that was there leaves its permissions to the new one. What was
    written is on the disk, not only on its way there, when the file takes its place. A process that is killed meanwhile
    leaves a file whose name begins with `PARTIAL`; see `remove_partial`.

    Raises:
        OSError: if the folder cannot be written.
    """
    target = Path(os.path.realpath(path))
    name = f"{PARTIAL}{uuid.uuid4().hex[:8]}{target.suffix}"  # short: the target's name may be the longest
    beside = target.with_name(name)
    try:
        beside.touch(READABLE, exist_ok=False)
    except OSError as error:
        raise _named(error, path) from error
    try:
        try:
            yield beside
            to_the_disk(beside)
            if target.exists():
                beside.chmod(stat.S_IMODE(target.stat().st_mode))
            beside.replace(target)
            to_the_disk(target.parent)
        except OSError as error:
            raise _named(error, path) from error
    finally:
        beside.unlink(missing_ok=True)


def to_the_disk(path: Path) -> None:
    """Wait until a file's content, or the names in a folder, have reached the disk.

    Raises:
        OSError: if they have not.
    """
    descriptor = os.open(path, os.O_RDONLY)
    try:
        os.fsync(descriptor)
    finally:
        os.close(descriptor)


def remove_partial(folder: Path) -> None:
    """Remove what a killed process has left half-written in a folder that nobody else is writing into.

    Raises:
        OSError: if the folder cannot be written.
    """
    for left in folder.glob(f"{PARTIAL}*"):
        if not left.is_dir():
            left.unlink()


def _named(error: OSError, path: Path) -> OSError:
    """The same kind of error, with the file that was to be written and what may be done."""
    full = error.errno in (errno.ENOSPC, errno.EDQUOT, errno.EFBIG)
    mend = "a disk with room for it" if full else "a folder that can"
    return type(error)(f"path = {str(path)!r} cannot be written ({error}); allowed: {mend}")


def json_text(content: Mapping[str, Any]) -> str:
    """JSON that people can read, whose numbers come back to the last digit.

    Raises:
        ValueError: for NaN and inf.
    """
    return json.dumps(content, indent=2, ensure_ascii=False, allow_nan=False) + "\n"


def write_text(path: Path, text: str) -> None:
    """Write a text, whole or not at all.

    Raises:
        OSError: if it cannot be written.
    """
    with whole_file(path) as beside:
        beside.write_text(text, encoding="utf-8", newline="")


def write_json(path: Path, content: Mapping[str, Any]) -> None:
    """Write `json_text`, whole or not at all.

    Raises:
        ValueError: for NaN and inf.
        OSError: if it cannot be written.
    """
    write_text(path, json_text(content))
