"""One look for all interactive figures: readable on a phone, in grey print and without colour vision."""

from collections.abc import Iterable
from typing import Any

import numpy as np
import plotly.graph_objects as go

from flapenv.aero.checks import record
from flapenv.drawing import BLACK, BLUE, GREEN, GREY, ORANGE, RED

FONT = "system-ui, -apple-system, 'Segoe UI', Roboto, 'Helvetica Neue', Arial, sans-serif"
RULE, GRID = "#8c8c8c", "#e4e4e4"
"""Colours of axes and of what lies behind the curves."""
REMOVED_BUTTONS = ["zoom2d", "pan2d", "select2d", "lasso2d", "zoomIn2d", "zoomOut2d", "autoScale2d"]


@record
class LineStyle:
    """How one of several strokes is told from the others, three ways at once.

    Attributes:
        colour: of Okabe and Ito's, each of another lightness.
        dash: Plotly's name of the line's pattern.
        symbol: Plotly's name of the marker.
        width: of the line [px].
    """

    colour: str
    dash: str
    symbol: str
    width: float = 2.5

    @property
    def line(self) -> dict[str, Any]:
        """The `line` of a Plotly trace."""
        return {"color": self.colour, "dash": self.dash, "width": self.width}

    @property
    def marker(self) -> dict[str, Any]:
        """The `marker` of a Plotly trace."""
        return {"color": self.colour, "symbol": self.symbol, "size": 10, "line": {"color": "white", "width": 1}}


STYLES: dict[str, LineStyle] = {
    "learned": LineStyle(colour=BLUE, dash="solid", symbol="circle", width=3),
    "optimal": LineStyle(colour=BLACK, dash="dash", symbol="diamond"),
    "own": LineStyle(colour=ORANGE, dash="dashdot", symbol="square", width=3),
}
"""By label of a stroke; what is named otherwise takes the looks that are left, in `OTHERS`' order."""
OTHERS: tuple[LineStyle, ...] = (
    STYLES["learned"],
    LineStyle(colour=RED, dash="dot", symbol="triangle-up"),
    LineStyle(colour=GREEN, dash="longdash", symbol="cross"),
    LineStyle(colour=GREY, dash="longdashdot", symbol="star"),
)


def line_styles(labels: Iterable[str]) -> dict[str, LineStyle]:
    """A look for every label, no two alike.

    Raises:
        ValueError: for more labels than there are looks.
    """
    labels = list(labels)
    taken = {STYLES[label].colour for label in labels if label in STYLES}
    free = [style for style in OTHERS if style.colour not in taken]
    others = [label for label in labels if label not in STYLES]
    if len(others) > len(free):
        raise ValueError(f"{len(labels)} lines are too many to be told apart; allowed: up to {len(OTHERS)}")
    chosen = dict(zip(others, free, strict=False))
    return {label: STYLES[label] if label in STYLES else chosen[label] for label in labels}


def template() -> go.layout.Template:
    """Fonts, axes and margins of every figure."""
    axis = {
        "showline": True,
        "linecolor": RULE,
        "ticks": "outside",
        "tickcolor": RULE,
        "gridcolor": GRID,
        "zeroline": True,
        "zerolinecolor": RULE,
        "zerolinewidth": 1,
        "automargin": True,
        "title": {"standoff": 8},
        "fixedrange": True,  # a finger that scrolls the page must not zoom the figure
    }
    return go.layout.Template(
        layout={
            "font": {"family": FONT, "size": 13, "color": "#1a1a1a"},
            "paper_bgcolor": "white",
            "plot_bgcolor": "white",
            "margin": {"l": 56, "r": 12, "t": 44, "b": 48},
            "xaxis": axis,
            "yaxis": axis,
            "legend": {"orientation": "h", "x": 0, "xanchor": "left", "y": 1.02, "yanchor": "bottom"},
            "hoverlabel": {"font": {"family": FONT, "size": 13}},
            "hovermode": "closest",
            "dragmode": False,
            "colorway": [BLUE, ORANGE, GREEN, RED, GREY, BLACK],
        }
    )


def styled(figure: go.Figure, height: int) -> go.Figure:
    """The same figure, in the house's look.

    Args:
        figure: changed in place.
        height: of the figure [px]; its width is the page's.
    """
    figure.update_layout(template=template(), height=height, autosize=True)
    return figure


def rounded(values: Any) -> Any:
    """Numbers to four significant digits, which no screen shows more of; lists of any depth, NaN as None."""
    if np.ndim(values):
        return [rounded(value) for value in values]
    return float(f"{values:.4g}") if np.isfinite(values) else None


def config() -> dict[str, Any]:
    """Plotly's configuration: as wide as the page, no logo, no links that lead out."""
    return {
        "responsive": True,
        "displaylogo": False,
        "displayModeBar": False,
        "modeBarButtonsToRemove": REMOVED_BUTTONS,
        "plotlyServerURL": "",
        "scrollZoom": False,
    }
