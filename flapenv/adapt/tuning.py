"""Tuning of the references on training draws, their score on held-out ones, and the shipped file of both."""

import csv
import functools
import math
from collections.abc import Callable, Iterable
from importlib import resources
from pathlib import Path
from typing import Any

import numpy as np

from flapenv.adapt.references import (
    COORDINATES,
    Controller,
    FeltLift,
    FixedStroke,
    LadderClimber,
    Trials,
    beats_of,
    best_returns,
    fixed_returns,
    fly,
    trials,
)
from flapenv.adapt.task import AdaptTask
from flapenv.aero.checks import record
from flapenv.aero.parameters import StrokeReference
from flapenv.insects import INSECTS, Insect, load_insect

REFERENCES_FILE = "adapt_references.csv"
DRAWS = 1024
"""Episodes the references are tuned on, and as many held out."""
SAMPLES, STARTS, EVALUATIONS = 200, 4, 400
"""Points spread over the parameters, how many of the best are refined, and strokes for each of these."""
NAMES = ("full_knowledge", "fixed_stroke", "felt_lift", "lift_ladder")
"""The references as tables and infos call them."""
FIRST_HEIGHT, GAIN, MARGIN = (1.0, 1.9), (0.1, 1.2), (-0.02, 0.08)
"""Where the first place on the ladder, κ and the margin are sought."""


@record
class Tuned:
    """The tuned references of one insect.

    Attributes:
        fixed_action: action of the best fixed stroke, shape (5,).
        felt_action: first action of the felt-lift controller, whose waveform it keeps, shape (5,).
        felt_gain: κ [-].
        felt_margin: margin [-].
        ladder_height: first place on the ladder, the weight support of the nominal wing [-].
        ladder_gain: κ [-].
        ladder_margin: margin [-].
    """

    fixed_action: tuple[float, ...]
    felt_action: tuple[float, ...]
    felt_gain: float
    felt_margin: float
    ladder_height: float
    ladder_gain: float
    ladder_margin: float


def draws_of(task: AdaptTask, split: str, seed: int = 0) -> Trials:
    """The common draws of the only insect of a task.

    Args:
        task: of one insect.
        split: "train" or "test".
        seed: of both.
    """
    number = ("train", "test").index(split)
    rng = np.random.default_rng(np.random.SeedSequence([seed, number]))
    return trials(task, np.zeros(DRAWS, dtype=np.intp), rng)


def action_of(task: AdaptTask, amplitude: float, lift: float) -> tuple[float, ...]:
    """The action with a φmax [rad] and the cheapest waveform of an L [-]."""
    values = {name: float(value[0]) for name, value in task.ladder.waveform(np.array([lift])).items()}
    point = COORDINATES.encode(values | {"flap_amplitude": amplitude}, StrokeReference(1.0, 1.0))
    return tuple(round(float(value), 6) for value in point)


def tune(task: AdaptTask) -> Tuned:
    """Tune all references of the only insect of a task to the least mean true cost on its training draws.

    A fixed waveform counts by L and S alone, and at any L the least S is the best, whatever the condition: so the fixed
    stroke is sought over φmax and L, five parameters in two.

    Args:
        task: of one insect.
    """
    given, ladder = draws_of(task, "train"), task.ladder
    waveforms = ladder.amplitude, (float(ladder.lift[0]), ladder.largest_lift)

    def fixed_cost(x: np.ndarray) -> float:
        return -float(np.mean(fixed_returns(task, beats_of(np.array(action_of(task, x[0], x[1]))), given)))

    def felt_cost(x: np.ndarray) -> float:
        controller = FeltLift(beats_of(np.array(action_of(task, x[0], x[1]))), x[2], x[3])
        return -float(np.mean(fly(task, controller, given)))

    def ladder_cost(x: np.ndarray) -> float:
        return -float(np.mean(fly(task, LadderClimber(task, given.index, *x), given)))

    fixed = _least(fixed_cost, waveforms)
    felt = _least(felt_cost, (*waveforms, GAIN, MARGIN))
    climb = _least(ladder_cost, (FIRST_HEIGHT, GAIN, MARGIN))
    return Tuned(
        fixed_action=action_of(task, fixed[0], fixed[1]),
        felt_action=action_of(task, felt[0], felt[1]),
        felt_gain=float(felt[2]),
        felt_margin=float(felt[3]),
        ladder_height=float(climb[0]),
        ladder_gain=float(climb[1]),
        ladder_margin=float(climb[2]),
    )


