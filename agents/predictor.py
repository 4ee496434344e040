"""What evaluation asks of a policy."""

from typing import Any, Protocol

import numpy as np


class Predictor(Protocol):
    """Anything that maps observations to actions, such as a Stable-Baselines3 model.

    A policy with memory has `start()` too, which `begin` calls before its episodes.
    """

    def predict(self, observation: np.ndarray, *, deterministic: bool) -> tuple[np.ndarray, Any]:
        """Actions for a batch of observations."""


def begin(policy: object) -> None:
    """Tell a policy that new episodes begin, those of all rows together; nothing to one without memory."""
    start = getattr(policy, "start", None)
    if start is not None:
        start()
