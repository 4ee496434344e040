"""One wingbeat of one wing in plain numbers: what a batch of one costs in arrays is mostly the arrays.

The formulas of `StrokeCoordinates.decode`, `plate_averages` and `HoverObjective.score` stand here once more, in the
language of one stroke, which Python runs as it is and numba (the extra "fast") compiles. For the paper's force law with
elastic power and a k_tip that stays; everything else goes through the batch. Tests hold both against each other.
"""

import math
from collections.abc import Callable
from typing import Any

import numpy as np

from flapenv.aero.parameters import STROKE_PARAMETERS, StrokeReference
from flapenv.aero.stroke import SMALLEST_SHAPE
from flapenv.case import lift_constant
from flapenv.coordinates import StrokeCoordinates
from flapenv.model import HoverModel
from flapenv.objective import HoverObjective

FREQUENCY, AMPLITUDE, FLAP_SHAPE, PITCH_SHAPE, PITCH_AMPLITUDE, PITCH_PHASE = range(6)
"""Rows of the axes and places of the results, in the order of `STROKE_PARAMETERS`."""
COLUMN, SCALE, LOW, HIGH, FIRST, WIDTH, SHIFT, RELATIVE = range(8)
"""Columns of the axes: of the action (-1: fixed), kind of scale, bounds, how the value runs, whether a multiple."""
LINEAR, LOG, LOG_COMPLEMENT, TIP_SPEED = range(4)
LIFT, POWER, EVEN, BY_AMPLITUDE, OWN_FREQUENCY, OWN_AMPLITUDE, BOUND, BEST, PENALTY, BOUND_CHARGE, CHARGE = range(11)
"""Columns of the wings: scales of Λ and P*, 1/C_T = EVEN + BY_AMPLITUDE/√φmax, own stroke, references."""
RESULTS = (
    *STROKE_PARAMETERS,
    *("weight_support", "specific_power", "lift_deficit", "power_term", "lift_term"),
    *("bound_gap", "optimality_gap", "clipped"),
)
"""What a wingbeat gives, by its place."""


def decode(action: Any, axes: Any, wing: Any, slack: float, results: Any) -> float:
    """The stroke of an action, into the first six results; 1.0 where anything was clipped."""
    clipped = 0.0
    for row in range(6):
        axis = axes[row]
        column, value = int(axis[COLUMN]), axis[LOW]
        if column >= 0:
            point = float(action[column])
            inside = min(max(point, -1.0), 1.0)
            if inside != point:
                clipped = 1.0
            value = axis[FIRST] + axis[WIDTH] * (inside + 1) / 2
            if axis[SCALE] != LINEAR:
                value = math.exp(value) - axis[SHIFT]
            if axis[SCALE] == LOG_COMPLEMENT:
                value = 1 - value
            if axis[SCALE] != TIP_SPEED:
                value = min(max(value, axis[LOW]), axis[HIGH])
        results[row] = value
    axis = axes[FREQUENCY]
    if axis[SCALE] == TIP_SPEED:
        wanted = results[FREQUENCY] / results[AMPLITUDE]
        results[FREQUENCY] = min(max(wanted, axis[LOW]), axis[HIGH])
        if abs(results[FREQUENCY] - wanted) > slack * wanted:
            clipped = 1.0
    results[FREQUENCY] *= wing[OWN_FREQUENCY] if axis[RELATIVE] else 1.0
    results[AMPLITUDE] *= wing[OWN_AMPLITUDE] if axes[AMPLITUDE][RELATIVE] else 1.0
    return clipped


def averages(results: Any, fractions: Any, weights: Any, sines: Any) -> tuple[float, float]:
    """⟨φ̇|φ̇| sin 2θ⟩/v̄² and ⟨|φ̇|³ cos² θ⟩/v̄³ of the stroke in the results, as `plate_averages`."""
    nodes = len(fractions)
    shape, pitch_shape = max(results[FLAP_SHAPE], SMALLEST_SHAPE), max(results[PITCH_SHAPE], SMALLEST_SHAPE)
    rest = max((1 - shape) * (1 + shape) / (shape * shape), 1e-36)
    pitch_scale = results[PITCH_AMPLITUDE] / math.tanh(pitch_shape)
    half_turns = round(results[PITCH_PHASE] / math.pi)
    span = half_turns * math.pi - results[PITCH_PHASE] + math.pi / 2  # from stroke to pitch reversal
    side = -1.0 if half_turns % 2 == 0 else 1.0
    lift = power = 0.0
    for _ in range(2):
        for k in range(nodes):
            sines[k] = math.sin(span * fractions[k])  # cos ωt, and read backwards sin(ωt + δ)
        lift_sum = power_sum = 0.0
        for k in range(nodes):
            speed = sines[k] / math.sqrt(rest + sines[k] * sines[k])  # φ̇ of (2.1), but for a factor
            pitch = pitch_scale * math.tanh(pitch_shape * sines[nodes - 1 - k])  # (2.2)
            normal = speed * math.cos(pitch)  # |φ̇| sin α
            lift_sum += weights[k] * normal * speed * math.sin(pitch)
            power_sum += weights[k] * normal * normal * speed
        lift += side * span / math.pi * lift_sum
        power += span / math.pi * power_sum
        span, side = math.pi - span, -side
    scale = math.pi / 2 / math.asin(shape)
    return 2 * scale * scale * lift, scale * scale * scale * power


