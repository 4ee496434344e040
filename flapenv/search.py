"""The search behind `optimum`: multi-start SLSQP over a box's cube, for the least power or the largest lift."""

import math
from typing import Any, Literal

import numpy as np

from flapenv.aero.parameters import STROKE_PARAMETERS
from flapenv.aero.stroke import Stroke
from flapenv.case import hover_case
from flapenv.coordinates import StrokeCoordinates
from flapenv.insects import Insect
from flapenv.performance import hover_averages
from flapenv.problem import HoverProblem

SAMPLES, CANDIDATES, STARTS = 512, 64, 5
"""Strokes drawn over the box, the best of them, and those of the best, far apart, that the search starts at."""
STEP = 1e-4
"""Of the central differences, in units of the cube; the averages are good to 1e-10."""
LEAST_SCALE = 1e-6
"""Weight supports below this are as good as none."""
WEIGHT_TOLERANCE = 1e-7
"""Weight support short of one by less than this counts as carried."""


def spread(points: np.ndarray) -> np.ndarray:
    """`STARTS` of the points, the first and then always the one farthest from all chosen: a start for every basin."""
    chosen = points[:1]
    while len(chosen) < min(STARTS, len(points)):
        distances = np.linalg.norm(points[:, None] - chosen, axis=-1).min(axis=1)
        chosen = np.concatenate([chosen, points[[np.argmax(distances)]]])
    return chosen


class Search:
    """Multi-start SLSQP over the box's cube, with batched central differences."""

    def __init__(self, insect: Insect, problem: HoverProblem) -> None:
        """Reduce the insect and the model to what strokes are evaluated with."""
        self.problem, self.case = problem, hover_case(insect, problem.model)
        self.coordinates = StrokeCoordinates(problem.box, scaling="log")
        self.rule = problem.box.time_rule(tolerance=1e-9)
        self.wingbeats = 0
        self._last: tuple[np.ndarray, tuple[float, float, np.ndarray, np.ndarray]] | None = None

    def samples(self) -> np.ndarray:
        """Points spread over the cube, its middle among them."""
        size = (SAMPLES, len(self.coordinates))
        points = np.random.default_rng(0).uniform(-1, 1, size)
        points[0] = 0.0
        return points

    def evaluate(self, points: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Λ and P* at points of shape (..., n)."""
        values, _ = self.coordinates.decode(points, self.case.reference)
        self.wingbeats += math.prod(points.shape[:-1])
        return hover_averages(self.case, self.problem.model, **values, rule=self.rule)

    def stroke(self, point: np.ndarray) -> Stroke:
        """The stroke at a point."""
        values, _ = self.coordinates.decode(point, self.case.reference)
        return Stroke(**{name: float(value) for name, value in values.items()})

    def local(self, point: np.ndarray) -> tuple[float, float, np.ndarray, np.ndarray]:
        """Λ, P* and their gradients along the axes at one point, in one batch; one-sided on the faces of the cube."""
        if self._last is None or not np.array_equal(self._last[0], point):
            offsets = STEP * np.eye(len(self.coordinates))
            ahead, behind = np.clip(point + offsets, -1, 1), np.clip(point - offsets, -1, 1)
            weight, power = self.evaluate(np.concatenate([point[None], ahead, behind]))
            width = np.diagonal(ahead - behind)
            by_weight, by_power = (np.subtract(*np.split(value[1:], 2)) / width for value in (weight, power))
            self._last = point.copy(), (float(weight[0]), float(power[0]), by_weight, by_power)
        return self._last[1]

    def minimise(self, goal: Literal["power", "lift"], starts: np.ndarray) -> np.ndarray:
        """The point of least log P* with Λ >= 1 ("power") or of largest Λ ("lift") over the ends of all starts."""
        if not len(self.coordinates):
            return np.zeros(0)
        from scipy.optimize import minimize

        scale = max(
            float(np.max(np.abs(self.evaluate(starts)[0]))), LEAST_SCALE
        )  # of Λ, so that tolerances mean the same

        def value(point: np.ndarray) -> float:
            weight, power, _, _ = self.local(point)
            return math.log(power) if goal == "power" else -weight / scale

        def slope(point: np.ndarray) -> np.ndarray:
            _, power, by_weight, by_power = self.local(point)
            return by_power / power if goal == "power" else -by_weight / scale

        hover = {
            "type": "ineq",
            "fun": lambda point: self.local(point)[0] - 1,
            "jac": lambda point: self.local(point)[2],
        }
        best, best_value = starts[0], math.inf
        for start in starts:
            found = minimize(
                value,
                start,
                jac=slope,
                bounds=[(-1.0, 1.0)] * len(start),
                constraints=[hover] if goal == "power" else [],
                method="SLSQP",
                options={"maxiter": 200, "ftol": 1e-12},
            )
            for point in (start, np.clip(found.x, -1, 1)):
                carried = goal == "lift" or self.local(point)[0] >= 1 - WEIGHT_TOLERANCE
                if carried and value(point) < best_value:
                    best, best_value = point, value(point)
        return best

    def settle(self, point: np.ndarray) -> np.ndarray:
        """The point with its frequency lowered to carry just the weight, where the search stopped a little above it."""
        weight = float(self.evaluate(point)[0])
        values, _ = self.coordinates.decode(point, self.case.reference)
        low = self.problem.box.bounds("frequency", self.case.reference)[0]
        slower = values["frequency"] / math.sqrt(weight)
        if "frequency" not in self.coordinates.names or not 1 < weight < 1.01 or slower < low:
            return point
        return self.coordinates.encode({**values, "frequency": slower}, self.case.reference)

    def multiplier(self, point: np.ndarray) -> float:
        """dP*/dΛ from stationarity along the axes that do not lie on a face."""
        if not len(self.coordinates):
            return math.inf
        weight, _, by_weight, by_power = self.local(point)
        if weight > 1 + 1e-4:
            return 0.0
        inner = np.abs(point) < 1 - 1e-6
        lift = by_weight[inner]
        strength = float(lift @ lift)
        return float(lift @ by_power[inner]) / strength if strength > 1e-12 else math.inf

    def sensitivity(self, stroke: Stroke, multiplier: float) -> dict[str, float]:
        """∂P*/∂x - μ ∂Λ/∂x for every parameter, by differences that stay within its valid range."""
        own = {name: float(getattr(stroke, name)) for name in STROKE_PARAMETERS}
        slopes = {}
        scale = 1e-3 if self.problem.model.accounting == "positive" else 1e-5  # power with corners is rougher
        for name, row in STROKE_PARAMETERS.items():
            step = scale * max(abs(own[name]), 0.1)
            high = math.pi / 2 if name == "flap_amplitude" and self.problem.model.uses_k else row.high
            ends = np.clip([own[name] - step, own[name] + step], row.low, np.nextafter(high, 0.0))
            values: dict[str, Any] = {key: np.where(key == name, ends, value) for key, value in own.items()}
            weight, power = hover_averages(self.case, self.problem.model, **values, rule=self.rule)
            self.wingbeats += 2
            slopes[name] = float((power[1] - power[0] - multiplier * (weight[1] - weight[0])) / (ends[1] - ends[0]))
        return slopes

    def active_bounds(self, stroke: Stroke) -> tuple[tuple[str, str], ...]:
        """Which parameters lie on a bound."""
        active = []
        for name in self.coordinates.names:
            low, high = self.problem.box.bounds(name, self.case.reference)
            value, slack = getattr(stroke, name), 1e-5 * (high - low)
            if value >= high - slack:
                active.append((name, "upper"))
            elif value <= low + slack:
                active.append((name, "lower"))
        return tuple(active)
