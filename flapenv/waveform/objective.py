"""The reward and the gaps of free waveforms: the exact-penalty objective of `flapenv.objective`, for splines."""

import warnings
from collections.abc import Sequence
from typing import Any, NamedTuple

import numpy as np

from flapenv.case import hover_case, stack_cases
from flapenv.insects import Insect
from flapenv.objective import INFEASIBLE_PENALTY, LEAST_PENALTY, penalised
from flapenv.optimum import gap_charge, lower_bound
from flapenv.problem import HoverProblem
from flapenv.waveform.coordinates import Waveform, WaveformCoordinates
from flapenv.waveform.largest_lift import largest_weight_support
from flapenv.waveform.performance import waveform_performance
from flapenv.waveform.shipped import KnownOptimum, known_optimum, shipped_waveforms


class WaveformScore(NamedTuple):
    """How a batch of waveforms did; arrays of shape (rows,).

    Attributes:
        weight_support: Λ [-].
        specific_power: P* [W/kg].
        lift_deficit: max(0, 1 - Λ) [-].
        power_term: -P*/P*_ref [-].
        lift_term: -λ max(0, 1 - Λ) [-].
        reward: the sum of both terms, not below the problem's floor [-].
        bound_gap: P* over the proven bound, minus one, plus the charge for missing lift [-].
        optimality_gap: P* over the best waveform of as many knots, alike [-]; 0 where that is not known.
        known: whether it is.
        half_cycle: as `peak_rates` takes it [knots].
    """

    weight_support: np.ndarray
    specific_power: np.ndarray
    lift_deficit: np.ndarray
    power_term: np.ndarray
    lift_term: np.ndarray
    reward: np.ndarray
    bound_gap: np.ndarray
    optimality_gap: np.ndarray
    known: np.ndarray
    half_cycle: np.ndarray


class WaveformObjective:
    """-P*/P*_ref - λ max(0, 1-Λ) for a set of insects; P*_ref is the proven lower bound of each.

    λ "auto" is max(3, twice the multiplier of the best waveform of as many knots): from the table of shipped
    waveforms, or, where f is free and n is not in the table, from the row of the next smaller n, which needs more
    power. Where nothing is known of a wing λ is the one of infeasible wings. Nothing is searched for.

    Attributes:
        cases: the insects' numbers.
        bound: P*_ref [W/kg].
        known: the best waveform of each insect, or None.
        largest_weight_support: Λ of the waveform of the largest lift [-].
        lift_penalty: λ [-].
    """

    def __init__(
        self, insects: Sequence[Insect], problem: HoverProblem, coordinates: WaveformCoordinates, dtype: Any
    ) -> None:
        """Collect the references of every insect."""
        self.problem, self.dtype = problem, np.dtype(dtype)
        single = [hover_case(insect, problem.model) for insect in insects]
        self.cases = stack_cases(single)
        self.bound = np.asarray(lower_bound(self.cases, problem), dtype=float)
        self.known: tuple[KnownOptimum | None, ...] = tuple(
            known_optimum(case, problem, coordinates.knots) for case in single
        )
        self.largest_weight_support = np.asarray(largest_weight_support(self.cases, problem, coordinates))
        multiplier = np.array([0.0 if best is None else best.multiplier for best in self.known])
        power = np.array([1.0 if best is None else best.specific_power for best in self.known])
        known = np.array([best is not None for best in self.known])
        coarser = [_multiplier_of_fewer_knots(case, problem, coordinates.knots) for case in single]
        auto = np.maximum(LEAST_PENALTY, 2 * np.where(known, multiplier, coarser) / self.bound)
        auto = np.where((self.largest_weight_support < 1) | ~np.isfinite(auto), INFEASIBLE_PENALTY, auto)
        wanted = problem.lift_penalty
        self.lift_penalty = auto if isinstance(wanted, str) else np.full(len(single), wanted)
        for insect, relative, own in zip(insects, multiplier / self.bound, self.lift_penalty, strict=True):
            if own < relative:
                warnings.warn(
                    f"lift_penalty = {own:g} is below the multiplier {relative:.3g} of {insect.name}: the reward's "
                    "optimum will not carry the weight",
                    stacklevel=4,
                )
        reference = {
            "bound": self.bound,
            "optimum": power,
            "penalty": self.lift_penalty,
            "bound_charge": gap_charge(multiplier, self.bound),
            "charge": gap_charge(multiplier, power),
        }
        self._reference = {name: value.astype(self.dtype) for name, value in reference.items()}
        self._is_known = known
        self._typed = self.cases.rows(..., self.dtype)

    def score(self, index: np.ndarray, waveform: Waveform) -> WaveformScore:
        """Score one waveform for each row.

        Args:
            index: which insect each row is, shape (rows,).
            waveform: fields of shape (rows,) and (rows, n).
        """
        case = self._typed.rows(index, self.dtype)
        weight_support, specific_power, half_cycle = waveform_performance(case, self.problem.model, waveform)
        own = {name: value[index] for name, value in self._reference.items()}
        known = self._is_known[index]
        return WaveformScore(
            weight_support=weight_support,
            specific_power=specific_power,
            **penalised(weight_support, specific_power, own, known, self.problem.reward_floor),
            known=known,
            half_cycle=half_cycle,
        )


def _multiplier_of_fewer_knots(case: Any, problem: HoverProblem, knots: int) -> float:
    """dP*/dΛ of the best waveform of the most knots in the table that are fewer [W/kg]; inf where there is none."""
    for fewer in sorted({row.knots for row in shipped_waveforms() if row.knots < knots}, reverse=True):
        best = known_optimum(case, problem, fewer)
        if best is not None:
            return best.multiplier
    return float("inf")
