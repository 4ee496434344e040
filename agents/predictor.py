"""What evaluation asks of a policy."""

from typing import Any, Protocol

import numpy as np


class Predictor(Protocol):
    """Anything that maps observations to actions, such as a Stable-Baselines3 model."""

    def predict(self, observation: np.ndarray, *, deterministic: bool) -> tuple[np.ndarray, Any]:
        """Actions for a batch of observations."""
