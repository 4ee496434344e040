"""Cases of the explorer: judged as `assess` judges, solved once, forgotten in their turn."""

import math
from pathlib import Path

import pytest

import flapenv
from agents.explorer.cases import KEPT, Case, Cases
from agents.explorer.controls import OWN_WING, read_stroke, shown_stroke, stroke_controls
from flapenv.aero.parameters import STROKE_PARAMETERS
from flapenv.assessment import assess
from flapenv.files import WingFile, read_wing

ROBOT = Path(flapenv.__file__).parents[1] / "docs" / "examples" / "robot.json"
STROKE = flapenv.Stroke(frequency=30.0, flap_amplitude=1.2, pitch_amplitude=1.0, flap_shape=0.5, pitch_phase=1.5)


@pytest.mark.parametrize("name", flapenv.INSECTS)
def test_a_stroke_is_judged_as_assess_judges_it(name: str) -> None:
    insect = flapenv.load_insect(name)
    case = Case(insect, flapenv.PROBLEMS["free-frequency"])
    judged, wanted = case.judged(STROKE), assess(insect, STROKE)
    fields = set(vars(wanted)) - {"rankings"}
    assert {field: getattr(judged, field) for field in fields} == {field: getattr(wanted, field) for field in fields}
    assert judged.saving == wanted.saving


def test_a_stroke_survives_the_sliders_units() -> None:
    insect = flapenv.load_insect("hawkmoth")
    back = read_stroke(shown_stroke(STROKE, insect), insect)
    for name in STROKE_PARAMETERS:
        assert getattr(back, name) == pytest.approx(getattr(STROKE, name), abs=1e-8)


@pytest.mark.parametrize("name", flapenv.INSECTS)
def test_every_stroke_that_a_button_loads_is_within_the_sliders(name: str) -> None:
    insect = flapenv.load_insect(name)
    case = Case(insect, flapenv.PROBLEMS["fixed-frequency"])
    for stroke in case.strokes().values():
        shown = shown_stroke(stroke, insect)
        assert shown[0] == pytest.approx(stroke.frequency, rel=1e-6)
        for control, value in zip(stroke_controls(insect), shown, strict=True):
            assert control.low <= value <= control.high
        back = read_stroke(shown, insect)
        assert back.pitch_shape == pytest.approx(stroke.pitch_shape, abs=1e-6)
        assert back.pitch_amplitude == pytest.approx(stroke.pitch_amplitude, abs=1e-8)


def test_a_case_is_solved_once_and_known_by_its_key() -> None:
    cases = Cases()
    key, case = cases.solve("fruitfly", None, "free-frequency")
    assert cases.solve("fruitfly", ["ignored"], "free-frequency")[1] is case
    assert cases.known(key) is case
    with pytest.raises(ValueError, match="reload the page"):
        cases.known("fruitfly")


def test_the_oldest_cases_are_forgotten() -> None:
    cases = Cases()
    first, _ = cases.solve("fruitfly", None, "free-frequency")
    for number in range(KEPT):
        cases._solved[str(number)] = cases.known(first)
    cases.solve("hawkmoth", None, "free-frequency")
    with pytest.raises(ValueError, match="reload the page"):
        cases.known(first)


def test_a_wing_of_a_file_is_explored_within_its_limits() -> None:
    wing = read_wing(ROBOT)
    cases = Cases(wing)
    assert next(iter(cases.insects)) == wing.insect.name
    _, case = cases.solve(wing.insect.name, None, "free-frequency")
    assert case.problem == wing.problem(flapenv.PROBLEMS["free-frequency"])
    assert case.own.best.specific_power == pytest.approx(flapenv.optimum(wing.insect, case.problem).specific_power)
    assert math.isfinite(case.judged(case.learned).weight_support)


def test_a_wing_of_a_file_may_not_be_called_as_the_page_calls_its_own() -> None:
    insect = flapenv.load_insect("hawkmoth")
    with pytest.raises(ValueError, match="taken"):
        Cases(WingFile(insect=insect))
    other = flapenv.Insect(name=OWN_WING, mass=insect.mass, wing=insect.wing, stroke=insect.stroke)
    with pytest.raises(ValueError, match="taken"):
        Cases(WingFile(insect=other))
