"""JSON Schemas of stroke and wing files (draft 2020-12), made from the table of parameters and the records.

What a schema cannot say is left to the readers: bounds in order, radii that rise, and wings that no theory covers.
"""

import dataclasses
import math
from collections.abc import Collection, Mapping
from typing import Any

from flapenv.aero.checks import HUGEST, TINIEST, require_name
from flapenv.aero.parameters import STROKE_PARAMETERS
from flapenv.aero.planform import LARGEST_R1_HAT, LEAST_R1_HAT, TabulatedPlanform
from flapenv.aero.stroke import Stroke
from flapenv.aero.wing import Wing
from flapenv.files import strokes, wings
from flapenv.files.envelope import STROKE_UNITS, VERSION, WING_UNITS
from flapenv.files.plausible import CHORDS, HEAVIEST, LARGEST_FACTOR, LENGTHS, LONGEST_NAME, STROKES
from flapenv.insects import INSECTS, ForceConstants, HoverReference, Insect, WingFactors
from flapenv.problem import RELATIVE, StrokeBox

DRAFT = "https://json-schema.org/draft/2020-12/schema"
UNSEEN = r"[\u0000-\u001f\u007f-\u009f\u2028\u2029]"
"""What no name holds: control characters and line ends; readers refuse whatever does not print."""
Schema = dict[str, Any]


def stroke_schema() -> Schema:
    """The schema of a stroke file."""
    insect = {"anyOf": [{"enum": list(INSECTS)}, {"type": "null"}, {"$ref": "#/$defs/insect"}]}
    entry = _object({"insect": insect, **_stroke_fields()}, needed=STROKE_UNITS)
    listed = {"type": "array", "items": entry, "minItems": 1, "maxItems": strokes.MOST_STROKES}
    return {
        **_head("Strokes", strokes.FORMAT, STROKE_UNITS, {"strokes": listed}, needed=strokes.KEYS),
        "$defs": {"insect": _insect()},
    }


def wing_schema() -> Schema:
    """The schema of a wing file."""
    columns = {"type": "array", "items": _number(0), "minItems": 2, "maxItems": wings.MOST_RADII}
    metres = _object({"radius": columns, "chord": columns, "rounded": {"type": "boolean"}}, needed=("radius", "chord"))
    own = _wing_fields()
    rest = {name: own[name] for name in wings.OF_A_TABLE}
    whole = _object(own, needed=("length", "mean_chord"))
    wing = {
        "anyOf": [
            {**whole, "anyOf": [{"required": ["r1_hat"]}, {"required": ["planform"]}]},
            _object({"planform": metres, **rest}, needed=("planform",)),
            _object({"planform_file": {"type": "string", "minLength": 1}, **rest}, needed=("planform_file",)),
        ]
    }
    both = [{"required": [name, f"{name}_ratio"]} for name in RELATIVE]
    fields = {
        **_insect()["properties"],
        "wing": wing,
        "stroke": _object(_stroke_fields(), needed=STROKE_UNITS),
        "limits": {**_object(_limits(), needed=()), "not": {"anyOf": both}},
    }
    return _head("Wing", wings.FORMAT, WING_UNITS, fields, needed=wings.NEEDED)


def _head(title: str, name: str, units: Mapping[str, str], fields: Schema, *, needed: Collection[str]) -> Schema:
    """A whole file: what it is, its version and units, and its fields."""
    told = {
        "format": {"const": name},
        "version": {"const": VERSION},
        "units": _object({field: {"const": unit} for field, unit in units.items()}, needed=units),
    }
    return {"$schema": DRAFT, "title": f"flapenv: {title}", **_object({**told, **fields}, needed=needed)}


def _object(properties: Schema, *, needed: Collection[str]) -> Schema:
    """An object without other keys than these."""
    return {"type": "object", "properties": properties, "required": list(needed), "additionalProperties": False}


