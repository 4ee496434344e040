"""Stroke files give back every digit, reproduce the published table, and refuse what could be misread."""

import csv
import dataclasses
import json
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from conftest import strokes, wings
from hypothesis import given
from hypothesis import strategies as st

from flapenv import (
    INSECTS,
    Insect,
    NamedStroke,
    Stroke,
    evaluate,
    load_insect,
    read_strokes,
    strokes_to_text,
    write_strokes,
)
from flapenv.aero.planform import FunctionPlanform
from flapenv.aero.wing import Wing
from flapenv.files.strokes import MOST_STROKES

NAMED = st.builds(NamedStroke, stroke=strokes(), insect=st.none() | st.sampled_from(INSECTS))
OWN = st.builds(
    Insect,
    name=st.sampled_from(["robot", "Ψ <b>"]),
    mass=st.floats(1e-4, 1e-3),
    wing=wings().map(lambda wing: dataclasses.replace(wing, length=0.02, mean_chord=0.006)),
    stroke=strokes(),
)
HAWKMOTH = load_insect("hawkmoth")


@given(some=st.lists(NAMED, min_size=1, max_size=4), ending=st.sampled_from([".json", ".csv", ".JSON"]))
def test_strokes_come_back_to_the_last_digit(
    some: list[NamedStroke], ending: str, tmp_path_factory: pytest.TempPathFactory
) -> None:
    path = tmp_path_factory.mktemp("strokes") / f"a{ending}"
    write_strokes(path, some)
    assert read_strokes(path) == tuple(some)
    assert list(path.parent.iterdir()) == [path]


@given(insect=OWN, stroke=strokes())
def test_an_insect_of_ones_own_is_in_the_file_in_full(
    insect: Insect, stroke: Stroke, tmp_path_factory: pytest.TempPathFactory
) -> None:
    path = tmp_path_factory.mktemp("strokes") / "a.json"
    write_strokes(path, [NamedStroke(stroke=stroke, insect=insect)])
    assert read_strokes(path) == (NamedStroke(stroke=stroke, insect=insect),)


@pytest.mark.parametrize("ending", [".json", ".csv"])
def test_a_published_stroke_from_a_file_reproduces_its_line_of_table_3(
    insect: Insect, ending: str, tmp_path: Path
) -> None:
    write_strokes(tmp_path / f"a{ending}", [NamedStroke(stroke=insect.stroke, insect=insect.name)])
    (read,) = read_strokes(tmp_path / f"a{ending}")
    found, line = evaluate(read.insect, read.stroke), evaluate(insect)
    assert found == line
    assert found.weight_support == pytest.approx(insect.published.weight_support, abs=0.05)  # printed with two digits


def test_the_text_is_what_the_file_holds_and_says_what_it_is(tmp_path: Path) -> None:
    named = [NamedStroke(stroke=HAWKMOTH.stroke, insect="hawkmoth"), NamedStroke(stroke=HAWKMOTH.stroke)]
    write_strokes(tmp_path / "a.json", named)
    text = strokes_to_text(named)
    assert (tmp_path / "a.json").read_text(encoding="utf-8") == text
    content = json.loads(text)
    assert (content["format"], content["version"]) == ("flapenv-strokes", 1)
    assert content["units"]["flap_amplitude"] == "rad"
    assert [one["insect"] for one in content["strokes"]] == ["hawkmoth", None]


def test_columns_may_stand_in_any_order_and_the_insect_may_be_missing(tmp_path: Path) -> None:
    write_strokes(tmp_path / "a.csv", [NamedStroke(stroke=HAWKMOTH.stroke)])
    with (tmp_path / "a.csv").open(encoding="utf-8", newline="") as file:
        rows = [row[:0:-1] for row in csv.reader(file)]
    text = "\r\n".join([", ".join(row) for row in rows] + ["", ""])
    (tmp_path / "b.csv").write_bytes(b"\xef\xbb\xbf" + text.encode())
    assert read_strokes(tmp_path / "b.csv") == (NamedStroke(stroke=HAWKMOTH.stroke),)


def test_the_results_of_a_run_are_read_as_the_strokes_it_learned(tmp_path: Path) -> None:
    stroke = dataclasses.asdict(HAWKMOTH.stroke)
    results = {"insects": {"hawkmoth": {"stroke": stroke, "gap_percent": 1.0}}, "mean_gap_percent": None}
    (tmp_path / "results.json").write_text(json.dumps(results))
    assert read_strokes(tmp_path / "results.json") == (NamedStroke(stroke=HAWKMOTH.stroke, insect="hawkmoth"),)