def _least(cost: Callable[[np.ndarray], float], bounds: Iterable[tuple[float, float]]) -> np.ndarray:
    """The least of a cost within bounds: the best of spread points, each refined by Nelder and Mead's simplex."""
    from scipy.optimize import minimize
    from scipy.stats import qmc

    low, high = np.array(list(bounds)).T
    points = low + (high - low) * qmc.Halton(len(low), scramble=False).random(SAMPLES)
    costs = np.array([cost(point) for point in points])
    ends = [
        minimize(
            lambda share: cost(np.clip(low + (high - low) * share, low, high)),
            (points[start] - low) / (high - low),
            method="Nelder-Mead",
            bounds=[(0.0, 1.0)] * len(low),
            options={"xatol": 1e-5, "fatol": 1e-6, "maxfev": EVALUATIONS},
        )
        for start in np.argsort(costs)[:STARTS]
    ]
    best = min(ends, key=lambda end: float(end.fun))
    return np.clip(low + (high - low) * best.x, low, high)


def scores(task: AdaptTask, tuned: Tuned, given: Trials) -> dict[str, np.ndarray]:
    """Returns of the optimum and of the tuned references by their names, shape (n,) each [-]."""
    flown = (fly(task, controller, given) for controller in controllers(task, tuned, given.index))
    return dict(zip(NAMES, (best_returns(given), *flown), strict=True))


def controllers(task: AdaptTask, tuned: Tuned, index: np.ndarray) -> tuple[Controller, ...]:
    """The tuned references of the only insect of a task, at their beginning, in the order of `NAMES[1:]`."""
    fixed, felt = (beats_of(np.array(action)) for action in (tuned.fixed_action, tuned.felt_action))
    return (
        FixedStroke(fixed),
        FeltLift(felt, tuned.felt_gain, tuned.felt_margin),
        LadderClimber(task, index, tuned.ladder_height, tuned.ladder_gain, tuned.ladder_margin),
    )


def write_references(folder: Path, names: tuple[str, ...] = INSECTS) -> Path:
    """Tune the references of named insects and write them with their mean returns.

    Args:
        folder: that exists; the package's data folder to ship them.
        names: of `INSECTS`.

    Returns:
        The file.
    """
    rows = []
    for name in names:
        task = AdaptTask((load_insect(name),))
        tuned = tune(task)
        row: dict[str, str] = {"insect": name}
        for field, value in vars(tuned).items():
            if isinstance(value, tuple):
                row |= {f"{field}/{axis}": f"{v:.6f}" for axis, v in zip(COORDINATES.names, value, strict=True)}
            else:
                row[field] = f"{value:.6f}"
        for split in ("train", "test"):
            for reference, returns in scores(task, tuned, draws_of(task, split)).items():
                row[f"{split}_return/{reference}"] = f"{np.mean(returns):.4f}"
                row[f"{split}_error/{reference}"] = f"{np.std(returns, ddof=1) / math.sqrt(len(returns)):.4f}"
        rows.append(row)
    path = folder / REFERENCES_FILE
    with path.open("w", encoding="utf-8", newline="") as file:
        writer = csv.DictWriter(file, list(rows[0]), lineterminator="\n")
        writer.writeheader()
        writer.writerows(rows)
    return path


@functools.lru_cache(maxsize=64)
def tuned_for(insect: Insect) -> Tuned:
    """The references of one insect, shipped or else tuned now, which takes some ten seconds, and kept."""
    return shipped(insect) or tune(AdaptTask((insect,)))


@functools.cache
def shipped_rows() -> dict[str, dict[str, str]]:
    """The lines of the shipped file by insect."""
    with resources.files("flapenv").joinpath("data", REFERENCES_FILE).open(encoding="utf-8") as file:
        return {row["insect"]: row for row in csv.DictReader(file)}


def shipped(insect: Insect) -> Tuned | None:
    """The shipped references of an insect; None for any but the named ones."""
    row = shipped_rows().get(insect.name)
    if row is None or insect != load_insect(insect.name):
        return None
    values: dict[str, Any] = {
        field: tuple(float(row[f"{field}/{axis}"]) for axis in COORDINATES.names)
        if field.endswith("action")
        else float(row[field])
        for field in Tuned.__dataclass_fields__
    }
    return Tuned(**values)
