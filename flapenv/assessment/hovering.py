"""A stroke brought to carry exactly the weight, so that powers of two strokes can be compared."""

import dataclasses
import math

from flapenv.aero.checks import record
from flapenv.aero.stroke import Stroke
from flapenv.insects import Insect
from flapenv.model import HoverModel
from flapenv.performance import evaluate

CLOSE_ENOUGH, MOST_STEPS = 1e-12, 60
"""Of the weight support from 1 [-]; one step is exact but where k_tip follows the stroke."""


@record
class HoveringStroke:
    """A stroke at the frequency with which it carries exactly the weight.

    Attributes:
        stroke: the stroke.
        specific_power: P* [W/kg].
    """

    stroke: Stroke
    specific_power: float


def hovering(insect: Insect, stroke: Stroke, model: HoverModel) -> HoveringStroke | None:
    """The same beat, faster or slower, until Λ = 1: Λ ∝ f² and, with springs, P* ∝ f³.

    Args:
        insect: one insect, scalar fields.
        stroke: one stroke, scalar fields.
        model: the options.

    Returns:
        The stroke and its power; None where it lifts nothing, or no frequency carries the weight.

    Raises:
        ValueError: for what `evaluate` refuses.
    """
    for _ in range(MOST_STEPS):
        found = evaluate(insect, stroke, **vars(model))
        if not found.weight_support > 0:
            return None
        if abs(found.weight_support - 1) <= CLOSE_ENOUGH:
            return HoveringStroke(stroke=stroke, specific_power=found.specific_power)
        stroke = dataclasses.replace(stroke, frequency=stroke.frequency / math.sqrt(found.weight_support))
    return None
