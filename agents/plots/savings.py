"""How much less power learned strokes need than the insects' own, and how sure that is."""

from collections.abc import Sequence
from typing import Any

import plotly.graph_objects as go

from agents.plots.style import STYLES, styled
from flapenv.assessment import StrokeAssessment
from flapenv.drawing import BLUE, GREY, ORANGE

ROW_HEIGHT, FRAME_HEIGHT = 52, 130
"""Of an insect, and of everything around the bars [px]."""
EQUAL, PUBLISHED, CFD = "at equal weight support", "own stroke as it is", "over CFD's power of the own stroke"
"""Names of the three comparisons."""


def savings(assessments: Sequence[StrokeAssessment]) -> go.Figure:
    """Bars for each insect: the saving at equal weight support and over its own stroke as it is, with uncertainties.

    Whiskers are what the model's relative error against CFD at the insect's own stroke makes of the learned power, and
    so of the saving: ±(1 - saving) times the uncertainty.

    Args:
        assessments: one of each insect.
    """
    names = [one.insect.name for one in assessments]
    figure = go.Figure()
    for label, values, colour, pattern in (
        (PUBLISHED, [one.saving_as_published for one in assessments], ORANGE, "/"),
        (EQUAL, [one.saving for one in assessments], BLUE, ""),
    ):
        figure.add_bar(
            name=label,
            y=names,
            x=[None if value is None else 100 * value for value in values],
            orientation="h",
            marker={"color": colour, "pattern": {"shape": pattern, "fgcolor": "white", "size": 6}},
            error_x=_whiskers(values, assessments),
            hovertemplate="%{y}: %{x:.1f} % ± %{error_x.array:.1f} %<extra>" + label + "</extra>",
        )
    figure.add_scatter(
        name=CFD,
        y=names,
        x=[None if one.saving_to_cfd is None else 100 * one.saving_to_cfd for one in assessments],
        mode="markers",
        marker=STYLES["CFD"].marker,
        hovertemplate="%{y}: %{x:.1f} %<extra>" + CFD + "</extra>",
    )
    styled(figure, FRAME_HEIGHT + ROW_HEIGHT * len(names))
    figure.update_layout(
        barmode="group",
        bargap=0.3,
        xaxis={"title": {"text": "power saved [%]"}, "zerolinewidth": 2},
        yaxis={"autorange": "reversed", "showgrid": False},
        legend={"traceorder": "reversed"},
    )
    return figure


def _whiskers(values: Sequence[float | None], assessments: Sequence[StrokeAssessment]) -> dict[str, Any]:
    """Uncertainties of savings as Plotly's error bars [%]."""
    spans = [
        None if value is None else 100 * (1 - value) * one.uncertainty
        for value, one in zip(values, assessments, strict=True)
    ]
    return {"type": "data", "array": spans, "color": GREY, "thickness": 1.5, "width": 4}