def valid() -> dict[str, Any]:
    return json.loads(strokes_to_text([NamedStroke(stroke=HAWKMOTH.stroke, insect="hawkmoth")]))


def with_entry(**changes: Any) -> dict[str, Any]:
    content = valid()
    content["strokes"][0] |= changes
    return content


def without(content: dict[str, Any], *keys: str) -> dict[str, Any]:
    return {key: value for key, value in content.items() if key not in keys}


def with_units(**changes: Any) -> dict[str, Any]:
    content = valid()
    return {**content, "units": {**content["units"], **changes}}


def in_millimetres() -> dict[str, Any]:
    return HAWKMOTH.to_dict() | {"name": "moth", "wing": HAWKMOTH.to_dict()["wing"] | {"length": 51.9}}


def valid_stroke() -> dict[str, float]:
    return dataclasses.asdict(HAWKMOTH.stroke)


def results(**insects: Any) -> dict[str, Any]:
    return {"insects": insects}


@pytest.mark.parametrize(
    ("content", "said"),
    [
        ({}, "format = None is not allowed; allowed: 'flapenv-strokes'"),
        (valid() | {"format": "flapenv-wing"}, "format = 'flapenv-wing' is not allowed"),
        (valid() | {"version": 2}, "version = 2 is not allowed; allowed: 1"),
        (valid() | {"version": True}, "version = True is not allowed"),
        (without(valid(), "version"), "version = None is not allowed"),
        (without(valid(), "units"), 'units = None are not allowed; allowed: {"frequency": "Hz"'),
        (with_units(flap_amplitude="deg"), "unit of flap_amplitude = 'deg' is not allowed; allowed: 'rad'; convert"),
        (with_units(speed="m/s"), "units: unknown key 'speed'"),
        (valid() | {"units": {"frequency": "Hz"}}, "units: flap_amplitude, .* not told"),
        (without(valid(), "strokes"), "the file: strokes not told"),
        (valid() | {"stroke": 1}, "unknown key 'stroke'; .*did you mean 'strokes'"),
        (valid() | {"strokes": {}}, "strokes = {} are not allowed; allowed: a list"),
        (valid() | {"strokes": []}, "strokes holds 0; allowed: from 1 to 10,000"),
        (valid() | {"strokes": [{}] * (MOST_STROKES + 1)}, "strokes holds 10,001; allowed: from 1 to 10,000"),
        (valid() | {"strokes": [3]}, r"strokes\[0\] = 3 is not allowed; allowed: an object"),
        (with_entry(flap_shap=0.5), r"strokes\[0\]: unknown key 'flap_shap'; .*did you mean 'flap_shape'"),
        (valid() | {"strokes": [without(valid()["strokes"][0], "pitch_phase")]}, r"strokes\[0\]: pitch_phase not told"),
        (with_entry(frequency="26"), r"strokes\[0\]: frequency = \"26\" is not a number"),
        (with_entry(frequency=True), r"strokes\[0\]: frequency = true is not a number"),
        (with_entry(frequency=None), r"strokes\[0\]: frequency = null is not a number"),
        (with_entry(frequency=[26]), r"strokes\[0\]: frequency = \[26\] is not a number"),
        (
            with_entry(frequency=0),
            r"strokes\[0\]: frequency = 0 is not allowed; allowed: finite, in \[1e-15, 1e\+15\] Hz",
        ),
        (with_entry(frequency=10**400), r"strokes\[0\]: frequency = 1000"),
        (with_entry(frequency=float("nan")), r"strokes\[0\].frequency = NaN is not a number"),
        (with_entry(flap_amplitude=60), r"strokes\[0\]: flap_amplitude = 60 .*; 60 looks like degrees: 1.0472 rad"),
        (with_entry(pitch_phase=90), "90 looks like degrees: 1.5708 rad"),
        (with_entry(insect="hawkmot"), r"strokes\[0\]: insect = 'hawkmot' is unknown; .*did you mean 'hawkmoth'"),
        (with_entry(insect=3), r"strokes\[0\]: insect = 3 is not allowed"),
        (with_entry(insect={"name": "robot"}), r"strokes\[0\]: Insect needs mass, wing, stroke"),
        (
            with_entry(insect=HAWKMOTH.to_dict() | {"mass": [1.0, 2.0]}),
            "mass of Insect is an array; allowed: scalar fields",
        ),
        (with_entry(insect=HAWKMOTH.to_dict() | {"name": "a\nb"}), r"name = 'a\\nb' is not allowed"),
        (with_entry(insect=HAWKMOTH.to_dict() | {"mass": 2e-3}), r"'hawkmoth' is that of an insect with other numbers"),
        (with_entry(insect=in_millimetres()), r"strokes\[0\]: length = 51.9 is .*; 51.9 looks like millimetres: 0.05"),
        (with_entry(frequency=1e104), r"frequency = 1e.104 is not allowed; allowed: finite, in \[1e-15, 1e.15\] Hz"),
        (
            with_entry(frequency=5e-324),
            r"strokes\[0\]: frequency = 4.9.*e-324 is not allowed; allowed: .* \[1e-15, 1e.15\]",
        ),
        (with_entry(flap_amplitude=1e-300), r"flap_amplitude = 1e-300 is not allowed; allowed: finite, in \[1e-15, 3"),
        (with_entry(pitch_shape=1e308), r"pitch_shape = 1e.308 is not allowed; allowed: finite, in \[0, 1e.06\]"),
        (with_entry(frequency="a\n\x1b[31m\u2028" + "b" * 10**6), r"frequency = .a.*b. is not a number"),
        (with_entry(**{"a\n\u0085": 1}), r"unknown key 'a.n.x85'"),
        (with_entry(insect="a\n\u0085"), r"insect = 'a.n.x85' is unknown"),
        (results(**{"a\nb\x1b": {"stroke": {}}}), r"insects.a.nb.x1b is none of"),
        (results(), "insects holds none"),
        (results(robot={"stroke": {}}), "insects.robot is none of fruitfly, .*allowed: a stroke file"),
        (
            results(moth={"stroke": valid_stroke(), "insect": HAWKMOTH.to_dict() | {"name": "b"}}),
            "not the one it stands",
        ),
        (results(moth={"stroke": valid_stroke(), "insect": HAWKMOTH.to_dict()}), "not the one it stands under"),
        (results(moth={"stroke": valid_stroke(), "insect": None}), "insect = None is not the one it stands under"),
        (results(hawkmoth={"gap": 1}), "insects.hawkmoth holds no stroke"),
        (results(hawkmoth={"stroke": [1]}), r"insects.hawkmoth.stroke = \[1\] is not allowed"),
        (results(hawkmoth={"stroke": {}}), "insects.hawkmoth.stroke: frequency, .* not told"),
    ],
)
def test_what_is_wrong_with_a_file_is_told_in_one_line_that_names_it(
    content: dict[str, Any], said: str, tmp_path: Path
) -> None:
    path = tmp_path / "a.json"
    path.write_text(json.dumps(content))
    refused(path, said)


