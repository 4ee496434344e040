"""A stroke beside optimum, own stroke, CFD and other models."""

import dataclasses
import json
import math
from typing import Any

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from flapenv import INSECTS, HoverProblem, HoverReference, Insect, Stroke, Wing, evaluate, load_insect, optimum
from flapenv.assessment import assess, assess_another, outside_validated
from flapenv.assessment.hovering import hovering_power
from flapenv.assessment.model_errors import model_errors
from flapenv.model import HoverModel
from flapenv.simulation import evaluate_by_blade_element
from flapenv.validation import table3

ROBOT = Insect(
    name="robot",
    mass=1e-4,
    wing=Wing(length=0.015, mean_chord=0.004, r1_hat=0.5),
    stroke=Stroke(frequency=120.0, flap_amplitude=math.radians(60), pitch_amplitude=math.radians(50)),
)


def test_the_own_stroke_is_its_line_of_table_3_and_its_uncertainty_reaches_to_cfd(insect: Insect) -> None:
    result = assess(insect)
    (row,) = [row for row in table3() if row.insect == insect.name]
    assert (result.weight_support, result.specific_power) == (row.weight_support, row.specific_power)
    assert result.specific_power == pytest.approx(insect.published.specific_power, abs=1)
    assert result.power_uncertainty == pytest.approx(abs(result.specific_power - insect.cfd.specific_power))
    assert result.weight_uncertainty == pytest.approx(abs(result.weight_support - 1))
    assert result.saving_as_published == result.saving == 0
    assert result.is_own
    assert result.saving_uncertainty is None
    needed = insect.cfd.specific_power * result.own_weight_support**1.5  # what CFD's power would have to be
    assert result.saving_to_cfd == pytest.approx(1 - result.own_specific_power / needed)


def test_the_model_is_as_far_off_cfd_as_table_3_says(insect: Insect) -> None:
    errors = assess(insect).errors
    printed = insect.published.specific_power / insect.cfd.specific_power - 1
    assert errors.specific_power == pytest.approx(printed, abs=0.04)  # Table 3 is rounded to whole W/kg
    assert errors.weight_support == pytest.approx(insect.published.weight_support - 1, abs=0.05)
    at_equal_weight = (1 + errors.specific_power) / (1 + errors.weight_support) ** 1.5 - 1
    assert errors.hovering_power == pytest.approx(at_equal_weight, rel=1e-9)


def test_the_optimum_saves_in_every_insect_beyond_the_uncertainty(insect: Insect) -> None:
    result = assess(insect, optimum(insect).stroke)
    assert result.gap == pytest.approx(0, abs=1e-6)
    assert result.saving > result.saving_uncertainty > 0
    assert result.saving > 0.1
    assert result.saving_to_cfd > 0.25
    assert result.saving_uncertainty == pytest.approx(abs(result.saving - result.saving_to_cfd))
    assert result.specific_power + result.power_uncertainty < insect.cfd.specific_power


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
    assert 1 - learned[1] / insect.cfd.specific_power == pytest.approx(result.saving_to_cfd, abs=1e-5)
    corrected = learned[1] * insect.cfd.specific_power / own[1]
    assert result.power_uncertainty == pytest.approx(abs(learned[1] - corrected), rel=1e-4)


def test_cfd_at_another_weight_support_is_brought_to_the_weight(hawkmoth: Insect) -> None:
    half = dataclasses.replace(hawkmoth, cfd=HoverReference(weight_support=0.5, specific_power=10.0))
    assert assess(half).saving_to_cfd == pytest.approx(1 - assess(half).own_hovering_power / (10 / 0.5**1.5))


@given(frequency=st.floats(20, 400), amplitude=st.floats(0.5, math.pi / 2))
def test_the_power_of_a_hovering_stroke_goes_with_the_weight_support_to_the_three_halves(
    frequency: float, amplitude: float
) -> None:
    stroke = Stroke(frequency=frequency, flap_amplitude=amplitude, pitch_amplitude=0.9)
    found = evaluate("hawkmoth", stroke)
    carried = hovering_power(load_insect("hawkmoth"), stroke, HoverModel())
    assert carried == pytest.approx(found.specific_power / found.weight_support**1.5, rel=1e-9)


def test_where_tip_loss_follows_the_stroke_the_weight_is_carried_too(insect: Insect) -> None:
    model = HoverModel(tip_loss="stroke")
    carried = hovering_power(insect, insect.stroke, model)
    frequencies = insect.stroke.frequency * np.linspace(0.7, 1.4, 2001)
    found = evaluate(insect, dataclasses.replace(insect.stroke, frequency=frequencies), tip_loss="stroke")
    assert carried == pytest.approx(np.interp(1.0, found.weight_support, found.specific_power), rel=1e-5)


def test_a_stroke_that_lifts_next_to_nothing_never_hovers() -> None:
    flat = dataclasses.replace(ROBOT.stroke, pitch_amplitude=0.0)  # α = 90° all the way
    late = dataclasses.replace(ROBOT.stroke, pitch_phase=1e-9)  # lift of a billionth of the weight
    for idle in (flat, late):
        assert hovering_power(ROBOT, idle, HoverModel()) is None
        result = assess(dataclasses.replace(ROBOT, stroke=idle), ROBOT.stroke)
        assert result.saving is None
        assert result.saving_uncertainty is None
        assert all(ranking.saving is None and not ranking.survives for ranking in result.rankings)
        json.dumps(result.to_dict(), allow_nan=False)


