"""What few seeds allow to say: interquartile means with intervals, shares below a gap, when a gap was first reached.

Agarwal et al. (2021), "Deep reinforcement learning at the edge of the statistical precipice", argue for the first two.
"""

from collections.abc import Sequence

import numpy as np
from scipy.stats import bootstrap, trim_mean

CONFIDENCE = 0.95
RESAMPLES = 10_000


def interquartile_mean(values: np.ndarray, axis: int = -1) -> np.ndarray:
    """Mean of what is left when a quarter of the values, rounded down, is cut off at either end (of five, one).

    Args:
        values: any shape.
        axis: along which to take it.
    """
    return np.asarray(trim_mean(values, 0.25, axis=axis))


def interval(values: np.ndarray) -> tuple[float, float] | None:
    """Percentile-bootstrap interval of the interquartile mean, of `CONFIDENCE`; None for fewer than two values.

    Drawn from a generator of fixed seed, so that it is the same each time.

    Args:
        values: one a seed, shape (n,).
    """
    if len(values) < 2:
        return None
    result = bootstrap(
        (values,),
        interquartile_mean,
        n_resamples=RESAMPLES,
        vectorized=True,
        confidence_level=CONFIDENCE,
        method="percentile",
        random_state=np.random.default_rng(0),
    )
    return float(result.confidence_interval.low), float(result.confidence_interval.high)


def profile(values: np.ndarray, thresholds: np.ndarray) -> np.ndarray:
    """Share of the values at or below each threshold, shape of `thresholds`.

    Args:
        values: shape (n,).
        thresholds: any shape.
    """
    return np.searchsorted(np.sort(values), thresholds, side="right") / len(values)


def first_below(values: np.ndarray, threshold: float) -> int | None:
    """Number of the first value at or below the threshold; None where there is none. Nothing is interpolated."""
    below = np.flatnonzero(values <= threshold)
    return int(below[0]) if len(below) else None


def median_of_reached(spent: Sequence[float | None]) -> float | None:
    """Median of what it took, where None never got there; None where half or more of them did not.

    Args:
        spent: one a seed.
    """
    middle = float(np.median([np.inf if one is None else one for one in spent]))
    return middle if np.isfinite(middle) else None


def last_known(at: np.ndarray, values: np.ndarray, grid: np.ndarray) -> np.ndarray:
    """The value of the last point at or before each place of the grid; NaN before the first.

    Args:
        at: places of the points, rising, shape (n,).
        values: shape (n,).
        grid: any shape.
    """
    number = np.searchsorted(at, grid, side="right") - 1
    return np.where(number >= 0, values[np.maximum(number, 0)], np.nan)