@pytest.mark.parametrize("column", ["frequency", "pitch_shape"])
def test_a_table_holds_no_stroke_that_nothing_beats(column: str, tmp_path: Path) -> None:
    write_strokes(tmp_path / "a.csv", [NamedStroke(stroke=HAWKMOTH.stroke)])
    text = (tmp_path / "a.csv").read_text(encoding="utf-8")
    value = repr(float(getattr(HAWKMOTH.stroke, column)))
    (tmp_path / "a.csv").write_text(text.replace(f",{value},", ",1e200,"), encoding="utf-8")
    refused(tmp_path / "a.csv", f"row 1: {column} = 1e.200 is not allowed")


def refused(path: Path, said: str, kinds: Any = (TypeError, ValueError)) -> None:
    with pytest.raises(kinds, match=said) as caught:
        read_strokes(path)
    assert str(path) in str(caught.value)
    assert str(caught.value).isprintable()
    assert len(str(caught.value)) < 1500
    assert (
        "allowed: " in str(caught.value) or "its keys are" in str(caught.value) or "its fields are" in str(caught.value)
    )


HEADER = (
    "insect,frequency [Hz],flap_amplitude [rad],pitch_amplitude [rad],flap_shape [-],pitch_shape [-],pitch_phase [rad]"
)
ROW = "hawkmoth,26.3,1.05,1.01,0,5,1.57"


