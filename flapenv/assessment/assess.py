"""A stroke of an insect beside everything that is known: optimum, bound, own stroke, CFD, other models."""

import dataclasses
import math
import warnings
from typing import Any

from flapenv.aero.checks import record
from flapenv.aero.parameters import STROKE_PARAMETERS
from flapenv.aero.stroke import Stroke
from flapenv.assessment.hovering import saved
from flapenv.assessment.model_errors import ModelErrors, cfd_hovering_power, model_errors, typical_errors
from flapenv.assessment.rankings import Ranking, ranked, rankings
from flapenv.assessment.validity import Quantity, outside_box, outside_validated
from flapenv.insects import Insect, as_insect
from flapenv.model import BEYOND_THEORY
from flapenv.optimum import Optimum, optimum
from flapenv.problem import HoverProblem, as_problem


@record
class StrokeAssessment:
    """What a stroke of an insect is worth.

    The model's error against CFD at the insect's own stroke is taken as the uncertainty of what it says of any other
    stroke, on which nobody has run CFD; where an insect has no CFD, the root mean square over the eight cases.

    Attributes:
        insect: the insect.
        stroke: what is judged.
        problem: whose box and model count.
        weight_support: Λ [-].
        specific_power: P* [W/kg].
        gap: to the optimum of the box, missing weight charged [-]; negative for strokes beyond the box; None where no
            stroke of the box carries the weight.
        best: the optimum of the box with its proven bound.
        own_weight_support: Λ of the model at the insect's own stroke [-].
        own_specific_power: P* of the model at the insect's own stroke [W/kg].
        hovering_power: P* of the stroke at the frequency with which it carries exactly the weight in this model
            [W/kg]; None where it lifts nothing.
        own_hovering_power: the same of the insect's own stroke [W/kg].
        errors: of the model against CFD at the insect's own stroke.
        outside: what of stroke and wing the eight CFD cases do not cover.
        beyond_box: what of the stroke lies beyond the problem's box, where the optimum was not sought.
        rankings: the stroke beside the insect's own under other models.
    """

    insect: Insect
    stroke: Stroke
    problem: HoverProblem
    weight_support: float
    specific_power: float
    gap: float | None
    best: Optimum
    own_weight_support: float
    own_specific_power: float
    hovering_power: float | None
    own_hovering_power: float | None
    errors: ModelErrors
    outside: tuple[Quantity, ...]
    beyond_box: tuple[Quantity, ...]
    rankings: tuple[Ranking, ...]

    @property
    def weight_uncertainty(self) -> float:
        """Of Λ [-]: what it would change if this stroke's lift is off by as much as the insect's own."""
        return self.weight_share * self.weight_support

    @property
    def power_uncertainty(self) -> float | None:
        """Of P* [W/kg]: likewise; None where only positive power is paid, which no CFD gives."""
        return None if self.power_share is None else self.power_share * self.specific_power

    @property
    def saving_uncertainty(self) -> float | None:
        """Of `saving` [-]: how far it is from `saving_to_cfd`, or would typically be where there is no CFD.

        None of the insect's own stroke, too, which saves nothing of itself in any model.
        """
        if self.is_own:
            return None
        error = self.errors.hovering_power
        error = typical_errors(self.problem.model).hovering_power if error is None else error
        return None if self.saving is None or error is None else (1 - self.saving) * abs(error)

    @property
    def weight_share(self) -> float:
        """Uncertainty of Λ over Λ [-]."""
        share = _share(self.errors.weight_support, typical_errors(self.problem.model).weight_support)
        assert share is not None  # every CFD case has a weight support
        return share

    @property
    def power_share(self) -> float | None:
        """Uncertainty of P* over P* [-]."""
        return _share(self.errors.specific_power, typical_errors(self.problem.model).specific_power)

    @property
    def cfd_power(self) -> float | None:
        """P* that CFD found for the insect's own stroke [W/kg]; None where there is no CFD."""
        return self.insect.cfd.specific_power if self.insect.cfd else None

    @property
    def saving(self) -> float | None:
        """1 - P*/P*_own in this model, both strokes carrying exactly the weight [-]; None where one cannot.

        An error that the model makes alike in both cancels.
        """
        return saved(self.hovering_power, self.own_hovering_power)

    @property
    def saving_as_published(self) -> float:
        """1 - P*/P*_own in this model, both as they are, whatever they carry [-]."""
        return 1 - self.specific_power / self.own_specific_power

    @property
    def saving_to_cfd(self) -> float | None:
        """1 - P*/P*_CFD, this stroke carrying the weight in this model and the insect's own in CFD [-].

        It holds the model's error against CFD as well as what is saved. None where only positive power is paid, too:
        CFD's power is what springs return, and less.
        """
        if self.problem.model.accounting == "positive":
            return None
        return saved(self.hovering_power, cfd_hovering_power(self.insect.cfd))

    @property
    def is_own(self) -> bool:
        """Whether the stroke is the insect's own but for rounding."""
        pairs = zip(vars(self.stroke).values(), vars(self.insect.stroke).values(), strict=True)
        return all(math.isclose(one, own, rel_tol=1e-4, abs_tol=1e-9) for one, own in pairs)

    @property
    def flags(self) -> tuple[str, ...]:
        """What lies outside the validated range, a sentence each."""
        return tuple(quantity.text for quantity in self.outside)

    def to_dict(self) -> dict[str, Any]:
        """The insect's entry of results.json: SI units, percent where a key says so."""
        return {
            "weight_support": self.weight_support,
            "specific_power": self.specific_power,
            "weight_uncertainty": self.weight_uncertainty,
            "power_uncertainty": self.power_uncertainty,
            "optimum_specific_power": self.best.specific_power if self.best.feasible else None,
            "lower_bound": self.best.lower_bound,
            "gap_percent": _percent(self.gap),
            "feasible": self.best.feasible,
            "max_weight_support": self.best.max_weight_support,
            "lift_shortfall": None if self.best.feasible else self.best.max_weight_support - self.weight_support,
            "cfd_specific_power": self.cfd_power,
            "model_weight_error_percent": _percent(self.errors.weight_support),
            "model_power_error_percent": _percent(self.errors.specific_power),
            "model_hovering_error_percent": _percent(self.errors.hovering_power),
            "own_stroke_weight_support": self.own_weight_support,
            "own_stroke_specific_power": self.own_specific_power,
            "hovering_power": self.hovering_power,
            "own_stroke_hovering_power": self.own_hovering_power,
            "saving_percent": _percent(self.saving),
            "saving_uncertainty_percent": _percent(self.saving_uncertainty),
            "saving_as_published_percent": _percent(self.saving_as_published),
            "saving_to_cfd_percent": _percent(self.saving_to_cfd),
            "outside_validated_range": list(self.flags),
            "beyond_box": [quantity.text for quantity in self.beyond_box],
            "other_models": [ranking.to_dict() for ranking in self.rankings],
            "stroke": {name: float(getattr(self.stroke, name)) for name in STROKE_PARAMETERS},
        }


