"""Whether a stroke beats the insect's own under other models."""

import dataclasses
import math

import pytest

from flapenv import COEFFICIENTS, INSECTS, HoverModel, Insect, evaluate, load_insect, optimum
from flapenv.assessment import rankings
from flapenv.assessment.rankings import WITHOUT_SPRINGS, other_models


def test_every_model_that_knows_the_insect_is_asked() -> None:
    rest = [name for name in COEFFICIENTS if name != "lifting-line"]
    assert list(other_models(load_insect("hawkmoth"), HoverModel())) == [*rest, WITHOUT_SPRINGS]
    assert list(other_models(load_insect("honeybee"), HoverModel())) == [name for name in rest if name != "berman-wang"]
    assert "lifting-line" in other_models(load_insect("honeybee"), HoverModel(coefficients="robofly"))
    assert WITHOUT_SPRINGS not in other_models(load_insect("hawkmoth"), HoverModel(accounting="positive"))


def test_the_optimum_beats_the_own_stroke_under_all_coefficients_of_all_insects(insect: Insect) -> None:
    for ranking in rankings(insect, optimum(insect).stroke):
        if ranking.model != WITHOUT_SPRINGS:
            assert ranking.survives, ranking
            assert ranking.saving > 0.1


def test_without_springs_the_hawkmoths_own_stroke_is_the_better_one() -> None:
    """Sharp reversals cost inertia that nothing gives back: A's optimum is not to be flown without springs."""
    found = {name: rankings(load_insect(name), optimum(name).stroke)[-1] for name in ("fruitfly", "hawkmoth")}
    assert [one.model for one in found.values()] == [WITHOUT_SPRINGS] * 2
    assert not found["hawkmoth"].survives
    assert found["hawkmoth"].saving == pytest.approx(-0.35, abs=0.02)
    assert found["fruitfly"].survives


@pytest.mark.filterwarnings("ignore:.*outside the range of the:UserWarning")
def test_powers_and_savings_are_those_of_evaluate_at_equal_weight(insect: Insect) -> None:
    """Λ ∝ f², and P* ∝ f³ with springs or without: inertia's power goes with f³, too."""
    stroke = optimum(insect).stroke
    for ranking in rankings(insect, stroke):
        options = {"coefficients": ranking.model} if ranking.model in COEFFICIENTS else {"accounting": "positive"}
        judged, own = evaluate(insect, stroke, **options), evaluate(insect, **options)
        assert (ranking.weight_support, ranking.specific_power) == (judged.weight_support, judged.specific_power)
        assert (ranking.own_weight_support, ranking.own_specific_power) == (own.weight_support, own.specific_power)
        carried = [one.specific_power / one.weight_support**1.5 for one in (judged, own)]
        assert ranking.saving == pytest.approx(1 - carried[0] / carried[1], abs=1e-9)


def test_the_own_stroke_saves_nothing_in_any_model(insect: Insect) -> None:
    for ranking in rankings(insect, insect.stroke):
        assert ranking.saving == 0
        assert not ranking.survives


def test_models_without_an_answer_for_a_stroke_are_left_out() -> None:
    triangle = dataclasses.replace(optimum("hawkmoth").stroke, flap_shape=1.0)
    asked = [one.model for one in rankings(load_insect("hawkmoth"), triangle)]
    assert WITHOUT_SPRINGS not in asked
    assert len(asked) == len(COEFFICIENTS) - 1
    wide = dataclasses.replace(triangle, flap_amplitude=math.radians(120))  # k_flap ends at 90°
    own = HoverModel(coefficients="robofly")
    asked = [one.model for one in rankings(load_insect("hawkmoth"), wide, own)]
    assert asked == ["extended-lifting-line", "berman-wang"]


def test_a_ranking_says_so_in_words_that_json_keeps() -> None:
    entries = [one.to_dict() for name in INSECTS for one in rankings(load_insect(name), optimum(name).stroke)]
    assert sum(not entry["survives"] for entry in entries) == 1
    for entry in entries:
        assert entry["survives"] == (entry["saving_percent"] > 0)


def test_measured_coefficients_get_no_second_drag_at_zero_lift() -> None:
    others = other_models(load_insect("hawkmoth"), HoverModel(profile_drag=0.1))
    assert {name: other.profile_drag for name, other in others.items()} == {
        "extended-lifting-line": 0.1,
        "polhamus": 0.1,
        "robofly": 0.0,
        "berman-wang": 0.0,
        WITHOUT_SPRINGS: 0.1,
    }


def test_rounding_is_no_saving(insect: Insect) -> None:
    nearly = dataclasses.replace(insect.stroke, pitch_phase=insect.stroke.pitch_phase + 1e-9)
    assert not any(ranking.survives for ranking in rankings(insect, nearly))
