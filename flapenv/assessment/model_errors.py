"""How far the model is off CFD at an insect's own stroke, which is all that anybody knows of its uncertainty."""

import dataclasses
import functools
import math
import warnings

from flapenv.aero.checks import record
from flapenv.assessment.hovering import hovering_power
from flapenv.insects import INSECTS, HoverReference, Insect, load_insect
from flapenv.model import BEYOND_THEORY, HoverModel
from flapenv.performance import evaluate


@record
class ModelErrors:
    """Model over CFD, minus one, at an insect's own stroke; each None where CFD gives no such number.

    Attributes:
        weight_support: of Λ [-].
        specific_power: of P* [-].
        hovering_power: of P* where the stroke is beaten as fast as carries the weight, in either [-].
    """

    weight_support: float | None
    specific_power: float | None
    hovering_power: float | None


def model_errors(insect: Insect, model: HoverModel) -> ModelErrors:
    """Of one insect, with the springs that CFD's power has.

    CFD's power at full weight is P*_CFD Λ_CFD^-1.5: the same beat at another frequency, where P* ∝ f³ and Λ ∝ f².

    Args:
        insect: one insect, scalar fields; without CFD all errors are None.
        model: the options; where only positive power is paid CFD has nothing to hold against it but the lift.

    Source: Nabawy & Crowther (2014), Part II, Table 3; Sun & Du (2003).
    """
    cfd = insect.cfd
    if cfd is None:
        return ModelErrors(weight_support=None, specific_power=None, hovering_power=None)
    with warnings.catch_warnings():
        warnings.filterwarnings("ignore", message=BEYOND_THEORY)  # its error is what is asked for
        found = evaluate(insect, **vars(model))
        carried = hovering_power(insect, insect.stroke, model)
    lift = found.weight_support / cfd.weight_support - 1
    if cfd.specific_power is None or model.accounting == "positive":
        return ModelErrors(weight_support=lift, specific_power=None, hovering_power=None)
    needed = cfd_hovering_power(cfd)
    return ModelErrors(
        weight_support=lift,
        specific_power=found.specific_power / cfd.specific_power - 1,
        hovering_power=None if carried is None or needed is None else carried / needed - 1,
    )


def cfd_hovering_power(cfd: HoverReference | None) -> float | None:
    """P*_CFD at the frequency with which CFD's lift is the weight [W/kg]; None where CFD gives no power."""
    if cfd is None or cfd.specific_power is None:
        return None
    return cfd.specific_power / cfd.weight_support**1.5


@functools.lru_cache(maxsize=256)
def typical_errors(model: HoverModel) -> ModelErrors:
    """Root mean square of each of `model_errors` over the CFD cases that the model knows [-].

    Args:
        model: the options; where only positive power is paid, few wings have the mass it needs, but all have the lift.
    """
    insects = [load_insect(name) for name in INSECTS]
    if model.coefficients == "berman-wang":
        insects = [insect for insect in insects if insect.force_constants is not None]
    errors = [model_errors(insect, dataclasses.replace(model, accounting="elastic")) for insect in insects]
    lift, power, carried = (
        _rms([getattr(one, name) for one in errors]) for name in ("weight_support", "specific_power", "hovering_power")
    )
    if model.accounting == "positive":
        return ModelErrors(weight_support=lift, specific_power=None, hovering_power=None)
    return ModelErrors(weight_support=lift, specific_power=power, hovering_power=carried)


def _rms(errors: list[float]) -> float:
    """Root mean square."""
    return math.sqrt(sum(error**2 for error in errors) / len(errors))
