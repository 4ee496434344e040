"""Wing files: one's own wing with its mass, its known stroke and the limits of what drives it."""

import dataclasses
import os
from collections.abc import Mapping
from pathlib import Path
from typing import Any

from flapenv.aero.checks import record, require_real, shown
from flapenv.aero.parameters import STROKE_PARAMETERS
from flapenv.aero.wing import Wing
from flapenv.files.columns import read_columns
from flapenv.files.envelope import (
    VERSION,
    WING_UNITS,
    errors_of,
    existing,
    require_format,
    require_keys,
    require_place,
)
from flapenv.files.plausible import STROKES, require_insect
from flapenv.files.strokes import stroke_of
from flapenv.insects import Insect
from flapenv.problem import HoverProblem, StrokeBox
from flapenv.read_json import read_object
from flapenv.whole_file import json_text, write_text

FORMAT = "flapenv-wing"
MOST_RADII = 10_000
"""A planform of more points is refused."""
PARTS = tuple(field.name for field in dataclasses.fields(Insect))
NEEDED = ("format", "version", "units", "name", "mass", "wing", "stroke")
KEYS = ("format", "version", "units", *PARTS, "limits")
MEND = "a wing file, as docs/examples/robot.json is one"
OF_A_TABLE = ("mass", "pitch_axis")
"""Fields of `Wing` that may stand beside a planform in metres, which tells all others."""


@record
class WingFile:
    """One's own insect or vehicle, and the limits of its strokes.

    Attributes:
        insect: scalar fields.
        limits: bounds (lower, upper) by the names of `StrokeBox`'s fields [their units].

    Raises:
        TypeError: for another kind, or array fields.
        ValueError: for bounds out of range, or numbers that are no flapping wing's.
    """

    insect: Insect
    limits: dict[str, tuple[float, float]] = dataclasses.field(default_factory=dict)

    def __post_init__(self) -> None:
        """Check both; a limit may be one number, which fixes its parameter."""
        if not isinstance(self.insect, Insect):
            raise TypeError(f"insect = {shown(self.insect)} is not allowed; allowed: an Insect")
        require_insect(self.insect)
        if not isinstance(self.limits, Mapping):
            raise TypeError(f"limits = {shown(self.limits)} are not allowed; allowed: an object of [lower, upper]")
        with errors_of("limits"):
            for name, bounds in self.limits.items():
                if bounds is None:
                    raise TypeError(f"bounds of {name} = null are not allowed; allowed: [lower, upper] or one number")
            box = StrokeBox(**self.limits)
            _require_bounds(box, self.insect)
        object.__setattr__(self, "limits", {name: getattr(box, name) for name in self.limits})

    def problem(self, base: HoverProblem) -> HoverProblem:
        """A problem within the limits: they replace its bounds where those are the default, and narrow them elsewhere.

        Args:
            base: the problem; where it has bounds of its own, such as a fixed frequency, they stay in force.

        Raises:
            ValueError: where the limits leave nothing of the base's own bounds, or the model does not cover them.
        """
        if not self.limits:
            return base
        default, bounds = StrokeBox(), vars(base.box).copy()
        for field, limits in self.limits.items():
            name = field.removesuffix("_ratio")
            own = f"{name}_ratio" if base.box.is_relative(name) else name
            if bounds[own] == getattr(default, own):
                bounds |= {own: None, field: limits} if own != field else {field: limits}
            else:
                bounds[own] = self._common(field, own, bounds[own])
        return dataclasses.replace(base, name=f"{base.name} within limits", box=StrokeBox(**bounds))

    def _common(self, field: str, own: str, bounds: tuple[float, float]) -> tuple[float, float]:
        """What the bounds of a problem, in its own terms, and the limits share."""
        low, high = self.limits[field]
        if field != own:
            reference = float(getattr(self.insect.reference, field.removesuffix("_ratio")))
            to_absolute = field.endswith("_ratio")  # divided, not multiplied by 1/reference: own over own is 1 exactly
            low, high = (end * reference if to_absolute else end / reference for end in (low, high))
        common = max(low, bounds[0]), min(high, bounds[1])
        if common[0] > common[1]:
            raise ValueError(
                f"limits of {field} leave {self.insect.name} nothing of the problem's own bounds: {own} in [{low:.6g}, "
                f"{high:.6g}] and in [{bounds[0]:.6g}, {bounds[1]:.6g}]; allowed: limits that meet them, or another "
                "problem"
            )
        return common


def _require_bounds(box: StrokeBox, insect: Insect) -> None:
    """Refuse bounds beyond what is allowed of the strokes themselves."""
    for name, (low, high) in STROKES.items():
        own = float(getattr(insect.stroke, name)) if box.is_relative(name) else 1.0
        field, unit = (f"{name}_ratio", "") if box.is_relative(name) else (name, STROKE_PARAMETERS[name].unit)
        for end, bound in zip(("lower", "upper"), getattr(box, field), strict=True):
            require_real(f"{end} bound of {field}", bound, low / own, high / own, unit=unit)


