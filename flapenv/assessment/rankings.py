"""A stroke and the insect's own under one model, and whether the first needs less power in all of them."""

import dataclasses
import math
import warnings

from flapenv.aero.checks import record
from flapenv.aero.stroke import Stroke
from flapenv.assessment.hovering import hovering_power, saved
from flapenv.insects import Insect
from flapenv.model import BEYOND_THEORY, COEFFICIENTS, HoverModel
from flapenv.performance import evaluate

WITHOUT_SPRINGS = "positive power"
"""What the model is called in which negative power is not returned."""
MEASURED = ("robofly", "berman-wang")
"""Coefficients that hold the drag at zero lift already, so that none is added."""
TIE = 1e-6
"""A saving this small is none [-]."""


@record
class Ranking:
    """A stroke and the insect's own under one model.

    Attributes:
        model: a name of `COEFFICIENTS`, or `WITHOUT_SPRINGS`.
        weight_support: Λ of the stroke [-].
        specific_power: P* of the stroke [W/kg].
        own_weight_support: Λ of the insect's own stroke [-].
        own_specific_power: P* of the insect's own stroke [W/kg].
        hovering_power: P* of the stroke, as fast as carries the weight in this model [W/kg]; None where it cannot.
        own_hovering_power: the same of the insect's own stroke [W/kg].
    """

    model: str
    weight_support: float
    specific_power: float
    own_weight_support: float
    own_specific_power: float
    hovering_power: float | None
    own_hovering_power: float | None

    @property
    def saving(self) -> float | None:
        """1 - P*/P*_own, both carrying the weight [-]; None where one of them cannot."""
        return saved(self.hovering_power, self.own_hovering_power)

    @property
    def survives(self) -> bool:
        """Whether the stroke hovers with less power than the insect's own."""
        return self.saving is not None and self.saving > TIE

    def to_dict(self) -> dict[str, float | bool | str | None]:
        """As JSON keeps it."""
        percent = None if self.saving is None else 100 * self.saving
        return {**vars(self), "saving_percent": percent, "survives": self.survives}


def ranked(name: str, insect: Insect, stroke: Stroke, model: HoverModel) -> Ranking:
    """The stroke beside the insect's own under one model.

    Args:
        name: of the model.
        insect: one insect, scalar fields.
        stroke: one stroke, scalar fields.
        model: the options.

    Raises:
        ValueError: for what `evaluate` refuses.
    """
    judged, own = (evaluate(insect, one, **vars(model)) for one in (stroke, insect.stroke))
    return Ranking(
        model=name,
        weight_support=judged.weight_support,
        specific_power=judged.specific_power,
        own_weight_support=own.weight_support,
        own_specific_power=own.specific_power,
        hovering_power=hovering_power(insect, stroke, model),
        own_hovering_power=hovering_power(insect, insect.stroke, model),
    )


def other_models(insect: Insect, model: HoverModel) -> dict[str, HoverModel]:
    """The models a stroke can be held against beside `model`, by name: other coefficients, and power without springs.

    Args:
        insect: one insect; "berman-wang" needs its force constants, power without springs the mass of its wing.
        model: what is changed in one respect at a time; drag at zero lift is not added to measured coefficients.
    """
    others = {}
    for name in COEFFICIENTS:
        if name != model.coefficients and (name != "berman-wang" or insect.force_constants is not None):
            drag = 0.0 if name in MEASURED else model.profile_drag
            others[name] = dataclasses.replace(model, coefficients=name, profile_drag=drag)
    if insect.wing.mass is not None and model.accounting == "elastic":
        others[WITHOUT_SPRINGS] = dataclasses.replace(model, accounting="positive")
    return others


def rankings(insect: Insect, stroke: Stroke, model: HoverModel | None = None) -> tuple[Ranking, ...]:
    """The stroke beside the insect's own under every other model that knows the insect.

    A model whose k_flap has no answer for one of the amplitudes, or which cannot accelerate a triangle, is left out.

    Args:
        insect: one insect, scalar fields.
        stroke: one stroke, scalar fields.
        model: the one that the stroke was found in; the paper's where None.
    """
    found = []
    for name, other in other_models(insect, model or HoverModel()).items():
        if _knows(other, stroke) and _knows(other, insect.stroke):
            with warnings.catch_warnings():
                warnings.filterwarnings("ignore", message=BEYOND_THEORY)  # asked beyond their range, too
                found.append(ranked(name, insect, stroke, other))
    return tuple(found)


def _knows(model: HoverModel, stroke: Stroke) -> bool:
    """Whether the model has an answer for the stroke."""
    if model.accounting == "positive" and stroke.flap_shape == 1:
        return False
    return not model.uses_k or stroke.flap_amplitude <= math.pi / 2
