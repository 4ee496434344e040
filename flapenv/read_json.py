"""Files that others may have made or changed: what is wrong with one is an error of one line that names it."""

import json
import math
import os
from pathlib import Path
from typing import Any

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
        OSError: if it cannot be read.
    """
    called = os.fspath(path) if called is None else called
    with Path(path).open("rb") as file:
        content = file.read(largest + 1)
    if len(content) > largest:
        raise ValueError(f"{called} has more than {largest:,} bytes; allowed: up to {largest:,}")
    try:
        return content.decode("utf-8-sig")
    except UnicodeDecodeError as mistake:
        raise ValueError(f"{called} is not {kind}: {mistake}; allowed: text in UTF-8") from None


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
    called = os.fspath(path) if called is None else called
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
        keys = [key for key, _ in pairs]
        twice = next(key for key in keys if keys.count(key) > 1)
        raise ValueError(f"the key {twice!r} stands twice in one object")
    return made


def _require_sane(content: dict[str, Any], called: str) -> None:
    """Refuse what Python reads but JSON does not know, with the place where it stands."""
    parts: list[tuple[str, Any, int]] = [("", content, 0)]
    while parts:
        place, value, depth = parts.pop()
        if depth > DEEPEST:
            raise ValueError(f"{called} is not JSON that can be read: it is nested too deep; allowed: {DEEPEST} levels")
        if isinstance(value, dict):
            for key in value:
                _require_text(key, called, place)
            parts += [(f"{place}.{key}" if place else key, one, depth + 1) for key, one in value.items()]
        elif isinstance(value, list):
            parts += [(f"{place}[{number}]", one, depth + 1) for number, one in enumerate(value)]
        elif isinstance(value, float) and not math.isfinite(value):
            name = "NaN" if math.isnan(value) else "Infinity" if value > 0 else "-Infinity"
            raise ValueError(f"{called} is not JSON: {place} = {name} is not a number; allowed: finite numbers")
        elif isinstance(value, str):
            _require_text(value, called, place)


def _require_text(text: str, called: str, place: str) -> None:
    """Refuse halves of characters, which no file could hold."""
    try:
        text.encode()
    except UnicodeEncodeError as mistake:
        raise ValueError(f"{called}: {place} holds {text!a}: {mistake.reason}; allowed: text in UTF-8") from None


def _kind(value: object) -> str:
    """What JSON calls a value."""
    names = {list: "a list", str: "a text", bool: "true or false", type(None): "null"}
    return names.get(type(value), "a number")
