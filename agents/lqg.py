"""The competitor in Heave-v0, as a front of power over height.

`python -m agents.lqg` flies LQG through gusty episodes of one insect for twelve ratios of the weights, prints the front
and keeps it in a table and a picture. `agents.heave_flights` compares any other policy with it.
"""

import argparse
import csv
import sys
from collections.abc import Callable, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from agents.heave_flights import EPISODES, Flights, fly
from agents.intervals import mean_with_interval
from agents.lqg_controller import Lqg, lqg, proportional_derivative
from agents.run_folder import open_run_folder, write_atomically
from flapenv.aero.checks import record, require_count
from flapenv.drawing import BLUE, GREY, ORANGE, require_matplotlib, verbatim
from flapenv.heave.gusts import GustModel
from flapenv.insects import INSECTS, Insect, as_insect
from flapenv.tables import text_table

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

RATIOS = tuple(float(ratio) for ratio in np.logspace(3, -1.5, 12))
"""Weights of φmax's action over those of (z/R)²: from lazy to eager."""
TABLE, PICTURE = "front.csv", "front.png"


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
    """Design and fly a controller of each kind for every ratio.

    Args:
        insect: scalar fields, or a name.
        ratios: weights of the input over that of (z/R)².
        episodes: of each controller; the same gusts for all.
        seed: of the episodes.
        gusts: flown through, and expected by the filter; the environment's own where None.
    """
    insect = as_insect(insect)
    common: dict[str, Any] = {"ratios": ratios, "episodes": episodes, "seed": seed, "gusts": gusts}
    return Front(
        insect=insect.name,
        ratios=tuple(ratios),
        lqg=fly_every(lqg, insect, **common),
        pd=fly_every(proportional_derivative, insect, **common),
    )


def fly_every(
    make: Callable[[Insect, float, GustModel | None], Lqg],
    insect: Insect,
    *,
    ratios: Sequence[float] = RATIOS,
    episodes: int = EPISODES,
    seed: int = 0,
    gusts: GustModel | None = None,
) -> tuple[Flights, ...]:
    """Controllers of one kind through the same gusts.

    Args:
        make: `lqg` or `proportional_derivative`.
        insect: scalar fields.
        ratios: as `fly_front`'s, like the rest.
        episodes: of each.
        seed: of the episodes.
        gusts: flown through, and expected.
    """
    return tuple(
        fly(make(insect, ratio, gusts), episodes=episodes, seed=seed, insect=insect, gusts=gusts) for ratio in ratios
    )


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
                    _told(100 * one.power_excess),
                    _told(100 * more),
                    _told(one.returns),
                    f"{int(np.sum(one.lost))}",
                )
            )
    return rows


def _told(values: np.ndarray) -> str:
    """A mean and its interval."""
    mean, interval = mean_with_interval(values)
    return f"{mean:.3f} ± {interval:.3f}"


def draw_front(front: Front) -> "Figure":
    """Power over rms height, both controllers, with the paired intervals over the laziest LQG."""
    require_matplotlib()
    from matplotlib.figure import Figure

    figure = Figure(figsize=(7.2, 4.4), dpi=110, layout="constrained")
    draw_front_on(figure.add_subplot(), front)
    return figure


def draw_front_on(axes: "Axes", front: Front) -> None:
    """The same on axes that are there."""
    from matplotlib.ticker import LogLocator

    base = front.lqg[0]
    for flights, colour, mark, label in (
        (front.lqg, BLUE, "o-", "LQG with gust estimate and integral"),
        (front.pd, ORANGE, "s--", "PD, the same gains on z and w"),
    ):
        more = [one.power_excess - base.power_excess for one in flights]
        axes.errorbar(
            [one.rms_height for one in flights],
            [100 * (base.mean_power_excess + float(np.mean(values))) for values in more],
            yerr=[100 * mean_with_interval(values)[1] for values in more],
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
        title=f"Holding height in gusts: {verbatim(front.insect)}, {len(base.beats)} episodes",
    )
    axes.legend(frameon=False)
    axes.grid(alpha=0.25)


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