def _number(low: float = -math.inf, high: float = math.inf, *, meaning: str = "") -> Schema:
    """A number in a range."""
    made: Schema = {"type": "number"}
    if math.isfinite(low):
        made["minimum"] = low
    if math.isfinite(high):
        made["maximum"] = high
    return {**made, "description": meaning} if meaning else made


def _or_null(schema: Schema) -> Schema:
    """A value that may be left out."""
    return {"anyOf": [schema, {"type": "null"}]}


def _record(kind: type, properties: Schema) -> Schema:
    """A record of the package, whose fields without a default are needed; fails where a field is not described."""
    fields = dataclasses.fields(kind)
    for field in fields:
        require_name(f"field of {kind.__name__}", field.name, properties)
    needed = [
        field.name
        for field in fields
        if field.default is dataclasses.MISSING and field.default_factory is dataclasses.MISSING
    ]
    return _object(properties, needed=needed)


def _stroke_fields() -> Schema:
    """The six numbers of a stroke."""
    made = {}
    for name, row in STROKE_PARAMETERS.items():
        low, high = STROKES.get(name, (row.low, row.high))
        meaning = f"{row.meaning} [{row.unit or '-'}]"
        made[name] = _number(low, high, meaning=meaning)
    return made


def _limits() -> Schema:
    """Bounds of strokes: pairs, or one number for a parameter that is fixed."""
    made = {}
    for field in (field.name for field in dataclasses.fields(StrokeBox)):
        row = STROKE_PARAMETERS[field.removesuffix("_ratio")]
        low, high = STROKES.get(field, (row.low, row.high))
        bound = _number(low, high)
        unit = "over the insect's own" if field.endswith("_ratio") else row.unit or "-"
        pair = {"type": "array", "items": bound, "minItems": 2, "maxItems": 2}
        made[field] = {"anyOf": [pair, bound], "description": f"{row.meaning} [{unit}]"}
    return made


def _wing_fields() -> Schema:
    """The fields of `Wing` with relative radii and chords."""
    column = {"type": "array", "items": _number(0), "minItems": 2}
    planform = _record(TabulatedPlanform, {"r_hat": column, "chord": column, "rounded": {"type": "boolean"}})
    return {
        "length": _number(*LENGTHS, meaning="R, from root to tip [m]"),
        "mean_chord": _number(*CHORDS, meaning="c̄ [m]"),
        "r1_hat": _or_null({"type": "number", "minimum": LEAST_R1_HAT, "maximum": LARGEST_R1_HAT}),
        "planform": _or_null(planform),
        "mass": _or_null(_number(TINIEST, HUGEST, meaning="of one wing [kg]")),
        "pitch_axis": _number(0, 1, meaning="behind the leading edge [chords]"),
    }


def _insect() -> Schema:
    """The fields of `Insect`, as `Insect.to_dict` gives them."""
    positive, factor = _number(TINIEST, LARGEST_FACTOR), _number(1, LARGEST_FACTOR)
    above = _number(TINIEST, HUGEST)
    reference = _record(HoverReference, {"weight_support": above, "specific_power": _or_null(above)})
    factors = {"k_ind": factor, "k_tip": factor, "k_revolving": _or_null(factor)}
    constant = _number(0, LARGEST_FACTOR)
    constants = {"lift_constant": positive, "zero_drag": constant, "normal_drag": constant}
    name = {"type": "string", "maxLength": LONGEST_NAME, "pattern": r"\S", "not": {"pattern": UNSEEN}}
    return _record(
        Insect,
        {
            "name": name,
            "mass": _number(TINIEST, HEAVIEST, meaning="of the whole body [kg]"),
            "wing": _record(Wing, _wing_fields()),
            "stroke": _record(Stroke, _stroke_fields()),
            "k_table": _or_null(_record(WingFactors, factors)),
            "force_constants": _or_null(_record(ForceConstants, constants)),
            **{source: _or_null(reference) for source in ("cfd", "published", "berman_wang")},
        },
    )
