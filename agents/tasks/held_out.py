"""What is common to judging policies: draws that no training run meets, noise-free actions and paired intervals."""

from collections.abc import Callable

import numpy as np

from agents.predictor import Predictor

HELD_OUT_SEED = 2**32
"""Above every seed that a training run can have."""
NORMAL_95 = 1.96
"""Standard errors either side of a mean that hold it with 95 %."""


def noise_free(policy: Predictor) -> Callable[[np.ndarray], np.ndarray]:
    """Observations to actions, without the policy's noise."""

    def act(observations: np.ndarray) -> np.ndarray:
        return policy.predict(observations, deterministic=True)[0]

    return act


def mean_with_interval(values: np.ndarray) -> tuple[float, float]:
    """A mean and the half-width of its 95 % interval, normal approximation; inf for a single value."""
    if len(values) < 2:
        return float(np.mean(values)), float("inf")
    return float(np.mean(values)), float(NORMAL_95 * np.std(values, ddof=1) / np.sqrt(len(values)))
