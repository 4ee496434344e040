"""Optima of thousands of wings at once, by what they share.

For force coefficients (2.7), (2.12) with profile drag C_D0 = e C_T, elastic power and a fixed k_tip, all that a
waveform x = (Cφ, Cθ, θmax, δ) contributes are three numbers, the same for every wing,

    L = ⟨v² sin 2α⟩/v̄²,  S = ⟨v³ sin² α⟩/v̄³,  K = ⟨v³⟩/v̄³,   Λ = A_L v̄² L,   P* = 2 A_P C_T v̄³ (S + e K/2).

- Frequency free and inside its bounds: P* at Λ = 1 is 2 A_P C_T A_L^(-3/2) (S + e K/2)/L^(3/2), so the best x depends
  on the wing through e alone (not at all without profile drag), the best φmax is the largest, and f follows from Λ = 1.
- Frequency and amplitude fixed, e = 0: the best x has the least S with L >= s, s = 1/(A_L v̄²), one number a wing.

Either way the optima of all wings lie on one curve. It is solved at grid points, every wing takes the best of its
neighbours' waveforms and what lies between them, and is evaluated exactly. Wings that want more than their highest
frequency are solved one by one from there; what does not fit (a frequency at its lower bound, other coefficients,
positive power) alone by `optimum`.
"""

import math
from typing import Any, NamedTuple

import numpy as np

from flapenv.aero.checks import record, require_count
from flapenv.aero.parameters import STROKE_PARAMETERS
from flapenv.aero.stroke import Stroke
from flapenv.case import HoverCase, hover_case, lift_constant
from flapenv.insects import Insect, pick
from flapenv.optimum import lower_bound, optimum
from flapenv.performance import hover_averages
from flapenv.problem import HoverProblem, as_problem
from flapenv.search import WEIGHT_TOLERANCE
from flapenv.shape_curve import TOLERANCE, cost_of_lift, curve, largest_lift, lifting, neighbours, shapes_of

GRID = 160
"""Points of the curve."""


SLACK = 1e-4
"""Weight support carried beyond one by more than this costs nothing."""


@record
class ManyOptima:
    """The least power of many wings; arrays of shape (n,).

    Attributes:
        feasible: whether any stroke of the box carries the weight.
        stroke: the best stroke; where none carries the weight, the one with the largest lift.
        weight_support: Λ of it [-].
        specific_power: P* of it [W/kg].
        lower_bound: proven bound [W/kg]; None where the model leaves no proof.
        max_weight_support: the largest Λ of the box [-].
        multiplier: dP*/dΛ [W/kg]; inf where infeasible.
        solved_alone: wings that did not lie on the curve and were solved one by one.
    """

    feasible: np.ndarray
    stroke: Stroke
    weight_support: np.ndarray
    specific_power: np.ndarray
    lower_bound: np.ndarray | None
    max_weight_support: np.ndarray
    multiplier: np.ndarray
    solved_alone: np.ndarray


