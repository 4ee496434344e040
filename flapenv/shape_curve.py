"""Waveforms of a box by what they contribute to any wing, the best of them, and how those run with what is asked.

A waveform x = (Cφ, Cθ, θmax, δ) contributes L = ⟨v² sin 2α⟩/v̄², S = ⟨v³ sin² α⟩/v̄³ and K = ⟨v³⟩/v̄³, the same for every
wing; `flapenv.many_optima` says what that is good for.
"""

import functools
import math
from typing import Any

import numpy as np

from flapenv.aero.force_laws import PlateLaw
from flapenv.aero.parameters import StrokeReference
from flapenv.aero.wingbeat import speed_averages
from flapenv.coordinates import StrokeCoordinates
from flapenv.problem import StrokeBox

SHAPES = ("flap_shape", "pitch_amplitude", "pitch_shape", "pitch_phase")
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


class Shapes:
    """Waveforms of a box, their three numbers, and the best of them."""

    def __init__(self, box: StrokeBox) -> None:
        """Take the shape parameters of a box; its frequency and amplitude do not count."""
        self.rule = box.time_rule(tolerance=TOLERANCE)
        fixed: dict[str, Any] = {"frequency": 1.0, "flap_amplitude": 1.0}
        own = {name: getattr(box, name) for name in SHAPES}
        self.coordinates = StrokeCoordinates(StrokeBox(**fixed, **own), scaling="log")

    def values(self, points: np.ndarray) -> dict[str, Any]:
        """Fields of the waveforms at points of the cube (..., n)."""
        decoded, _ = self.coordinates.decode(points, StrokeReference(1.0, 1.0))
        return {name: decoded[name] for name in SHAPES}

    def numbers(self, points: np.ndarray, ratio: np.ndarray | float = 0.0) -> tuple[np.ndarray, np.ndarray]:
        """L and S + e K/2 at points (..., n), for e of shape (...)."""
        law = PlateLaw(constant=1.0, profile_drag=ratio) if np.any(ratio) else None
        lift, power = speed_averages(**self.values(points), rule=self.rule, law=law)
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
        if not len(self.coordinates):
            return np.zeros(0)
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
def shapes_of(box: StrokeBox) -> Shapes:
    """The waveforms of a box, kept."""
    return Shapes(box)


@functools.lru_cache(maxsize=32)
def _starts(box: StrokeBox) -> np.ndarray:
    """Points spread over the cube."""
    return np.random.default_rng(0).uniform(-1, 1, (STARTS, len(shapes_of(box).coordinates)))


@functools.lru_cache(maxsize=32)
def largest_lift(box: StrokeBox) -> tuple[np.ndarray, float]:
    """The waveform of the largest L in a box, as a point of the cube, and that L."""
    shapes = shapes_of(box)
    point = shapes.best("lift", _starts(box))
    return point, float(shapes.numbers(point[None])[0][0])


def curve(box: StrokeBox, goal: str, grid: np.ndarray) -> np.ndarray:
    """`_kept_curve` of an array."""
    return _kept_curve(box, goal, tuple(grid.tolist()))


@functools.lru_cache(maxsize=32)
def _kept_curve(box: StrokeBox, goal: str, grid: tuple[float, ...]) -> np.ndarray:
    """Best points at the numbers of a grid (m, n), kept: from spread starts at some, from their neighbours at all."""
    shapes, which = shapes_of(box), "ratio" if goal == "free" else "needed"
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


def neighbours(grid: np.ndarray, points: np.ndarray, numbers: np.ndarray) -> list[np.ndarray]:
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


def cost_of_lift(shapes: Shapes, points: np.ndarray, ratio: np.ndarray) -> np.ndarray:
    """d(S + e K/2)/dL at constrained optima, by stationarity along the axes that lie on no face, shape (n wings,)."""
    if not points.shape[1]:
        return np.full(len(points), np.inf)
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


def lifting(shapes: Shapes, points: np.ndarray, limit: np.ndarray, needed: np.ndarray) -> np.ndarray:
    """Points moved towards the largest lift, by bisection, just until L reaches what is needed, shape (n wings, n)."""
    low, high = np.zeros(len(points)), np.ones(len(points))
    low = np.where(shapes.numbers(points)[0] >= needed, -PULL, low)
    for _ in range(HALVINGS):
        middle = (low + high) / 2
        carried = shapes.numbers(np.clip(points + middle[:, None] * (limit - points), -1, 1))[0] >= needed
        low, high = np.where(carried, low, middle), np.where(carried, middle, high)
    return np.clip(points + high[:, None] * (limit - points), -1, 1)
