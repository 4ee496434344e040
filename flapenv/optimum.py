"""The least power that hovers: a proven lower bound, and the best stroke of the box found and verified.

The bound holds for the paper's coefficients (2.7), (2.12) with profile drag or without, "elastic" power, a horizontal
stroke plane, and every waveform φ(t), θ(t) within the limits that `lower_bound` states; proofs in docs/optimum.md.
"""

import functools
import math
from typing import Any

import numpy as np

from flapenv.aero.checks import is_single, record
from flapenv.aero.stroke import Stroke
from flapenv.case import HoverCase, hover_case, lift_constant
from flapenv.insects import Insect, as_insect
from flapenv.model import warn_of_aspect_ratio
from flapenv.performance import yardstick
from flapenv.problem import HoverProblem, as_problem
from flapenv.search import CANDIDATES, SAMPLES, STARTS, WEIGHT_TOLERANCE, Search, spread
from flapenv.simulation import evaluate_by_blade_element

ORACLE_STEPS = (40_000, 1_000_000)
"""Instants a cycle of the oracle that confirms an optimum; the second where waveforms are too sharp for the first."""
ORACLE_TOLERANCE = 1e-5
"""Relative difference up to which the refined oracle confirms an optimum."""
NEXT_TO_NOTHING = 1e-4
"""Lift and power that are not compared digit for digit, over the yardstick stroke's."""
LEAST_GAP_CHARGE = 10.0
"""The gap charges missing weight support at least this many times its fraction."""
ROUGH_TOLERANCE = 2e-4
"""The same for coefficients that jump or have corners, and for power that is only paid where positive."""


@record
class Optimum:
    """The least power for hovering within a box.

    Attributes:
        insect: its name.
        feasible: whether any stroke of the box carries the weight.
        stroke: the best stroke of the box; the one with the largest lift where none carries the weight.
        weight_support: Λ of that stroke [-].
        specific_power: P* of that stroke [W/kg].
        lower_bound: proven: no stroke of the box hovers with less, nor any waveform in `lower_bound`'s scope [W/kg];
            None where the coefficients leave no proof.
        max_weight_support: Λ_max, the largest Λ in the box [-].
        multiplier: dP*/dΛ of the optimum, what a unit of weight support costs [W/kg]; 0 where the weight does not
            bind, inf at the limit of lift.
        sensitivity: ∂P*/∂x - multiplier ∂Λ/∂x for every parameter of the stroke: what a unit of it costs while the
            weight stays carried [W/kg per SI unit]; 0 for a free parameter inside its bounds, the multiplier of the
            bound for one on it. Empty where the multiplier is infinite.
        active_bounds: name and "lower" or "upper" of every parameter that lies on a bound.
        oracle_weight_support: Λ of the stroke by the refined blade-element oracle [-].
        oracle_specific_power: P* by the same [W/kg].
        wingbeats: strokes evaluated by the search.
        verification: how the stroke was found and checked, in words.
    """

    insect: str
    feasible: bool
    stroke: Stroke
    weight_support: float
    specific_power: float
    lower_bound: float | None
    max_weight_support: float
    multiplier: float
    sensitivity: dict[str, float]
    active_bounds: tuple[tuple[str, str], ...]
    oracle_weight_support: float
    oracle_specific_power: float
    wingbeats: int
    verification: str

    @property
    def gap_to_bound(self) -> float | None:
        """P* over the lower bound, minus one [-]; None where no bound is proven."""
        return None if self.lower_bound is None else self.specific_power / self.lower_bound - 1

    def gap(self, weight_support: float, specific_power: float) -> float | None:
        """How far another stroke is off [-]: P*/P*_opt - 1 + c max(0, 1-Λ); None where the optimum is infeasible.

        Args:
            weight_support: Λ of the stroke [-].
            specific_power: P* of the stroke [W/kg].
        """
        if not self.feasible:
            return None
        charge = float(gap_charge(self.multiplier, self.specific_power))
        return specific_power / self.specific_power - 1 + charge * max(0.0, 1 - weight_support)

    @property
    def reference_power(self) -> float:
        """What powers are measured in: the proven bound, or P* of the stroke where none is proven [W/kg]."""
        return self.specific_power if self.lower_bound is None else self.lower_bound


