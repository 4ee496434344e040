"""Angles, force and power of strokes over one wingbeat."""

import copy
import functools
import math
from collections.abc import Iterable, Mapping, Sequence
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
"""Of the blade element; a stroke that turns more sharply takes more steps, see `_steps`."""
STEPS_PER_SHARPNESS, MOST_STEPS = 144, 14_400
"""A turn of the wing takes the 1/Cθ-th part of a radian of the phase, and 23 instants."""
BINS = 120
"""Parts of the cycle of which a curve that is drawn keeps the least and the largest value."""
USUAL = (15.0, 85.0)
"""Of a curve's values over time, what an axis must have room for [%]: what is beyond is a spike."""
SPIKE = 1.5
"""How much longer an axis would have to be before spikes are cut off."""
PANEL, GAP, FOOT = 190, 56, 56
"""Heights of a panel, of what is between two, and of what is below the last [px]."""
LEGEND_ROW, TITLE = 22, 38
"""Heights of a row of the legend, and of a panel's title [px]."""
LIFT, POWER = "lift / weight [-]", "power / mass [W/kg]"
PURPLE = "#CC79A7"
TERM_STYLES: dict[str, LineStyle] = {
    "translational": LineStyle(colour=BLUE, dash="solid", symbol="circle", width=3),
    "rotational": LineStyle(colour=ORANGE, dash="dash", symbol="square"),
    "added mass": LineStyle(colour=GREEN, dash="dot", symbol="diamond"),
    "added mass pitch": LineStyle(colour=RED, dash="longdashdot", symbol="cross"),
    "aerodynamic": LineStyle(colour=PURPLE, dash="longdash", symbol="circle-open"),
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
    steps, looks = _steps(strokes.values()), line_styles(strokes)
    beats = {
        label: simulate(insect, strokes[label], model=model, strips=2, steps=steps, spacing="gauss") for label in looks
    }
    angles = [{label: np.degrees(beat.kinematics.flap) for label, beat in beats.items()}]
    angles.append({label: np.degrees(beat.kinematics.pitch) for label, beat in beats.items()})
    angles.append({label: np.degrees(beat.angle_of_attack) for label, beat in beats.items()})
    curves = _curves(angles, looks, names={label: label for label in looks})
    figure = _stacked(panels, curves, legend_rows=(len(strokes) + 2) // 3)
    figure.update_layout(yaxis_dtick=45, yaxis2_dtick=45, yaxis3_dtick=30, yaxis3_range=[0, 95])
    return figure


def forces(insect: Insect, strokes: Mapping[str, Stroke], model: HoverModel) -> go.Figure:
    """Lift over weight and the power that is counted over body mass, over t/T; arguments as `waveforms`.

    The lift is the translational one. So is the power, but where only positive power is paid: there added mass and the
    wings' inertia count, too.
    """
    steps, looks, paid = _steps(strokes.values()), line_styles(strokes), model.accounting == "positive"
    counted = ("translational", "added-mass", "inertia") if paid else ("translational",)
    cut: dict[str, Any] = {"strips": STRIPS, "spacing": "graded"} if paid else {"strips": 2, "spacing": "gauss"}
    support, power, names = {}, {}, {}
    for label in looks:
        beat = simulate(insect, strokes[label], model=model, terms=counted, steps=steps, **cut)
        support[label] = beat.terms["translational"].force[:, 2] / (insect.mass * model.gravity)
        power[label] = beat.paid_power(model.accounting) / insect.mass
        names[label] = f"{label}: mean lift {np.mean(support[label]):.3f} weights, {np.mean(power[label]):.1f} W/kg"
    title = "power that is paid, with inertia" if paid else "aerodynamic power"
    figure = _stacked({"lift": LIFT, title: POWER}, _curves([support, power], looks, names), legend_rows=len(strokes))
    figure.update_layout(legend_orientation="v")
    return figure


def terms(insect: Insect, stroke: Stroke, model: HoverModel) -> go.Figure:
    """Lift and power of one stroke term by term; inertia where the wing's mass is known; arguments as `waveforms`."""
    known = [name for name in TERMS if name != "inertia" or insect.wing.mass is not None]
    if stroke.flap_shape == 1:  # whose accelerations are infinite at the corners
        known = ["translational"]
    steps = _steps([stroke])
    beat = simulate(insect, stroke, model=model, terms=known, strips=STRIPS, steps=steps, spacing="graded")
    air = [name for name in known if name != "inertia"]
    told = {name: name.replace("-", " ") for name in known}
    lift = {told[name]: beat.terms[name].force[:, 2] / (insect.mass * model.gravity) for name in air}
    power = {told[name]: beat.terms[name].power.sum(axis=0) / insect.mass for name in known}
    panels = {"lift by term": lift, "power by term": {told[name]: power[told[name]] for name in air}}
    if "inertia" in known:
        of_air = np.sum([power[told[name]] for name in air], axis=0)
        panels["with inertia"] = {"aerodynamic": of_air, "inertia": power["inertia"]}
    summed = [{**parts, "sum": np.sum(list(parts.values()), axis=0)} for parts in panels.values()]
    curves = _curves(summed, TERM_STYLES, names={name: name for name in TERM_STYLES})
    titles = {title: LIFT if parts is lift else POWER for title, parts in panels.items()}
    figure = _stacked(titles, curves, legend_rows=3)
    for row, parts in enumerate(summed):
        _cut_spikes(figure, row, list(parts.values()), counted=(lift if row == 0 else power)["translational"])
    return figure


def _steps(strokes: Iterable[Stroke]) -> int:
    """Instants of the cycle that resolve the sharpest turn of some strokes, a multiple of `BINS`."""
    sharpest = max(max(stroke.pitch_shape, 1 / math.sqrt(max(1 - stroke.flap_shape**2, 1e-6))) for stroke in strokes)
    wanted = min(max(STEPS, STEPS_PER_SHARPNESS * sharpest), MOST_STEPS)
    return BINS * math.ceil(wanted / BINS)


def _cut_spikes(figure: go.Figure, row: int, curves: Sequence[np.ndarray], counted: np.ndarray) -> None:
    """Leave short spikes out of a panel's range, which would flatten all the rest, and say how far they reach.

    Args:
        figure: as `_stacked` makes it, changed in place.
        row: the panel, from 0.
        curves: every curve in it, shape (steps,) each.
        counted: the one that is shown whole whatever it does.
    """
    usual = [np.percentile(values, USUAL) for values in curves]
    low = min(0.0, float(np.min(counted)), *(float(ends[0]) for ends in usual))
    high = max(0.0, float(np.max(counted)), *(float(ends[1]) for ends in usual))
    least, most = (float(end(np.concatenate(curves))) for end in (np.min, np.max))
    if most - least <= SPIKE * (high - low):
        return
    room = 0.08 * (high - low)
    figure.layout["yaxis" if row == 0 else f"yaxis{row + 1}"].range = rounded([low - room, high + room])
    figure.layout.annotations[row].text += f"; peaks {rounded(least):,g}, {rounded(most):,g}"


def _stacked(panels: Mapping[str, str], curves: Sequence[dict[str, Any]], legend_rows: int) -> go.Figure:
    """Panels over t/T, one below the other, with room for the legend above.

    Args:
        panels: titles, and labels of the vertical axes with units.
        curves: as `_curves` makes them.
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


def _curves(
    panels: Sequence[Mapping[str, np.ndarray]], looks: Mapping[str, LineStyle], names: Mapping[str, str]
) -> list[dict[str, Any]]:
    """Curves of all panels at the same instants, each named once in the legend.

    Args:
        panels: values at even instants by label, shape (steps,) each.
        looks: by label.
        names: in the legend, by label.
    """
    every = np.array([values for parts in panels for values in parts.values()])
    chosen, steps, listed = _telling(every), every.shape[1], set[str]()
    time = rounded((chosen + 0.5) / steps)
    curves = []
    for row, parts in enumerate(panels, start=1):
        axis = "" if row == 1 else str(row)
        for label, values in parts.items():
            curves.append(
                {
                    "type": "scatter",
                    "x": time,
                    "y": rounded(values[chosen]),
                    "mode": "lines",
                    "line": looks[label].line,
                    "name": names[label],
                    "legendgroup": label,
                    "showlegend": label not in listed,
                    "hovertemplate": f"{label} %{{y:.4g}}<extra></extra>",
                    "xaxis": f"x{axis}",
                    "yaxis": f"y{axis}",
                }
            )
            listed.add(label)
    return curves


def _telling(curves: np.ndarray) -> np.ndarray:
    """The instants at which one of some curves is least or largest within its part of the cycle, in order.

    Args:
        curves: shape (curves, steps), the steps a multiple of `BINS`.
    """
    parts = curves.reshape(len(curves), BINS, -1)
    starts = np.arange(BINS) * parts.shape[2]
    return np.unique(np.concatenate([parts.argmin(axis=2) + starts, parts.argmax(axis=2) + starts]))
