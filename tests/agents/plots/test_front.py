"""The figure of fronts."""

import dataclasses

import numpy as np
import pytest

from agents.plots.front import front
from flapenv import Stroke, load_insect, optimum
from flapenv.assessment import StrokeAssessment, assess
from flapenv.trade_off import TradeOff, weight_front

NAMES = ("bumblebee", "cranefly")
WEIGHTS = (0.8, 1.0, 1.2)


@pytest.fixture(scope="module")
def strokes() -> list[StrokeAssessment]:
    return [assess(name, optimum(name).stroke) for name in NAMES]


def scaled(curve: TradeOff, factors: list[float]) -> TradeOff:
    return dataclasses.replace(curve, specific_power=curve.specific_power * np.array(factors))


def test_fronts_that_agree_are_one_line_through_the_optimum_at_the_full_weight(
    strokes: list[StrokeAssessment],
) -> None:
    fronts = [weight_front(name, WEIGHTS) for name in NAMES]
    (line,) = (trace for trace in front(strokes, fronts).data if trace.name == "least power")
    np.testing.assert_array_equal(line.x, WEIGHTS)
    assert line.y[1] == pytest.approx(1, rel=1e-5)
    np.testing.assert_allclose(line.y, fronts[1].specific_power / strokes[1].best.specific_power, rtol=0.01)
    assert line.text == ("", "", "all two")


def test_a_front_that_parts_from_the_others_has_its_name_and_its_own_numbers(strokes: list[StrokeAssessment]) -> None:
    curve = weight_front(NAMES[0], WEIGHTS)
    parted = scaled(curve, [1, 1, 1.2])
    three, fronts = [strokes[0], strokes[0], strokes[1]], [curve, curve, parted]
    lines = [trace for trace in front(three, fronts).data if trace.name == "least power"]
    assert [line.text[-1] for line in lines] == ["two alike", NAMES[1]]
    np.testing.assert_allclose(lines[1].y, parted.specific_power / strokes[1].best.specific_power)
    ended = scaled(curve, [1, 1, float("nan")])
    lines = [trace for trace in front(three, [curve, curve, ended]).data if trace.name == "least power"]
    assert lines[-1].text == ("", NAMES[1], "") or lines[0].text[-1] == "all three"


def test_points_that_are_not_at_the_optimum_have_their_name() -> None:
    strokes = [assess(NAMES[0], optimum(NAMES[0]).stroke), assess(NAMES[1])]
    (learned,) = (
        trace for trace in front(strokes, [weight_front(n, WEIGHTS) for n in NAMES]).data if trace.name == "learned"
    )
    assert learned.text == ("", NAMES[1])


def test_points_lie_where_the_strokes_do_and_never_below_the_front(strokes: list[StrokeAssessment]) -> None:
    figure = front(strokes, [weight_front(name, WEIGHTS) for name in NAMES])
    own, learned = figure.data[-2:]
    for number, one in enumerate(strokes):
        assert (own.x[number], learned.x[number]) == (one.own_weight_support, one.weight_support)
        assert own.y[number] * one.best.specific_power == pytest.approx(one.own_specific_power)
        assert learned.y[number] * one.best.specific_power == pytest.approx(one.specific_power)
        least = weight_front(one.insect, [one.own_weight_support, one.own_weight_support + 0.1]).specific_power[0]
        assert one.own_specific_power > least


def test_no_stroke_of_the_box_lies_below_the_front_at_the_weight_it_carries() -> None:
    insect, random = load_insect("hoverfly"), np.random.default_rng(5)
    low, high = 0.5 * insect.stroke.frequency, 1.5 * insect.stroke.frequency
    for _ in range(20):
        stroke = Stroke(
            frequency=random.uniform(low, high),
            flap_amplitude=np.radians(random.uniform(40, 90)),
            pitch_amplitude=np.radians(random.uniform(45, 65)),
            flap_shape=random.uniform(0.01, 0.99),
            pitch_shape=random.uniform(0.1, 10),
            pitch_phase=np.radians(random.uniform(60, 120)),
        )
        one = assess(insect, stroke)
        if one.weight_support > 0.1:
            least = weight_front(insect, [one.weight_support]).specific_power[0]
            assert np.isnan(least) or one.specific_power >= least * (1 - 1e-6)


def test_neighbours_have_their_names_on_different_sides(strokes: list[StrokeAssessment]) -> None:
    own = front(strokes, [weight_front(name, WEIGHTS) for name in NAMES]).data[-2]
    assert set(own.textposition) == {"top center", "bottom center"}
    assert own.text == NAMES


def test_strokes_that_are_not_learned_are_called_what_they_are(strokes: list[StrokeAssessment]) -> None:
    names = [trace.name for trace in front(strokes, [weight_front(name, WEIGHTS) for name in NAMES], "given").data]
    assert names == ["least power", "own stroke", "given"]
