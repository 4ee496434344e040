"""Stroke files: strokes of insects as JSON or CSV, and what a run's results.json says of the strokes it learned."""

import csv
import io
import os
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

from flapenv.aero.checks import LONGEST_SHOWN, one_line, record, require_name, shown
from flapenv.aero.stroke import Stroke
from flapenv.files.columns import heading, read_columns
from flapenv.files.envelope import (
    STROKE_UNITS,
    VERSION,
    errors_of,
    existing,
    require_format,
    require_keys,
    require_number,
    require_place,
)
from flapenv.files.plausible import require_insect, require_stroke
from flapenv.insects import INSECTS, as_insect, described, load_insect
from flapenv.read_json import read_object
from flapenv.whole_file import json_text, write_text

FORMAT = "flapenv-strokes"
MOST_STROKES = 10_000
"""A file of more is refused."""
KEYS = ("format", "version", "units", "strokes")
ENDINGS = (".json", ".csv")
MEND = "a stroke file as `write_strokes` or the explorer writes it, or a run's results.json"


@record
class NamedStroke:
    """A stroke, and whose it is.

    Attributes:
        stroke: one stroke, scalar fields.
        insect: an `Insect`, a name of `INSECTS` or the dict of its fields; None where it is told elsewhere.

    Raises:
        TypeError: for another kind, or array fields.
        ValueError: for an unknown name, the name of one of `INSECTS` with other numbers, and numbers that are no
            flapping wing's.
    """

    stroke: Stroke
    insect: Any = None

    def __post_init__(self) -> None:
        """Resolve the insect and check both."""
        if isinstance(self.stroke, Mapping):
            object.__setattr__(self, "stroke", Stroke(**self.stroke))
        if not isinstance(self.stroke, Stroke):
            raise TypeError(f"stroke = {shown(self.stroke)} is not allowed; allowed: a Stroke or a dict of its fields")
        if self.insect is not None:
            object.__setattr__(self, "insect", as_insect(self.insect))
            require_insect(self.insect)
        require_stroke(self.stroke)


def read_strokes(path: str | os.PathLike[str]) -> tuple[NamedStroke, ...]:
    """The strokes of a stroke file (JSON or CSV), or of the results.json of a run on named insects.

    Raises:
        TypeError: for a value of another kind.
        ValueError: for a file that is not what it should be, a number out of range or in another unit.
        OSError: if it cannot be read.
    """
    found = existing(path, MEND)
    if _ending(found) == ".csv":
        return _from_table(found)
    content = read_object(found, mend=MEND)
    with errors_of(found):
        if "format" not in content and isinstance(content.get("insects"), dict):
            return _from_results(content["insects"])
        return _from_content(content)


def write_strokes(path: str | os.PathLike[str], strokes: Sequence[NamedStroke]) -> None:
    """Write strokes as JSON or CSV, by the path's ending, whole or not at all; numbers keep every digit.

    Args:
        path: NAME.json, or NAME.csv, which holds insects by name only.
        strokes: at least one.

    Raises:
        TypeError: for anything but strokes.
        ValueError: for another ending, no strokes, or what a CSV file cannot hold.
        OSError: if it cannot be written.
    """
    write_text(*require_writable(path, strokes))


def require_writable(path: str | os.PathLike[str], strokes: Sequence[NamedStroke]) -> tuple[Path, str]:
    """Where strokes would be written, and as which text; arguments and errors as `write_strokes`'."""
    found = Path(path)
    text = _to_table(strokes) if _ending(found) == ".csv" else strokes_to_text(strokes)
    require_place(found)
    return found, text


def strokes_to_text(strokes: Sequence[NamedStroke]) -> str:
    """Strokes as the text of a JSON file; arguments and errors as `write_strokes`'."""
    entries = [
        {"insect": None if one.insect is None else described(one.insect), **_numbers(one.stroke)}
        for one in _checked(strokes)
    ]
    return json_text({"format": FORMAT, "version": VERSION, "units": STROKE_UNITS, "strokes": entries})


def stroke_of(fields: object, where: str) -> Stroke:
    """A stroke of which every field is told: a file has no defaults.

    Raises:
        TypeError: for anything but an object of numbers.
        ValueError: for an unknown or missing field, or a number out of range.
    """
    if not isinstance(fields, dict):
        raise TypeError(f"{where} = {shown(fields)} is not allowed; allowed: an object with {', '.join(STROKE_UNITS)}")
    require_keys(fields, STROKE_UNITS, needed=STROKE_UNITS, what=where)
    with errors_of(where):
        return Stroke(**{name: require_number(name, value) for name, value in fields.items()})


