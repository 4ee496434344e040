"""The learning curve of a run, to look into."""

from collections.abc import Mapping, Sequence

import numpy as np
import plotly.graph_objects as go

from agents.curve_picture import LEAST_GAP
from agents.plots.style import styled
from flapenv.drawing import BLUE, GREY, ORANGE

HEIGHT = 380
"""Of the figure [px]."""


def learning_curve(rows: Sequence[Mapping[str, float]], distance: str) -> go.Figure:
    """How far the noise-free policy was off, mean and worst, against wingbeats.

    Args:
        rows: of the run's CSV file, from `read_curve`.
        distance: what the numbers are, in words.
    """
    wingbeats = np.array([row["wingbeats"] for row in rows])
    figure = go.Figure()
    for column, colour, dash, label in (
        ("worst_gap", ORANGE, "dash", "worst"),
        ("mean_gap", BLUE, "solid", "mean"),
    ):
        percent = 100 * np.array([row[column] for row in rows])
        figure.add_scatter(
            name=label,
            x=wingbeats / 1e6,
            y=np.maximum(percent, LEAST_GAP),
            customdata=percent,
            mode="lines" if len(rows) > 1 else "markers",
            line={"color": colour, "dash": dash, "width": 2.5},
            hovertemplate="%{x:.3f} million wingbeats: %{customdata:.3f} %<extra>" + label + "</extra>",
        )
    styled(figure, HEIGHT)
    figure.add_scatter(  # a curve, so that the axis has room for it and the legend a name
        name="1 %",
        x=[0, float(np.max(wingbeats)) / 1e6],
        y=[1, 1],
        mode="lines",
        line={"color": GREY, "width": 1.5, "dash": "dot"},
        hoverinfo="skip",
    )
    figure.update_layout(
        xaxis={"title": {"text": "wingbeats [millions]"}},
        yaxis={"title": {"text": f"{distance} [%]"}, "type": "log", "dtick": 1},
    )
    return figure
