"""Train one policy for all insects of a problem, keep it, and compare it with the proven optimum."""

import sys
import time
from collections.abc import Mapping, Sequence
from dataclasses import asdict
from pathlib import Path
from typing import Any

import torch
from stable_baselines3 import PPO
from stable_baselines3.common.callbacks import CallbackList
from stable_baselines3.common.logger import configure

from agents.callbacks import Checkpoints, LearningCurve, NoiseFloor, ProgressBar
from agents.comparison import Comparison, InsectResult, comparison_table, mean_gap
from agents.pictures import draw_learning_curve, draw_strokes
from agents.policy import HoverPolicy
from agents.presets import PPOPreset
from agents.run_folder import (
    CONFIG,
    CURVE_PICTURE,
    RESULTS,
    STROKES_PICTURE,
    TENSORBOARD,
    open_run_folder,
    versions,
    write_json,
)
from agents.vec_env import GymnasiumVecEnv
from flapenv.aero.checks import record, require_count
from flapenv.envs import HoverVectorEnv
from flapenv.insects import INSECTS, Insect, as_insect
from flapenv.problem import HoverProblem, as_problem

LAST_SEED = 2**32 - 1
"""The largest seed that NumPy's and torch's global generators both take."""


@record
class TrainingConfig:
    """Everything a training run depends on.

    Attributes:
        insects: names or `Insect`s the policy is trained for.
        problem: the problem, by name, as a `HoverProblem` or as the dict of one.
        preset: the learner's settings.
        seed: of networks, noise and draws.
    """

    insects: Sequence[Any] = INSECTS
    problem: Any = "free-frequency"
    preset: Any = PPOPreset()
    seed: int = 0

    def __post_init__(self) -> None:
        """Resolve insects, problem and preset, which may be dicts as from config.json; check the seed."""
        if require_count("seed", self.seed, low=0) > LAST_SEED:
            raise ValueError(f"seed = {self.seed} is not allowed; allowed: whole numbers from 0 to {LAST_SEED}")
        if isinstance(self.insects, str) or not isinstance(self.insects, Sequence):
            raise TypeError(f"insects = {self.insects!r} are not allowed; allowed: a list of names or insects")
        preset = PPOPreset(**self.preset) if isinstance(self.preset, Mapping) else self.preset
        if not isinstance(preset, PPOPreset):
            raise TypeError(f"preset = {preset!r} is not allowed; allowed: a PPOPreset or a dict of its fields")
        object.__setattr__(self, "preset", preset)
        object.__setattr__(self, "insects", tuple(as_insect(insect) for insect in self.insects))
        object.__setattr__(self, "problem", as_problem(self.problem))

    def to_dict(self) -> dict[str, Any]:
        """As config.json keeps it."""
        insects: tuple[Insect, ...] = tuple(self.insects)
        problem: HoverProblem = self.problem
        preset: PPOPreset = self.preset
        return {
            "environment": "flapenv/Hover-v0",
            "algorithm": "PPO",
            "seed": self.seed,
            "insects": [insect.to_dict() for insect in insects],
            "problem": problem.to_dict(),
            "preset": asdict(preset),
        }


@record
class TrainingResult:
    """What a run ended with.

    Attributes:
        out: its folder.
        insects: every insect's learned stroke beside its references.
        wingbeats: wingbeats trained on.
        seconds: spent training.
        interrupted: whether it was stopped before its budget was spent.
    """

    out: Path
    insects: list[InsectResult]
    wingbeats: int
    seconds: float
    interrupted: bool


def make_model(config: TrainingConfig) -> PPO:
    """PPO on the native batched environment, with random weights."""
    preset: PPOPreset = config.preset
    env = HoverVectorEnv(
        preset.rows,
        insect=list(config.insects),
        problem=config.problem,
        autoreset_mode="SAME_STEP",
    )
    return PPO(
        HoverPolicy,
        GymnasiumVecEnv(env),
        learning_rate=preset.learning_rate_at,
        n_steps=1,
        batch_size=min(preset.minibatch, preset.rows),
        n_epochs=preset.epochs,
        gamma=1.0,
        gae_lambda=1.0,
        clip_range=preset.clip_range,
        target_kl=preset.target_kl,
        policy_kwargs={"net_arch": [preset.width, preset.width], "log_std_init": preset.log_std},
        seed=config.seed,
        device="cpu",
    )


def train(config: TrainingConfig, out: Path | None = None, *, progress: bool = True) -> TrainingResult:
    """Train from random weights; the last policy is the result, nothing is picked by its score.

    Writes config.json at the start, the policy and the learning curve as it goes, and results.json at the end;
    `draw_pictures` adds the pictures. Ctrl-C ends the training early and keeps what was learned: everything is
    written for the policy as it is then.

    Args:
        config: what to train.
        out: the run's folder; see `open_run_folder`.
        progress: whether to show a progress bar.

    Raises:
        FileExistsError: if the folder holds a run already.
        OSError: if it cannot be written.
    """
    preset: PPOPreset = config.preset
    described = config.to_dict()  # before anything is spent on what cannot be kept
    torch.set_num_threads(preset.threads)
    model, comparison = make_model(config), Comparison(config.insects, config.problem)
    out = open_run_folder(out, f"hover-ppo-seed{config.seed}")
    write_json(out / CONFIG, {**described, "versions": versions()})
    model.set_logger(configure(str(out / TENSORBOARD), ["tensorboard"]))
    curve = LearningCurve(out, comparison, preset.wingbeats)
    checkpoints = Checkpoints(out, preset.wingbeats)
    bar = ProgressBar(curve, preset.wingbeats, shown=progress)
    callbacks = CallbackList([NoiseFloor(preset), curve, checkpoints, bar])
    started, interrupted = time.monotonic(), False
    try:
        model.learn(preset.wingbeats, callback=callbacks)
    except KeyboardInterrupt:
        interrupted = True
    finally:
        bar.close()
    seconds = time.monotonic() - started
    if interrupted:
        print(f"stopped after {model.num_timesteps:,} wingbeats; keeping what was learned", file=sys.stderr)
    checkpoints.init_callback(model)
    checkpoints.save()
    curve.measure()
    result = TrainingResult(
        out=out,
        insects=comparison.results(model),
        wingbeats=model.num_timesteps,
        seconds=seconds,
        interrupted=interrupted,
    )
    save_results(config, result)
    return result


def draw_pictures(config: TrainingConfig, result: TrainingResult) -> None:
    """Add the learning curve and the learned over the optimal strokes to the run's folder."""
    draw_learning_curve(result.out, config.seed).savefig(result.out / CURVE_PICTURE)
    draw_strokes(result.insects).savefig(result.out / STROKES_PICTURE)


def save_results(config: TrainingConfig, result: TrainingResult) -> None:
    """Write results.json."""
    mean = mean_gap(result.insects)
    write_json(
        result.out / RESULTS,
        {
            **config.to_dict(),
            "insects": {one.insect.name: one.to_dict() for one in result.insects},
            "mean_gap_percent": None if mean is None else 100 * mean,
            "infeasible": [one.insect.name for one in result.insects if not one.best.feasible],
            "seconds": result.seconds,
            "wingbeats": result.wingbeats,
            "interrupted": result.interrupted,
            "versions": versions(),
        },
    )


def summary(result: TrainingResult) -> str:
    """The comparison as text, with where the run lies."""
    rate = result.wingbeats / max(result.seconds, 1e-9)
    return (
        f"{comparison_table(result.insects)}\n"
        f"{result.wingbeats:,} wingbeats in {result.seconds:.0f} s ({rate:,.0f}/s); run kept in {result.out}"
    )
