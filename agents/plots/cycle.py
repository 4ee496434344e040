"""Angles, force and power of strokes over one wingbeat."""

import copy
import functools
from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np
import plotly.graph_objects as go
from plotly.subplots import make_subplots

from agents.plots.style import LineStyle, line_styles, rounded, styled
from flapenv.aero.blade_element import TERMS
from flapenv.aero.stroke import Stroke
from flapenv.drawing import BLACK, BLUE, GREEN, GREY, ORANGE, RED
from flapenv.insects import Insect
from flapenv.model import HoverModel
from flapenv.simulation import simulate

STRIPS, STEPS = 12, 1440
"""Of the blade element: so many that rates and accelerations of any stroke that one would beat are resolved."""
POINTS = 180
"""Of a curve that is drawn."""
PANEL, GAP, FOOT = 190, 56, 56
"""Heights of a panel, of what is between two, and of what is below the last [px]."""
LEGEND_ROW, TITLE = 22, 30
"""Heights of a row of the legend, and of a panel's title [px]."""
LIFT, POWER = "lift / weight [-]", "power / mass [W/kg]"
TERM_STYLES: dict[str, LineStyle] = {
    "translational": LineStyle(colour=BLUE, dash="solid", symbol="circle", width=3),
    "rotational": LineStyle(colour=ORANGE, dash="dash", symbol="square"),
    "added-mass": LineStyle(colour=GREEN, dash="dot", symbol="diamond"),
    "added-mass-pitch": LineStyle(colour=RED, dash="longdashdot", symbol="cross"),
    "aerodynamic": LineStyle(colour=BLUE, dash="longdash", symbol="circle-open"),
    "inertia": LineStyle(colour=GREY, dash="dash", symbol="x"),
    "sum": LineStyle(colour=BLACK, dash="solid", symbol="star", width=1.2),
}
"""Of the terms of the blade element."""