def score(wing: Any, lift: float, power: float, results: Any) -> None:
    """Λ, P*, terms of the reward and gaps, into the results from the seventh on."""
    speed = 4 * results[FREQUENCY] * results[AMPLITUDE]
    constant = 1 / (wing[EVEN] + wing[BY_AMPLITUDE] / math.sqrt(results[AMPLITUDE]))  # C_T (2.9), (2.10)
    weight_support = wing[LIFT] * constant * speed * speed * lift
    specific_power = 2 * wing[POWER] * constant * speed * speed * speed * power
    deficit = max(0.0, 1 - weight_support)
    results[6], results[7], results[8] = weight_support, specific_power, deficit
    results[9], results[10] = -specific_power / wing[BOUND], -wing[PENALTY] * deficit
    results[11] = specific_power / wing[BOUND] - 1 + wing[BOUND_CHARGE] * deficit
    results[12] = specific_power / wing[BEST] - 1 + wing[CHARGE] * deficit


def beat(
    action: Any, axes: Any, wing: Any, fractions: Any, weights: Any, sines: Any, slack: float, results: Any
) -> None:
    """Everything that an action gives a wing, into `results` in the order of `RESULTS`."""
    results[13] = decode(action, axes, wing, slack, results)
    lift, power = averages(results, fractions, weights, sines)
    score(wing, lift, power, results)


def serves(model: HoverModel) -> bool:
    """Whether `beat` knows the model."""
    plain = model.is_plate and model.profile_drag == 0 and model.accounting == "elastic"
    return plain and (model.tip_loss == "reference" or not model.uses_k)


class HoverOfOne:
    """The tables that `beat` reads, and a call of it."""

    def __init__(
        self, objective: HoverObjective, coordinates: StrokeCoordinates, compiled: Callable[..., None] | None = None
    ) -> None:
        """Lay out the tables of an environment's coordinates and objective, whose model `serves` knows.

        Args:
            objective: of the environment.
            coordinates: of the environment.
            compiled: `beat` compiled, which takes arrays; None for `beat` itself, which takes lists.
        """
        self._compiled = compiled
        tables = _axes(coordinates, objective.dtype), _wings(objective), *objective.rule.points
        kept: list[Any] = [*tables, np.empty(objective.rule.nodes), np.empty(len(RESULTS))]
        if compiled is None:  # Python is quicker on lists than on arrays
            kept = [table.tolist() for table in kept]
        self._axes, self._wings, self._fractions, self._weights, self._sines, self._results = kept
        self._slack = 8 * float(np.finfo(objective.dtype).eps)

    def __call__(self, action: np.ndarray, number: int) -> list[float]:
        """What an action (n,) gives the wing of a number, in the order of `RESULTS`."""
        tables = self._axes, self._wings[number], self._fractions, self._weights, self._sines
        if self._compiled is not None:
            self._compiled(action, *tables, self._slack, self._results)
            return self._results.tolist()
        beat(action.tolist(), *tables, self._slack, self._results)
        return self._results


def _axes(coordinates: StrokeCoordinates, dtype: np.dtype) -> np.ndarray:
    """A row of numbers for every parameter of a stroke."""
    rows, bounds = [], coordinates.bounds(dtype)
    for name, axis in coordinates.axes.items():
        free = name in coordinates.names
        scale = {"linear": LINEAR, "log": LOG, "log-complement": LOG_COMPLEMENT}[axis.scale]
        if coordinates.axis_names[:1] == ("tip_speed",) and name == "frequency":
            scale = TIP_SPEED
        column = coordinates.names.index(name) if free else -1
        run = (axis.start, axis.span) if free else (0.0, 0.0)
        rows.append((column, scale, *bounds[name], *run, axis.shift, coordinates.box.is_relative(name)))
    return np.array(rows, dtype=float)


def _wings(objective: HoverObjective) -> np.ndarray:
    """A row of numbers for every wing."""
    cases, model, reference = objective.cases, objective.problem.model, objective.reference
    few, many = np.float64(0.5), np.float64(1.5)
    slow, fast = (1 / np.asarray(lift_constant(cases, model, 1.0, amplitude)) for amplitude in (few, many))
    by_amplitude = (slow - fast) / (few**-0.5 - many**-0.5)
    own: StrokeReference = cases.reference
    columns = (
        *(cases.lift_scale, cases.power_scale, slow - by_amplitude * few**-0.5, by_amplitude, *own),
        *(reference[name] for name in ("bound", "optimum", "penalty", "bound_charge", "charge")),
    )
    count = len(objective.flyers)
    return np.stack([np.broadcast_to(column, (count,)).astype(float) for column in columns], axis=-1)
