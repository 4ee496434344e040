"""Files that are there whole or not at all: a crash leaves the old file or the new one."""

import contextlib
import uuid
from collections.abc import Iterator
from pathlib import Path


@contextlib.contextmanager
def whole_file(path: Path) -> Iterator[Path]:
    """A file beside `path` to write into, which takes its place in one step, or is removed if anything goes wrong.

    Raises:
        OSError: if the folder cannot be written.
    """
    beside = path.with_name(f".{path.stem}.{uuid.uuid4().hex[:8]}{path.suffix}")
    try:
        beside.touch()
    except OSError as error:
        raise type(error)(f"path = {str(path)!r} cannot be written ({error}); allowed: a folder that can") from error
    try:
        yield beside
        beside.replace(path)
    finally:
        beside.unlink(missing_ok=True)
