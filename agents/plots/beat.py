"""The beating wing: sections with the force on them, frame by frame, which beat.js plays."""

import copy
import functools
import html
from collections.abc import Mapping
from pathlib import Path
from typing import Any

import numpy as np
import plotly.graph_objects as go
from plotly.subplots import make_subplots

from agents.plots.style import RULE, line_styles, rounded, styled
from flapenv.aero.stroke import Stroke
from flapenv.animation.beat import STAMPS, DrawnBeat, drawn_beat
from flapenv.drawing import BLACK
from flapenv.insects import Insect
from flapenv.model import HoverModel

SCRIPT = Path(__file__).with_name("beat.js")
"""What plays the figure wherever plotly.js and this script are on the page."""
SECONDS = 2.4
"""That one wingbeat takes on the screen."""
ROW, GAP, TOP, FOOT = 165, 34, 46, 56
"""Heights of a stroke's row, of its title, of what is above the first and below the last [px]."""
ABOVE, BELOW, BESIDE = 0.2, 1.35, 0.7
"""Room above the highest arrow, and below and beside the path of the section for the chord [mean chords]."""
LONGEST = 1.8
"""Arrow of the largest force [mean chords]."""
TRAIL = "#b0b0b0"


def beat(insect: Insect, strokes: Mapping[str, Stroke], model: HoverModel, frames: int = 48) -> go.Figure:
    """Wing sections at r̂₂ R with the aerodynamic force of each stroke, one above the other, all at the same t/T.

    The first frame is drawn; the others stand in `figure.layout.meta["beat"]`: "traces", the numbers of what moves,
    "seconds" of one wingbeat, and "frames", a list of {"x": [...], "y": [...], "text": [...]} with an entry a trace.

    Args:
        insect: whose wing it is.
        strokes: by label, at most four.
        model: of the aerodynamics.
        frames: of one wingbeat.
    """
    beats = {label: drawn_beat(insect, stroke, model=model, frames=frames) for label, stroke in strokes.items()}
    longest = max(float(np.max(np.hypot(*one.force[one.rows].T))) for one in beats.values())
    unit = LONGEST / max(longest, 1.0)  # mean chords for one weight
    traces: list[dict[str, Any]] = []
    moving: list[int] = []
    parts: list[list[list[dict[str, Any]]]] = []
    for row, (label, style) in enumerate(line_styles(beats).items(), start=1):
        one, number = beats[label], "" if row == 1 else str(row)
        axes = {"type": "scatter", "xaxis": f"x{number}", "yaxis": f"y{number}", "hoverinfo": "skip"}
        traces += [axes | piece for piece in _still(one, unit)]
        parts.append(_moving(one, unit, one.history.paid_power(model.accounting) / insect.mass))
        pieces = zip(parts[-1][0], _looks(style.colour), strict=True)
        drawn = [axes | piece | looks for piece, looks in pieces]
        moving += range(len(traces), len(traces) + len(drawn))
        traces += drawn
    played = [[piece for made in parts for piece in made[frame]] for frame in range(frames)]
    kept = [{key: [piece.get(key) for piece in pieces] for key in ("x", "y", "text")} for pieces in played]
    layout = _fitted(beats, unit) | {"meta": {"beat": {"traces": moving, "seconds": SECONDS, "frames": kept}}}
    return go.Figure(data=traces, layout=layout)


def _fitted(beats: Mapping[str, DrawnBeat], unit: float) -> dict[str, Any]:
    """The layout of the rows with their titles, and one scale for all."""
    layout = copy.deepcopy(_rows(len(beats)))
    reach = max(float(np.max(np.abs(one.axis[:, 0]))) for one in beats.values()) + BESIDE
    tips = [unit * one.force[one.rows, 1] for one in beats.values()]
    edges = [one.leading[:, 1] for one in beats.values()]
    top = max(0.3 + unit, *(float(np.max(heights)) for heights in (*tips, *edges))) + ABOVE
    for number, (label, one) in enumerate(beats.items(), start=1):
        rate = one.motion.frequency
        title = f"<b>{html.escape(label)}</b>: {rate:.4g} Hz, shown {rate * SECONDS:.0f}× slower"
        layout["annotations"][number - 1]["text"] = title
        axis = str(number) if number > 1 else ""
        layout[f"xaxis{axis}"]["range"] = rounded([-reach, reach])
        layout[f"yaxis{axis}"]["range"] = rounded([-BELOW, top])
    return layout


