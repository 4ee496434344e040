"""Actuators that do not carry out quite what a policy means, for any task."""

from typing import Any

import numpy as np

from agents.predictor import Predictor, begin
from flapenv.aero.checks import require_count, require_scalar

NOISE_SHARE = 0.02
"""Standard deviation of actuator noise as a fraction of the actions' range."""
ACTION_RANGE = 2.0
"""Of the cube [-1, 1]."""


class NoisyActuators:
    """A policy whose actions are not carried out as it meant them.

    Gaussian noise is added to every action, afresh in every beat, with a standard deviation of `share` of the actions'
    range; the environment clips what leaves the box. The policy does not know. It serves any task:
    `task.judge(NoisyActuators(policy))` is the verdict on noisy actuators.
    """

    def __init__(self, policy: Predictor, share: float = NOISE_SHARE, seed: int = 0) -> None:
        """Wrap a policy; the same seed gives the same noise.

        Raises:
            TypeError: for a share or a seed of another type.
            ValueError: for one out of range.
        """
        self.policy, self.share = policy, require_scalar("share", share, 0.0, 1.0)
        self._generator = np.random.default_rng(require_count("seed", seed, low=0))

    def start(self) -> None:
        """Let a policy with memory forget the last episodes; the noise goes on."""
        begin(self.policy)

    def predict(self, observation: np.ndarray, *, deterministic: bool = True) -> tuple[np.ndarray, Any]:
        """The policy's actions with noise, not clipped."""
        actions, state = self.policy.predict(observation, deterministic=deterministic)
        noise = self._generator.normal(scale=self.share * ACTION_RANGE, size=np.shape(actions))
        return actions + noise.astype(np.float32), state
