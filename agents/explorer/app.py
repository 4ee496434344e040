"""The Dash app: which part of the page answers to which."""

from pathlib import Path
from typing import Any

import plotly.graph_objects as go
from dash import ClientsideFunction, Dash, Input, Output, State, ctx, html, no_update
from flask import Response

from agents.explorer.answers import figures, file_name, file_text, labels, note, numbers, remarks
from agents.explorer.cases import Cases
from agents.explorer.controls import OWN_WING, WING_CONTROLS, read_stroke, shown_stroke, stroke_controls
from agents.explorer.guard import guard
from agents.explorer.layout import BUTTONS, FIGURES, MOST_LIFT, PAGE, field_of, page
from agents.plots.beat import SCRIPT
from flapenv.aero.checks import require_name
from flapenv.files import WingFile

MISTAKES = (ValueError, TypeError, ArithmeticError, OSError)
"""What is told on the page in one line."""
NO_NUMBERS = "no numbers: what is typed for the wing is not allowed"


def make_app(extra: WingFile | None = None, *, first: str | None = None) -> Dash:
    """The explorer, ready to be served.

    Args:
        extra: a wing of one's own with its limits, listed and shown first.
        first: name of the insect that is shown first otherwise.

    Raises:
        ValueError: for an insect whose name is taken.
    """
    cases = Cases(extra)
    app = Dash(
        "flapenv",
        title="flapenv explorer",
        update_title="",
        assets_folder=str(Path(__file__).with_name("assets")),
        external_scripts=["/beat.js"],
        index_string=PAGE,
        serve_locally=True,
        add_log_handler=False,
        enable_mcp=False,
    )
    app.layout = page(cases.insects, first)
    _case_callbacks(app, cases)
    _stroke_callbacks(app, cases)
    script = SCRIPT.read_text(encoding="utf-8")
    app.server.add_url_rule("/beat.js", "beat", lambda: Response(script, mimetype="text/javascript"))
    guard(app.server, app.csp_hashes())
    return app


def _case_callbacks(app: Dash, cases: Cases) -> None:
    """Insect, wing and problem: solve the optimum and set the sliders."""
    names = _names(cases)

    @app.callback(Output("own-wing", "hidden"), Input("insect", "value"))
    def show_fields(name: Any) -> bool:
        return bool(name != OWN_WING)

    @app.callback(
        output=[
            Output("case", "data"),
            Output("note", "children"),
            Output("load-optimal", "children"),
            Output("beside", "options"),
            *(Output(name, prop) for name in names for prop in ("min", "max", "step", "value")),
        ],
        inputs={
            "name": Input("insect", "value"),
            "problem": Input("problem", "value"),
            "own": [Input("wing-name", "value"), *(Input(control.name, "value") for control in WING_CONTROLS)],
        },
        state={"moved": [State(name, "value") for name in names]},
    )
    def take_case(name: Any, problem: Any, own: Any, moved: Any) -> list[Any]:
        try:
            key, case = cases.solve(name, own, problem)
        except MISTAKES as mistake:
            return [None, alert(mistake), *[no_update] * (2 + 4 * len(names))]
        insect = case.insect
        try:
            stroke = read_stroke(moved, insect) if ctx.triggered_id != "insect" else insect.stroke
        except MISTAKES:  # the sliders do not fit this insect
            stroke = insect.stroke
        rows = zip(stroke_controls(insect), shown_stroke(stroke, insect), strict=True)
        sliders = [part for one, value in rows for part in (one.low, one.high, one.step, value)]
        button = BUTTONS["optimal"] if case.own.best.feasible else MOST_LIFT
        beside = [{"value": value, "label": label} for value, label in labels(case).items()]
        return [key, note(case), button, beside, *sliders]

    @app.callback(
        output=[Output(name, "value", allow_duplicate=True) for name in names],
        inputs={"clicks": [Input(f"load-{label}", "n_clicks") for label in BUTTONS]},
        state={"key": State("case", "data")},
        prevent_initial_call=True,
    )
    def load(clicks: Any, key: Any) -> list[Any]:
        try:
            case = cases.known(key)
            label = require_name("stroke", str(ctx.triggered_id).removeprefix("load-"), BUTTONS)
            with cases.one_at_a_time:
                return list(shown_stroke(case.strokes()[label], case.insect))
        except MISTAKES:  # the numbers say what is wrong
            return [no_update] * len(names)


def _stroke_callbacks(app: Dash, cases: Cases) -> None:
    """Sliders: numbers at once, figures and remarks when the page has time, the file on demand."""
    names = _names(cases)

    @app.callback(
        output=Output("numbers", "children"),
        inputs={"key": Input("case", "data"), "moved": [Input(name, "value") for name in names]},
    )
    def show_numbers(key: Any, moved: Any) -> Any:
        if key is None:  # the note says what is wrong
            return NO_NUMBERS
        try:
            case = cases.known(key)
            return numbers(case, read_stroke(moved, case.insect))
        except MISTAKES as mistake:
            return alert(mistake)

    for name in names:
        app.clientside_callback(
            ClientsideFunction("explorer", "show"),
            Output(field_of(name), "value"),
            Input(name, "value"),
            State(name, "id"),
        )
        app.clientside_callback(
            ClientsideFunction("explorer", "type"),
            Input(field_of(name), "value"),
            *(State(name, part) for part in ("id", "value", "min", "max")),
        )
    app.clientside_callback(
        ClientsideFunction("explorer", "calm"),
        Output("calm", "data"),
        Input("case", "data"),
        Input("beside", "value"),
        *(Input(name, "value") for name in names),
    )

    @app.callback(
        output=[
            Output("remarks", "children"),
            *(Output(f"figure-{name}", prop) for name in FIGURES for prop in ("figure", "style")),
        ],
        inputs={"calm": Input("calm", "data")},
    )
    def draw(calm: Any) -> list[Any]:
        unchanged = [no_update] * (1 + 2 * len(FIGURES))
        if not isinstance(calm, list) or len(calm) != 2 + len(names) or calm[0] is None:
            return unchanged
        key, beside, *moved = calm
        try:
            case = cases.known(key)
            label = require_name("beside", beside, BUTTONS)
            stroke = read_stroke(moved, case.insect)
            with cases.one_at_a_time:
                told, drawn = remarks(case, stroke), figures(case, stroke, label)
            return [told, *(part for one in drawn for part in (one, height(one)))]
        except MISTAKES:  # the numbers say what is wrong
            return unchanged

    @app.callback(
        output=Output("download", "data"),
        inputs={"clicks": Input("export", "n_clicks")},
        state={"key": State("case", "data"), "moved": [State(name, "value") for name in names]},
        prevent_initial_call=True,
    )
    def export(clicks: Any, key: Any, moved: Any) -> Any:
        try:
            case = cases.known(key)
            text = file_text(case, read_stroke(moved, case.insect))
        except MISTAKES:  # the numbers say what is wrong
            return no_update
        return {"content": text, "filename": file_name(case), "type": "application/json"}


def _names(cases: Cases) -> list[str]:
    """Of the sliders, which are the same for every insect."""
    return [control.name for control in stroke_controls(next(iter(cases.insects.values())))]


def height(figure: go.Figure) -> dict[str, str]:
    """The style of the element that a figure fills."""
    return {"height": f"{figure.layout.height}px"}


def alert(mistake: Exception) -> html.Div:
    """A mistake in one line."""
    return html.Div(" ".join(str(mistake).split()), className="alert", role="alert")
