"""What happens beside the updates: what falls, the learning curve and the progress bar."""

import csv
import io
import math
import sys
import time
from pathlib import Path
from typing import Any

import numpy as np
from stable_baselines3.common.callbacks import BaseCallback
from tqdm import tqdm

from agents.presets import Settings
from agents.remembering import flown
from agents.run_folder import CURVE
from agents.tasks import Task
from flapenv.aero.checks import shown
from flapenv.whole_file import write_text

CURVE_COLUMNS = ("wingbeats", "seconds", "mean_reward", "mean_gap", "worst_gap")
CURVE_POINTS = 200
"""Points of the learning curve over a training budget."""
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

    def __init__(self, out: Path, task: Task, budget: int, state: Any = None) -> None:
        """Write about `CURVE_POINTS` points over `budget` wingbeats to `out`, more closely at the beginning.

        Args:
            out: the run's folder; the file is written anew.
            task: what the policy is watched at.
            budget: of the training.
            state: what `state` gave, to go on from there; None for the beginning.

        Raises:
            ValueError: for a state that is none.
            OSError: if the file cannot be written.
        """
        super().__init__()
        self.path, self.task = out / CURVE, task
        self.every, self.next = budget / CURVE_POINTS, 0.0
        self.rows: list[tuple[float, ...]] = []
        self._rewards: list[float] = []
        self._before, self._started, self._watched = 0.0, time.monotonic(), 0.0
        self._ended: float | None = None
        if state is not None:
            self._restore(_checked_curve(state))
        text = io.StringIO(newline="")
        csv.writer(text).writerows([CURVE_COLUMNS, *self.rows])
        write_text(self.path, text.getvalue())

    @property
    def seconds(self) -> float:
        """Spent training, in this process and those before it, without those spent watching."""
        until = time.monotonic() if self._ended is None else self._ended
        return self._before + until - self._started - self._watched

    def end(self) -> None:
        """Training is over: `seconds` stays as it is."""
        self._ended = time.monotonic()

    def state(self) -> dict[str, Any]:
        """What the curve goes on from, for JSON: NaN as None."""
        rows = [[None if math.isnan(value) else value for value in row] for row in self.rows]
        return {"seconds": self.seconds, "next": self.next, "rows": rows, "rewards": list(self._rewards)}

    def _restore(self, state: dict[str, Any]) -> None:
        self._before, self.next = state["seconds"], state["next"]
        self.rows = [tuple(math.nan if value is None else value for value in row) for row in state["rows"]]
        self._rewards = list(state["rewards"])

    def _on_training_start(self) -> None:
        self._started = time.monotonic()

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
        began, seconds = time.monotonic(), self.seconds
        mean, worst = self.task.glance(flown(self.model))
        reward = float(np.mean(self._rewards))
        self._rewards.clear()
        row = (self.model.num_timesteps, round(seconds, 3), reward, mean, worst)
        if self._ended is None:
            self._watched += time.monotonic() - began
        self.rows.append(row)
        with self.path.open("a", encoding="utf-8", newline="") as file:
            csv.writer(file).writerow(row)
        for name, value in (("reward", reward), ("mean_gap", mean), ("worst_gap", worst)):
            self.logger.record(f"hover/{name}", value)


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
            initial=min(self.model.num_timesteps, self.budget),
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


def _checked_curve(state: Any) -> dict[str, Any]:
    """What `LearningCurve.state` gave."""
    right = (
        isinstance(state, dict)
        and set(state) == {"seconds", "next", "rows", "rewards"}
        and all(type(state[name]) in (int, float) for name in ("seconds", "next"))
        and isinstance(state["rows"], list)
        and all(isinstance(row, list) and len(row) == len(CURVE_COLUMNS) for row in state["rows"])
        and all(type(value) in (int, float, type(None)) for row in state["rows"] for value in row)
        and isinstance(state["rewards"], list)
        and all(type(value) in (int, float) for value in state["rewards"])
    )
    if not right:
        raise ValueError(f"curve = {shown(state)} is not allowed; allowed: seconds, next, rows and rewards")
    return dict(state)