def test_a_wing_without_cfd_gets_the_rms_error_of_the_eight_insects() -> None:
    result, cases = assess(ROBOT), [model_errors(load_insect(name), HoverModel()) for name in INSECTS]
    assert set(vars(result.errors).values()) == {None}
    assert result.saving_to_cfd is None
    late = assess(ROBOT, dataclasses.replace(ROBOT.stroke, pitch_phase=1.5))
    for name, share, documented in (
        ("specific_power", result.power_share, 0.109),  # docs/validation.md
        ("weight_support", result.weight_share, 0.158),
        ("hovering_power", late.saving_uncertainty / (1 - late.saving), 0.144),
    ):
        errors = [getattr(case, name) for case in cases]
        assert share == pytest.approx(float(np.sqrt(np.mean(np.square(errors)))))
        assert share == pytest.approx(documented, abs=0.001)
    assert assess(ROBOT, problem=HoverProblem(model={"coefficients": "robofly"})).power_share != result.power_share


def test_no_cfd_says_what_power_without_springs_is(hawkmoth: Insect) -> None:
    result = assess(hawkmoth, problem="inertial")
    assert result.saving_to_cfd is result.power_uncertainty is result.saving_uncertainty is None
    assert result.weight_uncertainty == assess(hawkmoth).weight_uncertainty


def test_missing_weight_and_strokes_beyond_the_box_show_in_the_gap(hawkmoth: Insect) -> None:
    best = optimum(hawkmoth).stroke
    slow = assess(hawkmoth, dataclasses.replace(best, frequency=0.99 * best.frequency))
    assert slow.gap == pytest.approx(0.99**3 - 1 + 10 * (1 - 0.99**2), rel=1e-3)
    sharper = dataclasses.replace(best, flap_shape=0.9999, pitch_shape=100.0)
    lift = evaluate(hawkmoth, sharper).weight_support
    beyond = assess(hawkmoth, dataclasses.replace(sharper, frequency=sharper.frequency / math.sqrt(lift)))
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


def test_every_number_of_an_entry_is_what_its_key_says() -> None:
    """In a problem and with a stroke that share no number with the defaults."""
    model = {"air_density": 1.0, "profile_drag": 0.05, "coefficients": "extended-lifting-line"}
    problem = HoverProblem(box={"frequency": (20, 24), "flap_amplitude": (1.0, 1.4)}, model=model)
    stroke = Stroke(frequency=25.0, flap_amplitude=1.3, pitch_amplitude=0.95, flap_shape=0.6, pitch_phase=1.5)
    hawkmoth, result = load_insect("hawkmoth"), assess("hawkmoth", stroke, problem)
    judged, own = evaluate(hawkmoth, stroke, **model), evaluate(hawkmoth, **model)
    best = optimum(hawkmoth, problem)
    powers = [one.specific_power / one.weight_support**1.5 for one in (judged, own)]
    entry = result.to_dict()
    expected = {
        "weight_support": judged.weight_support,
        "specific_power": judged.specific_power,
        "weight_uncertainty": abs(judged.weight_support - judged.weight_support / own.weight_support),
        "power_uncertainty": abs(judged.specific_power - judged.specific_power * 33 / own.specific_power),
        "optimum_specific_power": best.specific_power,
        "lower_bound": best.lower_bound,
        "max_weight_support": best.max_weight_support,
        "gap_percent": 100 * best.gap(judged.weight_support, judged.specific_power),
        "cfd_specific_power": 33,
        "model_weight_error_percent": 100 * (own.weight_support - 1),
        "model_power_error_percent": 100 * (own.specific_power / 33 - 1),
        "model_hovering_error_percent": 100 * (powers[1] / 33 - 1),
        "own_stroke_weight_support": own.weight_support,
        "own_stroke_specific_power": own.specific_power,
        "hovering_power": powers[0],
        "own_stroke_hovering_power": powers[1],
        "saving_percent": 100 * (1 - powers[0] / powers[1]),
        "saving_uncertainty_percent": 100 * abs(powers[0] / powers[1] - powers[0] / 33),
        "saving_as_published_percent": 100 * (1 - judged.specific_power / own.specific_power),
        "saving_to_cfd_percent": 100 * (1 - powers[0] / 33),
    }
    for key, value in expected.items():
        assert entry.pop(key) == pytest.approx(value, rel=1e-8), key
    assert entry.pop("stroke") == vars(stroke)
    assert (entry.pop("feasible"), entry.pop("lift_shortfall")) == (True, None)
    assert entry.pop("outside_validated_range") == list(result.flags)
    assert "f = 25 Hz, beyond 20 to 24 Hz" in entry.pop("beyond_box")
    names = [ranking["model"] for ranking in entry.pop("other_models")]
    assert names == ["lifting-line", "polhamus", "robofly", "berman-wang", "positive power"]
    assert not entry
    assert result.outside == outside_validated(hawkmoth, stroke, air_density=1.0)


def test_what_is_not_finite_is_refused(hawkmoth: Insect) -> None:
    def holed(alpha: Any) -> Any:  # tried at whole degrees, between which it is infinite
        return np.sin(2 * alpha), np.where(np.abs(np.degrees(alpha) % 1 - 0.5) < 0.4, np.inf, 1.0)

    known = dataclasses.replace(assess(hawkmoth), problem=HoverProblem(model=HoverModel(coefficients=holed)))
    with pytest.raises(ValueError, match=r"hawkmoth: Λ = .* are not finite"):
        assess_another(known, hawkmoth.stroke)


def test_another_stroke_is_judged_as_afresh_but_for_other_models(insect: Insect) -> None:
    stroke = dataclasses.replace(insect.stroke, flap_amplitude=1.2, pitch_shape=3.0)
    for problem in ("free-frequency", "profile-drag"):
        afresh = assess(insect, stroke, problem)
        assert assess_another(assess(insect, problem=problem), stroke) == dataclasses.replace(afresh, rankings=())
