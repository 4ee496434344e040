"""Train one policy by a preset, keep it, and judge it against its task's reference."""

import dataclasses
import sys
from pathlib import Path

import torch
from stable_baselines3.common.base_class import BaseAlgorithm

from agents.checkpoint import CHECKPOINT_SECONDS, remove_checkpoint
from agents.learning import DivergedError, Learning
from agents.presets import Preset
from agents.remembering import flown
from agents.resuming import finished_result, is_finished, keep_config, require_nothing_lost
from agents.run_folder import CHECKPOINT, locked_run_folder
from agents.run_results import draw_pictures, reported, save_results
from agents.tasks import Task
from agents.training_config import TrainingConfig, TrainingResult
from agents.vec_env import GymnasiumVecEnv
from flapenv.aero.checks import require_scalar
from flapenv.whole_file import json_text

__all__ = ["DivergedError", "TrainingConfig", "TrainingResult", "make_model", "summary", "train"]


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
            remove_checkpoint(folder / CHECKPOINT)  # what a kill left of it
            return finished_result(folder, task)
        require_nothing_lost(folder)
        learning = Learning(config, task, model, folder)
        if progress and model.num_timesteps:
            print(f"goes on from {model.num_timesteps:,} wingbeats", file=sys.stderr)
        try:
            interrupted = learning.learn(progress=progress, checkpoint_seconds=checkpoint_seconds)
            result = TrainingResult(
                out=folder,
                verdict=task.judge(flown(model)),
                wingbeats=model.num_timesteps,
                seconds=learning.curve.seconds,
                interrupted=interrupted,
            )
            save_results(config, result, model)
            draw_pictures(f"{config.name}, seed {config.seed}", task, result, flown(model))
            if report:
                result = dataclasses.replace(result, report=reported(config, task, result))
            if not interrupted:
                remove_checkpoint(folder / CHECKPOINT)  # nothing can go on from it any more
            return result
        except OSError as mistake:
            raise _named(mistake, folder) from mistake


def _named(mistake: OSError, folder: Path) -> OSError:
    """What the system says of a write, with the folder and what helps."""
    if mistake.errno is None:  # named already
        told = str(mistake)
    else:
        told = f"{folder} cannot be written ({mistake}); allowed: a disk with room, a folder that can be written"
    return type(mistake)(f"{told}; then --resume {folder} goes on from the last checkpoint")


def summary(result: TrainingResult) -> str:
    """The verdict as text, with where the run and its report lie."""
    rate = result.wingbeats / max(result.seconds, 1e-9)
    report = "" if result.report is None else f"\nreport: {result.report}"
    return (
        f"{result.verdict.text}\n"
        f"{result.wingbeats:,} wingbeats in {result.seconds:.0f} s ({rate:,.0f}/s); run kept in {result.out}{report}"
    )