def gap_charge(multiplier: np.ndarray | float, power: np.ndarray | float) -> np.ndarray:
    """C = max(10, 2 multiplier/power), what a gap charges for missing weight support, so that dropping never pays [-].

    Args:
        multiplier: dP*/dΛ of the optimum [W/kg]; one that is infinite, at the limit of lift, counts as 0.
        power: what the gap is measured in [W/kg].
    """
    finite = np.where(np.isfinite(multiplier), multiplier, 0.0)
    return np.maximum(LEAST_GAP_CHARGE, 2 * finite / power)


def lower_bound(case: HoverCase, problem: HoverProblem) -> np.ndarray | float | None:
    """Least P* that any waveform within the limits of the problem can hover with, proven [W/kg].

    With A_L = Λ/⟨v² sin 2α⟩, A_P = P*/⟨v³ (e/2 + sin² α)⟩, e = C_D0/C_T, at the largest C_T of the box, the larger of

        A_P h(α₀) A_L^(-1.5),  h(α) = (e/2 + sin² α)/(sin 2α)^1.5     for α_min <= α(t) <= 180° - α_min and any φ(t);
        A_P/(4 A_L² v̄_max)                                          for any α(t) and mean speeds up to v̄_max = 4 f φmax.

    α₀ is the least h's angle from α_min up: α_min itself unless profile drag puts it higher. The first, which is the
    larger in the default box, holds for every waveform, the second for those that reverse once at each end of the
    stroke, as all of (2.1) do: more reversals would raise the mean speed beyond 4 f φmax.
    Both decrease with C_T, which grows with φmax and with f, so its largest value in the box serves every stroke.

    Args:
        case: one insect's numbers or several (array fields).
        problem: the box and the model.

    Returns:
        The bound, of the case's shape; None for coefficients other than (2.7), (2.12) and profile drag, for which no
        bound is proven.
    """
    if not problem.model.has_proven_bound:
        return None
    amplitude = problem.box.bounds("flap_amplitude", case.reference)[1]
    speed = 4 * problem.box.bounds("frequency", case.reference)[1] * amplitude
    constant = lift_constant(case, problem.model, speed, amplitude)
    lift_factor = case.lift_scale * constant
    power_factor = 2 * case.power_scale * constant
    ratio = problem.model.profile_drag / constant
    alpha = np.maximum(problem.min_angle_of_attack, _free_angle(ratio))
    friction = 1 + ratio / 2 / np.maximum(np.sin(alpha) ** 2, np.finfo(float).tiny)
    angle_bound = power_factor * lift_factor**-1.5 * 2**-1.5 * np.sqrt(np.tan(alpha)) / np.cos(alpha) * friction
    speed_bound = power_factor / (4 * lift_factor**2 * speed)
    return np.maximum(angle_bound, speed_bound)


def _free_angle(ratio: np.ndarray | float) -> np.ndarray | float:
    """The angle of the least (e/2 + sin² α)/(sin 2α)^1.5, cos 2α = (3(1+e) - √(9(1+e)² - 8))/2 [rad]; e = C_D0/C_T."""
    sum_ = 3 * (1 + np.asarray(ratio))
    return np.arccos(np.minimum(1.0, (sum_ - np.sqrt(sum_**2 - 8)) / 2)) / 2


