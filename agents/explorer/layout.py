"""The page: what one chooses on the left, what it gives on the right; one below the other on a phone."""

from collections.abc import Mapping, Sequence
from typing import Any

from dash import dcc, html

from agents.explorer.cases import EXPLORED
from agents.explorer.controls import LONGEST_NAME, OWN_WING, WING_CONTROLS, Control, shown_stroke, stroke_controls
from agents.plots.style import config
from flapenv.insects import Insect

PROBLEM_LABELS = {
    "free-frequency": "A: frequency free, α ≥ 25°",
    "fixed-frequency": "B: own frequency and amplitude",
    "profile-drag": "C: with profile drag",
}
"""What `EXPLORED` are called on the page."""
BUTTONS = {"own": "its own stroke", "optimal": "the optimum", "learned": "the learned stroke"}
"""Labels of `Case.strokes` as the buttons say them."""
MOST_LIFT = "most lift"
"""What stands for the optimum where no stroke of the box carries the weight."""
PLACEHOLDER = "450px"
"""Height of a figure before it is there."""
CONFIG: Any = config()  # Dash types every key of it
LEFT_OVER = "what follows is of the last stroke that was allowed, not of what is typed now"
NO_FILE = "there is nothing to download: what is typed is not allowed"
"""Shown while an alert stands on the page."""
HINTS = {
    "own": "as it was measured; of a wing that you type, a plain one",
    "optimal": "of the problem's box",
    "learned": "by a shipped policy, which was trained for problem A",
}
FIGURES = {
    "beat": "The wing, beating",
    "forces": "Lift and power",
    "waveforms": "Angles",
    "terms": "Your stroke, term by term",
}
"""The figures in the page's order, with their captions."""
PAGE = """<!DOCTYPE html>
<html lang="en">
<head>{%metas%}<title>{%title%}</title>{%favicon%}{%css%}</head>
<body>{%app_entry%}<footer>{%config%}{%scripts%}{%renderer%}</footer></body>
</html>"""
"""What Dash fills in."""


def page(insects: Mapping[str, Insect], name: str | None = None) -> html.Div:
    """The whole page.

    Args:
        insects: by name, in the order of the list.
        name: of the insect that is shown; the first of the list where None.
    """
    first = insects[name or next(iter(insects))]
    return html.Div(
        id="page",
        children=[
            html.H1("flapenv: move a wingbeat, see what it costs"),
            html.Div(id="numbers", role="status"),
            html.Div([_case(list(insects), first.name), _stroke(first)], id="controls"),
            html.Div([_wrong(LEFT_OVER), html.Div(id="remarks"), *map(_figure, FIGURES)], id="figures"),
            dcc.Store(id="case"),
            dcc.Store(id="calm"),
            dcc.Download(id="download"),
        ],
    )


def _case(names: Sequence[str], shown: str) -> html.Div:
    """Insect or one's own wing, and the problem."""
    own = [_labelled("name", "name", dcc.Input(id="wing-name", value="my wing", maxLength=LONGEST_NAME, debounce=True))]
    own += [_labelled(c.name, _with_unit(c), _field(c)) for c in WING_CONTROLS]
    return html.Div(
        [
            html.H2("Insect and problem"),
            dcc.Dropdown(
                id="insect", options=[*names, OWN_WING], value=shown, clearable=False, searchable=False, maxHeight=420
            ),
            html.Div(own, id="own-wing", hidden=True),
            dcc.RadioItems(
                id="problem", options=[{"value": n, "label": PROBLEM_LABELS[n]} for n in EXPLORED], value=EXPLORED[0]
            ),
            html.Div(id="note"),
        ],
        className="panel",
    )


def _stroke(first: Insect) -> html.Div:
    """Buttons that load a stroke, and the sliders."""
    shown = shown_stroke(first.stroke, first)
    rows = [_slider(control, value) for control, value in zip(stroke_controls(first), shown, strict=True)]
    buttons = [
        html.Button(text, id=f"load-{label}", type="button", title=HINTS[label]) for label, text in BUTTONS.items()
    ]
    return html.Div(
        [
            html.H2("Stroke"),
            html.Div(["load ", *buttons], className="buttons"),
            *rows,
            html.Div(
                [
                    html.Span("drawn beside it: "),
                    dcc.RadioItems(id="beside", options=list(BUTTONS), value="optimal", inline=True),
                ],
                className="beside",
            ),
            html.Button("download JSON", id="export", type="button"),
            _wrong(NO_FILE),
        ],
        className="panel",
    )


def _slider(control: Control, value: float) -> html.Div:
    """A slider with a field for the number itself."""
    slider = dcc.Slider(
        id=control.name,
        min=control.low,
        max=control.high,
        step=control.step,
        value=value,
        marks=None,
        updatemode="drag",
        allow_direct_input=False,  # its own field shows what it does not use
    )
    field = dcc.Input(id=field_of(control.name), type="number", step="any", value=value, debounce=True)
    return html.Div([html.Div(_with_unit(control), className="label"), slider, field], className="slider")


def field_of(name: str) -> str:
    """The id of the field beside a slider; explorer.js keeps the two alike."""
    return f"{name}-field"


def _wrong(text: str) -> html.Div:
    """What is said while an alert stands."""
    return html.Div(text, className="when-wrong")


def _field(control: Control) -> dcc.Input:
    """A field for a number of the wing."""
    return dcc.Input(
        id=control.name, type="number", min=control.low, max=control.high, step="any", value=control.start, debounce=0.3
    )


def _labelled(name: str, text: str, field: Any) -> html.Label:
    """A field with its label."""
    return html.Label([html.Span(text), field], className=f"field {name}")


def _with_unit(control: Control) -> str:
    """The label with the unit behind it."""
    return f"{control.label} [{control.unit}]" if control.unit else control.label


def _figure(name: str) -> html.Div:
    """An empty figure with its caption."""
    graph = dcc.Graph(id=f"figure-{name}", config=CONFIG, style={"height": PLACEHOLDER})
    return html.Div([html.H2(FIGURES[name]), graph], className="figure")
