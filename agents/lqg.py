"""The competitor in Heave-v0: linear-quadratic-Gaussian control with integral action, as a front of power over height.

`python -m agents.lqg` flies it through gusty episodes of one insect for twelve ratios of the weights, prints the front
and keeps it in a table and a picture. `agents.heave_flights` compares any other policy with it.

It sees what an agent sees (height, velocity, the last weight support) and steers within the same box. Its Kalman filter
holds the gust as a state, which it infers from how the body answered the last beat; its regulator holds the integral of
height. Of the five inputs it uses φmax alone: the other four hover on the edge of their box or, as the pitch phase,
where lift has no slope, so that to first order they cannot push both ways, and every step they take from there costs
power that φmax would not.
"""

import argparse
import csv
import sys
from collections.abc import Sequence
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from agents.heave_flights import EPISODES, Flights, fly, interval_of_mean
from agents.run_folder import open_run_folder, write_atomically
from flapenv.aero.checks import record, require_count
from flapenv.drawing import BLUE, GREY, ORANGE, require_matplotlib
from flapenv.envs.heave import SUPPORT_UNIT, VELOCITY_UNIT
from flapenv.heave.dynamics import HeaveDynamics
from flapenv.heave.gusts import GustModel
from flapenv.heave.linear import LinearBeat, linear_beat
from flapenv.insects import INSECTS, Insect, as_insect
from flapenv.tables import text_table

if TYPE_CHECKING:
    from matplotlib.figure import Figure

INPUT = "flap_amplitude"
RATIOS = tuple(float(ratio) for ratio in np.logspace(3, -1.5, 12))
"""Weights of φmax's action over those of (z/R)²: from lazy to eager."""
INTEGRAL_WEIGHT = 1e-3
"""Of (Σ z/R)² beside (z/R)²: takes some 30 beats to remove what linear theory does not foresee."""
MEASUREMENT_NOISE, MODEL_NOISE = 1e-9, 1e-6
"""Standard deviations the filter assumes of its measurements, which are exact, and of the linear model beside the gust:
enough to keep its equation well posed."""
TABLE, PICTURE = "front.csv", "front.png"


@record
class Design:
    """Gains of one controller.

    Attributes:
        beat: the linear beat map.
        axis: of the action that it steers.
        transition: of the filter's state (z/R, w/U, w_g/U, last Λ - 1), shape (4, 4).
        entry: of the input into it, shape (4,).
        filter_gain: from the surprise in (z/R, w/U, last Λ - 1) to that state, shape (4, 3).
        feedback: from (z/R, w/U, w_g/U, Σ z/R) to the input, shape (4,).
    """

    beat: LinearBeat
    axis: int
    transition: np.ndarray
    entry: np.ndarray
    filter_gain: np.ndarray
    feedback: np.ndarray


def design(insect: Insect | str, ratio: float, gusts: GustModel | None = None) -> Design:
    """Solve both Riccati equations for one insect.

    Args:
        insect: scalar fields, or a name.
        ratio: weight of the input over that of (z/R)².
        gusts: what the filter expects.

    Source: Anderson & Moore (1979), Optimal Filtering; Stengel (1994), Optimal Control and Estimation, chapter 6.
    """
    from scipy.linalg import solve_discrete_are

    gusts = gusts or GustModel()
    dynamics = HeaveDynamics([as_insect(insect)])
    beat, axis = linear_beat(dynamics, 0), dynamics.coordinates.names.index(INPUT)
    transition, entry = np.zeros((4, 4)), np.zeros(4)
    transition[[0, 1, 3], :3] = beat.by_state[:3]
    transition[2, 2] = gusts.persistence
    entry[[0, 1, 3]] = beat.by_action[:3, axis]

    seen = np.eye(4)[[0, 1, 3]]
    noise = np.diag([0.0, 0.0, max(gusts.innovation, 1e-6) ** 2, 0.0]) + MODEL_NOISE**2 * np.eye(4)
    scatter = MEASUREMENT_NOISE**2 * np.eye(3)
    spread = solve_discrete_are(transition.T, seen.T, noise, scatter)
    filter_gain = np.linalg.solve(seen @ spread @ seen.T + scatter, seen @ spread).T

    steered = np.eye(4)
    steered[:3, :3] = transition[:3, :3]
    steered[3] = (1.0, 0.0, 0.0, 1.0)
    push = np.array([entry[0], entry[1], 0.0, 0.0])[:, None]
    weights = np.diag([1.0, 0.0, 0.0, INTEGRAL_WEIGHT])
    price = np.array([[ratio]])
    cost = solve_discrete_are(steered, push, weights, price)
    feedback = np.linalg.solve(push.T @ cost @ push + price, push.T @ cost @ steered)[0]
    return Design(beat=beat, axis=axis, transition=transition, entry=entry, filter_gain=filter_gain, feedback=feedback)


