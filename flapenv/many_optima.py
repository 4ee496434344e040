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

import functools
import math
from typing import Any, NamedTuple

import numpy as np

from flapenv.aero.checks import record
from flapenv.aero.force_laws import PlateLaw
from flapenv.aero.parameters import STROKE_PARAMETERS, StrokeReference
from flapenv.aero.stroke import Stroke
from flapenv.aero.wingbeat import speed_averages
from flapenv.case import HoverCase, hover_case, lift_constant
from flapenv.coordinates import StrokeCoordinates
from flapenv.insects import Insect, pick
from flapenv.optimum import WEIGHT_TOLERANCE, lower_bound, optimum
from flapenv.performance import hover_averages
from flapenv.problem import HoverProblem, StrokeBox, as_problem

SHAPES = ("flap_shape", "pitch_amplitude", "pitch_shape", "pitch_phase")
GRID = 160
"""Points of the curve."""
TOLERANCE = 1e-9
"""Of the time quadrature."""
STEP = 1e-4
"""Of central differences, in units of the cube."""
STARTS, ANCHOR = 12, 20
"""Spread starts, and how many points of the grid lie between those that are solved from all of them."""
SMALLEST = 1e-12
"""Stands in for lift that is not positive, where its logarithm is taken."""
PULL, HALVINGS = 0.05, 40
"""How far a waveform may be drawn away from the largest lift, and how often that is halved to meet the weight."""


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


