"""What a policy learned beside the proven optimum and CFD: evaluation, table and results."""

from collections.abc import Sequence
from typing import Any

import numpy as np

from agents.predictor import Predictor, begin
from flapenv.aero.checks import record
from flapenv.aero.parameters import STROKE_PARAMETERS
from flapenv.aero.stroke import Stroke
from flapenv.envs import HoverVectorEnv
from flapenv.insects import Insect
from flapenv.optimum import Optimum
from flapenv.performance import evaluate
from flapenv.problem import HoverProblem
from flapenv.tables import text_table


@record
class InsectResult:
    """A learned stroke of one insect beside its references.

    Attributes:
        insect: the insect.
        stroke: the learned stroke.
        weight_support: Λ of the learned stroke [-].
        specific_power: P* of the learned stroke [W/kg].
        gap: to the optimum of the box, missing weight charged [-]; None where no stroke carries the weight.
        best: the optimum of the box with its proven bound.
        own_weight_support: Λ of the model at the insect's own stroke [-].
        own_specific_power: P* of the model at the insect's own stroke [W/kg].
    """

    insect: Insect
    stroke: Stroke
    weight_support: float
    specific_power: float
    gap: float | None
    best: Optimum
    own_weight_support: float
    own_specific_power: float

    def to_dict(self) -> dict[str, Any]:
        """The entry of results.json."""
        return {
            "weight_support": self.weight_support,
            "specific_power": self.specific_power,
            "optimum_specific_power": self.best.specific_power if self.best.feasible else None,
            "lower_bound": self.best.lower_bound,
            "gap_percent": None if self.gap is None else 100 * self.gap,
            "feasible": self.best.feasible,
            "max_weight_support": self.best.max_weight_support,
            "lift_shortfall": None if self.best.feasible else self.best.max_weight_support - self.weight_support,
            "cfd_specific_power": self.insect.cfd.specific_power if self.insect.cfd else None,
            "own_stroke_weight_support": self.own_weight_support,
            "own_stroke_specific_power": self.own_specific_power,
            "stroke": {name: float(getattr(self.stroke, name)) for name in STROKE_PARAMETERS},
        }


class Comparison:
    """Evaluates policies on every insect of a problem, without noise and in double precision."""

    def __init__(self, insects: Sequence[Insect], problem: HoverProblem) -> None:
        """Make one row for each insect; names must differ."""
        self.env = HoverVectorEnv(
            len(insects),
            insect=list(insects),
            problem=problem,
            autoreset_mode="DISABLED",
            dtype="float64",
        )
        self.names = list(self.env.flyers.names)

    def beat(self, policy: Predictor) -> dict[str, np.ndarray]:
        """The infos of one wingbeat of every insect."""
        observations, _ = self.env.reset(options={"insect": self.names})
        begin(policy)
        actions, _ = policy.predict(observations, deterministic=True)
        return self.env.step(actions)[-1]

    def gaps(self, policy: Predictor) -> np.ndarray:
        """Gap of every feasible insect [-]."""
        info = self.beat(policy)
        return np.asarray(info["optimality_gap"][info["_optimality_gap"]])

    def results(self, policy: Predictor) -> list[InsectResult]:
        """Every insect's learned stroke, evaluated afresh through `flapenv.evaluate`."""
        info, objective = self.beat(policy), self.env.objective
        options = vars(self.env.problem.model)
        results = []
        for number in range(len(self.names)):
            insect = self.env.flyers[number]
            stroke = Stroke(**{name: float(info[f"stroke/{name}"][number]) for name in STROKE_PARAMETERS})
            learned, own = evaluate(insect, stroke, **options), evaluate(insect, **options)
            results.append(
                InsectResult(
                    insect=insect,
                    stroke=stroke,
                    weight_support=learned.weight_support,
                    specific_power=learned.specific_power,
                    gap=objective.gap(number, learned.weight_support, learned.specific_power),
                    best=objective.flyers.optima[number],
                    own_weight_support=own.weight_support,
                    own_specific_power=own.specific_power,
                )
            )
        return results


def mean_gap(results: Sequence[InsectResult]) -> float | None:
    """Mean gap of the feasible insects [-]; None where there is none."""
    gaps = [result.gap for result in results if result.gap is not None]
    return float(np.mean(gaps)) if gaps else None


def worst_gap(results: Sequence[InsectResult]) -> float | None:
    """Largest gap of the feasible insects [-]; None where there is none."""
    return max((result.gap for result in results if result.gap is not None), default=None)


def comparison_table(results: Sequence[InsectResult]) -> str:
    """The table people read: learned against optimal, proven bound, and what the insect's own stroke needs."""
    header = ("insect", "weight", "learned", "optimum", "bound", "gap", "own stroke:", "CFD", "model", "weight")
    units = ("", "support", "W/kg", "W/kg", "W/kg", "%", "", "W/kg", "W/kg", "support")
    rows = [header, units]
    for result in results:
        best, cfd = result.best, result.insect.cfd
        rows.append(
            (
                result.insect.name,
                f"{result.weight_support:.4f}",
                f"{result.specific_power:.2f}",
                f"{best.specific_power:.2f}" if best.feasible else "none",
                "none" if best.lower_bound is None else f"{best.lower_bound:.2f}",
                "none" if result.gap is None else f"{100 * result.gap:.2f}",
                "",
                "none" if cfd is None or cfd.specific_power is None else f"{cfd.specific_power:.0f}",
                f"{result.own_specific_power:.1f}",
                f"{result.own_weight_support:.3f}",
            )
        )
    lines = [text_table(rows, header_rows=2)]
    gaps = [result.gap for result in results if result.gap is not None]
    if gaps:
        lines.append(f"gap to the optimum: mean {100 * np.mean(gaps):.3f} %, worst {100 * max(gaps):.3f} %")
    lines.extend(
        f"{result.insect.name} is INFEASIBLE: no stroke of the box supports more than "
        f"{result.best.max_weight_support:.3f} of its weight; learned {result.weight_support:.3f}"
        for result in results
        if not result.best.feasible
    )
    return "\n".join(lines)
