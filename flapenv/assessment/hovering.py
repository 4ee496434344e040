"""The power of a stroke that is beaten as fast as carries exactly the weight, so that two strokes can be compared."""

import dataclasses
import math

from flapenv.aero.stroke import Stroke
from flapenv.insects import Insect
from flapenv.model import HoverModel
from flapenv.performance import evaluate

CLOSE_ENOUGH, MOST_STEPS = 1e-12, 60
"""Of the weight support from 1 [-]; one step is exact but where k_tip follows the stroke."""
LEAST_SUPPORT = 0.01
"""A stroke that lifts less of the weight is not hurried until it hovers, which would take ten times its f [-]."""


def hovering_power(insect: Insect, stroke: Stroke, model: HoverModel) -> float | None:
    """P* of the same beat, faster or slower, with Λ = 1 [W/kg]: Λ ∝ f² and P* ∝ f³, with springs or without.

    Args:
        insect: one insect, scalar fields.
        stroke: one stroke, scalar fields.
        model: the options.

    Returns:
        The power; None where the stroke lifts next to nothing, or no frequency carries the weight.

    Raises:
        ValueError: for what `evaluate` refuses.
    """
    if not evaluate(insect, stroke, **vars(model)).weight_support > LEAST_SUPPORT:
        return None
    for _ in range(MOST_STEPS):
        found = evaluate(insect, stroke, **vars(model))
        if not found.weight_support > 0:
            return None
        if abs(found.weight_support - 1) <= CLOSE_ENOUGH:
            return float(found.specific_power)
        stroke = dataclasses.replace(stroke, frequency=stroke.frequency / math.sqrt(found.weight_support))
    return None


def saved(power: float | None, own: float | None) -> float | None:
    """What of `own` is saved, 1 - power/own [-]; None where one of them is not known."""
    return None if power is None or own is None else 1 - power / own
