"""A stroke of an insect beside everything that is known: optimum, bound, own stroke, CFD, other models."""

import dataclasses
import functools
import math
import warnings
from typing import Any

from flapenv.aero.checks import record
from flapenv.aero.parameters import STROKE_PARAMETERS
from flapenv.aero.stroke import Stroke
from flapenv.assessment.hovering import hovering
from flapenv.assessment.rankings import Ranking, rankings
from flapenv.assessment.validity import Quantity, outside_box, outside_validated
from flapenv.insects import INSECTS, Insect, as_insect, load_insect
from flapenv.model import HoverModel
from flapenv.optimum import Optimum, optimum
from flapenv.performance import evaluate
from flapenv.problem import HoverProblem, as_problem


@record
class StrokeAssessment:
    """What a stroke of an insect is worth.

    The model's own error against CFD at the insect's stroke is taken as the uncertainty of the power it gives for any
    other stroke: nobody has run CFD there.

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
        model_error: P*_model/P*_CFD - 1 at the insect's own stroke [-]; None where there is no CFD.
        uncertainty: of `specific_power`, relative [-]: |model_error|, or the root mean square of the eight insects'
            where there is no CFD.
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
    model_error: float | None
    uncertainty: float
    outside: tuple[Quantity, ...]
    beyond_box: tuple[Quantity, ...]
    rankings: tuple[Ranking, ...]

    @property
    def power_uncertainty(self) -> float:
        """Of P* [W/kg]."""
        return self.uncertainty * self.specific_power

    @property
    def cfd_power(self) -> float | None:
        """P* that CFD found for the insect's own stroke [W/kg]; None where there is no CFD."""
        return self.insect.cfd.specific_power if self.insect.cfd else None

    @property
    def saving(self) -> float | None:
        """1 - P*/P*_own in this model, both strokes carrying exactly the weight [-]; None where one cannot."""
        return _saved(self.hovering_power, self.own_hovering_power)

    @property
    def saving_as_published(self) -> float:
        """1 - P*/P*_own in this model, both as they are, whatever they carry [-]."""
        return 1 - self.specific_power / self.own_specific_power

    @property
    def saving_to_cfd(self) -> float | None:
        """1 - P*/P*_CFD, this stroke carrying the weight in this model and the insect's own in CFD [-].

        None where only positive power is paid, too: CFD's power is what springs return, and less.
        """
        if self.problem.model.accounting == "positive":
            return None
        return _saved(self.hovering_power, self.cfd_power)

    @property
    def saving_uncertainty(self) -> float | None:
        """Of `saving_to_cfd` [-]."""
        saving = self.saving_to_cfd
        return None if saving is None else self.uncertainty * (1 - saving)

    @property
    def flags(self) -> tuple[str, ...]:
        """What lies outside the validated range, a sentence each."""
        return tuple(quantity.text for quantity in self.outside)

    def to_dict(self) -> dict[str, Any]:
        """The insect's entry of results.json: SI units, percent where a key says so."""
        return {
            "weight_support": self.weight_support,
            "specific_power": self.specific_power,
            "power_uncertainty": self.power_uncertainty,
            "optimum_specific_power": self.best.specific_power if self.best.feasible else None,
            "lower_bound": self.best.lower_bound,
            "gap_percent": _percent(self.gap),
            "feasible": self.best.feasible,
            "max_weight_support": self.best.max_weight_support,
            "lift_shortfall": None if self.best.feasible else self.best.max_weight_support - self.weight_support,
            "cfd_specific_power": self.cfd_power,
            "model_error_percent": _percent(self.model_error),
            "own_stroke_weight_support": self.own_weight_support,
            "own_stroke_specific_power": self.own_specific_power,
            "hovering_power": self.hovering_power,
            "own_stroke_hovering_power": self.own_hovering_power,
            "saving_percent": _percent(self.saving),
            "saving_as_published_percent": _percent(self.saving_as_published),
            "saving_to_cfd_percent": _percent(self.saving_to_cfd),
            "saving_to_cfd_uncertainty_percent": _percent(self.saving_uncertainty),
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
    stroke, model = insect.stroke if stroke is None else stroke, problem.model
    judged, own = evaluate(insect, stroke, **vars(model)), evaluate(insect, **vars(model))
    best = optimum(insect, problem)
    carried, own_carried = (hovering(insect, one, model) for one in (stroke, insect.stroke))
    error = model_error(insect, model)
    return StrokeAssessment(
        insect=insect,
        stroke=stroke,
        problem=problem,
        weight_support=judged.weight_support,
        specific_power=judged.specific_power,
        gap=best.gap(judged.weight_support, judged.specific_power),
        best=best,
        own_weight_support=own.weight_support,
        own_specific_power=own.specific_power,
        hovering_power=carried.specific_power if carried else None,
        own_hovering_power=own_carried.specific_power if own_carried else None,
        model_error=error,
        uncertainty=typical_error(model) if error is None else abs(error),
        outside=outside_validated(insect, stroke, air_density=model.air_density),
        beyond_box=outside_box(insect, stroke, problem.box),
        rankings=rankings(insect, stroke, model),
    )


def model_error(insect: Insect, model: HoverModel) -> float | None:
    """P*_model/P*_CFD - 1 at the insect's own stroke, with the springs that CFD's power has [-]; None without CFD."""
    if insect.cfd is None or insect.cfd.specific_power is None:
        return None
    elastic = dataclasses.replace(model, accounting="elastic")
    with warnings.catch_warnings():
        warnings.filterwarnings("ignore", message=".*outside the range of the")  # its error is what is asked for
        return evaluate(insect, **vars(elastic)).specific_power / insect.cfd.specific_power - 1


@functools.lru_cache(maxsize=256)
def typical_error(model: HoverModel) -> float:
    """Root mean square of `model_error` over the CFD cases that the model knows [-]."""
    insects = [load_insect(name) for name in INSECTS]
    if model.coefficients == "berman-wang":
        insects = [insect for insect in insects if insect.force_constants is not None]
    errors = [error for insect in insects if (error := model_error(insect, model)) is not None]
    return math.sqrt(sum(error**2 for error in errors) / len(errors))


def _saved(power: float | None, own: float | None) -> float | None:
    """What of `own` is saved [-]; None where one is not known."""
    return None if power is None or own is None else 1 - power / own


def _percent(value: float | None) -> float | None:
    """A fraction in percent."""
    return None if value is None else 100 * value
