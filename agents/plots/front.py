"""The least power against the weight carried, with what was learned and what insects do."""

import warnings
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
AGREEMENT = 0.01
"""Of fronts, and of points with the optimum, that are told as one [-]."""
NAMES_ROOM = 0.3
"""Right of the curves, for their names [weights]."""
COUNTS = {2: "two", 3: "three", 4: "four", 5: "five", 6: "six", 7: "seven", 8: "eight"}


def front(assessments: Sequence[StrokeAssessment], fronts: Sequence[TradeOff], called: str = LEARNED) -> go.Figure:
    """Fronts of several insects on one scale: power over the insect's least power for its full weight.

    The front of an insect passes through (1, 1); no stroke of the box lies below it. Own strokes may lie outside of
    the box, and carry what they carry.

    Args:
        assessments: one of each insect.
        fronts: of the same insects against weight support, in the same order.
        called: what the strokes are, in a word.
    """
    figure = go.Figure(_lines(assessments, fronts))
    own = [(one.own_weight_support, one.own_specific_power) for one in assessments]
    learned = [(one.weight_support, one.specific_power) for one in assessments]
    for label, points in (("own", own), (called, learned)):
        named = points is own
        figure.add_scatter(
            name="own stroke" if named else plain(label),
            x=[weight for weight, _ in points],
            y=[power / one.best.specific_power for (_, power), one in zip(points, assessments, strict=True)],
            customdata=[[plain(one.insect.name), power] for (_, power), one in zip(points, assessments, strict=True)],
            text=[
                plain(one.insect.name) if named or _is_elsewhere(weight, power / one.best.specific_power) else ""
                for (weight, power), one in zip(points, assessments, strict=True)
            ],
            textposition=_sides([weight for weight, _ in points]),
            textfont={"size": 11},
            mode="markers+text",
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
            "range": [min(0.75, *carried) - 0.05, max(*fronts[0].values, *carried) + NAMES_ROOM],
        },
        yaxis={"title": {"text": "power over the least for the full weight"}, "range": [0, 1.1 * highest]},
    )
    _mark_full_weight(figure)
    return figure


def _lines(assessments: Sequence[StrokeAssessment], fronts: Sequence[TradeOff]) -> list[go.Scatter]:
    """One line for all the fronts that agree, and one with its name for each of the others."""
    ratios = [curve.specific_power / one.best.specific_power for one, curve in zip(assessments, fronts, strict=True)]
    with warnings.catch_warnings():
        warnings.filterwarnings("ignore", message="All-NaN slice")  # a weight that nobody can carry
        middle = np.nanmedian(ratios, axis=0)
    agreeing = [not np.any(np.abs(ratio / middle - 1) > AGREEMENT) for ratio in ratios]  # NaN: no more can be carried
    if sum(agreeing) < 2:
        agreeing = [False] * len(ratios)
    drawn = [
        (plain(one.insect.name), ratio)
        for one, ratio, same in zip(assessments, ratios, agreeing, strict=True)
        if not same
    ]
    if any(agreeing):
        count = sum(agreeing)
        told = f"all {COUNTS.get(count, count)}" if all(agreeing) else f"{COUNTS.get(count, count)} alike"
        longest = max((ratio for ratio, same in zip(ratios, agreeing, strict=True) if same), key=_carried)
        drawn.insert(0, (told, longest))
    lines = []
    for number, (name, ratio) in enumerate(drawn):
        last = _carried(ratio) - 1
        lines.append(
            go.Scatter(
                name="least power",
                legendgroup="front",
                showlegend=number == 0,
                x=fronts[0].values,
                y=ratio,
                text=[name if place == last else "" for place in range(len(ratio))],
                textposition="middle right",
                textfont={"size": 11, "color": GREY},
                mode="lines+text",
                line={"color": GREY, "width": 1.5},
                hovertemplate=f"{name}: %{{x:.3f}} weights for %{{y:.3f}} of the power for one"
                "<extra>least power</extra>",
            )
        )
    return lines


def _carried(ratio: np.ndarray) -> int:
    """How many of the weights can be carried, the lightest first."""
    return int(np.sum(np.isfinite(ratio)))


def _is_elsewhere(weight: float, power: float) -> bool:
    """Whether a point is not where all optima lie, (1, 1), and so needs its name."""
    return abs(weight - 1) > AGREEMENT or abs(power - 1) > AGREEMENT


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
