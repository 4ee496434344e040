"""Assessed strokes as people read them: the table, what other models say, and what lies outside the validated range."""

from collections.abc import Mapping, Sequence

import numpy as np

from flapenv.assessment import StrokeAssessment
from flapenv.assessment.model_errors import typical_errors
from flapenv.assessment.validity import ANGLES, BOX, CASES, Quantity
from flapenv.tables import text_table

LEARNED = "learned"
"""What the strokes of a policy are called."""


def assessment_table(results: Sequence[StrokeAssessment], called: str = LEARNED) -> str:
    """Each stroke beside optimum, bound, CFD and the insect's own stroke, and below it what the columns mean.

    Args:
        results: one an insect.
        called: what the strokes are, in a word.
    """
    rows: list[tuple[str, ...]] = [
        (
            *("insect", "weight", "", called, "", "optimum", "bound", "gap"),
            *("own stroke:", "CFD", "model", "weight", "saved", "", "of CFD"),
        ),
        ("", "support", "±", "W/kg", "±", "W/kg", "W/kg", "%", "", "W/kg", "W/kg", "support", "%", "±", "%"),
    ]
    rows += [table_row(result) for result in results]
    lines = [text_table(rows, header_rows=2)]
    gaps = [result.gap for result in results if result.gap is not None]
    if gaps:
        lines.append(f"gap to the optimum: mean {100 * np.mean(gaps):.3f} %, worst {100 * max(gaps):.3f} %")
    lines.extend(
        f"{result.insect.name} is INFEASIBLE: no stroke of the box supports more than "
        f"{result.best.max_weight_support:.3f} of its weight; {called} {result.weight_support:.3f}"
        for result in results
        if not result.best.feasible
    )
    lines += [
        _legend(results),
        "saved: of the own stroke's power in this model, both beaten as fast as carries exactly the weight; of CFD: of",
        "what CFD gives the own stroke, which holds the model's error, too: the difference is the ± of what is saved",
    ]
    lines += [ranking_sentence(results, called), outside_sentences(results)]
    return "\n".join(line for line in lines if line)


def table_row(result: StrokeAssessment) -> tuple[str, ...]:
    """The numbers of one insect, rounded as everywhere."""
    best = result.best
    return (
        result.insect.name,
        f"{result.weight_support:.4f}",
        f"{result.weight_uncertainty:.3f}",
        f"{result.specific_power:.2f}",
        number(result.power_uncertainty, 1),
        f"{best.specific_power:.2f}" if best.feasible else "none",
        number(best.lower_bound, 2),
        number(result.gap, 2, percent=True),
        "",
        number(result.cfd_power, 0),
        f"{result.own_specific_power:.1f}",
        f"{result.own_weight_support:.3f}",
        "-" if result.is_own else number(result.saving, 0, percent=True),
        "-" if result.is_own else number(result.saving_uncertainty, 0, percent=True),
        number(result.saving_to_cfd, 0, percent=True),
    )


def _legend(results: Sequence[StrokeAssessment]) -> str:
    """What ± says, with how far the model is off in the eight CFD cases."""
    typical = typical_errors(results[0].problem.model)
    power = "" if typical.specific_power is None else f" and {100 * typical.specific_power:.0f} % in power"
    return (
        "±: as far as the model is off CFD at the insect's own stroke; in the rms of the CFD cases, which stands where "
        f"there is\nno CFD, {number(typical.weight_support, 0, percent=True)} % in weight support{power}"
    )


def number(value: float | None, digits: int, *, percent: bool = False) -> str:
    """A number, or that there is none.

    Args:
        value: in its unit, or a fraction.
        digits: after the point.
        percent: whether a fraction is told in percent.
    """
    if value is None:
        return "none"
    return f"{round(100 * value if percent else value, digits) + 0.0:.{digits}f}"  # + 0.0, so that no zero is negative


def ranking_table(results: Sequence[StrokeAssessment]) -> str:
    """What each model says a stroke saves of the insect's own, both carrying the weight in that model [%].

    A negative number says that the insect's own stroke needs less there.
    """
    models = list(dict.fromkeys(ranking.model for result in results for ranking in result.rankings))
    rows: list[tuple[str, ...]] = [("saved [%] in", "this model", *models)]
    for result in results:
        saved = {ranking.model: number(ranking.saving, 1, percent=True) for ranking in result.rankings}
        rows.append((result.insect.name, number(result.saving, 1, percent=True), *(saved.get(m, "-") for m in models)))
    return text_table(rows)


def ranking_sentence(results: Sequence[StrokeAssessment], called: str = LEARNED) -> str:
    """In how many of the models the strokes still need less power than the insects' own, and where not.

    Args:
        results: one an insect; those whose stroke is the insect's own are left out.
        called: what the strokes are, in a word.
    """
    judged = [(result.insect.name, ranking) for result in results for ranking in result.rankings if not result.is_own]
    if not judged:
        return ""
    lost: dict[str, list[str]] = {}
    for name, ranking in judged:
        if not ranking.survives:
            lost.setdefault(ranking.model, []).append(name)
    held = len(judged) - sum(map(len, lost.values()))
    end = "".join(f"; not with {model}: {', '.join(names)}" for model, names in lost.items())
    return f"{called} needs less than the own stroke in {held} of {len(judged)} cases of other models{end}"


def outside_sentences(results: Sequence[StrokeAssessment]) -> str:
    """What lies outside of the CFD cases, the model's angles and the problem's box, with the insects it holds for."""
    lines = []
    for basis, remark in ((CASES, ""), (ANGLES, ""), (BOX, ", so that a gap may be negative")):
        found = {
            result.insect.name: [one for one in (*result.outside, *result.beyond_box) if one.basis == basis]
            for result in results
        }
        if any(found.values()):
            lines += [f"outside of {basis}{remark}:", *_grouped(found)]
    return "\n".join(lines)


def _grouped(outside: Mapping[str, Sequence[Quantity]]) -> list[str]:
    """A line for each quantity and range."""
    return [f"  {name} = {value}, beyond {where}: {who}" for name, value, where, who in grouped(outside)]


def grouped(outside: Mapping[str, Sequence[Quantity]]) -> list[tuple[str, str, str, str]]:
    """Name, value or span of values, range, and whose it is, of each quantity and range; what most share comes first.

    Args:
        outside: of each insect.
    """
    found: dict[tuple[str, str], dict[str, float]] = {}
    for insect, quantities in outside.items():
        for quantity in quantities:
            found.setdefault((quantity.name, quantity.range_text), {})[insect] = quantity.value
    rows = []
    for (name, where), values in sorted(found.items(), key=lambda item: -len(item[1])):
        low, high = (f"{end(values.values()):.4g}" for end in (min, max))
        who = "all" if len(values) == len(outside) > 1 else ", ".join(values)
        rows.append((name, low if low == high else f"{low} to {high}", where, who))
    return rows
