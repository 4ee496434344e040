"""A run under way: it learns, makes checkpoints, and goes on from one."""

import sys
from pathlib import Path

import numpy as np
import torch
from stable_baselines3.common.base_class import BaseAlgorithm
from stable_baselines3.common.callbacks import CallbackList
from stable_baselines3.common.logger import configure

from agents.callbacks import Annealing, LearningCurve, ProgressBar
from agents.checkpoint import (
    Checkpoint,
    Checkpoints,
    learner_state,
    read_checkpoint,
    restore_learner,
    write_checkpoint,
)
from agents.interrupts import noted_interrupts
from agents.run_folder import CHECKPOINT, POLICY, TENSORBOARD, require_no_file, write_atomically
from agents.run_results import save_actor
from agents.silent_threads import silent_threads
from agents.tasks import Task
from agents.training_config import TrainingConfig
from flapenv.aero.checks import shown


class DivergedError(ArithmeticError):
    """Raised where training has destroyed its own policy."""


class Learning:
    """A learner at work in its folder.

    Attributes:
        curve: its learning curve so far.
    """

    def __init__(self, config: TrainingConfig, task: Task, model: BaseAlgorithm, folder: Path) -> None:
        """Begin, or go on from the folder's checkpoint where there is one.

        Args:
            config: what is trained.
            task: of the config.
            model: with random weights.
            folder: locked, with the config's config.json.

        Raises:
            ValueError: if the checkpoint is not what was written, or not of this run.
            OSError: if it cannot be read, or the learning curve not be written.
        """
        self.config, self.task, self.model, self.folder = config, task, model, folder
        budget, path = config.preset.settings.wingbeats, folder / CHECKPOINT
        require_no_file(path)
        require_no_file(folder / TENSORBOARD)
        checkpoint = read_checkpoint(path)
        if checkpoint is None:
            self.curve = LearningCurve(folder, task, budget)
            return
        try:
            self._restore(checkpoint)
            self.curve = LearningCurve(folder, task, budget, checkpoint.numbers.get("curve"))
        except (TypeError, ValueError) as problem:
            raise ValueError(
                f"{path} is not of this run: {problem}; without that folder the run begins again"
            ) from None

    def _restore(self, checkpoint: Checkpoint) -> None:
        """Let the learner go on."""
        found, learner = (checkpoint.numbers.get(name) for name in ("environment", "learner"))
        if found != self.task.environment:
            raise ValueError(f"environment = {shown(found)} is not allowed; allowed: {self.task.environment!r}")
        if not isinstance(learner, dict):
            raise ValueError(f"learner = {shown(learner)} is not allowed; allowed: its numbers")
        restore_learner(self.model, Checkpoint(numbers=learner, arrays=checkpoint.arrays))

    def make_checkpoint(self) -> None:
        """Keep all that the run goes on from.

        Raises:
            DivergedError: if weights became NaN or inf.
            OSError: if it cannot be written; the last one stays.
        """
        self.require_finite()
        state = learner_state(self.model)
        numbers = {"environment": self.task.environment, "curve": self.curve.state(), "learner": state.numbers}
        write_checkpoint(self.folder / CHECKPOINT, Checkpoint(numbers=numbers, arrays=state.arrays))

    def learn(self, *, progress: bool, checkpoint_seconds: float) -> bool:
        """Train until the budget is spent or Ctrl-C, and write the policy; whether it was Ctrl-C.

        At the first Ctrl-C training ends before the next rollout, with a checkpoint of just that; at a second one at
        once, whatever it is doing.

        Raises:
            DivergedError: if weights became NaN or inf.
            OSError: if something cannot be written; the last checkpoint stays.
        """
        model, settings = self.model, self.config.preset.settings
        bar = ProgressBar(self.curve, settings.wingbeats, shown=progress)
        # Checkpoints come first, for what else happens when a rollout begins happens again when it does so again.
        interrupted = False
        with noted_interrupts() as interrupts, silent_threads():
            checkpoints = Checkpoints(self.make_checkpoint, seconds=checkpoint_seconds, stop=lambda: interrupts.asked)
            callbacks = CallbackList([checkpoints, Annealing(settings), self.curve, bar])
            try:
                model.set_logger(configure(str(self.folder / TENSORBOARD), ["tensorboard"]))
                left = max(0, settings.wingbeats - model.num_timesteps)
                model.learn(left, callback=callbacks, reset_num_timesteps=model._last_obs is None)
            except KeyboardInterrupt:
                interrupted = True
            except ValueError as mistake:
                self.require_finite()
                if not self._acts():
                    raise self._diverged("what the policy answers is") from mistake
                raise
            finally:
                interrupts.hurrying = False
                bar.close()
            self.curve.end()
            if interrupted:
                print(f"stopped after {model.num_timesteps:,} wingbeats; keeping what was learned", file=sys.stderr)
                self.require_finite()
            else:
                self.make_checkpoint()
            self.curve.measure()
            write_atomically(self.folder / POLICY, model.save)
            save_actor(self.config, model, self.folder, {"mean": None, "worst": None})
        return interrupted

    def require_finite(self) -> None:
        """Refuse a policy that has been destroyed.

        Raises:
            DivergedError: if a weight is NaN or inf.
        """
        if not all(bool(torch.isfinite(weights).all()) for weights in self.model.policy.parameters()):
            raise self._diverged("weights are")

    def _acts(self) -> bool:
        """Whether the policy answers what was seen last with numbers: large finite weights may not."""
        seen = self.model._last_obs
        assert seen is not None
        try:
            actions, _ = self.model.predict(seen, deterministic=True)
        except ValueError:  # torch has no normal distribution about NaN
            return False
        return bool(np.isfinite(actions).all())

    def _diverged(self, what: str) -> DivergedError:
        """Training that destroyed its policy, in words."""
        return DivergedError(
            f"training diverged: after {self.model.num_timesteps:,} wingbeats {what} not finite, and none of them was "
            "kept; a smaller learning rate may help"
        )
