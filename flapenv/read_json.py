"""Files that others may have made or changed: what is wrong with one is an error of one line that names it."""

import json
import math
import os
import stat
from collections import Counter
from collections.abc import Iterator, Sequence
from pathlib import Path
from typing import Any

from flapenv.aero.checks import LONGEST_SHOWN, one_line, shown

LARGEST_FILE = 2**24
"""A larger file is not read [bytes]."""
DEEPEST = 64
"""Levels of objects and lists in each other."""
AS_WRITTEN = "a file as it was written"


def read_text(
    path: str | os.PathLike[str], *, called: str | None = None, kind: str = "text", largest: int = LARGEST_FILE
) -> str:
    """The text of a file, in UTF-8 with a byte order mark or without.

    Args:
        path: of the file.
        called: how errors call it; the path where None.
        kind: what it should be, in words.
        largest: size up to which it is read [bytes].

    Raises:
        ValueError: for a file that is too large or no text.
        OSError: if it cannot be read, or is a folder, a pipe or a device, which might never end.
    """
    called = one_line(os.fspath(path) if called is None else called)
    require_file(path, called)
    with Path(path).open("rb") as file:
        content = file.read(largest + 1)
    if len(content) > largest:
        raise ValueError(f"{called} has more than {largest:,} bytes; allowed: up to {largest:,}")
    try:
        return content.decode("utf-8-sig")
    except UnicodeDecodeError as mistake:
        raise ValueError(f"{called} is not {kind}: {mistake}; allowed: text in UTF-8") from None


def require_file(path: str | os.PathLike[str], called: str, mend: str = AS_WRITTEN) -> None:
    """Refuse what is not there or is no file: a pipe without a writer would be waited for.

    Args:
        path: of the file.
        called: how errors call it.
        mend: what is allowed in its place, in words.

    Raises:
        OSError: for a folder, a pipe, a device, and a path that cannot be.
    """
    try:
        mode = Path(path).stat().st_mode
    except FileNotFoundError:
        raise FileNotFoundError(f"{called} does not exist; allowed: {mend}") from None
    except (OSError, ValueError) as mistake:  # too long, a loop, no permission, a zero byte
        reason = getattr(mistake, "strerror", None) or mistake
        raise OSError(f"{called} cannot be read ({reason}); allowed: {mend}") from None
    if stat.S_ISDIR(mode):
        raise IsADirectoryError(f"{called} is a folder; allowed: {mend}")
    if not stat.S_ISREG(mode):
        raise OSError(f"{called} is a pipe or a device; allowed: {mend}")


def read_object(
    path: str | os.PathLike[str], *, called: str | None = None, mend: str = AS_WRITTEN, largest: int = LARGEST_FILE
) -> dict[str, Any]:
    """The object in a file of JSON, whose numbers are all finite and whose texts can be written again.

    Args:
        path: of the file.
        called: how errors call it; the path where None.
        mend: what is allowed in its place, in words.
        largest: size up to which it is read [bytes].

    Raises:
        ValueError: for what is not text, not JSON or no object, for NaN and inf, and keys that stand twice.
        OSError: if it cannot be read.
    """
    called = one_line(os.fspath(path) if called is None else called)
    require_file(path, called, mend)
    text = read_text(path, called=called, kind="JSON", largest=largest)
    if not text.strip():
        raise ValueError(f"{called} is not JSON: it is empty; allowed: {mend}")
    try:
        content = json.loads(text, object_pairs_hook=_once)
    except RecursionError:
        raise ValueError(f"{called} is not JSON that can be read: it is nested too deep; allowed: {mend}") from None
    except ValueError as mistake:
        raise ValueError(f"{called} is not JSON that can be read: {mistake}; allowed: {mend}") from None
    if not isinstance(content, dict):
        raise ValueError(f"{called} holds no object but {_kind(content)}; allowed: {mend}")
    _require_sane(content, called)
    return content


def _once(pairs: list[tuple[str, Any]]) -> dict[str, Any]:
    """An object whose every key stands once."""
    made = dict(pairs)
    if len(made) < len(pairs):
        [(twice, _)] = Counter(key for key, _ in pairs).most_common(1)
        raise ValueError(f"the key {shown(twice)} stands twice in one object")
    return made


def _require_sane(content: dict[str, Any], called: str) -> None:
    """Refuse what Python reads but JSON does not know, with the place where it stands."""
    place: list[str | int] = []
    levels = [_steps(content)]
    while levels:
        for step, value in levels[-1]:
            place[len(levels) - 1 :] = [step]
            if isinstance(step, str):
                _require_text(step, called, place[:-1])
            if isinstance(value, str):
                _require_text(value, called, place)
            elif isinstance(value, float) and not math.isfinite(value):
                name = "NaN" if math.isnan(value) else "Infinity" if value > 0 else "-Infinity"
                raise ValueError(
                    f"{called} is not JSON: {_place_text(place)} = {name} is not a number; allowed: finite numbers"
                )
            elif isinstance(value, dict | list):
                levels.append(_steps(value))
                break
        else:
            levels.pop()
        if len(levels) > DEEPEST:
            raise ValueError(f"{called} is not JSON that can be read: it is nested too deep; allowed: {DEEPEST} levels")


def _steps(value: dict[str, Any] | list[Any]) -> Iterator[tuple[str | int, Any]]:
    """Keys or numbers of what an object or a list holds, and what that is."""
    return iter(value.items()) if isinstance(value, dict) else enumerate(value)


def _require_text(text: str, called: str, place: Sequence[str | int]) -> None:
    """Refuse halves of characters, which no file could hold."""
    try:
        text.encode()
    except UnicodeEncodeError as mistake:
        raise ValueError(
            f"{called}: {_place_text(place)} holds {shown(text)}: {mistake.reason}; allowed: text in UTF-8"
        ) from None


def _place_text(place: Sequence[str | int]) -> str:
    """A place as one reads it, `strokes[0].frequency`; made for an error only, as keys may be long and many."""
    steps = (f"[{step}]" if isinstance(step, int) else f".{one_line(step, LONGEST_SHOWN)}" for step in place)
    return one_line("".join(steps).removeprefix("."))


def _kind(value: object) -> str:
    """What JSON calls a value."""
    names = {list: "a list", str: "a text", bool: "true or false", type(None): "null"}
    return names.get(type(value), "a number")
