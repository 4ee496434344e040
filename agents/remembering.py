"""Models with memory flown as any other policy."""

from typing import Any

import numpy as np
from sb3_contrib import RecurrentPPO
from stable_baselines3.common.base_class import BaseAlgorithm

from agents.predictor import Predictor


class Remembering:
    """A model whose `predict` takes and gives its state, as a policy that keeps it; all episodes begin at `start`."""

    def __init__(self, model: RecurrentPPO) -> None:
        """Wrap a model, at the start of episodes."""
        self.model = model
        self._state: tuple[np.ndarray, ...] | None = None

    def start(self) -> None:
        """Forget: the next observations are the first of their episodes."""
        self._state = None

    def predict(self, observation: np.ndarray, *, deterministic: bool) -> tuple[np.ndarray, Any]:
        """Actions of the next beat, of as many rows as since `start`."""
        actions, self._state = self.model.predict(observation, state=self._state, deterministic=deterministic)
        return actions, self._state


def flown(model: BaseAlgorithm) -> Predictor:
    """What a task flies of a model: itself, or one that remembers."""
    return Remembering(model) if isinstance(model, RecurrentPPO) else model