def read_wing(path: str | os.PathLike[str]) -> WingFile:
    """One's own wing from a JSON file, with its planform where that is a table of its own.

    Raises:
        TypeError: for a value of another kind.
        ValueError: for a file that is not what it should be, a number out of range or in another unit, and wings that
            no theory covers.
        OSError: if it cannot be read.
    """
    found = existing(path, MEND)
    content = read_object(found, mend=MEND)
    with errors_of(found):
        require_format(content, FORMAT, WING_UNITS)
        require_keys(content, KEYS, needed=NEEDED, what="the file")
        fields = {name: content[name] for name in PARTS if name in content}
        stroke = stroke_of(fields.pop("stroke"), "stroke")
        with errors_of("wing"):
            wing = _wing(fields.pop("wing"), found.parent)
        return WingFile(insect=Insect(wing=wing, stroke=stroke, **fields), limits=content.get("limits", {}))


def write_wing(path: str | os.PathLike[str], wing_file: WingFile) -> None:
    """Write one's own wing as JSON, whole or not at all; numbers keep every digit.

    Raises:
        TypeError: for anything but a `WingFile`, or a planform that is a function.
        ValueError: for a path that does not end in .json.
        OSError: if it cannot be written.
    """
    if not isinstance(wing_file, WingFile):
        raise TypeError(f"wing_file = {shown(wing_file)} is not allowed; allowed: a WingFile")
    found = Path(path)
    if found.suffix.lower() != ".json":
        raise ValueError(f"{found} does not end in .json; allowed: NAME.json")
    require_place(found)
    write_text(found, wing_to_text(wing_file))


def wing_to_text(wing_file: WingFile) -> str:
    """What `write_wing` writes.

    Raises:
        TypeError: for a planform that is a function.
    """
    parts = {name: _told(value) for name, value in wing_file.insect.to_dict().items() if value is not None}
    limits = {"limits": {name: list(bounds) for name, bounds in wing_file.limits.items()}} if wing_file.limits else {}
    return json_text({"format": FORMAT, "version": VERSION, "units": WING_UNITS, **parts, **limits})


def _told(value: Any) -> Any:
    """A value without the fields that are not told."""
    return {key: one for key, one in value.items() if one is not None} if isinstance(value, dict) else value


def _wing(fields: object, folder: Path) -> Wing:
    """A wing from three numbers, from a planform in metres, or from one in a file beside."""
    if not isinstance(fields, dict):
        raise TypeError(
            f"{shown(fields)} is not allowed; allowed: an object with length, mean_chord and r1_hat, or a planform"
        )
    if "planform_file" in fields:
        require_keys(fields, ("planform_file", *OF_A_TABLE), needed=(), what="a wing with a planform_file")
        path = _beside(fields["planform_file"], folder)
        rows = read_columns(path, {"radius": "m", "chord": "m"}, most=MOST_RADII)
        table: dict[str, Any] = {name: [row[name] for row in rows] for name in ("radius", "chord")}
        with errors_of(path):
            return _from_table(table, fields)
    planform = fields.get("planform")
    if isinstance(planform, dict) and "radius" in planform:
        require_keys(fields, ("planform", *OF_A_TABLE), needed=(), what="a wing with a planform in metres")
        require_keys(planform, ("radius", "chord", "rounded"), needed=("radius", "chord"), what="planform")
        return _from_table(planform, fields)
    return Wing(**fields)


def _from_table(table: Mapping[str, Any], fields: Mapping[str, Any]) -> Wing:
    """A wing from radii and chords in metres."""
    if isinstance(table["radius"], list) and len(table["radius"]) > MOST_RADII:
        raise ValueError(f"radius has {len(table['radius']):,} rows; allowed: up to {MOST_RADII:,}")
    rest = {name: fields[name] for name in OF_A_TABLE if name in fields}
    return Wing.from_table(**table, **rest)


def _beside(name: object, folder: Path) -> Path:
    """A file in the folder of the wing file or below it.

    Raises:
        TypeError: if it is no text.
        ValueError: for a path that leaves the folder.
        OSError: if there is no such file.
    """
    if not isinstance(name, str) or not name or "\0" in name:
        raise TypeError(
            f"planform_file = {shown(name)} is not allowed; allowed: the name of a CSV file beside this one"
        )
    path = folder / name
    if not path.resolve().is_relative_to(folder.resolve()):
        raise ValueError(f"planform_file = {shown(name)} leaves the folder of the wing file; allowed: a file beside it")
    return existing(path, "a CSV file with the columns radius [m],chord [m]")
