"""What is common to judging policies: draws that no training run meets, noise-free actions and paired intervals."""

import numpy as np

from agents.predictor import Predictor, begin

HELD_OUT_SEED = 2**32
"""Above every seed that a training run can have."""
NORMAL_95 = 1.96
"""Standard errors either side of a mean that hold it with 95 %."""


class NoiseFree:
    """Observations to actions, without the policy's noise; `start` before episodes begin."""

    def __init__(self, policy: Predictor) -> None:
        """Wrap a policy."""
        self._policy = policy

    def start(self) -> None:
        """Let a policy with memory forget the last episodes."""
        begin(self._policy)

    def __call__(self, observations: np.ndarray) -> np.ndarray:
        """Actions of all rows."""
        return self._policy.predict(observations, deterministic=True)[0]


def mean_with_interval(values: np.ndarray) -> tuple[float, float]:
    """A mean and the half-width of its 95 % interval, normal approximation; inf for a single value."""
    if len(values) < 2:
        return float(np.mean(values)), float("inf")
    return float(np.mean(values)), float(NORMAL_95 * np.std(values, ddof=1) / np.sqrt(len(values)))
