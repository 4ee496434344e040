"""What the least power costs and buys: against weight support, amplitude limit and frequency limit.

`python -m flapenv.trade_off` prints the fronts of the eight insects and draws them with --out.
"""

import argparse
import dataclasses
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from flapenv.aero.checks import record, require_name, require_real, shown
from flapenv.case import wing_factors
from flapenv.drawing import BLUE, GREEN, GREY, ORANGE, RED, require_matplotlib, verbatim
from flapenv.insects import INSECTS, Insect, as_insect
from flapenv.many_optima import many_optima
from flapenv.optimum import optimum
from flapenv.problem import HoverProblem, StrokeBox, as_problem
from flapenv.tables import text_table

if TYPE_CHECKING:
    from matplotlib.figure import Figure

VARIED: dict[str, tuple[str, tuple[float, ...]]] = {
    "weight_support": ("weight support", tuple(np.linspace(0.5, 2.0, 13))),
    "flap_amplitude": ("largest φmax [°]", tuple(np.radians(np.linspace(45, 90, 10)))),
    "frequency_ratio": ("largest f over the insect's own", tuple(np.linspace(0.55, 1.5, 11))),
}
"""What may vary, its name on an axis, and the values that are shown; angles in rad."""
TICKS = (3, 5, 10, 20, 30, 50, 80)
COLOURS = (BLUE, ORANGE, GREEN, RED, "#CC79A7", "#56B4E9", "black", GREY)


@record
class TradeOff:
    """Least power against one limit; arrays of shape (n,).

    Attributes:
        insect: its name.
        varied: a key of `VARIED`.
        values: weight support [-], upper bound of φmax [rad] or of f over the insect's own [-].
        feasible: whether any stroke of the box carries that much.
        specific_power: P* of the best stroke [W/kg]; NaN where none carries it.
        lower_bound: proven bound [W/kg]; NaN where none is proven.
    """

    insect: str
    varied: str
    values: np.ndarray
    feasible: np.ndarray
    specific_power: np.ndarray
    lower_bound: np.ndarray


def trade_off(
    insect: Insect | str,
    varied: str = "weight_support",
    values: Sequence[float] | None = None,
    problem: HoverProblem | str | None = None,
) -> TradeOff:
    """The Pareto front of least power against a limit, point by point from `optimum`.

    The wing's k_ind and k_tip stay those of its own weight while the weight support varies.

    Args:
        insect: one insect or a name of `INSECTS`.
        varied: "weight_support" (what must be lifted, in weights), "flap_amplitude" or "frequency_ratio" (the upper
            bound of the box).
        values: rising; those of `VARIED` where None.
        problem: the problem; problem A where None.

    Raises:
        TypeError: for arguments of another kind.
        ValueError: for an unknown name, or values that the box refuses.
    """
    insect, problem = as_insect(insect), as_problem(problem)
    require_name("varied", varied, VARIED)
    points = np.atleast_1d(np.asarray(require_real("values", VARIED[varied][1] if values is None else values, 0.0)))
    fixed = dataclasses.replace(insect, k_table=wing_factors(insect, problem.model))
    best = [optimum(fixed, _limited(problem, varied, float(value))) for value in points]
    return TradeOff(
        insect=insect.name,
        varied=varied,
        values=points,
        feasible=np.array([one.feasible for one in best]),
        specific_power=np.array([one.specific_power if one.feasible else np.nan for one in best]),
        lower_bound=np.array([np.nan if one.lower_bound is None else one.lower_bound for one in best]),
    )


