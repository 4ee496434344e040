"""The tables of a report: the terminal's numbers, rounded by the same code."""

import math
from collections.abc import Mapping, Sequence

from agents.evaluation.assessment_table import grouped, number, table_row
from agents.plots.sensitivities import STEPS, fixed_parameters, step_costs
from flapenv.aero.checks import record
from flapenv.aero.parameters import STROKE_PARAMETERS
from flapenv.aero.stroke import Stroke
from flapenv.assessment import StrokeAssessment
from flapenv.assessment.validity import ANGLES, BOX, CASES


@record
class Table:
    """A table of texts with a header above and one to the left.

    Attributes:
        caption: what it shows.
        columns: name and unit of each, the first that of the rows' names.
        rows: their name first.
        note: below it; empty for none.
    """

    caption: str
    columns: tuple[tuple[str, str], ...]
    rows: tuple[tuple[str, ...], ...]
    note: str = ""


def results_table(strokes: Sequence[StrokeAssessment], called: str) -> Table:
    """The terminal's table, number and uncertainty in one cell.

    Args:
        strokes: one an insect.
        called: what the strokes are, in a word.
    """
    rows = []
    for one in strokes:
        cells = [cell for cell in table_row(one) if cell]
        name, weight, weight_unsure, power, power_unsure, *middle, saved, saved_unsure, by_cfd = cells
        pairs = ((weight, weight_unsure), (power, power_unsure), (saved, saved_unsure))
        weight, power, saved = (cell if unsure == "none" else f"{cell} ± {unsure}" for cell, unsure in pairs)
        rows.append((name, weight, power, *middle, saved, by_cfd))
    return Table(
        caption=f"Each insect's {called} stroke beside the optimum, the proven bound and its own stroke",
        columns=(
            ("insect", ""),
            ("weight support", "Λ"),
            (f"{called} power", "W/kg"),
            ("optimum", "W/kg"),
            ("proven bound", "W/kg"),
            ("gap to the optimum", "%"),
            ("own stroke: CFD", "W/kg"),
            ("own stroke: model", "W/kg"),
            ("own stroke: weight support", "Λ"),
            ("saved in this model", "%"),
            ("saved of CFD's", "%"),
        ),
        rows=tuple(rows),
        note=(
            "±: as far as the model is off CFD at the insect's own stroke; without CFD, the root mean square over the "
            "eight cases. Saved: of the own stroke's power, both strokes beaten as fast as carries exactly the weight; "
            "what is saved of CFD's power holds the model's error, too, and the difference is the ± of what is saved."
        ),
    )


def models_table(strokes: Sequence[StrokeAssessment]) -> Table:
    """What every model says is saved of the own stroke's power, both carrying the weight."""
    models = list(dict.fromkeys(ranking.model for one in strokes for ranking in one.rankings))
    rows = []
    for one in strokes:
        said = {}
        for ranking in one.rankings:
            text = number(ranking.saving, 1, percent=True)
            said[ranking.model] = text if ranking.survives else f"✗ {text}"
        rows.append((one.insect.name, number(one.saving, 1, percent=True), *(said.get(model, "–") for model in models)))
    return Table(
        caption="Power saved of the insect's own stroke under other models, both strokes carrying the weight there",
        columns=(("insect", ""), ("this model", "%"), *((model, "%") for model in models)),
        rows=tuple(rows),
        note=(
            "✗: the ranking does not survive, the insect's own stroke needs less or one of the two cannot carry the "
            "weight. –: the model has no constants for this insect or no answer for its strokes. “positive power” is "
            "paid with the wings' inertia and gives nothing back."
        ),
    )


def outside_tables(strokes: Sequence[StrokeAssessment]) -> list[Table]:
    """What lies outside of the CFD cases, of the model's angles and of the box, a table for each that has something."""
    tables = []
    for basis, caption, allowed in (
        (CASES, "What no CFD case covers", "covered"),
        (ANGLES, "Angles for which the model is not called accurate", "accurate"),
        (BOX, "What lies beyond the problem's box, where the optimum was not sought", "box"),
    ):
        found = {
            one.insect.name: [quantity for quantity in (*one.outside, *one.beyond_box) if quantity.basis == basis]
            for one in strokes
        }
        columns = (("quantity", ""), ("here", ""), (allowed, ""), ("of", ""))
        if any(found.values()):
            tables.append(Table(caption=caption, columns=columns, rows=tuple(grouped(found))))
    return tables


def strokes_table(strokes: Mapping[str, Stroke]) -> Table:
    """The six numbers of some strokes.

    Args:
        strokes: by label.
    """
    rows = []
    for name, parameter in STROKE_PARAMETERS.items():
        values = [float(getattr(stroke, name)) for stroke in strokes.values()]
        if parameter.unit == "rad":
            cells, unit = [f"{math.degrees(value):.2f}" for value in values], "°"
        else:
            cells, unit = [f"{value:.4g}" for value in values], parameter.unit
        rows.append((f"{parameter.symbol} [{unit}]" if unit else parameter.symbol, *cells))
    return Table(
        caption="The strokes' six numbers",
        columns=(("", ""), *((label, "") for label in strokes)),
        rows=tuple(rows),
    )


def steps_table(strokes: Sequence[StrokeAssessment]) -> Table:
    """What a step from each insect's optimum costs, and at which bounds of the box the optimum lies."""
    rows = []
    for one in strokes:
        costs, sides, fixed = step_costs(one.best), dict(one.best.active_bounds), fixed_parameters(one.problem)
        marks = {"upper": " ↑", "lower": " ↓"}
        cells = [
            "fixed"
            if name in fixed
            else f"{100 * costs[name]:.2f}{marks.get(sides.get(name, ''), '')}"
            if name in costs
            else "none"
            for name in STEPS
        ]
        rows.append((one.insect.name, *cells))
    return Table(
        caption="What a small step from the optimum costs while the weight stays carried, in percent of the power",
        columns=(("insect", ""), *((step.text, "%") for step in STEPS.values())),
        rows=tuple(rows),
        note=(
            "↑ ↓: the optimum lies at the upper or lower bound of the box, and the step leads back into it. 0.00 "
            "without an arrow: the optimum lies inside, where a small step costs nothing to first order. Λ: what "
            "carrying more costs. fixed: the problem leaves no choice."
        ),
    )
