"""What the page shows of a stroke: numbers to read, the same numbers in full, remarks, figures, and the file."""

import json
import math
import re
from typing import Any

import plotly.graph_objects as go
from dash import html

from agents.explorer.cases import LEARNED_IN, Case
from agents.explorer.controls import shown_stroke, stroke_controls
from agents.explorer.layout import BUTTONS, MOST_LIFT, PROBLEM_LABELS
from agents.plots.beat import beat
from agents.plots.cycle import forces, terms, waveforms
from flapenv.aero.parameters import STROKE_PARAMETERS
from flapenv.aero.stroke import Stroke
from flapenv.assessment import StrokeAssessment, rankings
from flapenv.assessment.validity import ANGLES, CASES
from flapenv.files import NamedStroke, strokes_to_text

YOURS = "yours"
"""Label of the stroke that the sliders say."""
SAME_WEIGHT = 1e-3
"""Weight supports that differ by less need no remark [-]."""
NONE = "–"
"""Stands where there is no number."""


def numbers(case: Case, stroke: Stroke) -> list[Any]:
    """The numbers of a stroke, each with its full digits in `data-exact`, and all of them as JSON."""
    judged = case.judged(stroke)
    saving = None if judged.is_own else judged.saving
    tiles = [
        _tile("weight_support", "weight support Λ", f"{judged.weight_support:#.5g}", "", judged.weight_support),
        _tile("specific_power", "power P*", f"{judged.specific_power:#.5g}", "W/kg", judged.specific_power),
        _tile("gap", "gap to the optimum", _percent(judged.gap), "%", judged.gap),
        _tile("saving", "saving against own stroke", _percent(saving), "%", saving),
    ]
    exact = {
        "insect": case.insect.name,
        "problem": case.problem.name,
        "weight_support": judged.weight_support,
        "specific_power": judged.specific_power,
        "gap": judged.gap,
        "saving": saving,
        "stroke": {name: float(getattr(stroke, name)) for name in STROKE_PARAMETERS},
    }
    told = (f"problem {PROBLEM_LABELS[case.explored]}", f"stroke: {_in_words(case, stroke)}")
    printed = html.Div(
        [*note(case), *map(html.Div, told)], className="printed"
    )  # where there are no controls: on paper
    return [html.Div(tiles, className="tiles"), printed, html.Div(json.dumps(exact), id="exact", hidden=True)]


def _tile(name: str, label: str, text: str, unit: str, exact: float | None) -> html.Div:
    """One number."""
    full: dict[str, Any] = {"data-exact": json.dumps(exact)}
    value = html.Span(text, id=f"number-{name}", className="value", **full)
    parts = [html.Span(label, className="label"), value]
    return html.Div(parts if text == NONE else [*parts, html.Span(unit, className="unit")], className="tile")


def _in_words(case: Case, stroke: Stroke) -> str:
    """A stroke's six numbers in a line."""
    shown = zip(stroke_controls(case.insect), shown_stroke(stroke, case.insect), strict=True)
    return ", ".join(f"{control.short_label} = {control.with_unit(value)}" for control, value in shown)


def _percent(share: float | None) -> str:
    """A share in percent, at least four digits."""
    if share is None or not math.isfinite(share):
        return NONE
    text = f"{100 * share:#.5g}" if abs(share) >= 0.01 else f"{100 * share:.4f}"
    return "0.0000" if text == "-0.0000" else text


def note(case: Case) -> list[Any]:
    """What does not change with the stroke: the wing, its optimum, bound and CFD's value."""
    own, wing = case.own, case.insect.wing
    lines = [f"{case.insect.name}: {case.insect.mass * 1e6:.4g} mg, AR {wing.aspect_ratio:.2f}"]
    if own.best.feasible:
        bound = f", proven bound {own.best.lower_bound:.4g} W/kg" if own.best.lower_bound is not None else ""
        lines.append(f"optimum of the box: {own.best.specific_power:.4g} W/kg{bound}")
    else:
        lines.append(
            f"no stroke of the box carries the weight: at most {own.best.max_weight_support:.3f} of it, "
            f"which “{labels(case)['optimal']}” loads"
        )
    if own.cfd_power is not None:
        lines.append(f"CFD of its own stroke: {own.cfd_power:.4g} W/kg, this model {own.own_specific_power:.4g} W/kg")
    if case.is_typed:
        lines.append(f"its own stroke is made up: {_in_words(case, case.insect.stroke)}")
    if case.explored != LEARNED_IN.name:
        lines.append(f"“{BUTTONS['learned']}” is that of a policy that was trained in problem A")
    return [html.Div(line) for line in lines]


def labels(case: Case) -> dict[str, str]:
    """What the strokes of `Case.strokes` are called in figures and beside them."""
    return {"own": "own", "optimal": "optimal" if case.own.best.feasible else MOST_LIFT, "learned": "learned"}


def remarks(case: Case, stroke: Stroke) -> list[Any]:
    """What one should know before one believes the numbers."""
    judged, found = case.judged(stroke), []
    if judged.power_share is not None:
        lift, power = 100 * judged.weight_share, 100 * judged.power_share
        found.append(f"uncertainty: Λ ± {lift:.0f} %, P* ± {power:.0f} %, {_why(judged)}")
    if judged.weight_support < 1 - SAME_WEIGHT:
        found.append(f"this stroke carries {100 * judged.weight_support:.2f} % of the weight: it does not hover")
    if abs(judged.weight_support - 1) > SAME_WEIGHT and not judged.is_own:
        found.append("the saving compares both strokes at the frequency with which each carries the weight")
    if judged.beyond_box:
        found.append(f"outside of the problem's box: {'; '.join(one.text for one in judged.beyond_box)}")
    for basis in (CASES, ANGLES):
        beyond = [one.text for one in judged.outside if one.basis == basis]
        if beyond:
            found.append(f"outside of {basis}: {'; '.join(beyond)}")
    others = () if judged.is_own else rankings(case.insect, stroke, case.problem.model)
    if others:
        against = [one.model for one in others if not one.survives]
        kept = len(others) - len(against)
        said = (
            f"needs less power than its own stroke, both carrying the weight, in {kept} of {len(others)} other models"
        )
        found.append(f"{said}; not in {', '.join(against)}" if against else said)
    return [html.Ul([html.Li(text) for text in found])]


def _why(judged: StrokeAssessment) -> str:
    """Where the uncertainty comes from."""
    if judged.errors.specific_power is None:
        return "the model's error against CFD over the eight insects"
    return "the model's error against CFD at the insect's own stroke"


def figures(case: Case, stroke: Stroke, beside: str) -> list[go.Figure]:
    """The figures in the page's order.

    Args:
        case: insect and problem.
        stroke: that the sliders say.
        beside: label of the stroke that is drawn with it.
    """
    insect, model = case.insect, case.problem.model
    strokes = {YOURS: stroke, labels(case)[beside]: case.strokes()[beside]}
    return [
        beat(insect, strokes, model),
        forces(insect, strokes, model),
        waveforms(insect, strokes, model),
        terms(insect, stroke, model),
    ]


def file_text(case: Case, stroke: Stroke) -> str:
    """The stroke and its insect as a file that `train.py evaluate` reads."""
    return strokes_to_text([NamedStroke(stroke=stroke, insect=case.insect)])


def file_name(case: Case) -> str:
    """Of the exported stroke: letters, digits and dashes, whatever the insect is called."""
    return f"{re.sub('[^A-Za-z0-9]+', '-', case.insect.name).strip('-') or 'wing'}-stroke.json"
