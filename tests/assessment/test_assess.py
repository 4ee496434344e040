"""A stroke beside optimum, own stroke, CFD and other models."""

import dataclasses
import json
import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from flapenv import INSECTS, HoverProblem, Insect, Stroke, Wing, evaluate, load_insect, optimum
from flapenv.assessment import assess
from flapenv.assessment.assess import model_error, typical_error
from flapenv.assessment.hovering import hovering
from flapenv.model import HoverModel
from flapenv.simulation import evaluate_by_blade_element
from flapenv.validation import table3

ROBOT = Insect(
    name="robot",
    mass=1e-4,
    wing=Wing(length=0.015, mean_chord=0.004, r1_hat=0.5),
    stroke=Stroke(frequency=120.0, flap_amplitude=math.radians(60), pitch_amplitude=math.radians(50)),
)


def test_the_own_stroke_is_its_line_of_table_3(insect: Insect) -> None:
    result = assess(insect)
    (row,) = [row for row in table3() if row.insect == insect.name]
    assert (result.weight_support, result.specific_power) == (row.weight_support, row.specific_power)
    assert result.saving_as_published == result.saving == 0
    assert result.saving_to_cfd == pytest.approx(1 - result.own_hovering_power / insect.cfd.specific_power)
    assert result.specific_power == pytest.approx(insect.published.specific_power, abs=1)
    assert result.model_error == pytest.approx(result.specific_power / insect.cfd.specific_power - 1)


def test_the_uncertainty_is_the_models_error_against_cfd_which_table_3_gives(insect: Insect) -> None:
    result = assess(insect, optimum(insect).stroke)
    printed = insect.published.specific_power / insect.cfd.specific_power - 1
    assert result.model_error == pytest.approx(printed, abs=0.04)  # Table 3 is rounded to whole W/kg
    assert result.power_uncertainty == pytest.approx(abs(result.model_error) * result.specific_power)
    assert result.saving_uncertainty == pytest.approx(result.power_uncertainty / insect.cfd.specific_power, rel=1e-6)


def test_the_optimum_saves_in_every_insect_beyond_the_uncertainty(insect: Insect) -> None:
    result = assess(insect, optimum(insect).stroke)
    assert result.gap == pytest.approx(0, abs=1e-6)
    assert result.saving_to_cfd > result.saving_uncertainty > 0
    assert result.saving > 0.1


def test_the_oracle_finds_the_same_powers(insect: Insect) -> None:
    """Refined: 6 Gauss strips are exact for these moments, 40,000 steps resolve the sharp waveforms."""
    result = assess(insect, optimum(insect).stroke)
    refined = {"strips": 6, "spacing": "gauss", "steps": 40_000}
    learned, own = (evaluate_by_blade_element(insect, one, **refined) for one in (result.stroke, insect.stroke))
    carried = own[1] / own[0] ** 1.5  # P* ∝ f³ and Λ ∝ f²
    assert learned == pytest.approx((result.weight_support, result.specific_power), rel=1e-5)
    assert own == pytest.approx((result.own_weight_support, result.own_specific_power), rel=1e-5)
    assert carried == pytest.approx(result.own_hovering_power, rel=1e-5)
    assert 1 - learned[1] / carried == pytest.approx(result.saving, abs=1e-5)
    assert own[1] / insect.cfd.specific_power - 1 == pytest.approx(result.model_error, abs=1e-5)


@given(frequency=st.floats(20, 400), amplitude=st.floats(0.5, math.pi / 2))
def test_a_hovering_stroke_carries_the_weight_and_power_goes_with_the_cube_of_frequency(
    frequency: float, amplitude: float
) -> None:
    stroke = Stroke(frequency=frequency, flap_amplitude=amplitude, pitch_amplitude=0.9)
    before, carried = evaluate("hawkmoth", stroke), hovering(load_insect("hawkmoth"), stroke, HoverModel())
    after = evaluate("hawkmoth", carried.stroke)
    assert after.weight_support == pytest.approx(1, abs=1e-11)
    assert after.specific_power == carried.specific_power
    assert carried.specific_power == pytest.approx(before.specific_power / before.weight_support**1.5, rel=1e-9)
    assert dataclasses.replace(carried.stroke, frequency=frequency) == stroke


def test_where_tip_loss_follows_the_stroke_the_weight_is_carried_too(insect: Insect) -> None:
    model = HoverModel(tip_loss="stroke")
    carried = hovering(insect, insect.stroke, model)
    assert evaluate(insect, carried.stroke, tip_loss="stroke").weight_support == pytest.approx(1, abs=1e-11)


def test_a_stroke_that_lifts_nothing_never_hovers() -> None:
    flat = dataclasses.replace(ROBOT.stroke, pitch_amplitude=0.0)  # α = 90° all the way
    assert hovering(ROBOT, flat, HoverModel()) is None
    result = assess(dataclasses.replace(ROBOT, stroke=flat), ROBOT.stroke)
    assert result.saving is None
    assert all(ranking.saving is None and not ranking.survives for ranking in result.rankings)
    json.dumps(result.to_dict(), allow_nan=False)


def test_a_wing_without_cfd_gets_the_rms_error_of_the_eight_insects() -> None:
    result = assess(ROBOT)
    errors = [model_error(load_insect(name), HoverModel()) for name in INSECTS]
    assert result.model_error is None
    assert result.saving_to_cfd is None
    assert result.uncertainty == pytest.approx(float(np.sqrt(np.mean(np.square(errors)))))
    assert result.uncertainty == pytest.approx(0.109, abs=0.001)  # docs/validation.md
    assert typical_error(HoverModel(coefficients="berman-wang")) > 0


def test_without_springs_the_error_is_still_that_of_the_power_that_cfd_has(hawkmoth: Insect) -> None:
    assert model_error(hawkmoth, HoverModel(accounting="positive")) == model_error(hawkmoth, HoverModel())
    assert assess(hawkmoth, problem="inertial").saving_to_cfd is None


def test_missing_weight_and_strokes_beyond_the_box_show_in_the_gap(hawkmoth: Insect) -> None:
    best = optimum(hawkmoth).stroke
    slow = assess(hawkmoth, dataclasses.replace(best, frequency=0.99 * best.frequency))
    assert slow.gap == pytest.approx(0.99**3 - 1 + 10 * (1 - 0.99**2), rel=1e-3)
    sharper = dataclasses.replace(best, flap_shape=0.9999, pitch_shape=100.0)
    carried = hovering(hawkmoth, sharper, HoverModel()).stroke
    beyond = assess(hawkmoth, carried)
    assert -0.045 < beyond.gap < -0.03
    assert beyond.specific_power > beyond.best.lower_bound


def test_an_insect_that_cannot_hover_in_the_problem_has_no_gap() -> None:
    result = assess("ladybird", problem="fixed-frequency")
    assert result.gap is None
    entry = result.to_dict()
    assert entry["feasible"] is False
    assert entry["optimum_specific_power"] is None
    assert entry["lift_shortfall"] == pytest.approx(result.best.max_weight_support - result.weight_support)


def test_everything_that_is_told_can_be_kept_as_json_in_every_problem() -> None:
    problems = ("free-frequency", "profile-drag", "inertial", HoverProblem(model={"coefficients": "berman-wang"}))
    for problem in problems:
        entry = json.loads(json.dumps(assess("bumblebee", problem=problem).to_dict(), allow_nan=False))
        assert Stroke(**entry["stroke"]) == load_insect("bumblebee").stroke
        assert entry["saving_as_published_percent"] == 0