class _Shapes:
    """Waveforms of a box, their three numbers, and the best of them."""

    def __init__(self, box: StrokeBox) -> None:
        self.nodes = box.time_nodes(tolerance=TOLERANCE)
        fixed: dict[str, Any] = {"frequency": 1.0, "flap_amplitude": 1.0}
        own = {name: getattr(box, name) for name in SHAPES}
        self.coordinates = StrokeCoordinates(StrokeBox(**fixed, **own), scaling="log")

    def values(self, points: np.ndarray) -> dict[str, np.ndarray]:
        """Fields of the waveforms at points of the cube (..., n)."""
        decoded, _ = self.coordinates.decode(points, StrokeReference(1.0, 1.0))
        return {name: decoded[name] for name in SHAPES}

    def numbers(self, points: np.ndarray, ratio: np.ndarray | float = 0.0) -> tuple[np.ndarray, np.ndarray]:
        """L and S + e K/2 at points (..., n), for e of shape (...)."""
        law = PlateLaw(constant=1.0, profile_drag=ratio) if np.any(ratio) else None
        lift, power = speed_averages(**self.values(points), nodes=self.nodes, law=law)
        return lift, power if law is None else power / 2

    def best(self, goal: str, starts: np.ndarray, *, ratio: float = 0.0, needed: float = 0.0) -> np.ndarray:
        """The best waveform's point (n,), over the ends of all starts.

        Args:
            goal: "free" for the least (S + e K/2)/L^1.5, "fixed" for the least S + e K/2 with L >= s, "lift" for the
                largest L.
            starts: points (m, n).
            ratio: e.
            needed: s.
        """
        from scipy.optimize import minimize

        offsets = STEP * np.eye(len(self.coordinates))
        seen: dict[bytes, tuple[np.ndarray, np.ndarray]] = {}

        def logs(point: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
            """Values and slopes of log L and log(S + e K/2)."""
            key = point.tobytes()
            if key not in seen:
                ahead, behind = np.clip(point + offsets, -1, 1), np.clip(point - offsets, -1, 1)
                lift, power = self.numbers(np.concatenate([point[None], ahead, behind]), ratio)
                both = np.log(np.maximum(np.stack([lift, power]), SMALLEST))
                width = np.diagonal(ahead - behind)
                n = len(width)
                seen.clear()
                seen[key] = both[:, 0], (both[:, 1 : n + 1] - both[:, n + 1 :]) / width
            return seen[key]

        weights = {"free": (-1.5, 1.0), "fixed": (0.0, 1.0), "lift": (-1.0, 0.0)}[goal]
        hover = {
            "type": "ineq",
            "fun": lambda point: logs(point)[0][0] - math.log(needed),
            "jac": lambda point: logs(point)[1][0],
        }
        best, least = starts[0], math.inf
        for start in starts:
            found = minimize(
                lambda point: float(np.dot(weights, logs(point)[0])),
                start,
                jac=lambda point: np.dot(weights, logs(point)[1]),
                bounds=[(-1.0, 1.0)] * len(start),
                constraints=[hover] if goal == "fixed" else [],
                method="SLSQP",
                options={"maxiter": 300, "ftol": 1e-14},
            )
            point = np.clip(found.x, -1, 1)
            (lift, power), _ = logs(point)
            value = weights[0] * lift + weights[1] * power
            if value < least and (goal != "fixed" or lift > math.log(needed) - 1e-7):
                best, least = point, value
        return best


@functools.lru_cache(maxsize=32)
def _shapes(box: StrokeBox) -> _Shapes:
    """The waveforms of a box, kept."""
    return _Shapes(box)


@functools.lru_cache(maxsize=32)
def _starts(box: StrokeBox) -> np.ndarray:
    """Points spread over the cube."""
    return np.random.default_rng(0).uniform(-1, 1, (STARTS, len(_shapes(box).coordinates)))


@functools.lru_cache(maxsize=32)
def largest_lift(box: StrokeBox) -> tuple[np.ndarray, float]:
    """The waveform of the largest L in a box, as a point of the cube, and that L."""
    shapes = _shapes(box)
    point = shapes.best("lift", _starts(box))
    return point, float(shapes.numbers(point[None])[0][0])


def _curve(box: StrokeBox, goal: str, grid: np.ndarray) -> np.ndarray:
    """`_kept_curve` of an array."""
    return _kept_curve(box, goal, tuple(grid.tolist()))


@functools.lru_cache(maxsize=32)
def _kept_curve(box: StrokeBox, goal: str, grid: tuple[float, ...]) -> np.ndarray:
    """Best points at the numbers of a grid (m, n), kept: from spread starts at some, from their neighbours at all."""
    shapes, which = _shapes(box), "ratio" if goal == "free" else "needed"
    points = np.empty((len(grid), len(shapes.coordinates)))
    anchors = set(range(0, len(grid), ANCHOR)) | {len(grid) - 1}
    for i, number in enumerate(grid):
        before = points[i - 1 : i] if i else points[:0]
        spread = _starts(box) if i in anchors else _starts(box)[:0]
        if goal == "fixed":
            spread = np.concatenate([spread, largest_lift(box)[0][None]]) if i in anchors else spread
        points[i] = shapes.best(goal, np.concatenate([before, spread]), **{which: number})
    for i in range(len(grid) - 2, -1, -1):  # and back, for branches that begin further on
        back = shapes.best(goal, points[i + 1 : i + 2], **{which: grid[i]})
        lift, power = shapes.numbers(np.stack([points[i], back]), grid[i] if goal == "free" else 0.0)
        merit = power / lift**1.5 if goal == "free" else np.where(lift > grid[i] * (1 - 1e-7), power, np.inf)
        points[i] = (points[i], back)[int(np.argmin(merit))]
    return points


def _neighbours(grid: np.ndarray, points: np.ndarray, numbers: np.ndarray) -> list[np.ndarray]:
    """For every number the points of the grid on both sides, between them, and drawn on from either side.

    Where a bound becomes active between two points of the grid the curve has a corner there; drawn on from its own
    side, and clipped to the cube, it is met on both.
    """
    if len(grid) == 1:
        return [np.broadcast_to(points[0], (len(numbers), points.shape[1]))]
    right = np.clip(np.searchsorted(grid, numbers), 1, len(grid) - 1)
    share = np.clip((numbers - grid[right - 1]) / (grid[right] - grid[right - 1]), 0, 1)[:, None]
    left, after = points[right - 1], points[right]
    candidates = [left + share * (after - left), left, after]
    if len(grid) > 3:
        first, last = np.maximum(right - 2, 0), np.minimum(right + 1, len(grid) - 1)
        width = (grid[right] - grid[right - 1])[:, None] * np.stack([share, 1 - share])
        for near, far, step in ((right - 1, first, width[0]), (right, last, width[1])):
            gap = np.abs(grid[near] - grid[far])[:, None]
            slope = (points[near] - points[far]) / np.where(gap > 0, gap, np.inf)
            candidates.append(np.clip(points[near] + slope * step, -1, 1))
    return candidates


def many_optima(insects: Insect, problem: HoverProblem | str | None = None) -> ManyOptima:
    """The least power with which each of many insects hovers in a problem's box.

    Args:
        insects: an `Insect` with array fields of shape (n,), as `wing_pool` gives.
        problem: a `HoverProblem` or a name of `PROBLEMS`; problem A where None.

    Returns:
        What `optimum` would return for each, to 1e-6, without the blade element's confirmation.

    Raises:
        TypeError: for insects without array fields.
        ValueError: for what the problem refuses.

    Source: derived here (module docstring); bounds as in `lower_bound`.
    """
    problem = as_problem(problem)
    problem.require_suitable(insects.name, insects.reference)
    case = hover_case(insects, problem.model)
    count = _count(insects)
    on_curve = np.zeros(count, dtype=bool)
    strokes = {name: np.empty(count) for name in STROKE_PARAMETERS}
    weight, power, multiplier = np.empty(count), np.empty(count), np.full(count, math.inf)
    largest = np.full(count, np.nan)
    shared = problem.model.has_proven_bound and problem.model.tip_loss == "reference"
    if shared and not problem.box.is_free("frequency") and not problem.box.is_free("flap_amplitude"):
        if problem.model.profile_drag == 0:
            on_curve, strokes, multiplier = _fixed(case, problem, count)
    elif shared and problem.box.is_free("frequency"):
        on_curve, strokes, multiplier = _free(case, problem, count)
    if np.any(on_curve):
        weight, power = hover_averages(
            case, problem.model, **strokes, nodes=problem.box.time_nodes(tolerance=TOLERANCE)
        )
    if shared:
        largest = largest_weight_support(insects, problem)
    for i in np.flatnonzero(~on_curve):
        best = optimum(_one(insects, int(i)), problem)
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


def _on_curve(case: HoverCase, problem: HoverProblem, count: int) -> _OnCurve:
    """Every wing's place on the curve of free frequencies."""
    shapes = _shapes(problem.box)
    amplitude = _limits(case, problem, "flap_amplitude", count)[1]
    constant = np.broadcast_to(lift_constant(case, problem.model, 1.0, amplitude), (count,))
    ratio = problem.model.profile_drag / constant
    low, high = float(np.min(ratio)), float(np.max(ratio))
    grid = np.unique(ratio) if count <= GRID else np.linspace(low, high, GRID)
    grid = grid if high > low * (1 + 1e-12) else np.array([low])
    points = _curve(problem.box, "free", grid)
    candidates = _neighbours(grid, points, ratio)
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
    return _on_curve(hover_case(insects, problem.model), problem, _count(insects)).frequency


def _free(case: HoverCase, problem: HoverProblem, count: int) -> tuple[np.ndarray, dict[str, np.ndarray], np.ndarray]:
    """Wings whose best frequency is not below its bounds: which, their strokes and multipliers."""
    shapes = _shapes(problem.box)
    amplitude, constant, ratio, point, frequency, power = _on_curve(case, problem, count)
    lowest, highest = _limits(case, problem, "frequency", count)
    multiplier = 1.5 * power
    limit, most = largest_lift(problem.box)
    speed = 4 * highest * amplitude
    needed = 1 / (case.lift_scale * constant * speed**2)
    hurried = (frequency > highest) & (needed <= most)
    for i in np.flatnonzero(hurried):  # at the bound of f two numbers count, e and s: one by one, from what is near
        starts = np.stack([_lifting(shapes, point[i : i + 1], limit, needed[i : i + 1])[0], point[i]])
        point[i] = shapes.best("fixed", starts, ratio=float(ratio[i]), needed=float(needed[i]))
        multiplier[i] = math.nan  # follows
    frequency = np.where(hurried, highest, frequency)
    if np.any(hurried):
        slope = _cost_of_lift(shapes, point[hurried], ratio[hurried])
        scale = 2 * np.broadcast_to(case.power_scale, (count,)) * constant * speed**3 * needed
        multiplier[hurried] = scale[hurried] * slope
    strokes = {"frequency": frequency, "flap_amplitude": amplitude, **shapes.values(point)}
    return (frequency >= lowest) & (frequency <= highest), strokes, multiplier


def _cost_of_lift(shapes: _Shapes, points: np.ndarray, ratio: np.ndarray) -> np.ndarray:
    """d(S + e K/2)/dL at constrained optima, by stationarity along the axes that lie on no face, shape (n wings,)."""
    lifts, powers = [], []
    for axis in np.eye(points.shape[1]):
        ahead, behind = np.clip(points + STEP * axis, -1, 1), np.clip(points - STEP * axis, -1, 1)
        inner = np.abs(points @ axis) < 1 - 1e-6
        (lift, power), (less, cheaper) = shapes.numbers(ahead, ratio), shapes.numbers(behind, ratio)
        lifts.append(np.where(inner, lift - less, 0.0))
        powers.append(np.where(inner, power - cheaper, 0.0))
    strength = np.sum(np.square(lifts), axis=0)
    return np.where(
        strength > 0, np.sum(np.multiply(lifts, powers), axis=0) / np.where(strength > 0, strength, 1), np.inf
    )


def _fixed(case: HoverCase, problem: HoverProblem, count: int) -> tuple[np.ndarray, dict[str, np.ndarray], np.ndarray]:
    """Wings of fixed frequency and amplitude without profile drag: all, their strokes and multipliers."""
    shapes, (limit, largest) = _shapes(problem.box), largest_lift(problem.box)
    frequency, amplitude = (_limits(case, problem, name, count)[1] for name in ("frequency", "flap_amplitude"))
    speed = 4 * frequency * amplitude
    constant = lift_constant(case, problem.model, speed, amplitude)
    needed = 1 / (case.lift_scale * constant * speed**2)
    feasible = needed <= largest
    low = float(np.min(needed[feasible], initial=largest))
    grid = largest - (largest - low) * np.linspace(1, 0, GRID) ** 2  # crowded to the limit of lift
    if np.sum(feasible) <= GRID:
        grid = needed[feasible] if np.any(feasible) else np.array([largest])
    grid = np.unique(np.minimum(grid, largest * (1 - 1e-9)))
    points = _curve(problem.box, "fixed", grid)
    candidates = [_lifting(shapes, candidate, limit, needed) for candidate in _neighbours(grid, points, needed)]
    merits = np.stack([shapes.numbers(candidate)[1] for candidate in candidates])
    best = np.argmin(merits, axis=0)
    point = np.where(feasible[:, None], np.stack(candidates)[best, np.arange(count)], limit)
    slope = _cost_of_lift(shapes, point, np.zeros(count))
    multiplier = np.where(feasible, 2 * case.power_scale * constant * speed**3 * slope * needed, np.inf)
    strokes = {"frequency": frequency, "flap_amplitude": amplitude, **shapes.values(point)}
    return np.ones(count, dtype=bool), strokes, multiplier


def _lifting(shapes: _Shapes, points: np.ndarray, limit: np.ndarray, needed: np.ndarray) -> np.ndarray:
    """Points moved towards the largest lift, by bisection, just until L reaches what is needed, shape (n wings, n)."""
    low, high = np.zeros(len(points)), np.ones(len(points))
    low = np.where(shapes.numbers(points)[0] >= needed, -PULL, low)
    for _ in range(HALVINGS):
        middle = (low + high) / 2
        carried = shapes.numbers(np.clip(points + middle[:, None] * (limit - points), -1, 1))[0] >= needed
        low, high = np.where(carried, low, middle), np.where(carried, middle, high)
    return np.clip(points + high[:, None] * (limit - points), -1, 1)


def _count(insects: Insect) -> int:
    """How many insects array fields hold."""
    fields = (insects.mass, insects.wing.length, insects.wing.mean_chord, insects.stroke.frequency)
    shape = np.broadcast_shapes(*(np.shape(field) for field in fields))
    if len(shape) != 1:
        raise TypeError(f"insects have fields of shape {shape}; allowed: one axis, (n,)")
    return int(shape[0])


def _one(insects: Insect, i: int) -> Insect:
    """Insect number i alone."""
    return pick(insects, i)