@pytest.mark.parametrize(
    ("text", "said"),
    [
        ("", "is empty; allowed: a header frequency"),
        (f"{HEADER}\n", "has a header but no rows"),
        (HEADER.replace(" [rad]", " [deg]", 1), r"column 'flap_amplitude \[deg\]' is not in rad; .*convert"),
        (HEADER.replace(" [Hz]", " [Hz"), "column 'frequency .Hz' is not in Hz; allowed: 'frequency .Hz.'"),
        (HEADER.replace(" [Hz]", ""), "column 'frequency' has no unit; allowed: 'frequency .Hz.'"),
        (HEADER.replace(",pitch_phase [rad]", ""), r"no column pitch_phase \[rad\]"),
        (f"{HEADER},pitch_phase [rad]", "column 'pitch_phase' stands twice"),
        (f"{HEADER},insect", "column 'insect' stands twice"),
        (HEADER.replace("frequency", "frequenzy"), "unknown column 'frequenzy .Hz.'; .*did you mean 'frequency"),
        (HEADER.replace(",", ";"), "columns are parted by semicolons; allowed: commas"),
        (f"{HEADER}\n{ROW},1", "line 2 has 8 cells; allowed: 7"),
        (f"{HEADER}\n{ROW[:-5]}", "line 2 has 6 cells"),
        (f"{HEADER}\n\n{ROW.replace('26.3', 'nan')}", "line 3: frequency = 'nan' is not a number"),
        (f"{HEADER}\n{ROW.replace('26.3', 'inf')}", "frequency = 'inf' is not a number"),
        (f"{HEADER}\n{ROW.replace('26.3', '1e999')}", "frequency = '1e999' is not a number"),
        (f"{HEADER}\n{ROW.replace('26.3', '2_6')}", "frequency = '2_6' is not a number"),
        (f"{HEADER}\n{ROW.replace('26.3', '٢')}", "frequency = '٢' is not a number"),
        (f"{HEADER}\n{ROW.replace('26.3', '')}", "frequency = '' is not a number"),
        (f"{HEADER}\n{ROW.replace('26.3', chr(34) + '26,3' + chr(34))}", "frequency = '26,3' is not a number"),
        (f"{HEADER}\n{ROW.replace('1.05', '60')}", "row 1: flap_amplitude = 60 .*; 60 looks like degrees: 1.0472 rad"),
        (f"{HEADER}\n{ROW}\n{ROW.replace('hawkmoth', 'moth')}", "row 2: insect = 'moth' is unknown; allowed: fruitfly"),
        (f'{HEADER}\n"hawkmoth', "line 2 is not CSV: unexpected end of data"),
        ("\n".join([HEADER, *[ROW] * (MOST_STROKES + 1)]), "has more than 10,000 rows; allowed: up to 10,000"),
    ],
)
def test_what_is_wrong_with_a_table_is_told_in_one_line(text: str, said: str, tmp_path: Path) -> None:
    (tmp_path / "a.csv").write_text(text, encoding="utf-8")
    refused(tmp_path / "a.csv", said, ValueError)


def test_other_files_and_paths_are_refused(tmp_path: Path) -> None:
    refused(tmp_path / "a.json", "does not exist; allowed: a stroke file", FileNotFoundError)
    refused(tmp_path, "is a folder", IsADirectoryError)
    (tmp_path / "a.txt").touch()
    refused(tmp_path / "a.txt", "does not end in .json or .csv")
    (tmp_path / "a.csv").write_bytes(b"PK\x03\x04\xff\xfe")
    refused(tmp_path / "a.csv", "is not text")
    (tmp_path / "a.json").write_bytes(b'{"format": "flapenv-str')
    refused(tmp_path / "a.json", "is not JSON that can be read: Unterminated string")
    with pytest.raises(TypeError, match="path = 3 is not allowed"):
        read_strokes(3)


def test_what_no_file_can_hold_is_refused_before_anything_is_written(tmp_path: Path) -> None:
    own = dataclasses.replace(HAWKMOTH, name="robot")
    bent = dataclasses.replace(
        own, wing=Wing(length=0.05, mean_chord=0.018, planform=FunctionPlanform(function=np.sqrt))
    )
    stroke = HAWKMOTH.stroke
    for name, named, said in (
        ("a.csv", [NamedStroke(stroke=stroke, insect=own)], "insect 'robot' is none of .*allowed: NAME.json"),
        ("a.json", [NamedStroke(stroke=stroke, insect=bent)], "planform of robot is a function"),
        ("a.json", [], "0 strokes are not allowed"),
        ("a.json", [stroke], "stroke = Stroke.* is not allowed; allowed: NamedStrokes"),
        ("a.txt", [NamedStroke(stroke=stroke)], "does not end in .json or .csv"),
        ("nowhere/a.json", [NamedStroke(stroke=stroke)], "nowhere is not a folder"),
    ):
        with pytest.raises((TypeError, ValueError, OSError), match=said):
            write_strokes(tmp_path / name, named)
    assert not list(tmp_path.iterdir())


def test_a_batch_of_strokes_is_no_stroke() -> None:
    with pytest.raises(TypeError, match="frequency of Stroke is an array; allowed: scalar"):
        NamedStroke(stroke=dataclasses.replace(HAWKMOTH.stroke, frequency=np.array([20.0, 30.0])))
    with pytest.raises(TypeError, match="stroke = 3 is not allowed"):
        NamedStroke(stroke=3)
