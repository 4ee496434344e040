"""Train one policy by a preset, keep it, and judge it against its task's reference."""

import dataclasses
import json
import sys
import time
from pathlib import Path
from typing import Any

import torch
from stable_baselines3.common.base_class import BaseAlgorithm
from stable_baselines3.common.callbacks import CallbackList
from stable_baselines3.common.logger import configure

from agents.actor_of import actor_of
from agents.callbacks import Annealing, Checkpoints, LearningCurve, ProgressBar
from agents.curve_picture import draw_learning_curve
from agents.interrupts import one_interrupt
from agents.policy_card import PolicyCard
from agents.policy_file import save_policy
from agents.presets import Preset
from agents.remembering import flown
from agents.run_folder import (
    CONFIG,
    CURVE_PICTURE,
    POLICY_TENSORS,
    RESULT_PICTURE,
    RESULTS,
    TENSORBOARD,
    open_run_folder,
    versions,
    write_atomically,
)
from agents.tasks import Predictor, Task
from agents.training_config import TrainingConfig, TrainingResult
from agents.vec_env import GymnasiumVecEnv
from flapenv.whole_file import write_json

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
    config: TrainingConfig, out: Path | None = None, *, progress: bool = True, report: bool = True
) -> TrainingResult:
    """Train from random weights; the last policy is the result, nothing is picked by its score.

    Writes config.json at the start, the policy and the learning curve as it goes, and results.json, pictures and a
    report at the end. Ctrl-C ends the training early and keeps what was learned: everything is written for the policy
    as it is then.

    Args:
        config: what to train.
        out: the run's folder; see `open_run_folder`.
        progress: whether to show a progress bar.
        report: whether to write the HTML report.

    Raises:
        FileExistsError: if the folder holds a run already.
        DivergedError: if weights became NaN or inf.
        OSError: if it cannot be written.
    """
    described = config.to_dict()
    json.dumps(
        described, ensure_ascii=False, allow_nan=False
    ).encode()  # before anything is spent on what cannot be kept
    preset: Preset = config.preset
    task, settings = preset.make_task(), preset.settings
    torch.set_num_threads(settings.threads)
    model = make_model(preset, task, config.seed)
    task.glance(flown(model))  # references are solved before the clock starts
    out = open_run_folder(out, f"{config.name}-seed{config.seed}")
    write_json(out / CONFIG, {**described, "versions": versions()})
    model.set_logger(configure(str(out / TENSORBOARD), ["tensorboard"]))
    curve = LearningCurve(out, task, settings.wingbeats)
    checkpoints = Checkpoints(out, settings.wingbeats)
    bar = ProgressBar(curve, settings.wingbeats, shown=progress)
    callbacks = CallbackList([Annealing(settings), curve, checkpoints, bar])
    started, interrupted = time.monotonic(), False
    with one_interrupt():
        try:
            model.learn(settings.wingbeats, callback=callbacks)
        except KeyboardInterrupt:
            interrupted = True
        except ValueError:
            _require_finite(model)
            raise
        finally:
            bar.close()
        seconds = time.monotonic() - started - curve.watching
        if interrupted:
            print(f"stopped after {model.num_timesteps:,} wingbeats; keeping what was learned", file=sys.stderr)
        _require_finite(model)
        curve.measure()
        checkpoints.init_callback(model)
        checkpoints.save()
        save_actor(config, model, out, {"mean": None, "worst": None})
    result = TrainingResult(
        out=out,
        verdict=task.judge(flown(model)),
        wingbeats=model.num_timesteps,
        seconds=seconds,
        interrupted=interrupted,
    )
    save_results(config, result, model)
    draw_pictures(f"{config.name}, seed {config.seed}", task, result, flown(model))
    return dataclasses.replace(result, report=_reported(config, task, result)) if report else result


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
