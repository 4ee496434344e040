"""What happens beside the updates: what falls, the learning curve, checkpoints and the progress bar."""

import csv
import sys
import time
from pathlib import Path
from typing import Any

import numpy as np
from stable_baselines3.common.callbacks import BaseCallback
from tqdm import tqdm

from agents.presets import Settings
from agents.remembering import flown
from agents.run_folder import CURVE, POLICY, write_atomically
from agents.tasks import Task

CURVE_COLUMNS = ("wingbeats", "seconds", "mean_reward", "mean_gap", "worst_gap")
CURVE_POINTS, CHECKPOINTS = 200, 10
"""Points of the learning curve and saved policies over a training budget."""
FINEST = 0.1
"""Early points of the learning curve lie a tenth of what was flown apart, for a logarithmic axis."""


class Annealing(BaseCallback):
    """Lowers what the settings lower as the budget is spent, before every rollout."""

    def __init__(self, settings: Settings) -> None:
        """Follow the schedules of `settings`."""
        super().__init__()
        self.settings = settings

    def _on_rollout_start(self) -> None:
        self.settings.anneal(self.model, 1 - self.num_timesteps / self.settings.wingbeats)

    def _on_step(self) -> bool:
        return True


class LearningCurve(BaseCallback):
    """Writes how far the noise-free policy is off against wingbeats and seconds, to a CSV file and to TensorBoard.

    That is watched only: nothing is chosen by it. What watching costs is not counted as seconds of training.
    """

    def __init__(self, out: Path, task: Task, budget: int) -> None:
        """Write about `CURVE_POINTS` points over `budget` wingbeats to `out`, more closely at the beginning."""
        super().__init__()
        self.path, self.task = out / CURVE, task
        with self.path.open("w", encoding="utf-8", newline="") as file:
            csv.writer(file).writerow(CURVE_COLUMNS)
        self.started, self.watching = time.monotonic(), 0.0
        self.every, self.next = budget / CURVE_POINTS, 0.0
        self.rows: list[tuple[float, ...]] = []
        self._rewards: list[float] = []

    def _on_training_start(self) -> None:
        self.started = time.monotonic()

    def _on_step(self) -> bool:
        self._rewards.append(float(np.mean(self.locals["rewards"])))
        return True

    def _on_rollout_start(self) -> None:  # what has been flown has been learned from
        if self.num_timesteps < self.next:
            return
        step = min(self.every, max(self.num_timesteps * FINEST, self.every / CURVE_POINTS))
        self.next = self.num_timesteps + step
        self.measure()

    def measure(self) -> None:
        """Add a point for the policy as it is now, unless nothing was flown since the last."""
        if not self._rewards:
            return
        began = time.monotonic()
        mean, worst = self.task.glance(flown(self.model))
        reward = float(np.mean(self._rewards))
        self._rewards.clear()
        row = (self.num_timesteps, round(began - self.started - self.watching, 3), reward, mean, worst)
        self.watching += time.monotonic() - began
        self.rows.append(row)
        with self.path.open("a", encoding="utf-8", newline="") as file:
            csv.writer(file).writerow(row)
        for name, value in (("reward", reward), ("mean_gap", mean), ("worst_gap", worst)):
            self.logger.record(f"hover/{name}", value)


class Checkpoints(BaseCallback):
    """Saves the policy ten times over the budget, each time in place of the last."""

    def __init__(self, out: Path, budget: int) -> None:
        """Save to `out`."""
        super().__init__()
        self.path, self.every = out / POLICY, budget / CHECKPOINTS
        self.next = self.every

    def _on_rollout_start(self) -> None:
        if self.num_timesteps >= self.next:
            self.next += self.every
            self.save()

    def _on_step(self) -> bool:
        return True

    def save(self) -> None:
        """Save the policy as it is now."""
        write_atomically(self.path, self.model.save)


class ProgressBar(BaseCallback):
    """A bar over the wingbeats with the latest gaps."""

    def __init__(self, curve: LearningCurve, budget: int, *, shown: bool) -> None:
        """Show the bar, or nothing."""
        super().__init__()
        self.curve, self.budget, self.shown = curve, budget, shown
        self._bar: Any = None

    def _on_training_start(self) -> None:
        self._bar = tqdm(
            total=self.budget,
            unit=" wingbeats",
            unit_scale=True,
            disable=not self.shown,
            dynamic_ncols=True,
            mininterval=0.2 if sys.stderr.isatty() else 10,  # a log file wants few lines
        )

    def _on_step(self) -> bool:
        self._bar.update(min(self.num_timesteps, self.budget) - self._bar.n)
        if self.curve.rows:
            _, _, _, mean, worst = self.curve.rows[-1]
            self._bar.set_postfix_str(f"gap mean {100 * mean:.2f} %, worst {100 * worst:.2f} %", refresh=False)
        return True

    def close(self) -> None:
        """Leave the bar as it stands."""
        if self._bar is not None:
            self._bar.close()
