"""Valid documents with a few things changed, and files with a few bytes changed."""

import copy
import json
from collections.abc import Sequence
from typing import Any

from fuzzing.draw import Draw

Place = tuple[Any, Any]
"""A dict or list, and a key of it."""


def changed(document: Any, draw: Draw) -> Any:
    """A copy of a document with up to seven things changed, taken out, added or exchanged."""
    held = {"document": copy.deepcopy(document)}
    for _ in range(draw.byte() % 8):
        _change(held, draw)
    return held["document"]


def _change(held: dict[str, Any], draw: Draw) -> None:
    """Change one thing."""
    places = _places(held)
    parent, key = draw.one_of(places)
    value, how = parent[key], draw.byte() % 16
    if how < 6:
        usual = isinstance(value, int | float) and not isinstance(value, bool)
        parent[key] = draw.number(float(value) if usual and abs(value) < 1e300 else 1.0)
    elif how < 10:
        parent[key] = draw.thing()
    elif how == 10 and key != "document":
        del parent[key]
    elif how == 11 and isinstance(value, dict):
        value[draw.one_of(KEYS) if draw.byte() % 2 else draw.text()] = draw.thing()
    elif how == 12 and isinstance(value, list):
        value.insert(draw.index(len(value) + 1), draw.thing())
    elif how == 13 and isinstance(value, list) and value:
        parent[key] = value * (1 + draw.byte() % 8)
    elif how == 14:
        other, name = draw.one_of(places)
        parent[key] = copy.deepcopy(other[name]) if other is not held else {}
    else:
        parent[key] = [value]


def _places(held: Any) -> list[Place]:
    """Every place in a document, the first of long lists only."""
    found: list[Place] = []
    open_ = [held]
    while open_ and len(found) < 4000:
        parent = open_.pop()
        keys: Sequence[Any] = list(parent) if isinstance(parent, dict) else range(min(len(parent), 16))
        for key in keys:
            found.append((parent, key))
            if isinstance(parent[key], dict | list):
                open_.append(parent[key])
    return found


KEYS = (
    "format",
    "version",
    "insect",
    "name",
    "frequency",
    "planform",
    "planform_file",
    "radius",
    "limits",
    "mass",
    "box",
    "model",
    "problem",
    "coefficients",
    "rows",
    "widths",
    "memory",
    "frequency_ratio",
    "flap_amplitude_ratio",
)
"""That some document or other knows."""


def json_bytes(document: Any, draw: Draw) -> bytes:
    """A document as text, sometimes with a few bytes changed."""
    text = json.dumps(document, ensure_ascii=bool(draw.byte() % 4))
    return damaged(text.encode("utf-8", "surrogatepass"), draw)


def damaged(content: bytes, draw: Draw) -> bytes:
    """Up to three bytes or stretches changed, or nothing."""
    made = bytearray(content)
    for _ in range(max(0, draw.byte() % 8 - 4)):
        place, how = draw.index(len(made) + 1), draw.byte() % 4
        if how == 0:
            made[place : place + 1] = draw.take(1)
        elif how == 1:
            del made[place:]
        elif how == 2:
            made[place:place] = draw.take(draw.byte() % 9)
        else:
            made[place : place + draw.byte()] = b""
    return bytes(made)