def _numbers(stroke: Stroke) -> dict[str, float]:
    """The fields of a stroke, in the order of the table."""
    return {name: float(getattr(stroke, name)) for name in STROKE_UNITS}


def _ending(path: Path) -> str:
    """The path's ending, one of `ENDINGS`."""
    ending = path.suffix.lower()
    if ending not in ENDINGS:
        raise ValueError(f"{path} does not end in {' or '.join(ENDINGS)}; allowed: NAME.json, NAME.csv")
    return ending


def _checked(strokes: Sequence[NamedStroke]) -> Sequence[NamedStroke]:
    """Strokes that a file can hold, which can be read again."""
    for one in strokes:
        if not isinstance(one, NamedStroke):
            raise TypeError(f"stroke = {shown(one)} is not allowed; allowed: NamedStrokes")
    if not 1 <= len(strokes) <= MOST_STROKES:
        raise ValueError(f"{len(strokes)} strokes are not allowed in a file; allowed: from 1 to {MOST_STROKES:,}")
    return strokes


def _from_content(content: Mapping[str, Any]) -> tuple[NamedStroke, ...]:
    """The strokes of a file of our own format."""
    require_format(content, FORMAT, STROKE_UNITS)
    require_keys(content, KEYS, needed=KEYS, what="the file")
    entries = content["strokes"]
    if not isinstance(entries, list):
        raise TypeError(f"strokes = {shown(entries)} are not allowed; allowed: a list of objects")
    if not 1 <= len(entries) <= MOST_STROKES:
        raise ValueError(f"strokes holds {len(entries):,}; allowed: from 1 to {MOST_STROKES:,}")
    return tuple(_entry(entry, f"strokes[{number}]") for number, entry in enumerate(entries))


def _entry(entry: object, where: str) -> NamedStroke:
    """One entry of the list."""
    if not isinstance(entry, dict):
        raise TypeError(f"{where} = {shown(entry)} is not allowed; allowed: an object with {', '.join(STROKE_UNITS)}")
    require_keys(entry, ("insect", *STROKE_UNITS), needed=STROKE_UNITS, what=where)
    stroke = stroke_of({name: value for name, value in entry.items() if name != "insect"}, where)
    with errors_of(where):
        return NamedStroke(stroke=stroke, insect=entry.get("insect"))


def _from_results(insects: Mapping[str, Any]) -> tuple[NamedStroke, ...]:
    """The learned strokes of a run's results.json."""
    strokes = []
    for name, entry in insects.items():
        where = f"insects.{one_line(name, LONGEST_SHOWN)}"
        if not isinstance(entry, dict) or "stroke" not in entry:
            raise ValueError(f"{where} holds no stroke; allowed: the results of a run on Hover-v0")
        if name not in INSECTS and "insect" not in entry:
            raise ValueError(
                f"{where} is none of {', '.join(INSECTS)}, and the file does not describe it; allowed: a stroke file, "
                "which does"
            )
        stroke = stroke_of(entry["stroke"], f"{where}.stroke")
        with errors_of(where):
            found = NamedStroke(stroke=stroke, insect=entry.get("insect", name))
            if found.insect is None or found.insect.name != name:
                raise ValueError(
                    f"insect = {shown(entry['insect'])} is not the one it stands under; allowed: {shown(name)}"
                )
        strokes.append(found)
    if not strokes:
        raise ValueError("insects holds none; allowed: the results of a run on Hover-v0")
    return tuple(strokes)


def _from_table(path: Path) -> tuple[NamedStroke, ...]:
    """The strokes of a CSV file."""
    strokes = []
    for number, row in enumerate(read_columns(path, STROKE_UNITS, names=("insect",), most=MOST_STROKES), start=1):
        name = row.pop("insect", "")
        with errors_of(f"{path} row {number}"):
            insect = load_insect(require_name("insect", name, INSECTS)) if name else None
            strokes.append(NamedStroke(stroke=Stroke(**row), insect=insect))
    return tuple(strokes)


def _to_table(strokes: Sequence[NamedStroke]) -> str:
    """Strokes as the text of a CSV file."""
    text = io.StringIO(newline="")
    writer = csv.writer(text, lineterminator="\n")
    writer.writerow(["insect", *(heading(name, unit) for name, unit in STROKE_UNITS.items())])
    for one in _checked(strokes):
        name = "" if one.insect is None else described(one.insect)
        if not isinstance(name, str):
            raise ValueError(
                f"insect {shown(one.insect.name)} is none of {', '.join(INSECTS)}, and a CSV file holds names only; "
                "allowed: NAME.json"
            )
        writer.writerow([name, *(repr(value) for value in _numbers(one.stroke).values())])
    return text.getvalue()
