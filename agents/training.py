"""Train one policy by a preset, keep it, and judge it against its task's reference."""

import dataclasses
import sys
from pathlib import Path
from typing import Any

import torch
from stable_baselines3.common.base_class import BaseAlgorithm
from stable_baselines3.common.callbacks import CallbackList
from stable_baselines3.common.logger import configure

from agents.actor_of import actor_of
from agents.callbacks import Annealing, LearningCurve, ProgressBar
from agents.checkpoint import (
    CHECKPOINT_SECONDS,
    Checkpoint,
    Checkpoints,
    learner_state,
    read_checkpoint,
    remove_checkpoint,
    restore_learner,
    write_checkpoint,
)
from agents.curve_picture import draw_learning_curve
from agents.interrupts import one_interrupt
from agents.policy_card import PolicyCard
from agents.policy_file import save_policy
from agents.presets import Preset
from agents.remembering import flown
from agents.resuming import finished_result, is_finished, keep_config
from agents.run_folder import (
    CHECKPOINT,
    CURVE_PICTURE,
    POLICY,
    POLICY_TENSORS,
    RESULT_PICTURE,
    RESULTS,
    TENSORBOARD,
    locked_run_folder,
    versions,
    write_atomically,
)
from agents.tasks import Predictor, Task
from agents.training_config import TrainingConfig, TrainingResult
from agents.vec_env import GymnasiumVecEnv
from flapenv.aero.checks import require_scalar, shown
from flapenv.whole_file import json_text, write_json

__all__ = ["DivergedError", "TrainingConfig", "TrainingResult", "make_model", "summary", "train"]


class DivergedError(ArithmeticError):
    """Raised where training has destroyed its own policy."""


def make_model(preset: Preset, task: Task, seed: int) -> BaseAlgorithm:
    """The learner on the task's native batched environment, with random weights."""
    settings = preset.settings
    scale = getattr(settings, "reward_scale", 1.0)
    model: BaseAlgorithm = settings.build(GymnasiumVecEnv(task.vector_env(settings.rows), reward_scale=scale), seed)
    return model


def train(
    config: TrainingConfig,
    out: Path | None = None,
    *,
    progress: bool = True,
    report: bool = True,
    resume: bool = False,
    checkpoint_seconds: float = CHECKPOINT_SECONDS,
) -> TrainingResult:
    """Train from random weights; the last policy is the result, nothing is picked by its score.

    Writes config.json at the start, the learning curve and checkpoints as it goes, and the policy, results.json,
    pictures and a report at the end. Ctrl-C ends the training early and keeps what was learned: everything is written
    for the policy as it is then. A run that was killed, or stopped early, goes on from its last checkpoint with
    `resume`; with the same versions and machine it ends with the policy of a run that was never stopped.

    Args:
        config: what to train.
        out: the run's folder; see `open_run_folder`.
        progress: whether to show a progress bar.
        report: whether to write the HTML report.
        resume: whether to go on with the run in `out`: from its checkpoint, from the beginning where there is none
            yet, and not at all where it is finished.
        checkpoint_seconds: between two checkpoints, at least [s].

    Raises:
        BlockingIOError: if another process trains into the folder.
        FileExistsError: if the folder holds a run that is not to go on.
        ValueError: if it holds a run of another config, or a checkpoint that is not what was written.
        DivergedError: if weights became NaN or inf.
        OSError: if it cannot be written.
    """
    described = config.to_dict()
    json_text(described).encode()  # before anything is spent on what cannot be kept
    require_scalar("checkpoint_seconds", checkpoint_seconds, 0.0)
    preset: Preset = config.preset
    task, settings = preset.make_task(), preset.settings
    torch.set_num_threads(settings.threads)
    model = make_model(preset, task, config.seed)
    task.glance(flown(model))  # references are solved before the clock starts
    with locked_run_folder(out, f"{config.name}-seed{config.seed}", resume=resume) as folder:
        keep_config(folder, config)
        if resume and is_finished(folder):
            return finished_result(folder, task)
        curve = _begun(model, task, folder, settings.wingbeats)
        interrupted = _learn(config, model, curve, folder, progress, checkpoint_seconds)
        result = TrainingResult(
            out=folder,
            verdict=task.judge(flown(model)),
            wingbeats=model.num_timesteps,
            seconds=curve.seconds,
            interrupted=interrupted,
        )
        save_results(config, result, model)
        draw_pictures(f"{config.name}, seed {config.seed}", task, result, flown(model))
        if report:
            result = dataclasses.replace(result, report=_reported(config, task, result))
        if not interrupted:
            remove_checkpoint(folder / CHECKPOINT)
        return result


def _begun(model: BaseAlgorithm, task: Task, folder: Path, budget: int) -> LearningCurve:
    """The learning curve of a run, which begins, or goes on from its checkpoint like the learner.

    Raises:
        ValueError: if the checkpoint is not of this run.
        OSError: if it cannot be read.
    """
    path = folder / CHECKPOINT
    checkpoint = read_checkpoint(path)
    if checkpoint is None:
        return LearningCurve(folder, task, budget)
    try:
        found = checkpoint.numbers.get("environment")
        if found != task.environment:
            raise ValueError(f"environment = {shown(found)} is not allowed; allowed: {task.environment!r}")
        learner = checkpoint.numbers.get("learner")
        if not isinstance(learner, dict):
            raise ValueError(f"learner = {shown(learner)} is not allowed; allowed: its numbers")
        restore_learner(model, Checkpoint(numbers=learner, arrays=checkpoint.arrays))
        return LearningCurve(folder, task, budget, checkpoint.numbers.get("curve"))
    except (TypeError, ValueError) as problem:
        raise ValueError(f"{path} is not of this run: {problem}; without that folder the run begins again") from None


