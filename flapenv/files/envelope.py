"""What stroke and wing files have in common: a format, its version, units, and errors that name the file."""

import contextlib
import json
import os
from collections.abc import Collection, Iterator, Mapping
from pathlib import Path
from typing import Any

from flapenv.aero.checks import allowed, is_single
from flapenv.aero.parameters import STROKE_PARAMETERS
from flapenv.aero.stroke import Stroke
from flapenv.insects import Insect
from flapenv.whole_file import whole_file

VERSION = 1
"""Of both formats; a file of another one is refused."""
LONGEST_NAME = 100
"""Letters of an insect's."""
STROKE_UNITS = {name: row.unit or "-" for name, row in STROKE_PARAMETERS.items()}
"""By field of a stroke."""
WING_UNITS = {"mass": "kg", "length": "m", "frequency": "Hz", "angle": "rad", "specific_power": "W/kg"}
"""By kind of number."""


@contextlib.contextmanager
def errors_of(what: object) -> Iterator[None]:
    """Let `TypeError` and `ValueError` begin with `what` they are of."""
    try:
        yield
    except (TypeError, ValueError) as mistake:
        raise type(mistake)(f"{what}: {mistake}") from None


def existing(path: str | os.PathLike[str], mend: str) -> Path:
    """A path that leads to a file.

    Raises:
        TypeError: if it is no path.
        OSError: if there is none, or a folder.
    """
    if not isinstance(path, str | os.PathLike):
        raise TypeError(f"path = {path!r} is not allowed; allowed: a path of {mend}")
    found = Path(path)
    if found.is_dir():
        raise IsADirectoryError(f"{found} is a folder; allowed: {mend}")
    if not found.exists():
        raise FileNotFoundError(f"{found} does not exist; allowed: {mend}")
    return found


def require_format(content: Mapping[str, Any], name: str, units: Mapping[str, str]) -> None:
    """Refuse a file of another format, version or other units.

    Raises:
        ValueError: naming what is wrong and what is allowed.
    """
    told = content.get("format")
    if told != name:
        raise ValueError(f"format = {told!r} is not allowed; allowed: {name!r}, a file that says what it is")
    version = content.get("version")
    if isinstance(version, bool) or version != VERSION:
        raise ValueError(f"version = {version!r} is not allowed; allowed: {VERSION}")
    require_units(content.get("units"), units)


def require_units(told: object, units: Mapping[str, str]) -> None:
    """Refuse other units than these: nothing is converted, so nothing can be converted wrongly."""
    if not isinstance(told, dict):
        raise ValueError(f"units = {told!r} are not allowed; allowed: {json.dumps(dict(units), ensure_ascii=False)}")
    require_keys(told, units, needed=units, what="units")
    for name, unit in units.items():
        if told[name] != unit:
            raise ValueError(
                f"unit of {name} = {told[name]!r} is not allowed; allowed: {unit!r}; convert the numbers and say so"
            )


def require_keys(content: Mapping[str, Any], known: Collection[str], *, needed: Collection[str], what: str) -> None:
    """Refuse unknown keys and the lack of those that are needed."""
    for key in content:
        if key not in known:
            raise ValueError(f"{what}: unknown key {key!r}; {allowed(key, known)}")
    missing = [key for key in needed if key not in content]
    if missing:
        raise ValueError(f"{what}: {', '.join(missing)} not told; its keys are {', '.join(known)}")


def require_number(field: str, value: object) -> float:
    """One number of JSON: neither true nor a text, a list or null.

    Raises:
        TypeError: for anything else.
    """
    if isinstance(value, bool) or not isinstance(value, int | float):
        raise TypeError(f"{field} = {json.dumps(value, ensure_ascii=False)} is not a number; allowed: one number")
    return value


def require_single(part: Stroke | Insect) -> None:
    """Refuse array fields, and names that would not stand on one line.

    Raises:
        TypeError: for a field with an axis.
        ValueError: for a name of many lines.
    """
    for field, value in vars(part).items():
        if not is_single(value):
            raise TypeError(f"{field} of {type(part).__name__} is an array; allowed: scalar fields")
    name = getattr(part, "name", "")
    if not (name.isprintable() and len(name) <= LONGEST_NAME):
        raise ValueError(f"name = {name[:LONGEST_NAME]!r} is not allowed; allowed: {LONGEST_NAME} visible letters")


def to_text(content: Mapping[str, Any]) -> str:
    """JSON that people can read, whose numbers come back to the last digit."""
    return json.dumps(content, indent=2, ensure_ascii=False, allow_nan=False) + "\n"


def require_place(path: Path) -> None:
    """Refuse a path that no file can be written to.

    Raises:
        OSError: for a folder, or a file in a folder that does not exist.
    """
    if path.is_dir():
        raise IsADirectoryError(f"{path} is a folder; allowed: a file")
    if not path.parent.is_dir():
        raise FileNotFoundError(f"{path}: {path.parent} is not a folder; allowed: one that exists")


def write_text(path: Path, text: str) -> None:
    """Write a text, whole or not at all.

    Raises:
        OSError: if it cannot be written.
    """
    with whole_file(path) as beside:
        beside.write_text(text, encoding="utf-8", newline="")
