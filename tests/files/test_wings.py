"""Wing files give back every digit, keep to their folder, and refuse wings in wrong units or beyond every theory."""

import dataclasses
import json
import math
import os
from pathlib import Path
from typing import Any

import pytest
from conftest import strokes, wings
from hypothesis import given
from hypothesis import strategies as st

from flapenv import (
    PROBLEMS,
    HoverProblem,
    Insect,
    StrokeBox,
    TabulatedPlanform,
    Wing,
    WingFile,
    evaluate,
    load_insect,
    optimum,
    read_wing,
    write_wing,
)
from flapenv.files.wings import MOST_RADII

EXAMPLES = Path(__file__).parents[2] / "docs" / "examples"
HAWKMOTH = load_insect("hawkmoth")
PLANFORMS = st.lists(st.floats(0.1, 1.0), min_size=3, max_size=6).map(
    lambda chord: TabulatedPlanform(r_hat=[i / (len(chord) - 1) for i in range(len(chord))], chord=chord)
)
LIMITS = st.fixed_dictionaries(
    {},
    optional={
        "frequency": st.just((60.0, 110.0)),
        "flap_amplitude_ratio": st.just((0.9, 1.1)),
        "pitch_phase": st.floats(1, 2).map(lambda one: (one, one)),
    },
)


def plausible_mass(wing: Wing) -> float:
    """8 N/m² on both wings [kg]."""
    return 8 * 2 * float(wing.area) / 9.81


@given(
    wing=wings(), stroke=strokes(), limits=LIMITS, planform=st.none() | PLANFORMS, mass=st.none() | st.floats(0.01, 0.1)
)
def test_a_wing_comes_back_to_the_last_digit(
    wing: Wing, stroke: Any, limits: Any, planform: Any, mass: float | None, tmp_path_factory: pytest.TempPathFactory
) -> None:
    body = plausible_mass(wing)
    shape = {"planform": planform, "r1_hat": None} if planform and 0.39 < planform.r1_hat < 0.64 else {}
    wing = dataclasses.replace(wing, **shape, mean_chord=wing.length / 3.1, mass=mass and mass * body)
    body = plausible_mass(wing)
    wing_file = WingFile(insect=Insect(name="Ψ", mass=body, wing=wing, stroke=stroke), limits=limits)
    path = tmp_path_factory.mktemp("wing") / "a.json"
    write_wing(path, wing_file)
    assert read_wing(path) == wing_file
    assert list(path.parent.iterdir()) == [path]


def test_the_eight_insects_can_be_written_with_all_that_is_known_of_them(insect: Insect, tmp_path: Path) -> None:
    write_wing(tmp_path / "a.json", WingFile(insect=insect))
    read = read_wing(tmp_path / "a.json").insect
    assert read == insect
    assert evaluate(read) == evaluate(insect)


def test_the_example_hovers_within_its_limits_with_less_power_than_by_its_own_stroke() -> None:
    example = read_wing(EXAMPLES / "robot.json")
    own, best = evaluate(example.insect), optimum(example.insect, example.problem(HoverProblem()))
    assert example.insect.mass == 1e-4
    assert own.weight_support == pytest.approx(1, abs=0.05)
    assert best.feasible
    assert best.specific_power < own.specific_power
    for name, (low, high) in example.limits.items():
        assert low - 1e-9 <= getattr(best.stroke, name) <= high + 1e-9


def test_a_planform_in_metres_is_the_wing_measured_there(tmp_path: Path) -> None:
    content = valid()
    content["wing"] = {"planform": {"radius": [0, 0.02, 0.05], "chord": [0.01, 0.02, 0.005]}, "mass": 4e-5}
    wing = read_wing(written(content, tmp_path)).insect.wing
    assert wing == Wing.from_table([0, 0.02, 0.05], [0.01, 0.02, 0.005], mass=4e-5)
    table = "chord [m],radius [m]\n0.01,0\n0.02,0.02\n0.005,0.05\n"
    (tmp_path / "planforms").mkdir()
    (tmp_path / "planforms" / "a.csv").write_text(table)
    content["wing"] = {"planform_file": "planforms/a.csv", "mass": 4e-5}
    assert read_wing(written(content, tmp_path)).insect.wing == wing


def wing_file(**limits: Any) -> WingFile:
    return WingFile(insect=HAWKMOTH, limits=limits)


