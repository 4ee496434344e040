"""A folder that one process at a time works in, with the processes it starts."""

import contextlib
import fcntl
import os
from collections.abc import Iterator
from pathlib import Path

LOCK = ".lock"
"""Stays behind; it is held by who has locked it, not by being there."""


@contextlib.contextmanager
def locked(folder: Path) -> Iterator[int]:
    """Hold a folder's lock; yields its file descriptor.

    The system lets go of it when the last process that has it open is gone. Nothing stale is left by a process that
    was killed, and children that inherited it and live on still keep others out.

    Args:
        folder: there already.

    Raises:
        BlockingIOError: if another holds it; names the process.
        OSError: if the folder cannot be written.
    """
    try:
        descriptor = os.open(folder / LOCK, os.O_RDWR | os.O_CREAT | os.O_CLOEXEC, 0o600)
    except OSError as mistake:
        raise type(mistake)(
            f"{folder / LOCK} cannot be locked ({mistake.strerror}); allowed: a folder and {LOCK} of one's own"
        ) from None
    with os.fdopen(descriptor, "r+", encoding="utf-8") as file:
        try:
            fcntl.flock(file, fcntl.LOCK_EX | fcntl.LOCK_NB)
        except BlockingIOError:
            holder = file.read().strip() or "unknown"
            raise BlockingIOError(
                f"{folder} is in use by process {holder}, or by what it started; allowed: one at a time"
            ) from None
        with contextlib.suppress(OSError):  # a full disk forbids no lock, only its note
            file.truncate(0)
            file.write(str(os.getpid()))
            file.flush()
        yield descriptor
