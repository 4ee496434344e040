"""The reward and the gaps: one batched objective for environments, agents and optimisers."""

import warnings
from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np

from flapenv.aero.accelerators import ACCELERATORS, Accelerator, plate_kernel
from flapenv.aero.arrays import as_arrays, as_like
from flapenv.aero.checks import record, require_name, shown
from flapenv.case import HoverCase
from flapenv.insects import Insect
from flapenv.optimum import gap_charge
from flapenv.performance import hover_averages
from flapenv.problem import HoverProblem
from flapenv.references import Flyers, GapTo

LEAST_PENALTY = 3.0
"""λ "auto" is at least this, so that an agent that explores feels missing lift."""
INFEASIBLE_PENALTY = 10.0
"""λ where no stroke carries the weight and the aim is the largest weight support."""
QUADRATURE_TOLERANCE = 1e-5
"""Of the averages an environment computes; in the default box they are ten times better, near single precision."""


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
        optimality_gap: P*/P*_opt - 1 + c max(0, 1 - Λ) [-]; 0 where there is none, see `has_gap`.
        has_gap: whether the optimum of the row's insect is known and hovers.
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
    has_gap: np.ndarray
    has_bound: np.ndarray


def penalised(
    weight_support: np.ndarray,
    specific_power: np.ndarray,
    reference: Mapping[str, np.ndarray],
    has_gap: np.ndarray,
    reward_floor: float,
) -> dict[str, np.ndarray]:
    """Reward, its terms and the gaps, by their names in `Score`; arrays of shape (n,).

    Args:
        weight_support: Λ [-].
        specific_power: P* [W/kg].
        reference: "bound" and "optimum" [W/kg], "penalty", "bound_charge" and "charge" of each row [-].
        has_gap: whether the optimum of the row is known.
        reward_floor: of the problem.
    """
    deficit = np.maximum(0, 1 - weight_support)
    power_term = -specific_power / reference["bound"]
    lift_term = -reference["penalty"] * deficit
    gap = specific_power / reference["optimum"] - 1 + reference["charge"] * deficit
    return {
        "lift_deficit": deficit,
        "power_term": power_term,
        "lift_term": lift_term,
        "reward": np.maximum(power_term + lift_term, reward_floor),
        "bound_gap": -power_term - 1 + reference["bound_charge"] * deficit,
        "optimality_gap": np.where(has_gap, gap, 0),
    }


