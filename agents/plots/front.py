"""The least power against the weight carried, with what was learned and what insects do."""

from collections.abc import Sequence

import numpy as np
import plotly.graph_objects as go

from agents.evaluation.assessment_table import LEARNED
from agents.plots.names import plain
from agents.plots.style import STYLES, styled
from flapenv.assessment import StrokeAssessment
from flapenv.drawing import GREY
from flapenv.trade_off import TradeOff

HEIGHT = 520
"""Of the figure [px]."""


def front(assessments: Sequence[StrokeAssessment], fronts: Sequence[TradeOff], called: str = LEARNED) -> go.Figure:
    """Fronts of several insects on one scale: power over the insect's least power for its full weight.

    The front of an insect passes through (1, 1); no stroke of the box lies below it. Own strokes may lie outside of
    the box, and carry what they carry.

    Args:
        assessments: one of each insect.
        fronts: of the same insects against weight support, in the same order.
        called: what the strokes are, in a word.
    """
    figure = go.Figure()
    for number, (one, curve) in enumerate(zip(assessments, fronts, strict=True)):
        figure.add_scatter(
            name="least power",
            legendgroup="front",
            showlegend=number == 0,
            x=curve.values,
            y=curve.specific_power / one.best.specific_power,
            customdata=curve.specific_power,
            mode="lines",
            line={"color": GREY, "width": 1.5},
            hovertemplate=f"{plain(one.insect.name)}: %{{x:.3f}} weights for %{{customdata:.2f}} W/kg"
            "<extra>least power</extra>",
        )
    own = [(one.own_weight_support, one.own_specific_power) for one in assessments]
    learned = [(one.weight_support, one.specific_power) for one in assessments]
    for label, points in (("own", own), (called, learned)):
        named = points is own
        figure.add_scatter(
            name="own stroke" if named else plain(label),
            x=[weight for weight, _ in points],
            y=[power / one.best.specific_power for (_, power), one in zip(points, assessments, strict=True)],
            customdata=[[plain(one.insect.name), power] for (_, power), one in zip(points, assessments, strict=True)],
            text=[plain(one.insect.name) for one in assessments] if named else None,
            textposition=_sides([weight for weight, _ in points]),
            textfont={"size": 11},
            mode="markers+text" if named else "markers",
            marker=STYLES["own" if named else "learned"].marker,
            hovertemplate=f"%{{customdata[0]}}: %{{x:.3f}} weights for %{{customdata[1]:.2f}} W/kg"
            f"<extra>{plain(label)}</extra>",
        )
    styled(figure, HEIGHT)
    highest = max(power / one.best.specific_power for one in assessments for power in _powers(one))
    carried = [weight for weight, _ in (*own, *learned)]
    figure.update_layout(
        xaxis={
            "title": {"text": "weight support Λ"},
            "range": [min(0.75, *carried) - 0.05, max(1.5, *carried) + 0.05],
        },
        yaxis={"title": {"text": "power over the least for the full weight"}, "range": [0, 1.1 * highest]},
    )
    _mark_full_weight(figure)
    return figure


def _powers(one: StrokeAssessment) -> tuple[float, float, float]:
    """Every power of an insect that the figure must have room for [W/kg]."""
    return one.best.specific_power, one.specific_power, one.own_specific_power


def _sides(weights: Sequence[float]) -> list[str]:
    """Names above and below their points in turn, so that neighbours do not cover each other."""
    ranks = np.argsort(np.argsort(weights))
    return ["bottom center" if rank % 2 else "top center" for rank in ranks]


def _mark_full_weight(figure: go.Figure) -> None:
    """A line where exactly the weight is carried."""
    figure.add_vline(x=1.0, line={"color": GREY, "width": 1, "dash": "dot"})
