"""What it costs to leave the optimum by a small step, parameter by parameter."""

import math
from collections.abc import Collection, Sequence

import numpy as np
import plotly.graph_objects as go

from agents.plots.style import styled
from flapenv.aero.checks import record
from flapenv.aero.parameters import STROKE_PARAMETERS
from flapenv.drawing import BLUE, GREY
from flapenv.optimum import Optimum
from flapenv.problem import HoverProblem

HEIGHT = 380
"""Of the figure [px]."""


@record
class Step:
    """A step of a parameter that one can imagine.

    Attributes:
        size: [SI unit], or a share of the parameter itself.
        relative: whether it is a share.
        text: as one reads it.
    """

    size: float
    relative: bool
    text: str


STEPS: dict[str, Step] = {
    "weight_support": Step(size=0.01, relative=False, text="Λ by 0.01"),
    "frequency": Step(size=0.01, relative=True, text="f by 1 %"),
    "flap_amplitude": Step(size=math.radians(1), relative=False, text="φmax by 1°"),
    "flap_shape": Step(size=0.01, relative=False, text="Cφ by 0.01"),
    "pitch_shape": Step(size=1.0, relative=False, text="Cθ by 1"),
    "pitch_amplitude": Step(size=math.radians(1), relative=False, text="θmax by 1°"),
    "pitch_phase": Step(size=math.radians(1), relative=False, text="δ by 1°"),
}
"""For the weight support and every parameter of the stroke."""


def step_costs(best: Optimum) -> dict[str, float]:
    """Power that a step from the optimum into the box costs while the weight stays carried, over the least power [-].

    To first order, so 0 for a parameter that lies inside its bounds; for the weight support, what carrying more costs.

    Args:
        best: an optimum; empty for one at the limit of lift, where a unit of weight support has no price.
    """
    if not best.feasible or not best.sensitivity:
        return {}
    costs = {"weight_support": best.multiplier * STEPS["weight_support"].size / best.specific_power}
    held = {name for name, _ in best.active_bounds}
    for name, slope in best.sensitivity.items():
        step = STEPS[name]
        size = step.size * getattr(best.stroke, name) if step.relative else step.size
        costs[name] = abs(slope) * size / best.specific_power if name in held else 0.0
    return costs


def fixed_parameters(problem: HoverProblem) -> list[str]:
    """The parameters of the stroke that the problem's box leaves no choice of."""
    return [name for name in STROKE_PARAMETERS if not problem.box.is_free(name)]


def sensitivities(optima: Sequence[Optimum], fixed: Collection[str] = ()) -> go.Figure:
    """Bars of the median of the insects, whiskers from the least to the most, in percent of the power.

    Args:
        optima: one of each insect.
        fixed: parameters that have no bar.
    """
    every = [costs for costs in map(step_costs, optima) if costs]
    names = ["weight_support", *(name for name in STROKE_PARAMETERS if name not in fixed)]
    table = 100 * np.array([[costs.get(name, 0.0) for name in names] for costs in every]).reshape(-1, len(names))
    middle = np.median(table, axis=0) if len(table) else np.zeros(len(names))
    high, low = (np.max(table, axis=0), np.min(table, axis=0)) if len(table) else (middle, middle)
    figure = go.Figure()
    figure.add_bar(
        y=[STEPS[name].text for name in names],
        x=middle,
        orientation="h",
        marker={"color": BLUE},
        error_x={
            "type": "data",
            "symmetric": False,
            "array": high - middle,
            "arrayminus": middle - low,
            "color": GREY,
            "thickness": 1.5,
        },
        hovertemplate="%{y}: %{x:.3f} % of the power<extra></extra>",
    )
    styled(figure, HEIGHT)
    figure.update_layout(
        xaxis={"title": {"text": "cost of the step [% of the power]"}},
        yaxis={"autorange": "reversed", "showgrid": False},
        margin={"t": 12},
    )
    return figure