def test_limits_replace_default_bounds_and_narrow_those_that_the_problem_sets() -> None:
    base = HoverProblem()
    assert wing_file().problem(base) is base
    box = wing_file(frequency=(10, 30), pitch_amplitude=(0.5, 1.3)).problem(base).box
    assert box == StrokeBox(frequency=(10, 30), pitch_amplitude=(0.5, 1.3))
    fixed = PROBLEMS["fixed-frequency"]
    box = wing_file(frequency=(10, 30), flap_shape=0.5).problem(fixed).box
    assert box.frequency_ratio == (1, 1)  # 26.3 Hz lies within
    assert box.flap_shape == (0.5, 0.5)
    own = HAWKMOTH.stroke.frequency
    assert wing_file(frequency=(own, own)).problem(fixed).box.frequency_ratio == (1, 1)
    drag = wing_file(pitch_amplitude=(math.radians(50), math.radians(88))).problem(PROBLEMS["profile-drag"])
    assert drag.box.pitch_amplitude == pytest.approx((math.radians(50), math.radians(85)))
    assert drag.model == PROBLEMS["profile-drag"].model
    absolute = HoverProblem(box=StrokeBox(frequency=(20.0, 40.0)))
    low, high = wing_file(frequency_ratio=(0.5, 1.0)).problem(absolute).box.frequency
    assert (low, high) == pytest.approx((20.0, 26.3))


def test_limits_that_leave_nothing_are_told() -> None:
    with pytest.raises(ValueError, match=r"limits of frequency leave hawkmoth nothing .* frequency_ratio in \[1.9"):
        wing_file(frequency=(50, 60)).problem(PROBLEMS["fixed-frequency"])


def test_a_wing_of_many_is_none() -> None:
    with pytest.raises(TypeError, match="mass of Insect is an array; allowed: scalar fields"):
        WingFile(insect=dataclasses.replace(HAWKMOTH, mass=[1e-3, 2e-3]))
    with pytest.raises(TypeError, match="insect = 'hawkmoth' is not allowed; allowed: an Insect"):
        WingFile(insect="hawkmoth")
    with pytest.raises(TypeError, match="is not allowed; allowed: a WingFile"):
        write_wing("a.json", HAWKMOTH)
    with pytest.raises(ValueError, match=r"a\.csv does not end in \.json"):
        write_wing("a.csv", wing_file())


def valid() -> dict[str, Any]:
    """The hawkmoth as a wing file, without its tabulated k."""
    numbers = HAWKMOTH.to_dict()
    return {
        "format": "flapenv-wing",
        "version": 1,
        "units": {"mass": "kg", "length": "m", "frequency": "Hz", "angle": "rad", "specific_power": "W/kg"},
        "name": "moth",
        "mass": numbers["mass"],
        "wing": {"length": 0.0519, "mean_chord": 0.01826, "r1_hat": 0.46},
        "stroke": numbers["stroke"],
    }


def written(content: dict[str, Any], folder: Path) -> Path:
    (folder / "a.json").write_text(json.dumps(content))
    return folder / "a.json"


def with_wing(**changes: Any) -> dict[str, Any]:
    return valid() | {"wing": valid()["wing"] | changes}


def with_table(radius: Any, chord: Any, **rest: Any) -> dict[str, Any]:
    return valid() | {"wing": {"planform": {"radius": radius, "chord": chord, **rest}}}


def with_stroke(**changes: Any) -> dict[str, Any]:
    return valid() | {"stroke": valid()["stroke"] | changes}