class Lqg:
    """A controller that flies many rows at once: observations in, actions out; `start` before each episode."""

    def __init__(self, made: Design) -> None:
        """Keep the gains."""
        self.design = made
        self._state: np.ndarray | None = None

    def start(self) -> None:
        """Forget the last episode."""
        self._state = None

    def __call__(self, observations: np.ndarray) -> np.ndarray:
        """Actions, shape (rows, 5), for observations of Heave-v0, shape (rows, n)."""
        made = self.design
        seen = observations[:, :3] * np.array([1.0, VELOCITY_UNIT, SUPPORT_UNIT])
        if self._state is None:
            rows = len(seen)
            self._state, self._sum = np.zeros((rows, 4)), np.zeros(rows)
            self._state[:, [0, 1, 3]] = seen
        else:
            self._state += (seen - self._state[:, [0, 1, 3]]) @ made.filter_gain.T
        base = made.beat.hover[made.axis]
        wanted = -np.column_stack([self._state[:, :3], self._sum]) @ made.feedback
        given = np.clip(base + wanted, -1, 1) - base
        self._sum += np.where(given == wanted, seen[:, 0], 0.0)  # the integral waits where the box has an end
        self._state = self._state @ made.transition.T + given[:, None] * made.entry
        actions = np.tile(made.beat.hover, (len(seen), 1))
        actions[:, made.axis] = base + given
        return actions


def lqg(insect: Insect | str, ratio: float, gusts: GustModel | None = None) -> Lqg:
    """The controller of one insect; arguments as in `design`."""
    return Lqg(design(insect, ratio, gusts))


def proportional_derivative(insect: Insect | str, ratio: float, gusts: GustModel | None = None) -> Lqg:
    """The same gains on height and velocity, without gust and integral; arguments as in `design`."""
    made = design(insect, ratio, gusts)
    return Lqg(replace(made, feedback=made.feedback * np.array([1.0, 1.0, 0.0, 0.0])))


@record
class Front:
    """Controllers of one insect from lazy to eager, flown through the same gusts.

    Attributes:
        insect: its name.
        ratios: weights of the input over that of (z/R)².
        lqg: the flights of each.
        pd: those of the same gains on height and velocity alone.
    """

    insect: str
    ratios: tuple[float, ...]
    lqg: tuple[Flights, ...]
    pd: tuple[Flights, ...]


def fly_front(
    insect: Insect | str,
    *,
    ratios: Sequence[float] = RATIOS,
    episodes: int = EPISODES,
    seed: int = 0,
    gusts: GustModel | None = None,
) -> Front:
    """Design and fly a controller for every ratio.

    Args:
        insect: scalar fields, or a name.
        ratios: weights of the input over that of (z/R)².
        episodes: of each controller; the same gusts for all.
        seed: of the episodes.
        gusts: flown through, and expected by the filter; the environment's own where None.
    """
    insect = as_insect(insect)
    flown = [
        tuple(
            fly(make(insect, ratio, gusts), episodes=episodes, seed=seed, insect=insect, gusts=gusts)
            for ratio in ratios
        )
        for make in (lqg, proportional_derivative)
    ]
    return Front(insect=insect.name, ratios=tuple(ratios), lqg=flown[0], pd=flown[1])


HEADER = (
    "controller",
    "weight",
    "rms z/R",
    "power excess [%]",
    "over the laziest [%]",
    "return",
    "lost",
)


