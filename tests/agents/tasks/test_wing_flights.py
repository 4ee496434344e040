"""Numbers of many wings: percentiles, errors about hovering, and wings that no stroke lifts."""

from typing import Any

import numpy as np
import pytest

from agents.tasks.random_wings import wings_table
from agents.tasks.wing_flights import WingFlights, WingPool
from agents.tasks.wings_picture import draw_wings
from flapenv import HoverProblem

WINGS = 40


class Middle:
    """The middle of the box."""

    def predict(self, observation: np.ndarray, *, deterministic: bool) -> tuple[np.ndarray, Any]:
        return np.zeros((len(observation), 6), dtype=np.float32), None


def flights(weight_support: np.ndarray) -> WingFlights:
    """Of a hundred wings and one, with gaps of 0 % to 100 %."""
    count = len(weight_support)
    return WingFlights(
        feasible=np.ones(count, dtype=bool),
        gaps=np.linspace(0, 1, count),
        weight_support=weight_support,
        frequency_error=np.full(count, -0.02),
    )


def test_five_wings_of_a_hundred_are_worse_than_what_is_told_of_most() -> None:
    told = flights(np.ones(101)).to_dict()
    assert told["p95_gap_percent"] == pytest.approx(95)
    assert [told["median_gap_percent"], told["mean_gap_percent"]] == pytest.approx([50, 50])
    assert told["worst_gap_percent"] == pytest.approx(100)
    assert [told["rms_frequency_error_percent"], told["mean_frequency_error_percent"]] == pytest.approx([2, -2])
    assert (told["wings"], told["infeasible"]) == (101, 0)


def test_weight_support_is_off_by_its_distance_to_hovering_not_to_its_own_mean() -> None:
    """All at 0.9 err by 10 %, though they do not scatter; the least is what falls fastest."""
    assert flights(np.full(101, 0.9)).to_dict()["rms_weight_support_error_percent"] == pytest.approx(10)
    told = flights(np.linspace(0.95, 1.03, 101)).to_dict()
    assert told["least_weight_support"] == 0.95
    assert told["rms_weight_support_error_percent"] == pytest.approx(2.54, abs=0.02)


def test_wings_that_cannot_hover_are_counted_and_left_out_of_every_mean() -> None:
    pool = WingPool(WINGS, split="test", problem=HoverProblem(box={"frequency_ratio": (0.3, 0.75)}), seed=0)
    lifted = np.asarray(pool.best.feasible)
    assert 0 < np.sum(lifted) < WINGS
    flown = pool.fly(Middle())
    assert np.array_equal(flown.feasible, lifted)
    assert flown.gaps.shape == flown.weight_support.shape == flown.frequency_error.shape == (np.sum(lifted),)
    assert all(np.all(np.isfinite(values)) for values in (flown.gaps, flown.weight_support, flown.frequency_error))
    told = flown.to_dict()
    assert (told["wings"], told["infeasible"]) == (np.sum(lifted), WINGS - np.sum(lifted))
    line = wings_table({"test": flown}).splitlines()[-1].split()
    assert line[:3] == ["test", str(np.sum(lifted)), str(WINGS - np.sum(lifted))]
    gaps, errors = draw_wings({"test": (pool, flown)}).axes
    aspect_ratio = pool.env.flyers.cases.aspect_ratio[lifted]
    for axes, values in ((gaps, flown.gaps), (errors, flown.frequency_error)):
        (dots,) = axes.collections
        np.testing.assert_allclose(dots.get_offsets(), np.column_stack([aspect_ratio, 100 * values]))


def test_wings_of_which_none_can_hover_are_refused_in_one_line() -> None:
    problem = HoverProblem(box={"frequency_ratio": (0.3, 0.45)})
    with pytest.raises(ValueError, match="lets none of 20 test wings hover; allowed: wider bounds") as refused:
        WingPool(20, split="test", problem=problem, seed=0)
    assert "\n" not in str(refused.value)