def waveforms(insect: Insect, strokes: Mapping[str, Stroke], model: HoverModel) -> go.Figure:
    """φ, θ and α over t/T, one panel each.

    Args:
        insect: whose strokes they are.
        strokes: by label, at most four.
        model: of the aerodynamics.
    """
    panels = {"flapping angle φ": "φ [°]", "pitching angle θ": "θ [°]", "angle of attack α": "α [°]"}
    curves = []
    for label, style in line_styles(strokes).items():
        beat = simulate(insect, strokes[label], model=model, strips=2, steps=STEPS, spacing="gauss")
        for row, angle in enumerate((beat.kinematics.flap, beat.kinematics.pitch, beat.angle_of_attack), start=1):
            curves.append(_curve(row, np.degrees(angle), label, style, named=label if row == 1 else None))
    figure = _stacked(panels, curves, legend_rows=(len(strokes) + 2) // 3)
    figure.update_layout(yaxis_dtick=45, yaxis2_dtick=45, yaxis3_dtick=30)
    return figure


def forces(insect: Insect, strokes: Mapping[str, Stroke], model: HoverModel) -> go.Figure:
    """Lift over weight and power over body mass over t/T, translational term; arguments as `waveforms`."""
    curves = []
    for label, style in line_styles(strokes).items():
        beat = simulate(insect, strokes[label], model=model, strips=2, steps=STEPS, spacing="gauss")
        support, power = beat.lift / (insect.mass * model.gravity), beat.power / insect.mass
        means = f"{label}: mean lift {np.mean(support):.3f} weights, {np.mean(power):.1f} W/kg"
        for row, values in enumerate((support, power), start=1):
            curves.append(_curve(row, values, label, style, named=means if row == 1 else None))
    figure = _stacked({"lift": LIFT, "aerodynamic power": POWER}, curves, legend_rows=len(strokes))
    figure.update_layout(legend_orientation="v")
    return figure


def terms(insect: Insect, stroke: Stroke, model: HoverModel) -> go.Figure:
    """Lift and power of one stroke term by term; inertia where the wing's mass is known; arguments as `waveforms`."""
    known = [name for name in TERMS if name != "inertia" or insect.wing.mass is not None]
    if stroke.flap_shape == 1:  # whose accelerations are infinite at the corners
        known = ["translational"]
    beat = simulate(insect, stroke, model=model, terms=known, strips=STRIPS, steps=STEPS, spacing="graded")
    air = [name for name in known if name != "inertia"]
    lift = {name: beat.terms[name].force[:, 2] / (insect.mass * model.gravity) for name in air}
    power = {name: beat.terms[name].power.sum(axis=0) / insect.mass for name in known}
    panels = {"lift by term": lift, "aerodynamic power by term": {name: power[name] for name in air}}
    if "inertia" in known:
        of_air = np.sum([power[name] for name in air], axis=0)
        panels["with the wings' inertia"] = {"aerodynamic": of_air, "inertia": power["inertia"]}
    curves, listed = [], set[str]()
    for row, parts in enumerate(panels.values(), start=1):
        for name, values in {**parts, "sum": np.sum(list(parts.values()), axis=0)}.items():
            label = name.replace("-", " ")
            curves.append(_curve(row, values, label, TERM_STYLES[name], named=None if name in listed else label))
            listed.add(name)
    titles = {title: LIFT if parts is lift else POWER for title, parts in panels.items()}
    return _stacked(titles, curves, legend_rows=3)


def _stacked(panels: Mapping[str, str], curves: Sequence[dict[str, Any]], legend_rows: int) -> go.Figure:
    """Panels over t/T, one below the other, with room for the legend above.

    Args:
        panels: titles, and labels of the vertical axes with units.
        curves: as `_curve` makes them.
        legend_rows: that the legend takes on a phone.
    """
    layout = copy.deepcopy(_layout(tuple(panels.items()), legend_rows))
    return go.Figure(data=list(curves), layout=layout)


@functools.lru_cache(maxsize=64)
def _layout(panels: tuple[tuple[str, str], ...], legend_rows: int) -> dict[str, Any]:
    """The layout of empty panels, which takes Plotly longer than everything else."""
    count, top = len(panels), legend_rows * LEGEND_ROW + TITLE + 12
    inside = count * PANEL + (count - 1) * GAP
    spacing = GAP / inside if count > 1 else 0
    titles = [title for title, _ in panels]
    figure = make_subplots(rows=count, cols=1, shared_xaxes=True, vertical_spacing=spacing, subplot_titles=titles)
    styled(figure, inside + top + FOOT)
    figure.update_annotations(x=0, xanchor="left", align="left", font_size=13)
    for number, (_, label) in enumerate(panels, start=1):
        figure.update_yaxes(title_text=label, row=number, col=1)
    figure.update_xaxes(range=[0, 1], dtick=0.25, zeroline=False, showticklabels=True)
    figure.update_xaxes(title_text="time over the cycle t/T [-]", row=count, col=1)
    figure.update_layout(
        margin={"t": top, "b": FOOT, "l": 62, "r": 14},
        legend={"y": 1 + TITLE / inside, "yanchor": "bottom"},
        hovermode="x unified",
    )
    layout: dict[str, Any] = figure.to_plotly_json()["layout"]
    return layout


def _curve(row: int, values: np.ndarray, label: str, style: LineStyle, named: str | None) -> dict[str, Any]:
    """One curve in a panel, with a line in the legend where it is named there."""
    every = len(values) // POINTS
    chosen = slice(every // 2, None, every)
    time = (np.arange(len(values)) + 0.5) / len(values)
    axis = "" if row == 1 else str(row)
    return {
        "type": "scatter",
        "x": rounded(time[chosen]),
        "y": rounded(values[chosen]),
        "mode": "lines",
        "line": style.line,
        "name": named or label,
        "legendgroup": label,
        "showlegend": named is not None,
        "hovertemplate": f"{label} %{{y:.4g}}<extra></extra>",
        "xaxis": f"x{axis}",
        "yaxis": f"y{axis}",
    }
