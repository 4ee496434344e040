"""Files that are there whole or not at all: a crash leaves the old file or the new one."""

import contextlib
import errno
import json
import os
import stat
import uuid
from collections.abc import Iterator, Mapping
from pathlib import Path
from typing import Any


@contextlib.contextmanager
def whole_file(path: Path) -> Iterator[Path]:
    """A file beside `path` to write into, which takes its place in one step, or is removed if anything goes wrong.

    A link stays one and its target is replaced; a file that was there leaves its permissions to the new one.

    Raises:
        OSError: if the folder cannot be written.
    """
    target = Path(os.path.realpath(path))
    beside = target.with_name(f".{uuid.uuid4().hex[:8]}{target.suffix}")  # short: the target's name may be the longest
    try:
        beside.touch()
    except OSError as error:
        raise _named(error, path) from error
    try:
        try:
            yield beside
        except OSError as error:
            raise _named(error, path) from error
        if target.exists():
            beside.chmod(stat.S_IMODE(target.stat().st_mode))
        beside.replace(target)
    finally:
        beside.unlink(missing_ok=True)


def _named(error: OSError, path: Path) -> OSError:
    """The same kind of error, with the file that was to be written and what may be done."""
    full = error.errno in (errno.ENOSPC, errno.EDQUOT)
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
