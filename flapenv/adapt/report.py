"""The references in words and tables."""

import dataclasses
import math

import numpy as np

from flapenv.adapt.references import LadderClimber, Trials, fly
from flapenv.adapt.task import BEATS, AdaptTask, Flight
from flapenv.adapt.tuning import NAMES, draws_of, scores, shipped_rows, tuned_for
from flapenv.insects import INSECTS, load_insect
from flapenv.tables import text_table

PROPOSALS = 4000
"""Conditions proposed to say how many are accepted."""
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


def conditions_table() -> str:
    """What is drawn for every insect: how many draws can be hovered in, and what their optima are like."""
    rows: list[tuple[str, ...]] = [
        ("held-out draws", "f Hz", "accepted %", "φmax < 90° %", "best reward: median", "worst", "λ: median", "largest")
    ]
    for name in INSECTS:
        task = AdaptTask((load_insect(name),))
        flight = draws_of(task, "test").flights[0]
        below = flight.max_weight_support * task.ladder.lift[0] / task.ladder.largest_lift > 1
        rows.append(
            (
                name,
                f"{task.frequency[0]:.1f}",
                f"{100 * task.acceptance(np.random.default_rng(0), np.zeros(PROPOSALS, dtype=np.intp)):.0f}",
                f"{100 * np.mean(below):.0f}",
                *(f"{value:.3f}" for value in (np.median(flight.best_reward), np.min(flight.best_reward))),
                *(f"{value:.2f}" for value in (np.median(flight.lift_penalty), np.max(flight.lift_penalty))),
            )
        )
    return text_table(rows)


def losses_table(name: str = INSECTS[0]) -> str:
    """What the references lose to full knowledge on held-out draws, paired, and what blind beats and noise cost.

    Args:
        name: of the insect.
    """
    task, tuned = AdaptTask((load_insect(name),)), tuned_for(load_insect(name))
    given = draws_of(task, "test")
    found = scores(task, tuned, given)
    best = found["full_knowledge"]

    def one_beat(noise: float) -> np.ndarray:
        climber = LadderClimber(task, given.index, tuned.ladder_height, 1.0, 0.0)
        return best - fly(task, climber, dataclasses.replace(given, noise=given.noise**noise))

    rows = [(reference.replace("_", " "), best - found[reference]) for reference in NAMES[1:]]
    rows += [
        ("lift ladder, κ = 1, no margin", one_beat(1.0)),
        ("lift ladder, κ = 1, no margin, without noise", one_beat(0.0)),
        ("all known after one beat in a condition", blind_loss(task, tuned.ladder_height, given)),
    ]
    most = float(np.mean(rows[0][1]))
    head = (f"return lost to full knowledge, {name}", "mean", "95 %", "won back of the first %")
    cells = (
        (
            text,
            f"{np.mean(lost):.3f}",
            f"± {INTERVAL * np.std(lost, ddof=1) / math.sqrt(len(lost)):.3f}",
            f"{100 * (1 - np.mean(lost) / most):.0f}",
        )
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


def report() -> str:
    """All tables."""
    return "\n\n".join([conditions_table(), references_table(), losses_table()])