@pytest.mark.parametrize(
    ("content", "said"),
    [
        (valid() | {"format": "flapenv-strokes"}, "format = 'flapenv-strokes' is not allowed; allowed: 'flapenv-wing'"),
        (valid() | {"version": "1"}, "version = '1' is not allowed; allowed: 1"),
        (valid() | {"units": valid()["units"] | {"length": "mm"}}, "unit of length = 'mm' is not allowed; .*convert"),
        (valid() | {"units": "SI"}, "units = 'SI' are not allowed"),
        (valid() | {"limit": {}}, "unknown key 'limit'; .*did you mean 'limits'"),
        ({key: one for key, one in valid().items() if key != "mass"}, "the file: mass not told"),
        (valid() | {"name": ""}, "name = '' is not allowed"),
        (valid() | {"name": "a\nb"}, r"name = 'a\\nb' is not allowed"),
        *[(valid() | {"name": name}, "name = .* is not allowed; allowed: up") for name in ("  ", "a\x1b", "a\u2028")],
        (valid() | {"name": "hawkmoth"}, "name = 'hawkmoth' is that of an insect with other numbers"),
        (valid() | {"name": "a" * 101}, "allowed: up to 100 visible letters"),
        (valid() | {"mass": True}, "mass = True is not a real number"),
        (valid() | {"mass": 1648}, "mass = 1648 is not allowed; .*; 1648 looks like milligrams: 0.001648 kg"),
        (valid() | {"mass": 1.648}, "; 1.648 looks like grams: 0.001648 kg"),
        (valid() | {"mass": 0.8}, r"wing loading of 4.14e\+03 N/m².*; 0.8 looks like grams: 0.0008 kg"),
        (valid() | {"mass": 1e-9}, r"wing loading of 5.18e-06 N/m²; allowed: 0.01 to 1000$"),
        (valid() | {"mass": float("inf")}, "mass = Infinity is not a number"),
        (valid() | {"wing": [1]}, r"wing: \[1\] is not allowed; allowed: an object"),
        (with_wing(length=51.9), "length = 51.9 is not allowed; .*; 51.9 looks like millimetres: 0.0519 m"),
        (with_wing(mean_chord=18.26), "mean_chord = 18.26 .*; 18.26 looks like millimetres: 0.01826 m"),
        (with_wing(length=2000), r"length = 2000 is not allowed; allowed: finite, in \[0.0001, 1\] m$"),
        (with_wing(length=1.5e-12), "length = 1.5e-12 is .*; lengths are in metres, and 1.5e-09 mm is no flapping"),
        (with_wing(mean_chord=1e-6), r"mean_chord = 1e-06 is .* in \[1e-05, 1\] m; lengths are in metres"),
        (with_wing(length=0.01826, mean_chord=0.0519), "length/mean_chord = 0.3518 .*exchanged"),
        (with_wing(mean_chord=0.001), r"length/mean_chord = 51.9 is not allowed.*allowed: 1 to 20$"),
        (with_wing(r1_hat=0.9), r"wing: r1_hat = 0.9 is not allowed; allowed: finite, in \[0.001, 0.759\]"),
        (with_wing(r1_hat=0.7), r"r1_hat = 0.7 is not allowed; allowed: finite, in \[0.38, 0.65\]"),
        (with_wing(r1_hat=None), "wing: Wing needs r1_hat"),
        (with_wing(lenght=0.05), "wing: Wing has no field 'lenght'.*did you mean 'length'"),
        (with_wing(mass=0.001), "wing mass = 0.001 kg of each of two wings .*allowed: up to half of the body's mass"),
        (with_wing(pitch_axis=2), "wing: pitch_axis = 2"),
        (with_wing(planform_file="a.csv"), "wing: a wing with a planform_file: unknown key 'length'"),
        (with_wing(planform={"radius": [0, 1], "chord": [1, 1]}), "a wing with a planform in metres: unknown key"),
        (with_table([0, 25, 51.9], [10, 18, 5]), "length = 51.9 .*looks like millimetres"),
        (with_table([0, 0.03], [0.01, 0.01, 0.01]), r"wing: radius and chord have shapes \(2,\), \(3,\)"),
        (with_table([0, 0.03, 0.02], [0.01, 0.01, 0.01]), "wing: r_hat"),
        (with_table([0.01, 0.03], [0.01, 0.01]), "wing: radius runs from 0.01 to 0.03 m and does not cover the span"),
        (with_table([0, "0.03"], [0.01, 0.01]), "wing: radius = .* is not a real number"),
        (with_table([0, 0.03], [0, 0]), "wing: chord is zero everywhere"),
        (with_table([0, 0.03], [0.01, -0.01]), r"wing: chord\[1\] = -0.01 is not allowed"),
        (with_table([0, 0.03], [0.01, 0.01], round=True), "planform: unknown key 'round'; .*did you mean 'rounded'"),
        (with_table([0.0] * (MOST_RADII + 1), [0.01]), "wing: radius has 10,001 rows; allowed: up to 10,000"),
        (valid() | {"wing": {"planform_file": 3}}, "wing: planform_file = 3 is not allowed"),
        (valid() | {"wing": {"planform_file": "a\0b"}}, r"wing: planform_file = 'a.x00b' is not allowed"),
        (valid() | {"wing": {"planform_file": "../b.csv"}}, "planform_file = '../b.csv' leaves the folder"),
        (valid() | {"wing": {"planform_file": "/etc/passwd"}}, "planform_file = '/etc/passwd' leaves the folder"),
        (valid() | {"wing": {"planform_file": "link.csv"}}, "planform_file = 'link.csv' leaves the folder"),
        (
            valid() | {"wing": {"planform_file": "mm.csv"}},
            r"mm.csv: column .radius \[mm\]. is not in m; .*convert",
        ),
        (with_stroke(flap_amplitude=60.5), "stroke: flap_amplitude = 60.5 .*; 60.5 looks like degrees: 1.0559 rad"),
        (with_stroke(frequency=26300), r"frequency = 26300 is not allowed; allowed: finite, in \[0.1, 5000\] Hz"),
        (with_stroke(frequency=1e-300), r"frequency = 1e-300 is not allowed; allowed: finite, in \[1e-15, 1e.15\] Hz"),
        (valid() | {"stroke": {"frequency": 26.3}}, "stroke: flap_amplitude, .* not told"),
        (valid() | {"limits": [1]}, r"limits = \[1\] are not allowed"),
        (valid() | {"limits": {"frequenzy": [1, 2]}}, "limits: StrokeBox has no field 'frequenzy'"),
        (valid() | {"limits": {"frequency": None}}, "limits: bounds of frequency = null are not allowed"),
        (valid() | {"limits": {"frequency": [2, 1]}}, "limits: bounds of frequency: lower = 2 > upper = 1"),
        (valid() | {"limits": {"frequency": [1, 6000]}}, r"limits: upper bound of frequency = 6000 .* 5000\] Hz"),
        (
            valid() | {"limits": {"flap_amplitude": [40, 80]}},
            "limits: lower .*; 40 looks like degrees: 0.69813",
        ),
        (valid() | {"limits": {"frequency": [1, 2], "frequency_ratio": [1, 1]}}, "both bound the frequency"),
        (valid() | {"cfd": 3}, "cfd = 3 is not allowed"),
        (valid() | {"cfd": {"specific_power": 3}}, "HoverReference needs weight_support"),
        (valid() | {"limits": {"frequency_ratio": [1, 200]}}, "upper bound of frequency_ratio = 200 .*, 190.114\\]"),
        (valid() | {"limits": {"frequency": [1e-300, 50]}}, "lower bound of frequency = 1e-300 is not allowed"),
        (
            valid() | {"limits": {"flap_amplitude_ratio": [1e-300, 1]}},
            "lower bound of flap_amplitude_ratio = 1e-300 is",
        ),
        (valid() | {"limits": {"pitch_shape": [1, 1e7]}}, "upper bound of pitch_shape = 10000000 .*, 1e.06\\]"),
        (with_stroke(pitch_shape=1e308), r"pitch_shape = 1e.308 is not allowed; allowed: finite, in \[0, 1e.06\]"),
        (valid() | {"k_table": {"k_ind": 1e10, "k_tip": 1.0}}, "k_ind = 10000000000 is .* .1, 10\\]"),
        (valid() | {"k_table": {"k_ind": 9, "k_tip": 9}}, "k_revolving = 81 is not allowed"),
        (
            valid() | {"force_constants": {"lift_constant": 1.6, "zero_drag": 0.1, "normal_drag": 1e14}},
            "normal_drag = 1e.14 is not allowed; allowed: .*, 10\\]",
        ),
        (valid() | {"k_table": {"k_ind": 0.5, "k_tip": 1.1}}, "k_ind = 0.5 is not allowed"),
    ],
)
def test_what_is_wrong_with_a_wing_is_told_in_one_line_that_names_the_file(
    content: dict[str, Any], said: str, tmp_path: Path
) -> None:
    folder = tmp_path / "wing"
    folder.mkdir()
    (tmp_path / "b.csv").write_text("radius [m],chord [m]\n0,0.02\n0.05,0.02\n")
    (folder / "link.csv").symlink_to(tmp_path / "b.csv")
    (folder / "mm.csv").write_text("radius [mm],chord [mm]\n0,20\n50,20\n")
    path = written(content, folder)
    with pytest.raises((TypeError, ValueError), match=said) as caught:
        read_wing(path)
    assert str(caught.value).startswith(str(path))
    assert len(str(caught.value).splitlines()) == 1


def test_missing_files_are_named(tmp_path: Path) -> None:
    with pytest.raises(FileNotFoundError, match=r"no.json does not exist; allowed: a wing file, as docs"):
        read_wing(tmp_path / "no.json")
    os.mkfifo(tmp_path / "pipe.csv")
    with pytest.raises(OSError, match=r"pipe.csv is a pipe or a device; allowed: a CSV file with the columns radius"):
        read_wing(written(valid() | {"wing": {"planform_file": "pipe.csv"}}, tmp_path))
    with pytest.raises(OSError, match=r"aaa cannot be read .File name too long.; allowed: a CSV file"):
        read_wing(written(valid() | {"wing": {"planform_file": "a" * 5000}}, tmp_path))
    path = written(valid() | {"wing": {"planform_file": "no.csv"}}, tmp_path)
    with pytest.raises(FileNotFoundError, match=r"no.csv does not exist; allowed: a CSV file with the columns radius"):
        read_wing(path)