def optimum(insect: Insect | str, problem: HoverProblem | str | None = None) -> Optimum:
    """The least power with which an insect can hover in a problem's box, solved once per (insect, problem).

    Args:
        insect: one insect (scalar fields) or a name of `INSECTS`.
        problem: a `HoverProblem` or a name of `PROBLEMS`; problem A where None.

    Returns:
        The bound, the best stroke and how it was verified. An infeasible box comes back with feasible=False and
        Λ_max, never as an error.

    Raises:
        TypeError: for arguments of another kind, or an insect with array fields.
        ValueError: for an unknown name.
        ArithmeticError: if the refined oracle does not confirm the stroke to 1e-5 (2e-4 for robofly or a function).

    Source: bounds by Jensen's and Cauchy-Schwarz' inequalities (docs/optimum.md); stroke by SLSQP from several starts.
    """
    insect, problem = as_insect(insect), as_problem(problem)
    if not is_single(insect):
        raise TypeError("insect has array fields; allowed: one insect with scalar fields")
    problem.require_suitable(insect.name, insect.reference)
    return _solve(insect, problem)


@functools.lru_cache(maxsize=1024)
def _solve(insect: Insect, problem: HoverProblem) -> Optimum:
    """Search, then verify; a warning about the wing comes once, as the answer is kept."""
    warn_of_aspect_ratio(insect.name, insect.wing.aspect_ratio, problem.model, stacklevel=4)
    search = Search(insect, problem)
    samples = search.samples()
    weight, power = search.evaluate(samples)
    best_lift = search.minimise("lift", spread(samples[np.argsort(-weight)[:CANDIDATES]]))
    max_weight_support = float(search.evaluate(best_lift)[0])
    feasible = max_weight_support >= 1 - WEIGHT_TOLERANCE
    point = best_lift
    if feasible:
        merit = np.log(power) + 4 * np.maximum(0, 1 - weight)
        starts = np.concatenate([spread(samples[np.argsort(merit)[:CANDIDATES]]), best_lift[None]])
        point = search.settle(search.minimise("power", starts))
    weight_support, specific_power = (float(value) for value in search.evaluate(point))
    stroke = search.stroke(point)
    bound = lower_bound(search.case, problem)
    multiplier = search.multiplier(point) if feasible else math.inf
    checked = _confirmed(insect, stroke, problem, (weight_support, specific_power))
    difference = abs(checked[1] / specific_power - 1)
    return Optimum(
        insect=insect.name,
        feasible=feasible,
        stroke=stroke,
        weight_support=weight_support,
        specific_power=specific_power,
        lower_bound=None if bound is None else float(bound),
        max_weight_support=max(max_weight_support, weight_support),
        multiplier=multiplier,
        sensitivity=search.sensitivity(stroke, multiplier) if math.isfinite(multiplier) else {},
        active_bounds=search.active_bounds(stroke),
        oracle_weight_support=checked[0],
        oracle_specific_power=checked[1],
        wingbeats=search.wingbeats,
        verification=(
            f"SLSQP from {STARTS + 1} starts out of {SAMPLES} strokes; the refined blade element differs by "
            f"{difference:.0e}"
        ),
    )


def _confirmed(
    insect: Insect, stroke: Stroke, problem: HoverProblem, found: tuple[float, float]
) -> tuple[float, float]:
    """Λ and P* of the stroke by the oracle, refined until it agrees with what the search found."""
    checked = found
    squared = problem.model.accounting == "positive"  # added mass goes with the chord squared
    rough = squared or callable(problem.model.coefficients) or problem.model.coefficients == "robofly"
    tolerance = ROUGH_TOLERANCE if rough else ORACLE_TOLERANCE
    span: dict[str, Any] = {"strips": 24, "spacing": "graded"} if squared else {"strips": 6, "spacing": "gauss"}
    # a stroke that feathers all the way lifts and costs next to nothing, and only at its thinnest instants
    least = np.array(yardstick(hover_case(insect, problem.model), problem.model)) * NEXT_TO_NOTHING
    for steps in ORACLE_STEPS:
        checked = evaluate_by_blade_element(insect, stroke, **span, steps=steps, **vars(problem.model))
        nothing = np.maximum(np.abs(checked), np.abs(found)) <= least
        if np.all(np.isclose(checked, found, rtol=tolerance, atol=1e-9) | nothing):
            return checked
    raise ArithmeticError(f"{insect.name}: the oracle finds {checked}, the search {found} for {stroke}")
