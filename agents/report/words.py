"""The summary of a report, in sentences."""

from collections.abc import Sequence

import numpy as np

from agents.evaluation.assessment_table import ranking_sentence
from agents.report.content import ReportContent
from flapenv.assessment import StrokeAssessment

CARRIED = 0.995
"""Weight support from which a stroke is said to carry the weight [-]."""


def summary(content: ReportContent) -> list[str]:
    """What was found, a sentence or two each, the most important first."""
    verdict, strokes = content.verdict, content.verdict.assessments
    told = [*_powers(strokes, content.called), *_savings(strokes)] if strokes else []
    if verdict.mean is not None and verdict.worst is not None:
        told.append(_distance(content, verdict.mean, verdict.worst))
    return [*told, *_rankings(strokes, content.called), *_infeasible(strokes, content.called), *_outside(strokes)]


def _powers(strokes: Sequence[StrokeAssessment], called: str) -> list[str]:
    """What the strokes carry and need."""
    power = span([one.specific_power for one in strokes], 2)
    weight = span([one.weight_support for one in strokes], 4)
    who = strokes[0].insect.name if len(strokes) == 1 else f"{len(strokes)} insects"
    told = [f"The {called} strokes of {who} carry {weight} of the weight with {power} W/kg. {_uncertainty(strokes)}"]
    light = [one.insect.name for one in strokes if one.best.feasible and one.weight_support < CARRIED]
    if light:
        told.append(f"The full weight is not carried by {', '.join(light)}.")
    return told


def _uncertainty(strokes: Sequence[StrokeAssessment]) -> str:
    """How far the model is off, and what that says of other strokes."""
    lift = f"{span([100 * one.weight_share for one in strokes], 0)} % in weight support"
    shares = [100 * share for one in strokes if (share := one.power_share) is not None]
    power = f" and {span(shares, 0)} % in power" if shares else ""
    end = "" if all(one.is_own for one in strokes) else ", which is taken as the uncertainty of these numbers: nobody"
    end += " has run CFD on these strokes" if end else ""
    if all(one.errors.weight_support is None for one in strokes):
        return f"In the eight CFD cases this model is typically off by {lift}{power}{end}."
    return f"At the insects' own strokes this model is off CFD by {lift}{power}{end}."


def _savings(strokes: Sequence[StrokeAssessment]) -> list[str]:
    """What is saved of the own strokes' power, and where that is less than is known."""
    others = [one for one in strokes if not one.is_own and one.saving is not None]
    if not others:
        return []
    saved = span([100 * (one.saving or 0.0) for one in others], 0)
    said = f"That saves {saved} % of the power of the own strokes, both beaten as fast as carries exactly the weight"
    known = [(one, unsure) for one in others if (unsure := one.saving_uncertainty) is not None]
    if known:
        doubted = [one.insect.name for one, unsure in known if (one.saving or 0.0) <= unsure]
        which = f"for all but {', '.join(doubted)}" if doubted else "each"
        said += f", ± {span([100 * unsure for _, unsure in known], 0)} points: {which} more than that uncertainty"
    by_cfd = [100 * saving for one in others if (saving := one.saving_to_cfd) is not None]
    told = [f"{said}."]
    if by_cfd:
        told.append(f"Of the power that CFD found for the own strokes it saves {span(by_cfd, 0)} %.")
    published = span([100 * one.saving_as_published for one in others], 0)
    carried = span([one.own_weight_support for one in others], 2)
    told.append(
        f"Of the own strokes as published, which carry {carried} of the weight in this model, it saves {published} %."
    )
    return told


def _distance(content: ReportContent, mean: float, worst: float) -> str:
    """How far it is from the reference, and the reference from what is proven."""
    distance = content.distance
    said = f"{distance[:1].upper()}{distance[1:]}: mean {100 * mean:.3f} %, worst {100 * worst:.3f} %."
    proven = [
        100 * gap
        for one in content.verdict.assessments
        if one.best.feasible and (gap := one.best.gap_to_bound) is not None
    ]
    if proven:
        bound = "a proven bound, below which no stroke of the box hovers"
        said += f" The optimum itself lies {span(proven, 1)} % above {bound}."
    return said


def _rankings(strokes: Sequence[StrokeAssessment], called: str) -> list[str]:
    """Whether the strokes need less than the insects' own under other models, too."""
    sentence = ranking_sentence(strokes, called)
    if not sentence:
        return []
    return [
        f"Does that hang on the model? {sentence[0].upper()}{sentence[1:]}. The other models are other force "
        "coefficients and, where the wing's mass is known, power without springs; both strokes carry the weight in "
        "each."
    ]


def _infeasible(strokes: Sequence[StrokeAssessment], called: str) -> list[str]:
    """Insects that cannot hover in the box."""
    return [
        f"{one.insect.name} cannot hover here: no stroke of the box supports more than "
        f"{one.best.max_weight_support:.3f} of its weight; {called}: {one.weight_support:.3f}."
        for one in strokes
        if not one.best.feasible
    ]


def _outside(strokes: Sequence[StrokeAssessment]) -> list[str]:
    """What no CFD case covers and what lies beyond the box, in a line each; the lists have a section of their own."""
    uncovered = dict.fromkeys(quantity.name for one in strokes for quantity in one.outside)
    beyond = dict.fromkeys(quantity.name for one in strokes for quantity in one.beyond_box)
    told = []
    if uncovered:
        told.append(
            f"Read it with care: {', '.join(uncovered)}: outside of what the eight CFD cases cover, listed below."
        )
    if beyond:
        told.append(
            f"{', '.join(beyond)}: beyond the problem's box, where no optimum was sought; gaps may be negative."
        )
    return told


def span(values: Sequence[float], digits: int) -> str:
    """Numbers as the range they span, "8.56 to 29.92", or as the one they all are."""
    low, high = (f"{round(float(end), digits) + 0.0:.{digits}f}" for end in (np.min(values), np.max(values)))
    return low if low == high else f"{low} to {high}"
