"""The references in words and tables."""

import dataclasses
import math

import numpy as np

from flapenv.adapt.references import LadderClimber, Trials, best_returns, fly
from flapenv.adapt.task import BEATS, AdaptTask, Flight
from flapenv.adapt.tuning import NAMES, draws_of, shipped_rows, tuned_for
from flapenv.insects import INSECTS, load_insect
from flapenv.tables import text_table

INTERVAL = 1.96
"""Standard errors either side of a mean that hold it with 95 %."""


def references_table(split: str = "test") -> str:
    """Mean returns of the shipped references on training or held-out draws, with 95 % intervals."""
    rows: list[tuple[str, ...]] = [(f"return, {split} draws", *(name.replace("_", " ") for name in NAMES))]
    for insect, row in shipped_rows().items():
        cells = (
            f"{float(row[f'{split}_return/{name}']):.2f} ± {INTERVAL * float(row[f'{split}_error/{name}']):.2f}"
            for name in NAMES
        )
        rows.append((insect, *cells))
    return text_table(rows)


def blind_text(name: str = INSECTS[0]) -> str:
    """Where the ladder controller loses what the optimum with full knowledge has: blind beats, and noise.

    Args:
        name: of the insect, on its held-out draws.
    """
    task, tuned = AdaptTask((load_insect(name),)), tuned_for(load_insect(name))
    given = draws_of(task, "test")
    best = best_returns(given)

    def loss(gain: float, margin: float, noise: float) -> np.ndarray:
        climber = LadderClimber(task, given.index, tuned.ladder_height, gain, margin)
        quiet = dataclasses.replace(given, noise=given.noise**noise)
        return best - fly(task, climber, quiet)

    rows = (
        ("as tuned, with the noise", loss(tuned.ladder_gain, tuned.ladder_margin, 1.0)),
        ("one-beat correction (κ = 1, no margin), with the noise", loss(1.0, 0.0, 1.0)),
        ("one-beat correction (κ = 1, no margin), without noise", loss(1.0, 0.0, 0.0)),
        ("only the first beat and that of the change blind", blind_loss(task, tuned.ladder_height, given)),
    )
    head = (f"lift ladder, {name}: return lost to full knowledge", "mean", "95 %")
    cells = (
        (text, f"{np.mean(lost):.3f}", f"± {INTERVAL * np.std(lost, ddof=1) / math.sqrt(len(lost)):.3f}")
        for text, lost in rows
    )
    return text_table([head, *cells])


def blind_loss(task: AdaptTask, height: float, given: Trials) -> np.ndarray:
    """Return lost by who learns a condition only after one beat in it, and all of it then, shape (n,) [-].

    The first beat is the ladder's at `height`, the beat of the change still the old condition's optimum.
    """
    before, after = given.flights
    climber = LadderClimber(task, given.index, height, 0.0, 0.0)
    blind = climber.beats()
    first = _lost(task, before, blind.amplitude, blind.lift, blind.power)
    rung = task.ladder.rung(before.case, task.model, 1 / task.ladder.full_lift(before.case, task.model))
    change = _lost(task, after, rung.flap_amplitude, rung.lift, rung.power)
    return first + np.where(given.draws.change_beat < BEATS, change, 0.0)


def _lost(task: AdaptTask, flight: Flight, *stroke: np.ndarray) -> np.ndarray:
    """What strokes are paid less than the optimum in a beat [-]."""
    weight_support, specific_power, _ = task.loads(flight.case, *stroke)
    return flight.best_reward - task.reward_terms(flight, weight_support, specific_power)[0]
