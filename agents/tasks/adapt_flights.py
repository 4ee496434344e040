"""What policy and references did in the same episodes of HoverAdapt-v0."""

import numpy as np

from flapenv.aero.checks import record


@record
class Flown:
    """Episodes that a policy and the references flew on the same draws with the same noise.

    Attributes:
        rewards: of every beat, by "policy" and the references' names; shape (beats, rows) each; NaN where an insect has
            no tuned references [-].
        weight_support: true Λ of the policy's beats, shape (beats, rows) [-].
        changed: whether the condition was no longer the first one, shape (beats, rows).
    """

    rewards: dict[str, np.ndarray]
    weight_support: np.ndarray
    changed: np.ndarray

    @property
    def returns(self) -> dict[str, np.ndarray]:
        """Sums of the rewards, shape (rows,) each [-]."""
        return {name: np.sum(rewards, axis=0) for name, rewards in self.rewards.items()}