def weight_front(
    insect: Insect | str, values: Sequence[float] | None = None, problem: HoverProblem | str | None = None
) -> TradeOff:
    """`trade_off` against weight support in a fraction of its time, from `many_optima`: to 1e-6, and not confirmed.

    Lifting w weights is an insect w times as heavy on the same wings, whose power is over a mass w times as large.

    Args:
        insect: one insect or a name of `INSECTS`.
        values: what must be lifted, in weights, rising; those of `VARIED` where None.
        problem: the problem; problem A where None.

    Raises:
        TypeError: for arguments of another kind.
        ValueError: for an unknown name, or values that are not positive.
    """
    insect, problem = as_insect(insect), as_problem(problem)
    given = VARIED["weight_support"][1] if values is None else values
    weights = np.atleast_1d(np.asarray(require_real("values", given, 0.0, open_low=True)))
    heavier = dataclasses.replace(insect, mass=insect.mass * weights, k_table=wing_factors(insect, problem.model))
    best = many_optima(heavier, problem)
    return TradeOff(
        insect=insect.name,
        varied="weight_support",
        values=weights,
        feasible=best.feasible,
        specific_power=np.where(best.feasible, best.specific_power * weights, np.nan),
        lower_bound=np.full(len(weights), np.nan) if best.lower_bound is None else best.lower_bound * weights,
    )


def _limited(problem: HoverProblem, varied: str, value: float) -> HoverProblem:
    """The problem with one limit set: lifting w weights is lifting one weight in w times the gravity."""
    if varied == "weight_support":
        model = dataclasses.replace(problem.model, gravity=problem.model.gravity * value)
        return dataclasses.replace(problem, name=None, model=model)
    if getattr(problem.box, varied) is None:
        raise ValueError(f"varied = {shown(varied)} is not bounded by the box; allowed: what it bounds")
    low = getattr(problem.box, varied)[0]
    bounds: dict[str, Any] = {**vars(problem.box), varied: (min(low, value), value)}
    return dataclasses.replace(problem, name=None, box=StrokeBox(**bounds))


def trade_off_table(fronts: Sequence[TradeOff]) -> str:
    """Fronts of several insects along the same limit, as text."""
    name = VARIED[fronts[0].varied][0]
    shown = np.degrees(fronts[0].values) if fronts[0].varied == "flap_amplitude" else fronts[0].values
    rows = [(f"P* [W/kg] at {name}", *(f"{value:.3g}" for value in shown))]
    rows += [
        (front.insect, *("-" if np.isnan(power) else f"{power:.1f}" for power in front.specific_power))
        for front in fronts
    ]
    return text_table(rows)


def draw_trade_offs(fronts: Mapping[str, Sequence[TradeOff]]) -> "Figure":
    """One panel for every limit, one line for every insect; a line ends where no stroke of the box hovers any more."""
    require_matplotlib()
    from matplotlib.figure import Figure

    figure = Figure(figsize=(11.0, 4.2), dpi=100, layout="constrained")
    panels = np.atleast_1d(figure.subplots(1, len(fronts)))
    titles = ("lift", "amplitude limit", "frequency limit")
    for axes, (varied, row), title in zip(panels, fronts.items(), titles, strict=False):
        for front, colour in zip(row, COLOURS, strict=False):
            shown = np.degrees(front.values) if varied == "flap_amplitude" else front.values
            axes.plot(shown, front.specific_power, "o-", ms=3, lw=1.4, color=colour, label=verbatim(front.insect))
        axes.set(xlabel=VARIED[varied][0], ylabel="least power [W/kg]", yscale="log", title=f"{title} against power")
        axes.set_yticks(TICKS, [str(tick) for tick in TICKS], minor=False)
        axes.minorticks_off()
        axes.grid(alpha=0.25)
        axes.set_ylim(2.5, 100)
    lines = panels[0].get_legend_handles_labels()
    figure.legend(*lines, loc="outside lower center", ncols=8, fontsize=8, frameon=False)
    return figure


def main() -> None:
    """Print the fronts of the eight insects; draw them where a folder is given."""
    parser = argparse.ArgumentParser(prog="python -m flapenv.trade_off", description=__doc__)
    parser.add_argument("--out", type=Path, metavar="FILE", help="also draw the fronts to this PNG file")
    file = parser.parse_args().out
    fronts = {varied: [trade_off(name, varied) for name in INSECTS] for varied in VARIED}
    print("\n\n".join(trade_off_table(row) for row in fronts.values()))
    if file is not None:
        file.parent.mkdir(parents=True, exist_ok=True)
        draw_trade_offs(fronts).savefig(file)
        print(f"wrote {file}")


if __name__ == "__main__":
    main()
