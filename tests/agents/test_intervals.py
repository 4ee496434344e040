"""Means of few numbers, with how far they can be trusted."""

import numpy as np
import pytest

from agents.intervals import mean_with_interval


def test_the_interval_of_a_mean_is_1_96_standard_errors_either_side() -> None:
    mean, half = mean_with_interval(np.array([1.0, 2.0, 3.0, 4.0]))
    assert mean == 2.5
    assert half == pytest.approx(1.96 * np.sqrt(5 / 3) / 2, rel=1e-3)


def test_nineteen_of_twenty_intervals_hold_the_truth(rng: np.random.Generator) -> None:
    found = [mean_with_interval(rng.normal(3.0, 2.0, size=200)) for _ in range(4000)]
    assert np.mean([abs(mean - 3) <= half for mean, half in found]) == pytest.approx(0.95, abs=0.012)


def test_one_number_says_nothing_of_how_far_it_can_be_trusted() -> None:
    assert mean_with_interval(np.array([7.0])) == (7.0, float("inf"))
