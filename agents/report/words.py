"""The summary of a report, in sentences."""

from collections.abc import Sequence

import numpy as np

from agents.assessment_table import ranking_sentence
from agents.report.content import ReportContent
from flapenv.assessment import StrokeAssessment


def summary(content: ReportContent) -> list[str]:
    """What was found, a sentence or two each, the most important first."""
    verdict, strokes = content.verdict, content.verdict.assessments
    told = [*_powers(strokes, content.called), *_savings(strokes)] if strokes else []
    if verdict.mean is not None and verdict.worst is not None:
        told.append(_distance(content, verdict.mean, verdict.worst))
    if not strokes:
        return told
    sentence = ranking_sentence(strokes, content.called)
    if sentence:
        told.append(
            f"Does that hang on the model? {_sentence(sentence)} The other models are other force coefficients and, where "
            "the wing's mass is known, power without springs; both strokes carry the weight in each."
        )
    return [*told, *_infeasible(strokes, content.called), *_outside(strokes)]


def _powers(strokes: Sequence[StrokeAssessment], called: str) -> list[str]:
    """What the strokes carry and need."""
    power = span([one.specific_power for one in strokes], 2)
    weight = span([one.weight_support for one in strokes], 4)
    error = span([100 * one.uncertainty for one in strokes], 0)
    who = strokes[0].insect.name if len(strokes) == 1 else f"{len(strokes)} insects"
    return [
        f"The {called} strokes of {who} carry {weight} of the weight with {power} W/kg. The model's own error against "
        f"CFD, {error} % at the insects' own strokes, is taken as the uncertainty of these powers: nobody has run CFD "
        "on these strokes."
    ]


def _savings(strokes: Sequence[StrokeAssessment]) -> list[str]:
    """What is saved of the own strokes' power, and where that is less than is known."""
    told = []
    known = [one for one in strokes if one.saving_to_cfd is not None and one.saving_uncertainty is not None]
    if known:
        saved = span([100 * (one.saving_to_cfd or 0) for one in known], 0)
        unsure = span([100 * (one.saving_uncertainty or 0) for one in known], 0)
        doubted = [one.insect.name for one in known if (one.saving_to_cfd or 0) <= (one.saving_uncertainty or 0)]
        end = (
            f"more than its uncertainty for all but {', '.join(doubted)}"
            if doubted
            else "each more than its uncertainty"
        )
        told.append(f"That saves {saved} % of the power that CFD found for the own strokes, ± {unsure} points: {end}.")
    equal = [100 * one.saving for one in strokes if one.saving is not None]
    if equal:
        published = span([100 * one.saving_as_published for one in strokes], 0)
        told.append(
            f"Model against model it saves {span(equal, 0)} % where the own stroke, too, carries exactly the weight, and "
            f"{published} % of the own stroke as published, which carries "
            f"{span([one.own_weight_support for one in strokes], 2)} of the weight in this model."
        )
    return told


def _distance(content: ReportContent, mean: float, worst: float) -> str:
    """How far it is from the reference, and the reference from what is proven."""
    distance = content.task.distance
    said = f"{distance[0].upper()}{distance[1:]}: mean {100 * mean:.3f} %, worst {100 * worst:.3f} %."
    proven = [
        100 * gap
        for one in content.verdict.assessments
        if one.best.feasible and (gap := one.best.gap_to_bound) is not None
    ]
    if proven:
        said += f" The optimum itself lies {span(proven, 1)} % above a proven lower bound: no stroke can need less than that."
    return said


def _infeasible(strokes: Sequence[StrokeAssessment], called: str) -> list[str]:
    """Insects that cannot hover in the box."""
    return [
        f"{one.insect.name} cannot hover here: no stroke of the box supports more than {one.best.max_weight_support:.3f} "
        f"of its weight; {called}: {one.weight_support:.3f}."
        for one in strokes
        if not one.best.feasible
    ]


def _outside(strokes: Sequence[StrokeAssessment]) -> list[str]:
    """How much of it no CFD case covers; the list has a section of its own."""
    names = list(dict.fromkeys(quantity.name for one in strokes for quantity in one.outside))
    if not names:
        return []
    return [f"Read it with care: {', '.join(names)} lie outside of what the eight CFD cases cover, see the list below."]


def span(values: Sequence[float], digits: int) -> str:
    """Numbers as the range they span, "8.56 to 29.92", or as the one they all are."""
    low, high = (f"{end:.{digits}f}" for end in (np.min(values), np.max(values)))
    return low if low == high else f"{low} to {high}"


def _sentence(text: str) -> str:
    """With a capital and a full stop."""
    return f"{text[0].upper()}{text[1:]}."