def front_rows(front: Front) -> list[tuple[str, ...]]:
    """A line for each controller; the 95 % interval of the difference is paired, both flew through the same gusts."""
    rows: list[tuple[str, ...]] = []
    for name, flights in (("LQG", front.lqg), ("PD", front.pd)):
        for ratio, one in zip(front.ratios, flights, strict=True):
            more = one.power_excess - front.lqg[0].power_excess
            rows.append(
                (
                    name,
                    f"{ratio:.3g}",
                    f"{one.rms_height:.4f}",
                    f"{100 * one.mean_power_excess:.3f} ± {100 * interval_of_mean(one.power_excess):.3f}",
                    f"{100 * np.mean(more):.3f} ± {100 * interval_of_mean(more):.3f}",
                    f"{np.mean(one.returns):.3f} ± {interval_of_mean(one.returns):.3f}",
                    f"{int(np.sum(one.lost))}",
                )
            )
    return rows


def draw_front(front: Front) -> "Figure":
    """Power over rms height, both controllers, with the paired intervals over the laziest LQG."""
    require_matplotlib()
    from matplotlib.figure import Figure
    from matplotlib.ticker import LogLocator

    figure = Figure(figsize=(7.2, 4.4), dpi=110, layout="constrained")
    axes = figure.add_subplot()
    base = front.lqg[0]
    for flights, colour, mark, label in (
        (front.lqg, BLUE, "o-", "LQG with gust estimate and integral"),
        (front.pd, ORANGE, "s--", "PD, the same gains on z and w"),
    ):
        more = [one.power_excess - base.power_excess for one in flights]
        axes.errorbar(
            [one.rms_height for one in flights],
            [100 * (base.mean_power_excess + float(np.mean(values))) for values in more],
            yerr=[100 * interval_of_mean(values) for values in more],
            fmt=mark,
            color=colour,
            ms=4,
            capsize=2,
            label=label,
        )
    best = max(front.lqg, key=lambda one: float(np.mean(one.returns)))
    axes.plot(
        best.rms_height,
        100 * best.mean_power_excess,
        "o",
        mfc="none",
        mec=GREY,
        ms=13,
        ls="none",
        label=f"LQG of the greatest return, {np.mean(best.returns):.2f}",
    )
    axes.set_xscale("log")
    axes.xaxis.set_major_locator(LogLocator(subs=(1, 2, 5)))
    axes.xaxis.set_major_formatter("{x:g}")
    axes.xaxis.set_minor_formatter("")
    axes.set(
        xlabel="rms height z/R  (bars: 95 % of the paired difference from the laziest LQG)",
        ylabel="mean power over hovering [%]",
        title=f"Holding height in gusts: {front.insect}, {len(base.beats)} episodes",
    )
    axes.legend(frameon=False)
    axes.grid(alpha=0.25)
    return figure


def save_front(front: Front, folder: Path) -> None:
    """Keep the table and the picture in a folder that is there."""

    def write(path: Path) -> None:
        with path.open("w", encoding="utf-8", newline="") as file:
            csv.writer(file).writerows([HEADER, *front_rows(front)])

    write_atomically(folder / TABLE, write)
    write_atomically(folder / PICTURE, draw_front(front).savefig)


def main(arguments: Sequence[str] | None = None) -> int:
    """Fly the front of one insect, print and keep it; 0 on success, 2 for bad input."""
    made = argparse.ArgumentParser(prog="python -m agents.lqg", description="LQG in Heave-v0, as a front.")
    made.add_argument("--insect", default="hawkmoth", metavar="NAME", help=f"of {', '.join(INSECTS)}")
    made.add_argument("--episodes", type=int, default=EPISODES, metavar="N", help=f"default {EPISODES}")
    made.add_argument("--seed", type=int, default=0, metavar="N", help="of the episodes (default 0)")
    made.add_argument("--out", type=Path, metavar="DIR", help="folder (default runs/heave-lqg-NAME/)")
    options = made.parse_args(arguments)
    try:
        require_count("--episodes", options.episodes)
        require_count("--seed", options.seed, low=0)
        insect = as_insect(options.insect)
        folder = open_run_folder(options.out, f"heave-lqg-{insect.name}")
    except (ValueError, TypeError, OSError) as problem:
        print(f"error: {problem}", file=sys.stderr)
        return 2
    front = fly_front(insect, ratios=RATIOS, episodes=options.episodes, seed=options.seed)
    print(text_table([HEADER, *front_rows(front)]))
    save_front(front, folder)
    print(f"\n{options.episodes} episodes, seed {options.seed}; kept in {folder}/")
    return 0


if __name__ == "__main__":
    sys.exit(main())
