"""The figure of fronts."""

import numpy as np
import pytest

from agents.plots.front import front
from flapenv import Stroke, load_insect, optimum
from flapenv.assessment import StrokeAssessment, assess
from flapenv.trade_off import weight_front

NAMES = ("bumblebee", "cranefly")
WEIGHTS = (0.8, 1.0, 1.2)


@pytest.fixture(scope="module")
def strokes() -> list[StrokeAssessment]:
    return [assess(name, optimum(name).stroke) for name in NAMES]


def test_every_front_passes_through_the_optimum_at_the_full_weight(strokes: list[StrokeAssessment]) -> None:
    fronts = [weight_front(name, WEIGHTS) for name in NAMES]
    figure = front(strokes, fronts)
    for line, curve in zip(figure.data[:2], fronts, strict=True):
        np.testing.assert_array_equal(line.x, WEIGHTS)
        assert line.y[1] == pytest.approx(1, rel=1e-5)
        np.testing.assert_array_equal(line.customdata, curve.specific_power)


def test_points_lie_where_the_strokes_do_and_never_below_the_front(strokes: list[StrokeAssessment]) -> None:
    figure = front(strokes, [weight_front(name, WEIGHTS) for name in NAMES])
    own, learned = figure.data[2:]
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
    own = front(strokes, [weight_front(name, WEIGHTS) for name in NAMES]).data[2]
    assert set(own.textposition) == {"top center", "bottom center"}
    assert own.text == NAMES


def test_strokes_that_are_not_learned_are_called_what_they_are(strokes: list[StrokeAssessment]) -> None:
    names = [trace.name for trace in front(strokes, [weight_front(name, WEIGHTS) for name in NAMES], "given").data]
    assert names == ["least power", "least power", "own stroke", "given"]
