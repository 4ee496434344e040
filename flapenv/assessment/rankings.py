"""Whether a stroke still needs less power than the insect's own where the aerodynamics are modelled otherwise."""

import dataclasses
import math
import warnings

from flapenv.aero.checks import record
from flapenv.aero.stroke import Stroke
from flapenv.assessment.hovering import hovering
from flapenv.insects import Insect
from flapenv.model import COEFFICIENTS, HoverModel
from flapenv.performance import evaluate

WITHOUT_SPRINGS = "positive power"
"""What the ranking is called in which negative power is not returned."""


@record
class Ranking:
    """A stroke and the insect's own under one model.

    Attributes:
        model: a name of `COEFFICIENTS`, or `WITHOUT_SPRINGS`.
        weight_support: Λ of the stroke [-].
        specific_power: P* of the stroke [W/kg].
        own_weight_support: Λ of the insect's own stroke [-].
        own_specific_power: P* of the insect's own stroke [W/kg].
        hovering_power: P* of the stroke at the frequency with which it carries the weight in this model [W/kg].
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
        if self.hovering_power is None or self.own_hovering_power is None:
            return None
        return 1 - self.hovering_power / self.own_hovering_power

    @property
    def survives(self) -> bool:
        """Whether the stroke hovers with less power than the insect's own."""
        return self.saving is not None and self.saving > 0

    def to_dict(self) -> dict[str, float | bool | str | None]:
        """As JSON keeps it."""
        return {
            **vars(self),
            "saving_percent": None if self.saving is None else 100 * self.saving,
            "survives": self.survives,
        }


def other_models(insect: Insect, model: HoverModel) -> dict[str, HoverModel]:
    """The models a stroke can be held against beside `model`, by name: other coefficients, and power without springs.

    Args:
        insect: one insect; "berman-wang" needs its force constants, power without springs the mass of its wing.
        model: what is changed in one respect at a time.
    """
    others = {
        name: dataclasses.replace(model, coefficients=name)
        for name in COEFFICIENTS
        if name != model.coefficients and (name != "berman-wang" or insect.force_constants is not None)
    }
    if insect.wing.mass is not None and model.accounting == "elastic":
        others[WITHOUT_SPRINGS] = dataclasses.replace(model, accounting="positive")
    return others


def rankings(insect: Insect, stroke: Stroke, model: HoverModel | None = None) -> tuple[Ranking, ...]:
    """The stroke beside the insect's own under every other model that knows the insect.

    A model whose k_flap has no answer for the amplitude, or which cannot accelerate a triangle, is left out.

    Args:
        insect: one insect, scalar fields.
        stroke: one stroke, scalar fields.
        model: the one that the stroke was found in; the paper's where None.
    """
    found = []
    for name, other in other_models(insect, model or HoverModel()).items():
        if not _knows(other, stroke) or not _knows(other, insect.stroke):
            continue
        with warnings.catch_warnings():
            warnings.filterwarnings("ignore", message=".*outside the range of the")  # asked beyond their range, too
            found.append(_ranking(name, insect, stroke, other))
    return tuple(found)


def _knows(model: HoverModel, stroke: Stroke) -> bool:
    """Whether the model has an answer for the stroke."""
    if model.accounting == "positive" and stroke.flap_shape == 1:
        return False
    return not model.uses_k or stroke.flap_amplitude <= math.pi / 2


def _ranking(name: str, insect: Insect, stroke: Stroke, model: HoverModel) -> Ranking:
    """One model's verdict."""
    judged, own = (evaluate(insect, one, **vars(model)) for one in (stroke, insect.stroke))
    carried, own_carried = (hovering(insect, one, model) for one in (stroke, insect.stroke))
    return Ranking(
        model=name,
        weight_support=judged.weight_support,
        specific_power=judged.specific_power,
        own_weight_support=own.weight_support,
        own_specific_power=own.specific_power,
        hovering_power=carried.specific_power if carried else None,
        own_hovering_power=own_carried.specific_power if own_carried else None,
    )
