"""What stroke and wing files have in common: a format, its version, units, and errors that name the file."""

import contextlib
import json
import os
from collections.abc import Collection, Iterator, Mapping
from pathlib import Path
from typing import Any

from flapenv.aero.checks import LONGEST_SHOWN, allowed, one_line, shown
from flapenv.aero.parameters import STROKE_PARAMETERS
from flapenv.read_json import require_file

VERSION = 1
"""Of both formats; a file of another one is refused."""
STROKE_UNITS = {name: row.unit or "-" for name, row in STROKE_PARAMETERS.items()}
"""By field of a stroke."""
WING_UNITS = {"mass": "kg", "length": "m", "frequency": "Hz", "angle": "rad", "specific_power": "W/kg"}
"""By kind of number."""


@contextlib.contextmanager
def errors_of(what: object) -> Iterator[None]:
    """Let `TypeError` and `ValueError` begin with `what` they are of, in one line of limited length."""
    try:
        yield
    except (TypeError, ValueError) as mistake:
        raise type(mistake)(f"{one_line(what)}: {one_line(mistake)}") from None


def existing(path: str | os.PathLike[str], mend: str) -> Path:
    """A path that leads to a file.

    Raises:
        TypeError: if it is no path.
        OSError: if there is none, or a folder, a pipe or a device.
    """
    if not isinstance(path, str | os.PathLike):
        raise TypeError(f"path = {shown(path)} is not allowed; allowed: a path of {mend}")
    found = Path(path)
    require_file(found, one_line(found), mend)
    return found


def require_format(content: Mapping[str, Any], name: str, units: Mapping[str, str]) -> None:
    """Refuse a file of another format, version or other units.

    Raises:
        ValueError: naming what is wrong and what is allowed.
    """
    told = content.get("format")
    if told != name:
        raise ValueError(f"format = {shown(told)} is not allowed; allowed: {shown(name)}, a file that says what it is")
    version = content.get("version")
    if isinstance(version, bool) or version != VERSION:
        raise ValueError(f"version = {shown(version)} is not allowed; allowed: {VERSION}")
    require_units(content.get("units"), units)


def require_units(told: object, units: Mapping[str, str]) -> None:
    """Refuse other units than these: nothing is converted, so nothing can be converted wrongly."""
    if not isinstance(told, dict):
        raise ValueError(
            f"units = {shown(told)} are not allowed; allowed: {json.dumps(dict(units), ensure_ascii=False)}"
        )
    require_keys(told, units, needed=units, what="units")
    for name, unit in units.items():
        if told[name] != unit:
            raise ValueError(
                f"unit of {name} = {shown(told[name])} is not allowed; allowed: {unit!r}; convert the numbers "
                "and say so"
            )


def require_keys(content: Mapping[str, Any], known: Collection[str], *, needed: Collection[str], what: str) -> None:
    """Refuse unknown keys and the lack of those that are needed."""
    for key in content:
        if key not in known:
            raise ValueError(f"{what}: unknown key {shown(key)}; {allowed(key, known)}")
    missing = [key for key in needed if key not in content]
    if missing:
        raise ValueError(f"{what}: {', '.join(missing)} not told; its keys are {', '.join(known)}")


def require_number(field: str, value: object) -> float:
    """One number of JSON: neither true nor a text, a list or null.

    Raises:
        TypeError: for anything else.
    """
    if isinstance(value, bool) or not isinstance(value, int | float):
        told = one_line(json.dumps(value, ensure_ascii=False), LONGEST_SHOWN)
        raise TypeError(f"{field} = {told} is not a number; allowed: one number")
    return value


def require_place(path: Path) -> None:
    """Refuse a path that no file can be written to.

    Raises:
        OSError: for a folder, or a file in a folder that does not exist.
    """
    if path.is_dir():
        raise IsADirectoryError(f"{path} is a folder; allowed: a file")
    if not path.parent.is_dir():
        raise FileNotFoundError(f"{path}: {path.parent} is not a folder; allowed: one that exists")