def many_optima(insects: Insect, problem: HoverProblem | str | None = None, *, points: int = GRID) -> ManyOptima:
    """The least power with which each of many insects hovers in a problem's box.

    Args:
        insects: an `Insect` with array fields of shape (n,), as `wing_pool` gives.
        problem: a `HoverProblem` or a name of `PROBLEMS`; problem A where None.
        points: of the curve that optima lie on, where it is longer than a point; fewer are quicker and rougher.

    Returns:
        What `optimum` would return for each, to 1e-6, without the blade element's confirmation.

    Raises:
        TypeError: for insects without array fields.
        ValueError: for what the problem refuses.

    Source: derived here (module docstring); bounds as in `lower_bound`.
    """
    require_count("points", points, low=8)
    problem = as_problem(problem)
    problem.require_suitable(insects.name, insects.reference)
    case = hover_case(insects, problem.model)
    count = _count(insects)
    on_curve = np.zeros(count, dtype=bool)
    strokes: dict[str, Any] = {name: np.empty(count) for name in STROKE_PARAMETERS}
    weight, power, multiplier = np.empty(count), np.empty(count), np.full(count, math.inf)
    largest = np.full(count, np.nan)
    shared = problem.model.has_proven_bound and problem.model.tip_loss == "reference"
    if shared and not problem.box.is_free("frequency") and not problem.box.is_free("flap_amplitude"):
        if problem.model.profile_drag == 0:
            on_curve, strokes, multiplier = _fixed(case, problem, count, points)
    elif shared and problem.box.is_free("frequency"):
        on_curve, strokes, multiplier = _free(case, problem, count, points)
    strokes = {name: np.array(np.broadcast_to(values, (count,)), dtype=float) for name, values in strokes.items()}
    if np.any(on_curve):
        weight, power = hover_averages(case, problem.model, **strokes, rule=problem.box.time_rule(tolerance=TOLERANCE))
    multiplier = np.where(on_curve & (weight > 1 + SLACK), 0.0, multiplier)
    if shared:
        largest = largest_weight_support(insects, problem)
    for i in np.flatnonzero(~on_curve):
        best = optimum(pick(insects, int(i)), problem)
        weight[i], power[i], largest[i] = best.weight_support, best.specific_power, best.max_weight_support
        multiplier[i] = best.multiplier
        for name, values in strokes.items():
            values[i] = getattr(best.stroke, name)
    bound = lower_bound(case, problem)
    return ManyOptima(
        feasible=largest >= 1 - WEIGHT_TOLERANCE,
        stroke=Stroke(**strokes),
        weight_support=weight,
        specific_power=power,
        lower_bound=None if bound is None else np.broadcast_to(bound, (count,)),
        max_weight_support=largest,
        multiplier=multiplier,
        solved_alone=~on_curve,
    )


def _limits(case: HoverCase, problem: HoverProblem, name: str, count: int) -> tuple[np.ndarray, np.ndarray]:
    """Bounds of a parameter for every wing, shape (n,) each."""
    low, high = (np.broadcast_to(end, (count,)).astype(float) for end in problem.box.bounds(name, case.reference))
    return low, high


def largest_weight_support(insects: Insect, problem: HoverProblem) -> np.ndarray:
    """Λ_max of many insects that share their waveforms: the largest L at the largest f and φmax, shape (n,) [-]."""
    case, count = hover_case(insects, problem.model), _count(insects)
    amplitude = _limits(case, problem, "flap_amplitude", count)[1]
    speed = 4 * _limits(case, problem, "frequency", count)[1] * amplitude
    constant = lift_constant(case, problem.model, speed, amplitude)
    return case.lift_scale * constant * speed**2 * largest_lift(problem.box)[1]


class _OnCurve(NamedTuple):
    """Wings at their best frequency, whatever its bounds; arrays of shape (n,), points (n, n shapes)."""

    amplitude: np.ndarray
    constant: np.ndarray
    ratio: np.ndarray
    point: np.ndarray
    frequency: np.ndarray
    power: np.ndarray


_Solved = tuple[np.ndarray, dict[str, np.ndarray], np.ndarray]
"""Which wings lie on the curve, their strokes and multipliers."""


def _on_curve(case: HoverCase, problem: HoverProblem, count: int, size: int) -> _OnCurve:
    """Every wing's place on the curve of free frequencies."""
    shapes = shapes_of(problem.box)
    amplitude = _limits(case, problem, "flap_amplitude", count)[1]
    constant = np.broadcast_to(lift_constant(case, problem.model, 1.0, amplitude), (count,))
    ratio = problem.model.profile_drag / constant
    low, high = float(np.min(ratio)), float(np.max(ratio))
    grid = np.unique(ratio) if count <= size else np.linspace(low, high, size)
    grid = grid if high > low * (1 + 1e-12) else np.array([low])
    points = curve(problem.box, "free", grid)
    candidates = neighbours(grid, points, ratio)
    numbers = [shapes.numbers(candidate, ratio) for candidate in candidates]
    merits = np.stack([power / lift**1.5 for lift, power in numbers])
    best, rows = np.argmin(merits, axis=0), np.arange(count)
    lift = np.stack([lift for lift, _ in numbers])[best, rows]
    return _OnCurve(
        amplitude=amplitude,
        constant=constant,
        ratio=ratio,
        point=np.stack(candidates)[best, rows],
        frequency=1 / np.sqrt(case.lift_scale * constant * lift) / (4 * amplitude),
        power=2 * case.power_scale * constant * (case.lift_scale * constant) ** -1.5 * merits[best, rows],
    )


