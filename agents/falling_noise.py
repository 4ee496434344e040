"""Exploration noise that is set from outside as the budget is spent."""

import numpy as np
from stable_baselines3.common.noise import ActionNoise, NormalActionNoise


class FallingNoise(ActionNoise):
    """White noise whose size is set from outside; drawn as `NormalActionNoise` draws, from what the model seeds."""

    def __init__(self, size: float, axes: int) -> None:
        """Noise of standard deviation `size` on each of `axes` axes."""
        super().__init__()
        self.size = size
        self._unit = NormalActionNoise(np.zeros(axes), np.ones(axes))

    def __call__(self) -> np.ndarray:
        """One draw, shape (axes,)."""
        return self.size * self._unit()
