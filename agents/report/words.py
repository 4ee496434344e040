"""The summary of a report, in sentences."""

import math
from collections.abc import Mapping, Sequence

import numpy as np

from agents.evaluation.assessment_table import ranking_sentence
from agents.report.content import ReportContent
from flapenv.assessment import StrokeAssessment
from flapenv.assessment.validity import ANGLES, BOX, CASES
from flapenv.insects import INSECTS

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
    one_only = len(strokes) == 1
    who = f"stroke of {strokes[0].insect.name} carries" if one_only else f"strokes of {len(strokes)} insects carry"
    told = [f"The {called} {who} {weight} of the weight with {power} W/kg. {_uncertainty(strokes)}"]
    light = [one.insect.name for one in strokes if one.best.feasible and is_light(one)]
    if light:
        told.append(f"The full weight is not carried by {', '.join(light)}.")
    return told


def is_light(one: StrokeAssessment) -> bool:
    """Whether the stroke does not carry the weight."""
    return one.weight_support < CARRIED


def _uncertainty(strokes: Sequence[StrokeAssessment]) -> str:
    """How far the model is off, and what that says of other strokes."""
    lift = f"{span([100 * one.weight_share for one in strokes], 0)} % in weight support"
    shares = [100 * share for one in strokes if (share := one.power_share) is not None]
    power = f" and {span(shares, 0)} % in power" if shares else ""
    own = [one.is_own for one in strokes]
    end = "" if all(own) else ", which is taken as the uncertainty of these numbers: nobody has run CFD on "
    if end:
        these = "this stroke" if len(strokes) == 1 else "these strokes"
        end += "the strokes that are not the insects' own" if any(own) else these
    if all(one.errors.weight_support is None for one in strokes):
        return f"In the eight CFD cases this model is typically off by {lift}{power}{end}."
    return f"At {_own(strokes)} this model is off CFD by {lift}{power}{end}."


def _own(strokes: Sequence[StrokeAssessment]) -> str:
    """The strokes that others are held against, in words."""
    return "the insect's own stroke" if len(strokes) == 1 else "the insects' own strokes"


def _savings(strokes: Sequence[StrokeAssessment]) -> list[str]:
    """What is saved of the own strokes' power, and where that is less than is known."""
    others = [one for one in strokes if not one.is_own and one.saving is not None]
    if not others:
        return []
    several = len(others) > 1
    own = "the own strokes" if several else "the own stroke"
    savings = {one.insect.name: one.saving or 0.0 for one in others}
    said = f"That {saved(savings)} the power of {own}, both beaten as fast as carries exactly the weight"
    light = [one.insect.name for one in others if is_light(one)]
    if light:
        said += f" (as found, {', '.join(light)} {'do' if len(light) > 1 else 'does'} not carry it)"
    known = [(one, unsure) for one in others if (unsure := one.saving_uncertainty) is not None]
    if known:
        doubted = [one.insect.name for one, unsure in known if abs(one.saving or 0.0) <= unsure]
        said += f", ± {small_span([100 * unsure for _, unsure in known])} points: "
        if several:
            said += f"{'for all but ' + ', '.join(doubted) if doubted else 'each'} more than that uncertainty"
        else:
            said += f"{'no more' if doubted else 'more'} than that uncertainty"
    by_cfd = {one.insect.name: saving for one in others if (saving := one.saving_to_cfd) is not None}
    told = [f"{said}."]
    if by_cfd:
        told.append(f"That {saved(by_cfd)} the power that CFD found for {own}.")
    return [*told, *_as_they_are([one for one in others if not is_light(one)])]


def _as_they_are(strokes: Sequence[StrokeAssessment]) -> list[str]:
    """What strokes that carry the weight save of the own ones, whatever those carry."""
    told = []
    for words, some in (
        ("strokes as published", [one for one in strokes if one.insect.name in INSECTS]),
        ("reference strokes", [one for one in strokes if one.insect.name not in INSECTS]),
    ):
        if some:
            carried = span([one.own_weight_support for one in some], 2)
            own = f"{words}, which carry" if len(some) > 1 else f"{words.replace('strokes', 'stroke')}, which carries"
            compared = saved({one.insect.name: one.saving_as_published for one in some})
            told.append(f"That {compared} the power of the {own} {carried} of the weight in this model.")
    return told


def saved(savings: Mapping[str, float]) -> str:
    """What is saved, or needed more: "saves 3 to 20 % of", to be followed by what it is of.

    Args:
        savings: by insect [-].
    """
    gains = [100 * saving for saving in savings.values() if saving >= 0]
    losses = {name: -100 * saving for name, saving in savings.items() if saving < 0}
    more = f"{small_span(list(losses.values()))} %" if losses else ""
    if not losses:
        return f"saves {span(gains, 0)} % of"
    if not gains:
        return f"needs {more} more than"
    return f"needs more for {', '.join(losses)} ({more}) and else saves {span(gains, 0)} % of"


def _distance(content: ReportContent, mean: float, worst: float) -> str:
    """How far it is from the reference, and the reference from what is proven."""
    distance, strokes = content.distance, content.verdict.assessments
    said = f"{distance[:1].upper()}{distance[1:]}: "
    if len(strokes) == 1:
        said += f"{100 * worst:.3f} %."
    else:
        whose = [one.insect.name for one in strokes if one.gap is not None and math.isclose(one.gap, worst)]
        name = f" ({whose[0]})" if len(whose) == 1 else ""
        said += f"mean {100 * mean:.3f} %, worst {100 * worst:.3f} %{name}."
    proven = [100 * gap for one in strokes if one.best.feasible and (gap := one.best.gap_to_bound) is not None]
    if proven:
        bound = "a proven bound, below which no stroke of the box hovers"
        said += f" The optimum itself lies {span(proven, 1)} % above {bound}."
    return said


def _rankings(strokes: Sequence[StrokeAssessment], called: str) -> list[str]:
    """Whether the strokes need less than the insects' own under other models, too."""
    sentence = ranking_sentence(strokes, f"the {called} stroke")
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
    """What lies outside of which range, a line each; the lists have a section of their own."""
    quantities = [quantity for one in strokes for quantity in (*one.outside, *one.beyond_box)]
    told = []
    for basis, words in (
        (CASES, "outside of what the eight CFD cases cover, listed below; read it with care"),
        (ANGLES, "outside of the angles for which the model is called accurate"),
        (BOX, "beyond the problem's box, where no optimum was sought; gaps may be negative"),
    ):
        names = dict.fromkeys(quantity.name for quantity in quantities if quantity.basis == basis)
        if names:
            told.append(f"{', '.join(names)}: {words}.")
    return told


def span(values: Sequence[float], digits: int) -> str:
    """Numbers as the range they span, "8.56 to 29.92", or as the one they all are."""
    low, high = (f"{round(float(end), digits) + 0.0:.{digits}f}" for end in (np.min(values), np.max(values)))
    return low if low == high else f"{low} to {high}"


def small_span(values: Sequence[float]) -> str:
    """`span` with as many digits as keep what is not nothing from reading 0."""
    least = min((abs(value) for value in values if value), default=1.0)
    return span(values, max(0, -math.floor(math.log10(least))))
