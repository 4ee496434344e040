"""How far a mean of few numbers can be trusted."""

import numpy as np

NORMAL_95 = 1.96
"""Standard errors either side of a mean that hold it with 95 %."""


def mean_with_interval(values: np.ndarray) -> tuple[float, float]:
    """A mean and the half-width of its 95 % interval, normal approximation; inf for a single value.

    Args:
        values: shape (n,).
    """
    if len(values) < 2:
        return float(np.mean(values)), float("inf")
    return float(np.mean(values)), float(NORMAL_95 * np.std(values, ddof=1) / np.sqrt(len(values)))
