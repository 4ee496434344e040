"""When checkpoints are made: often enough to lose little, seldom enough to cost nothing that one would notice."""

import time
from collections.abc import Callable

from stable_baselines3.common.callbacks import BaseCallback

CHECKPOINT_SECONDS = 5.0
"""Between two checkpoints, at least."""
SHARE = 0.01
"""Of the time that is spent on them, at most."""


class Checkpoints(BaseCallback):
    """Makes a checkpoint between two rollouts, at least some seconds apart, and fewer where one takes long.

    Nothing that is learned depends on when that happens. Time is the monotonic clock's, which does not jump when the
    machine's is set.
    """

    def __init__(
        self,
        make: Callable[[], object],
        *,
        seconds: float = CHECKPOINT_SECONDS,
        share: float = SHARE,
        stop: Callable[[], bool] = lambda: False,
    ) -> None:
        """Make checkpoints by calling `make`.

        Args:
            make: writes a checkpoint of what has been learned so far.
            seconds: between two, at least.
            share: of the time that they take, at most.
            stop: whether training is to end, by KeyboardInterrupt, after one checkpoint more.
        """
        super().__init__()
        self.make, self.seconds, self.share, self.stop = make, seconds, share, stop
        self._due = time.monotonic() + seconds

    def _on_training_start(self) -> None:
        self._due = time.monotonic() + self.seconds

    def _on_rollout_start(self) -> None:
        if self.stop():
            self.make()
            raise KeyboardInterrupt
        began = time.monotonic()
        if began < self._due:
            return
        self.make()
        ended = time.monotonic()
        self._due = ended + max(self.seconds, (ended - began) * (1 / self.share - 1))

    def _on_step(self) -> bool:
        return True
