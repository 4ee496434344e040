"""How much less power learned strokes need than the insects' own, and how sure that is."""

from collections.abc import Sequence

import plotly.graph_objects as go

from agents.plots.names import plain
from agents.plots.style import STYLES, styled
from flapenv.assessment import StrokeAssessment
from flapenv.drawing import BLACK, GREEN, ORANGE

ROW_HEIGHT, FRAME_HEIGHT = 42, 140
"""Of an insect, and of everything around the bars [px]."""
LIGHT_BLUE = "#7DB9E0"
"""On which black whiskers are seen."""
BY_CFD, BY_MODEL, AS_IS = (
    "of CFD's power",
    "in this model, both carrying the weight",
    "in this model, both as they are",
)
"""Names of the three comparisons with the insect's own stroke."""


def savings(assessments: Sequence[StrokeAssessment]) -> go.Figure:
    """Bars for each insect: what is saved of the own stroke's power in the model and of CFD's, in percent.

    Whiskers are what the model's error against CFD makes of the first.

    Args:
        assessments: one of each insect.
    """
    names = [plain(one.insect.name) for one in assessments]
    figure = go.Figure()
    spans = [_percent(one.saving_uncertainty) for one in assessments]
    whiskers = {"type": "data", "array": spans, "color": BLACK, "thickness": 2, "width": 7}
    for label, values, colour, pattern in (
        (BY_MODEL, [one.saving for one in assessments], LIGHT_BLUE, ""),
        (BY_CFD, [one.saving_to_cfd for one in assessments], ORANGE, "/"),
    ):
        figure.add_bar(
            name=label,
            y=names,
            x=[_percent(value) for value in values],
            orientation="h",
            showlegend=any(value is not None for value in values),
            marker={"color": colour, "pattern": {"shape": pattern, "bgcolor": colour, "fgcolor": "white", "size": 6}},
            error_x=whiskers if label == BY_MODEL else None,
            hovertemplate=f"%{{y}}: %{{x:.1f}} %<extra>{label}</extra>",
        )
    figure.add_scatter(
        name=AS_IS,
        y=names,
        x=[_percent(one.saving_as_published) for one in assessments],
        mode="markers",
        marker={**STYLES["learned"].marker, "color": GREEN, "symbol": "diamond"},
        hovertemplate=f"%{{y}}: %{{x:.1f}} %<extra>{AS_IS}</extra>",
    )
    styled(figure, FRAME_HEIGHT + ROW_HEIGHT * len(names))
    figure.update_layout(
        barmode="group",
        bargap=0.3,
        xaxis={"title": {"text": "power saved [%]"}, "zerolinewidth": 2},
        yaxis={"autorange": "reversed", "showgrid": False},
        legend={"orientation": "v"},
        margin={"t": 86},
    )
    return figure


def _percent(value: float | None) -> float | None:
    """A fraction in percent."""
    return None if value is None else 100 * value