def assess(
    insect: Insect | str, stroke: Stroke | None = None, problem: HoverProblem | str | None = None
) -> StrokeAssessment:
    """Judge a stroke of an insect.

    Args:
        insect: one insect, scalar fields, or a name of `INSECTS`.
        stroke: one stroke, scalar fields; the insect's own where None, which is the line of Table 3.
        problem: whose optimum, box and model count; problem A where None.

    Raises:
        TypeError: for arguments of another kind.
        ValueError: for what `evaluate` and `optimum` refuse.

    Source: Nabawy & Crowther (2014), Part II, section 3.3 and Table 3.
    """
    insect, problem = as_insect(insect), as_problem(problem)
    stroke = insect.stroke if stroke is None else stroke
    best, errors = optimum(insect, problem), model_errors(insect, problem.model)
    here = _assessed(insect, stroke, problem, best, errors)
    return dataclasses.replace(here, rankings=rankings(insect, stroke, problem.model))


def assess_another(known: StrokeAssessment, stroke: Stroke) -> StrokeAssessment:
    """Judge another stroke of an insect that was assessed: nothing is solved again, and no other model is asked.

    Args:
        known: any assessment of the insect in the problem.
        stroke: one stroke, scalar fields.

    Raises:
        ValueError: for what `evaluate` refuses.
    """
    return _assessed(known.insect, stroke, known.problem, known.best, known.errors)


def _assessed(
    insect: Insect,
    stroke: Stroke,
    problem: HoverProblem,
    best: Optimum,
    errors: ModelErrors,
) -> StrokeAssessment:
    """The stroke with all that is known of its insect, without other models."""
    with warnings.catch_warnings():
        warnings.filterwarnings("ignore", message=BEYOND_THEORY)  # `optimum` has said so
        here = ranked("", insect, stroke, problem.model)
    if not all(map(math.isfinite, (here.weight_support, here.specific_power))):
        raise ValueError(
            f"{insect.name}: Λ = {here.weight_support:.3g}, P* = {here.specific_power:.3g} W/kg of {stroke} are not "
            "finite; allowed: a stroke and a wing that animals or machines beat"
        )
    return StrokeAssessment(
        insect=insect,
        stroke=stroke,
        problem=problem,
        weight_support=here.weight_support,
        specific_power=here.specific_power,
        gap=best.gap(here.weight_support, here.specific_power),
        best=best,
        own_weight_support=here.own_weight_support,
        own_specific_power=here.own_specific_power,
        hovering_power=here.hovering_power,
        own_hovering_power=here.own_hovering_power,
        errors=errors,
        outside=outside_validated(insect, stroke, air_density=problem.model.air_density),
        beyond_box=outside_box(insect, stroke, problem.box),
        rankings=(),
    )


def _share(error: float | None, typical: float | None) -> float | None:
    """What correcting a number for the model's error changes it by, over the number; the typical error where None."""
    return typical if error is None else abs(1 - 1 / (1 + error))


def _percent(value: float | None) -> float | None:
    """A fraction in percent."""
    return None if value is None else 100 * value
