"""What steps from the optimum cost."""

import math

import numpy as np
import pytest

from agents.plots.sensitivities import STEPS, sensitivities, step_costs
from flapenv import HoverProblem, StrokeBox, optimum
from flapenv.aero.parameters import STROKE_PARAMETERS


def test_carrying_one_percent_more_costs_what_the_next_optimum_does() -> None:
    heavier = HoverProblem(model={"gravity": 9.81 * 1.01})
    best = optimum("hawkmoth", HoverProblem(model={"gravity": 9.81}))
    more = optimum("hawkmoth", heavier).specific_power / best.specific_power - 1
    assert step_costs(best)["weight_support"] == pytest.approx(more, rel=0.01)


def test_a_degree_less_pitch_costs_what_the_optimum_of_the_smaller_box_does() -> None:
    best = optimum("hawkmoth")
    smaller = HoverProblem(box=StrokeBox(pitch_amplitude=(math.radians(45), math.radians(64))))
    more = optimum("hawkmoth", smaller).specific_power / best.specific_power - 1
    assert step_costs(best)["pitch_amplitude"] == pytest.approx(more, rel=0.03)


def test_inside_the_box_a_small_step_costs_nothing_to_first_order() -> None:
    best = optimum("hawkmoth")
    held = {name for name, _ in best.active_bounds}
    costs = step_costs(best)
    assert set(costs) == set(STEPS)
    assert held
    for name in STROKE_PARAMETERS:
        assert (costs[name] > 0) == (name in held)


def test_bars_are_the_median_and_whiskers_reach_the_least_and_the_most() -> None:
    optima = [optimum(name) for name in ("fruitfly", "cranefly", "ladybird")]
    bars = sensitivities(optima).data[0]
    table = 100 * np.array([[step_costs(best)[name] for name in STEPS] for best in optima])
    np.testing.assert_allclose(bars.x, np.median(table, axis=0))
    np.testing.assert_allclose(bars.x + bars.error_x.array, table.max(axis=0))
    np.testing.assert_allclose(bars.x - bars.error_x.arrayminus, table.min(axis=0))


def test_where_nobody_hovers_nothing_has_a_price() -> None:
    infeasible = optimum("ladybird", "fixed-frequency")
    assert step_costs(infeasible) == {}
    assert list(sensitivities([infeasible]).data[0].x) == [0] * len(STEPS)
