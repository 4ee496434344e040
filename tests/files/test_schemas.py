"""The schemas say what the readers do, as far as a schema can, and the files under docs/ are the code's."""

import dataclasses
import json
import math
from collections.abc import Callable
from pathlib import Path
from typing import Any

import jsonschema
import pytest
from conftest import strokes
from hypothesis import given, settings
from hypothesis import strategies as st

from flapenv import (
    INSECTS,
    NamedStroke,
    WingFile,
    load_insect,
    read_strokes,
    read_wing,
    strokes_to_text,
    write_wing,
)
from flapenv.aero.parameters import STROKE_PARAMETERS
from flapenv.files import stroke_schema, wing_schema
from flapenv.files.__main__ import SCHEMAS, main

DOCS = Path(__file__).parents[2] / "docs"
HAWKMOTH = load_insect("hawkmoth")
NUMBERS = [-1, 0, 0.5, 1, 1.5, 3.2, 60, 1e9]
TEXTS = ["26.3", "rad", "deg", "hawkmoth", "moth", "a\nb", "a\n", " ", "a" * 101]
ODD = st.sampled_from([None, True, [], [1.0], {}, *NUMBERS, *TEXTS])
"""Values that are allowed in some places of a file and in others not."""


def test_the_schemas_under_docs_are_up_to_date(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    main(["--out", str(tmp_path)])
    for name in SCHEMAS:
        written = (tmp_path / name).read_text(encoding="utf-8")
        assert (DOCS / "schemas" / name).read_text(encoding="utf-8") == written, (
            "python -m flapenv.files --out docs/schemas"
        )
        assert f"wrote {tmp_path / name}" in capsys.readouterr().out or name != next(iter(SCHEMAS))
    main([])
    assert capsys.readouterr().out.count('"$schema"') == 2


@pytest.mark.parametrize("schema", [stroke_schema, wing_schema])
def test_the_schemas_are_schemas(schema: Callable[[], dict[str, Any]]) -> None:
    jsonschema.Draft202012Validator.check_schema(schema())


def valid(schema: dict[str, Any], content: Any) -> bool:
    return bool(jsonschema.Draft202012Validator(schema).is_valid(content))


def read(reader: Callable[[Path], object], content: Any, path: Path) -> bool:
    path.write_text(json.dumps(content), encoding="utf-8")
    try:
        reader(path)
    except (TypeError, ValueError):
        return False
    return True


def test_a_schema_has_the_ranges_of_the_table_of_parameters() -> None:
    fields = stroke_schema()["properties"]["strokes"]["items"]["properties"]
    least_of = {"frequency": 0.1, "flap_amplitude": 1e-3}
    for name, row in STROKE_PARAMETERS.items():
        assert fields[name]["minimum"] == least_of.get(name, row.low)
        assert fields[name].get("maximum", math.inf) == {"frequency": 5000, "pitch_shape": 1e6}.get(name, row.high)


def test_every_shipped_example_and_every_insect_fits_its_schema(tmp_path: Path) -> None:
    content = json.loads((DOCS / "examples" / "robot.json").read_text(encoding="utf-8"))
    jsonschema.validate(content, wing_schema())
    for name in INSECTS:
        write_wing(tmp_path / "a.json", WingFile(insect=load_insect(name), limits={"frequency": (10, 20)}))
        jsonschema.validate(json.loads((tmp_path / "a.json").read_text(encoding="utf-8")), wing_schema())


@given(stroke=strokes(), insect=st.none() | st.sampled_from(INSECTS), own=st.booleans())
def test_written_strokes_fit_the_schema(stroke: Any, insect: str | None, own: bool) -> None:
    whose = dataclasses.replace(load_insect(insect), name="robot") if own and insect else insect
    jsonschema.validate(json.loads(strokes_to_text([NamedStroke(stroke=stroke, insect=whose)])), stroke_schema())


def replaced(content: Any, place: tuple[Any, ...], value: Any) -> Any:
    """The content with another value in one place, or without it where the value is `LEFT_OUT`."""
    if not place:
        return value
    first, *rest = place
    changed = dict(content) if isinstance(content, dict) else list(content)
    if not rest and value is LEFT_OUT:
        del changed[first]
        return changed
    inner = changed.get(first, {}) if isinstance(changed, dict) else changed[first]
    changed[first] = replaced(inner, tuple(rest), value)
    return changed


LEFT_OUT = object()
STROKES = json.loads(strokes_to_text([NamedStroke(stroke=HAWKMOTH.stroke, insect="hawkmoth")]))
STROKE_PLACES = [
    *((key,) for key in (*STROKES, "unknown")),
    *(("units", name) for name in (*STROKE_PARAMETERS, "unknown")),
    ("strokes", 0),
    *(("strokes", 0, name) for name in (*STROKE_PARAMETERS, "insect", "unknown")),
]


def there(content: Any, place: tuple[Any, ...]) -> bool:
    """Whether the content has something in that place."""
    for key in place:
        if isinstance(content, dict) and key not in content:
            return False
        content = content[key]
    return True


def changes(places: list[tuple[Any, ...]], content: Any) -> st.SearchStrategy[tuple[tuple[Any, ...], Any]]:
    """A place of a file and what to put there; a key that is not known, too, and nothing in place of one that is."""
    left_out = st.tuples(st.sampled_from([place for place in places if there(content, place)]), st.just(LEFT_OUT))
    return st.tuples(st.sampled_from(places), ODD) | left_out


@settings(max_examples=300)
@given(change=changes(STROKE_PLACES, STROKES))
def test_schema_and_reader_agree_about_stroke_files(
    change: tuple[tuple[Any, ...], Any], tmp_path_factory: pytest.TempPathFactory
) -> None:
    content = replaced(STROKES, *change)
    path = tmp_path_factory.mktemp("schema") / "a.json"
    assert read(read_strokes, content, path) == valid(stroke_schema(), content), content


WING = {
    "format": "flapenv-wing",
    "version": 1,
    "units": {"mass": "kg", "length": "m", "frequency": "Hz", "angle": "rad", "specific_power": "W/kg"},
    "name": "moth",
    "mass": HAWKMOTH.mass,
    "wing": {"length": 0.0519, "mean_chord": 0.01826, "r1_hat": 0.46, "pitch_axis": 0.25, "mass": 4e-5},
    "stroke": dataclasses.asdict(HAWKMOTH.stroke),
    "limits": {"frequency": [20.0, 30.0], "pitch_phase": [1.0, 2.0]},
    "cfd": {"weight_support": 1.0, "specific_power": 30.0},
    "k_table": {"k_ind": 1.1, "k_tip": 1.1, "k_revolving": 1.2},
    "force_constants": {"lift_constant": 1.6, "zero_drag": 0.1, "normal_drag": 3.0},
}
BOTH = ("frequency_ratio", "flap_amplitude_ratio")
BODY = {"mass", "length", "mean_chord", "r1_hat"}
"""What a schema knows one by one, but not how they fit to each other."""
WING_PLACES = [
    *((key,) for key in (*WING, "published", "unknown") if key not in BODY),
    *(("units", name) for name in (*WING["units"], "unknown")),
    *(("wing", name) for name in ("pitch_axis", "unknown")),
    *(("stroke", name) for name in (*STROKE_PARAMETERS, "unknown")),
    *(("limits", name) for name in (*STROKE_PARAMETERS, "unknown", *BOTH) if name != "frequency"),
    *(("limits", "pitch_phase", end) for end in (0, 1)),
    *((part, name) for part in ("cfd", "k_table", "force_constants") for name in (*WING[part], "unknown")),
]


@settings(max_examples=300)
@given(change=changes(WING_PLACES, WING))
def test_schema_and_reader_agree_about_wing_files(
    change: tuple[tuple[Any, ...], Any], tmp_path_factory: pytest.TempPathFactory
) -> None:
    content = replaced(WING, *change)
    path = tmp_path_factory.mktemp("schema") / "a.json"
    agreed = read(read_wing, content, path), valid(wing_schema(), content)
    order = "lower = " in why(path) or "is that of an insect" in why(path)  # what no schema can compare
    assert agreed[0] == agreed[1] or (order and agreed == (False, True)), content


def why(path: Path) -> str:
    """What the reader says of a file; nothing where it reads it."""
    try:
        read_wing(path)
    except (TypeError, ValueError) as mistake:
        return str(mistake)
    return ""