@functools.lru_cache(maxsize=8)
def _rows(count: int) -> dict[str, Any]:
    """The layout of empty rows, which takes Plotly longer than everything else."""
    inside = count * ROW + (count - 1) * GAP
    spacing = GAP / inside if count > 1 else 0
    titles = [str(number) for number in range(count)]
    figure = make_subplots(rows=count, cols=1, shared_xaxes=True, vertical_spacing=spacing, subplot_titles=titles)
    styled(figure, inside + TOP + FOOT)
    figure.update_annotations(x=0, xanchor="left", font_size=13)
    figure.update_xaxes(zeroline=False, showgrid=False)
    figure.update_yaxes(showticklabels=False, ticks="", showline=False, zeroline=False, showgrid=False)
    for row in range(1, count + 1):
        across = "x" if row == 1 else f"x{row}"
        figure.update_yaxes(scaleanchor=across, scaleratio=1, row=row, col=1)
    figure.update_xaxes(title_text="arc at r̂₂ [mean chords], forward →", row=count, col=1)
    figure.update_layout(showlegend=False, margin={"t": TOP, "b": FOOT, "l": 14, "r": 14})
    layout: dict[str, Any] = figure.to_plotly_json()["layout"]
    return layout


def _still(one: DrawnBeat, unit: float) -> list[dict[str, Any]]:
    """The path, sections at equal times, and the scale of the arrows."""
    stamps = np.arange(STAMPS) * len(one.axis) // STAMPS
    lines = np.full((STAMPS, 3, 2), np.nan)
    lines[:, 0], lines[:, 1] = one.trailing[stamps], one.leading[stamps]
    x, y = rounded(lines.reshape(-1, 2).T)
    reach = float(np.max(np.abs(one.axis[:, 0])))
    return [
        {
            "x": rounded([-reach, reach]),
            "y": [0, 0],
            "mode": "lines",
            "line": {"color": RULE, "width": 1, "dash": "dot"},
        },
        {"x": x, "y": y, "mode": "lines", "line": {"color": TRAIL, "width": 2}, "connectgaps": False},
        {
            "x": rounded([-reach - BESIDE / 2] * 2),
            "y": rounded([0.3, 0.3 + unit]),
            "mode": "lines+markers+text",
            "text": ["", " 1 weight"],
            "textposition": "middle right",
            "line": {"color": RULE, "width": 3},
            "marker": {"symbol": "line-ew", "size": 8, "line": {"color": RULE, "width": 2}},
        },
    ]


def _moving(one: DrawnBeat, unit: float, power: np.ndarray) -> list[list[dict[str, Any]]]:
    """What moves, for every frame: chord, leading edge, force, lift and power [W/kg] of the instant."""
    made = []
    for number, at in enumerate(one.rows):
        chord = rounded(np.stack([one.trailing[at], one.leading[at]], axis=1))
        foot, tip = one.axis[at], one.axis[at] + unit * one.force[at]
        arrow = rounded(np.stack([foot, tip], axis=1))
        told = f"lift {one.force[at, 1]:.2f} weights, {power[at]:.1f} W/kg"
        made.append(
            [
                {"x": chord[0], "y": chord[1]},
                {"x": chord[0][1:], "y": chord[1][1:]},
                {"x": arrow[0], "y": arrow[1]},
                {"x": [0], "y": [-BELOW + 0.15], "text": [f"t/T {number / len(one.rows):.2f}   {told}"]},
            ]
        )
    return made


def _looks(colour: str) -> list[dict[str, Any]]:
    """How each of the moving traces looks."""
    return [
        {"mode": "lines", "line": {"color": colour, "width": 6}},
        {"mode": "markers", "marker": {"color": colour, "size": 11, "line": {"color": BLACK, "width": 1.5}}},
        {
            "mode": "lines+markers",
            "line": {"color": BLACK, "width": 2.5},
            "marker": {"symbol": "arrow", "size": [0, 14], "angleref": "previous", "color": BLACK},
        },
        {"mode": "text", "textfont": {"size": 12}},
    ]
