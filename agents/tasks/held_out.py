"""What is common to judging policies: draws that no training run meets, and noise-free actions."""

import numpy as np

from agents.predictor import Predictor, begin

HELD_OUT_SEED = 2**32
"""Above every seed that a training run can have, so that none meets these draws.

Not a stream of its own: NumPy reads a seed as words of 32 bits, and this one is the stream of `SeedSequence([0, 1])`,
from which the test wings of pool 0 and the draws that HoverAdapt's references are tested on come as well. Those are
held out, too, and nothing is learned from them: nothing leaks.
"""


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