def _learn(
    config: TrainingConfig, model: BaseAlgorithm, curve: LearningCurve, folder: Path, progress: bool, apart: float
) -> bool:
    """Train until the budget is spent or Ctrl-C, and write the policy; whether it was Ctrl-C.

    Raises:
        DivergedError: if weights became NaN or inf.
        OSError: if something cannot be written; the last checkpoint stays.
    """
    settings = config.preset.settings

    def make_checkpoint() -> None:
        _require_finite(model)
        state = learner_state(model)
        numbers = {"environment": curve.task.environment, "curve": curve.state(), "learner": state.numbers}
        write_checkpoint(folder / CHECKPOINT, Checkpoint(numbers=numbers, arrays=state.arrays))

    bar = ProgressBar(curve, settings.wingbeats, shown=progress)
    checkpoints = Checkpoints(make_checkpoint, seconds=apart)  # first: the others see that rollout begin again
    callbacks = CallbackList([checkpoints, Annealing(settings), curve, bar])
    interrupted = False
    with one_interrupt():
        try:
            model.set_logger(configure(str(folder / TENSORBOARD), ["tensorboard"]))
            left = max(0, settings.wingbeats - model.num_timesteps)
            model.learn(left, callback=callbacks, reset_num_timesteps=model._last_obs is None)
        except KeyboardInterrupt:
            interrupted = True
        except ValueError:
            _require_finite(model)
            raise
        finally:
            bar.close()
        curve.end()
        if interrupted:
            print(f"stopped after {model.num_timesteps:,} wingbeats; keeping what was learned", file=sys.stderr)
        _require_finite(model)
        if not interrupted:
            make_checkpoint()
        curve.measure()
        write_atomically(folder / POLICY, model.save)
        save_actor(config, model, folder, {"mean": None, "worst": None})
    return interrupted


def _require_finite(model: BaseAlgorithm) -> None:
    """Refuse a policy that has been destroyed.

    Raises:
        DivergedError: if a weight is NaN or inf.
    """
    if not all(bool(torch.isfinite(weights).all()) for weights in model.policy.parameters()):
        raise DivergedError(
            f"training diverged: after {model.num_timesteps:,} wingbeats weights are not finite, and none of them was "
            "kept; a smaller learning rate may help"
        )


def save_actor(config: TrainingConfig, model: BaseAlgorithm, out: Path, result: dict[str, Any]) -> None:
    """Write the policy's network as safetensors with its card, which says what it reached."""
    described, actor = config.to_dict(), actor_of(model)
    card = PolicyCard.of(
        actor,
        environment=described["environment"],
        task=described["task"],
        algorithm=described["algorithm"],
        preset=config.name,
        command=config.command,
        seed=config.seed,
        wingbeats=model.num_timesteps,
        result=result,
        versions=versions(),
    )
    save_policy(actor, card, out / POLICY_TENSORS)


def save_results(config: TrainingConfig, result: TrainingResult, model: BaseAlgorithm) -> None:
    """Write results.json, and what the policy reached on its card."""
    verdict = result.verdict
    scores = {"mean": verdict.mean, "worst": verdict.worst, "distance": config.preset.make_task().distance}
    save_actor(config, model, result.out, {**scores, "seconds": round(result.seconds, 1)})
    write_json(
        result.out / RESULTS,
        {
            **config.to_dict(),
            "verdict": scores,
            **verdict.results,
            "seconds": result.seconds,
            "wingbeats": result.wingbeats,
            "interrupted": result.interrupted,
            "versions": versions(),
        },
    )


def draw_pictures(title: str, task: Task, result: TrainingResult, policy: Predictor) -> None:
    """Add the learning curve, under a title, and the task's picture to the run's folder."""
    write_atomically(result.out / CURVE_PICTURE, draw_learning_curve(result.out, task.distance, title).savefig)
    write_atomically(result.out / RESULT_PICTURE, task.draw(policy).savefig)


def _reported(config: TrainingConfig, task: Task, result: TrainingResult) -> Path | None:
    """The report, beside results that are kept already: whatever goes wrong with drawing must not cost the run."""
    from agents.report.of_run import report_of_run

    try:
        return report_of_run(config, task, result)
    except Exception as mistake:
        print(f"the report could not be drawn: {mistake}; the run is kept without it", file=sys.stderr)
        return None


def summary(result: TrainingResult) -> str:
    """The verdict as text, with where the run and its report lie."""
    rate = result.wingbeats / max(result.seconds, 1e-9)
    report = "" if result.report is None else f"\nreport: {result.report}"
    return (
        f"{result.verdict.text}\n"
        f"{result.wingbeats:,} wingbeats in {result.seconds:.0f} s ({rate:,.0f}/s); run kept in {result.out}{report}"
    )
