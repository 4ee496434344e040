"""What few seeds allow to say, from invented numbers."""

import numpy as np
import pytest
import scipy.stats

from agents.benchmark.data import (
    CURVE_POINTS,
    THRESHOLDS,
    CurvePoint,
    thinned,
)
from agents.benchmark.statistics import (
    first_below,
    interquartile_mean,
    interval,
    last_known,
    median_of_reached,
    profile,
)


def test_the_interquartile_mean_is_the_mean_of_the_middle() -> None:
    assert interquartile_mean(np.array([5.0, 1, 100, 2, 3])) == pytest.approx((2 + 3 + 5) / 3)
    assert interquartile_mean(np.array([8.0, 1, 2, 3, 4, 5, 6, 7])) == pytest.approx((3 + 4 + 5 + 6) / 4)
    assert interquartile_mean(np.array([1.0, 2, 6])) == pytest.approx(3)
    assert interquartile_mean(np.array([[1.0, 5], [2, 6], [3, 7], [4, 80]]), axis=0) == pytest.approx([2.5, 6.5])


def test_the_interval_holds_the_interquartile_mean_and_needs_two_runs(rng: np.random.Generator) -> None:
    for size in (2, 5, 12):
        values = rng.lognormal(size=size)
        found = interval(values)
        assert found is not None
        assert values.min() <= found[0] <= interquartile_mean(values) <= found[1] <= values.max()
        assert interval(values) == found
    assert interval(np.array([1.0])) is None
    assert interval(np.full(5, 0.25)) == (0.25, 0.25)


def test_the_interval_covers_the_truth_nearly_as_often_as_it_says(rng: np.random.Generator) -> None:
    found = [interval(rng.normal(size=40)) for _ in range(20)]
    assert sum(one is not None and one[0] <= 0 <= one[1] for one in found) >= 17


def test_the_interval_of_many_runs_is_1_96_standard_errors_either_side() -> None:
    """Of n normal numbers the interquartile mean scatters by 1.0932/sqrt(n).

    Source: Huber & Ronchetti (2009), Robust Statistics, section 3.3: the variance of a trimmed mean, here of a quarter.
    """
    quantiles = scipy.stats.norm.ppf((np.arange(100) + 0.5) / 100)
    low, high = interval(quantiles) or (0.0, 0.0)
    assert high - low == pytest.approx(2 * 1.96 * 1.0932 / 10, rel=0.03)
    assert low + high == pytest.approx(0, abs=0.02)


def test_a_profile_rises_from_none_to_all(rng: np.random.Generator) -> None:
    values = rng.lognormal(size=30)
    shares = profile(values, np.geomspace(values.min() / 2, values.max(), 100))
    assert shares[0] == 0
    assert shares[-1] == 1
    assert np.all(np.diff(shares) >= 0)
    assert profile(np.array([1.0, 2, 2, 4]), np.array([2.0, 1.999])).tolist() == [0.75, 0.25]


def test_the_first_point_below_is_a_point_and_nothing_is_interpolated() -> None:
    values = np.array([0.5, 0.06, 0.05, 0.2, 0.001])
    assert [first_below(values, one) for one in (0.05, 0.01, 1e-4)] == [2, 4, None]
    assert first_below(np.array([]), 1.0) is None
    assert median_of_reached([3.0, None, 1.0, 2.0, None]) == 3.0
    assert median_of_reached([3.0, None, None]) is None
    steps = last_known(np.array([10.0, 20.0]), np.array([1.0, 2.0]), np.array([9.0, 10.0, 19.9, 20.0, 99.0]))
    np.testing.assert_array_equal(steps, [np.nan, 1, 1, 2, 2])


def test_a_thinned_curve_keeps_its_ends_and_when_each_threshold_was_first_reached(rng: np.random.Generator) -> None:
    gaps = 2 * np.exp(-np.arange(5000) / 500) * rng.lognormal(sigma=0.5, size=5000)
    points = [
        CurvePoint(preset="p", seed=0, wingbeats=100 * i, seconds=i / 7, mean=float(gap), worst=float(gap))
        for i, gap in enumerate(gaps)
    ]
    kept = thinned(points)
    assert len(kept) <= CURVE_POINTS
    assert kept[0] is points[0]
    assert kept[-1] is points[-1]
    for threshold in THRESHOLDS:
        first = first_below(np.array([point.mean for point in kept]), threshold)
        assert first is not None
        assert kept[first] is points[first_below(gaps, threshold) or 0]
    assert thinned(points[:20]) == points[:20]