class HoverObjective:
    """The exact-penalty objective -P*/P*_ref - λ max(0, 1-Λ) for a set of insects in one problem.

    P*_ref is each insect's proven lower bound, or its optimum where the coefficients leave no proof; λ exceeds the
    multiplier of its constrained optimum, which makes that optimum a maximum of the reward (an exact penalty;
    a quadratic one would settle short of the weight), and in the default problem the only one (docs/optimum.md). Optima
    are solved when the objective is made, once per process; scoring solves nothing.
    """

    def __init__(
        self,
        insects: Sequence[Insect] | Insect,
        problem: HoverProblem,
        dtype: Any = np.float64,
        *,
        gap_to: GapTo = "optimum",
        threads: int = 1,
        accelerator: Accelerator = "numpy",
        tolerance: float = QUADRATURE_TOLERANCE,
    ) -> None:
        """Solve the references of every insect.

        Args:
            insects: at least one, or a pool as `Flyers` takes it.
            problem: the box, the model and the reward's weights.
            dtype: of the arrays that `score` computes with.
            gap_to: as `Flyers` takes it.
            threads: how many work at once on large batches.
            tolerance: of the averages, relative.
            accelerator: what computes the averages, one of `flapenv.aero.accelerators.ACCELERATORS`.

        Raises:
            ValueError: as `Flyers` raises it, and for an accelerator that the type or the model has no use for.
            ImportError: where the accelerator is not installed.
        """
        self.problem, self.dtype, self.threads = problem, np.dtype(dtype), threads
        self.kernel = plate_kernel(require_name("accelerator", accelerator, ACCELERATORS))
        if accelerator != "numpy":
            self._require_use(accelerator)
        self.flyers = Flyers(insects, problem, gap_to=gap_to)
        self.rule = problem.box.time_rule(tolerance=tolerance)

        references = self.flyers.references
        feasible, bound = references.feasible, references.power
        best_power = np.where(np.isfinite(references.best_power), references.best_power, bound)
        self.lift_penalty = self._lift_penalty(feasible, references.multiplier / bound)
        self.gap_charge = gap_charge(references.multiplier, best_power)
        reference = {
            "bound": bound,
            "optimum": np.where(feasible, best_power, bound),
            "penalty": self.lift_penalty,
            "bound_charge": gap_charge(references.multiplier, bound),
            "charge": self.gap_charge,
        }
        self.reference = {name: value.astype(self.dtype) for name, value in reference.items()}
        self.has_gap = feasible & np.isfinite(references.best_power)
        self._cases = self.cases.spread((len(self.flyers),)).rows(slice(None), self.dtype)
        self._warn_of_a_flat_reward(np.where(feasible, best_power, 0) / bound)

    def _require_use(self, accelerator: str) -> None:
        """Refuse an accelerator that would change the precision or nothing at all."""
        if self.dtype.itemsize > 4:
            raise ValueError(
                f"accelerator = {shown(accelerator)} computes in single precision; allowed: dtype 'float32'"
            )
        model = self.problem.model
        if not model.is_plate or model.profile_drag or model.accounting == "positive":
            raise ValueError(
                f"accelerator = {shown(accelerator)} knows 'lifting-line' and 'extended-lifting-line' coefficients "
                f"without profile drag and with elastic power; allowed for problem {shown(self.problem.name)}: 'numpy'"
            )

    @property
    def cases(self) -> HoverCase:
        """The numbers of every insect."""
        return self.flyers.cases

    def _lift_penalty(self, feasible: np.ndarray, relative_multiplier: np.ndarray) -> np.ndarray:
        """λ of every insect, in units of its reference power."""
        wanted = self.problem.lift_penalty
        binding = feasible & np.isfinite(relative_multiplier)
        needed = np.where(binding, relative_multiplier, 0.0)
        if wanted == "auto":
            return np.where(binding, np.maximum(LEAST_PENALTY, 2 * needed), INFEASIBLE_PENALTY)
        for number in _few(np.flatnonzero(wanted < needed)):
            warnings.warn(
                f"lift_penalty = {wanted:g} is below the multiplier {needed[number]:.3g} of "
                f"{self.flyers.names[number]}: the reward's optimum will not carry the weight",
                stacklevel=4,
            )
        return np.full(len(self.flyers), float(wanted))

    def _warn_of_a_flat_reward(self, best: np.ndarray) -> None:
        """A best reward below the floor would leave nothing to learn from; best P*/P*_ref of every insect."""
        for number in _few(np.flatnonzero(-best <= self.problem.reward_floor)):
            warnings.warn(
                f"reward_floor = {self.problem.reward_floor:g} is above the reward {-best[number]:.3g} of the optimum "
                f"of {self.flyers.names[number]}: every stroke that hovers is paid the same; lower reward_floor",
                stacklevel=4,
            )

    def rows(self, index: np.ndarray) -> HoverCase:
        """The numbers of the insects at `index`, as arrays of the objective's type."""
        return self._cases.rows(index, None)

    def averages(self, index: np.ndarray, strokes: dict[str, Any]) -> tuple[Any, Any]:
        """Λ [-] and P* [W/kg] of one stroke for each row, arrays, or tensors that keep their gradient, shape (n,).

        Args:
            index: which insect each row is, shape (n,).
            strokes: the stroke's fields by name, each of shape (n,), inside the box.
        """
        options: dict[str, Any] = {"rule": self.rule, "threads": self.threads, "kernel": self.kernel}
        return hover_averages(self.rows(index), self.problem.model, **strokes, **options)

    def cost(self, index: np.ndarray, strokes: dict[str, Any]) -> tuple[Any, Any, Any]:
        """Λ, P* and P*/P*_ref + λ max(0, 1-Λ), the reward's negative without its floor; arguments as `averages`."""
        weight_support, specific_power = self.averages(index, strokes)
        bound, penalty = (as_like(specific_power, self.reference[name][index])[0] for name in ("bound", "penalty"))
        xp, deficit = as_arrays(1 - weight_support)
        return weight_support, specific_power, specific_power / bound + penalty * xp.clip(deficit, 0, None)

    def score(self, index: np.ndarray, strokes: dict[str, Any]) -> Score:
        """Score one stroke for each row.

        Args:
            index: which insect each row is, shape (n,).
            strokes: the stroke's fields by name, each of shape (n,), inside the box.

        Returns:
            Arrays of shape (n,).
        """
        weight_support, specific_power = self.averages(index, strokes)
        reference = {name: value[index] for name, value in self.reference.items()}
        has_gap = self.has_gap[index]
        return Score(
            weight_support=weight_support,
            specific_power=specific_power,
            **penalised(weight_support, specific_power, reference, has_gap, self.problem.reward_floor),
            has_gap=has_gap,
            has_bound=np.full(len(has_gap), self.problem.model.has_proven_bound),
        )


def _few(numbers: np.ndarray) -> list[int]:
    """At most eight of them: a pool is not warned about wing by wing."""
    return [int(number) for number in numbers[:8]]
