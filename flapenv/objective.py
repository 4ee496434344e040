"""The reward and the gaps: one batched objective for environments, agents and optimisers."""

import warnings
from collections.abc import Sequence
from typing import Any

import numpy as np

from flapenv.aero.checks import record
from flapenv.case import HoverCase, hover_case, stack_cases
from flapenv.insects import Insect
from flapenv.optimum import Optimum, optimum
from flapenv.performance import hover_averages
from flapenv.problem import HoverProblem

LEAST_PENALTY = 3.0
"""λ "auto" is at least this, so that an agent that explores feels missing lift."""
INFEASIBLE_PENALTY = 10.0
"""λ where no stroke carries the weight and the aim is the largest weight support."""
LEAST_GAP_WEIGHT = 10.0
"""The gap charges missing weight support at least this many times its fraction."""
QUADRATURE_TOLERANCE = 1e-6
"""Of the averages an environment computes, a little above single precision."""


@record
class Score:
    """How a batch of strokes did; arrays of shape (n,).

    Attributes:
        weight_support: Λ [-].
        specific_power: P* [W/kg].
        lift_deficit: max(0, 1 - Λ) [-].
        power_term: -P*/P*_ref [-].
        lift_term: -λ max(0, 1 - Λ) [-].
        reward: the sum of both terms, not below the problem's floor [-].
        bound_gap: P* over the proven bound, minus one, plus the charge for missing lift [-]; see `has_bound`.
        optimality_gap: P*/P*_opt - 1 + c max(0, 1 - Λ) [-]; 0 where infeasible, see `feasible`.
        feasible: whether the insect of the row can hover in the box at all.
        has_bound: whether a bound is proven; without one bound_gap is measured from the best stroke.
    """

    weight_support: np.ndarray
    specific_power: np.ndarray
    lift_deficit: np.ndarray
    power_term: np.ndarray
    lift_term: np.ndarray
    reward: np.ndarray
    bound_gap: np.ndarray
    optimality_gap: np.ndarray
    feasible: np.ndarray
    has_bound: np.ndarray


class HoverObjective:
    """The exact-penalty objective -P*/P*_ref - λ max(0, 1-Λ) for a set of insects in one problem.

    P*_ref is each insect's proven lower bound, or its optimum where the coefficients leave no proof; λ exceeds the
    multiplier of its constrained optimum, which makes that optimum a maximum of the reward (an exact penalty;
    a quadratic one would settle short of the weight), and in the default problem the only one (docs/optimum.md). Optima
    are solved when the objective is made, once per process; scoring solves nothing.
    """

    def __init__(self, insects: Sequence[Insect], problem: HoverProblem, dtype: Any = np.float64) -> None:
        """Solve the references of every insect.

        Args:
            insects: at least one.
            problem: the box, the model and the reward's weights.
            dtype: of the arrays that `score` computes with.
        """
        self.insects, self.problem, self.dtype = tuple(insects), problem, np.dtype(dtype)
        self.optima: tuple[Optimum, ...] = tuple(optimum(insect, problem) for insect in self.insects)
        self.cases = stack_cases([hover_case(insect, problem.model) for insect in self.insects])
        self.rule = problem.box.time_rule(tolerance=QUADRATURE_TOLERANCE)

        feasible = np.array([best.feasible for best in self.optima])
        bound = np.array([best.reference_power for best in self.optima])
        best_power = np.array([best.specific_power for best in self.optima])
        multiplier = np.array([best.multiplier for best in self.optima])
        self.lift_penalty = self._lift_penalty(feasible, multiplier / bound)
        charge = np.where(np.isfinite(multiplier), multiplier, 0.0)
        self.gap_charge = np.maximum(LEAST_GAP_WEIGHT, 2 * charge / best_power)
        reference = {
            "bound": bound,
            "optimum": np.where(feasible, best_power, bound),
            "penalty": self.lift_penalty,
            "bound_charge": np.maximum(LEAST_GAP_WEIGHT, 2 * charge / bound),
            "charge": self.gap_charge,
        }
        self._reference = {name: value.astype(self.dtype) for name, value in reference.items()}
        self._feasible = feasible
        self._warn_of_a_flat_reward()

    def _lift_penalty(self, feasible: np.ndarray, relative_multiplier: np.ndarray) -> np.ndarray:
        """λ of every insect, in units of its reference power."""
        wanted = self.problem.lift_penalty
        binding = feasible & np.isfinite(relative_multiplier)
        if wanted == "auto":
            exact = np.maximum(LEAST_PENALTY, 2 * np.where(binding, relative_multiplier, 0.0))
            return np.where(binding, exact, INFEASIBLE_PENALTY)
        for insect, multiplier in zip(self.insects, np.where(binding, relative_multiplier, 0.0), strict=True):
            if wanted < multiplier:
                warnings.warn(
                    f"lift_penalty = {wanted:g} is below the multiplier {multiplier:.3g} of {insect.name}: the "
                    "reward's optimum will not carry the weight",
                    stacklevel=4,
                )
        return np.full(len(self.insects), float(wanted))

    def _warn_of_a_flat_reward(self) -> None:
        """A best reward below the floor would leave nothing to learn from."""
        for best in self.optima:
            reward = -best.specific_power / best.reference_power
            if best.feasible and reward <= self.problem.reward_floor:
                warnings.warn(
                    f"reward_floor = {self.problem.reward_floor:g} is above the reward {reward:.3g} of the optimum of "
                    f"{best.insect}: every stroke that hovers is paid the same; lower reward_floor",
                    stacklevel=4,
                )

    def rows(self, index: np.ndarray) -> HoverCase:
        """The numbers of the insects at `index`, as arrays of the objective's type."""
        return self.cases.rows(index, self.dtype)

    def score(self, index: np.ndarray, strokes: dict[str, Any]) -> Score:
        """Score one stroke for each row.

        Args:
            index: which insect each row is, shape (n,).
            strokes: the stroke's fields by name, each of shape (n,), inside the box.

        Returns:
            Arrays of shape (n,).
        """
        weight_support, specific_power = hover_averages(self.rows(index), self.problem.model, **strokes, rule=self.rule)
        reference = {name: value[index] for name, value in self._reference.items()}
        feasible = self._feasible[index]
        deficit = np.maximum(0, 1 - weight_support)
        power_term = -specific_power / reference["bound"]
        lift_term = -reference["penalty"] * deficit
        gap = specific_power / reference["optimum"] - 1 + reference["charge"] * deficit
        return Score(
            weight_support=weight_support,
            specific_power=specific_power,
            lift_deficit=deficit,
            power_term=power_term,
            lift_term=lift_term,
            reward=np.maximum(power_term + lift_term, self.problem.reward_floor),
            bound_gap=-power_term - 1 + reference["bound_charge"] * deficit,
            optimality_gap=np.where(feasible, gap, 0),
            feasible=feasible,
            has_bound=np.full(len(feasible), self.problem.model.has_proven_bound),
        )

    def gap(self, number: int, weight_support: float, specific_power: float) -> float | None:
        """The gap of one evaluated stroke of insect `number` to its optimum [-]; None where it is infeasible."""
        best = self.optima[number]
        if not best.feasible:
            return None
        deficit = max(0.0, 1 - weight_support)
        return specific_power / best.specific_power - 1 + float(self.gap_charge[number]) * deficit