def best_frequency(insects: Insect, problem: HoverProblem) -> np.ndarray:
    """Frequency of the best stroke where no bound on it counts, shape (n,) [Hz]."""
    return _on_curve(hover_case(insects, problem.model), problem, _count(insects), GRID).frequency


def _free(
    case: HoverCase, problem: HoverProblem, count: int, size: int
) -> tuple[np.ndarray, dict[str, np.ndarray], np.ndarray]:
    """Wings whose best frequency is not below its bounds: which, their strokes and multipliers."""
    shapes = shapes_of(problem.box)
    amplitude, constant, ratio, point, frequency, power = _on_curve(case, problem, count, size)
    lowest, highest = _limits(case, problem, "frequency", count)
    multiplier = 1.5 * power
    limit, most = largest_lift(problem.box)
    speed = 4 * highest * amplitude
    needed = 1 / (case.lift_scale * constant * speed**2)
    hurried = (frequency > highest) & (needed <= most)
    for i in np.flatnonzero(hurried):  # at the bound of f two numbers count, e and s: one by one, from what is near
        starts = np.stack([lifting(shapes, point[i : i + 1], limit, needed[i : i + 1])[0], point[i]])
        point[i] = shapes.best("fixed", starts, ratio=float(ratio[i]), needed=float(needed[i]))
        multiplier[i] = math.nan  # follows
    frequency = np.where(hurried, highest, frequency)
    if np.any(hurried):
        slope = cost_of_lift(shapes, point[hurried], ratio[hurried])
        scale = 2 * np.broadcast_to(case.power_scale, (count,)) * constant * speed**3 * needed
        multiplier[hurried] = scale[hurried] * slope
    strokes = {"frequency": frequency, "flap_amplitude": amplitude, **shapes.values(point)}
    return (frequency >= lowest) & (frequency <= highest), strokes, multiplier


def _fixed(
    case: HoverCase, problem: HoverProblem, count: int, size: int
) -> tuple[np.ndarray, dict[str, np.ndarray], np.ndarray]:
    """Wings of fixed frequency and amplitude without profile drag: all, their strokes and multipliers."""
    shapes, (limit, largest) = shapes_of(problem.box), largest_lift(problem.box)
    frequency, amplitude = (_limits(case, problem, name, count)[1] for name in ("frequency", "flap_amplitude"))
    speed = 4 * frequency * amplitude
    constant = lift_constant(case, problem.model, speed, amplitude)
    needed = 1 / (case.lift_scale * constant * speed**2)
    feasible = needed <= largest
    low = float(np.min(needed[feasible], initial=largest))
    grid = largest - (largest - low) * np.linspace(1, 0, size) ** 2  # crowded to the limit of lift
    if np.sum(feasible) <= size:
        grid = needed[feasible] if np.any(feasible) else np.array([largest])
    grid = np.unique(np.minimum(grid, largest * (1 - 1e-9)))
    points = curve(problem.box, "fixed", grid)
    candidates = [lifting(shapes, candidate, limit, needed) for candidate in neighbours(grid, points, needed)]
    merits = np.stack([shapes.numbers(candidate)[1] for candidate in candidates])
    best = np.argmin(merits, axis=0)
    point = np.where(feasible[:, None], np.stack(candidates)[best, np.arange(count)], limit)
    slope = cost_of_lift(shapes, point, np.zeros(count))
    multiplier = np.where(feasible, 2 * case.power_scale * constant * speed**3 * slope * needed, np.inf)
    strokes = {"frequency": frequency, "flap_amplitude": amplitude, **shapes.values(point)}
    return np.ones(count, dtype=bool), strokes, multiplier


def _count(insects: Insect) -> int:
    """How many insects array fields hold."""
    parts = insects, insects.wing, insects.stroke, insects.k_table, insects.force_constants
    fields = [value for part in parts if part is not None for value in vars(part).values()]
    shape = np.broadcast_shapes(*(value.shape for value in fields if isinstance(value, np.ndarray)))
    if len(shape) != 1:
        raise TypeError(f"insects have fields of shape {shape}; allowed: one axis, (n,)")
    return int(shape[0])
