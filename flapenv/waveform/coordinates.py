"""Action coordinates of free waveforms: points of the cube [-1, 1]^m, shared by the environment and its optimiser."""

from typing import Any, NamedTuple

import numpy as np

from flapenv.aero.arrays import Real, as_arrays
from flapenv.aero.checks import require_count, shown
from flapenv.aero.parameters import StrokeReference
from flapenv.aero.spline_motion import SplineMotion
from flapenv.aero.splines import FEWEST_KNOTS
from flapenv.coordinates import StrokeCoordinates
from flapenv.problem import HoverProblem, StrokeBox

SPEED_FLOOR = 0.01
"""Smallest speed coefficient where the largest is 1: the wing reverses once at each end of the stroke."""
MOST_KNOTS = 256
"""Knots a half-cycle, at most."""


class Waveform(NamedTuple):
    """Wingbeats with free waveforms; fields of shape (...) and (..., n).

    Attributes:
        frequency: f [Hz].
        flap_amplitude: φmax [rad].
        speed_coefficients: w of the flapping rate, of any scale [-].
        pitch_coefficients: of θ [rad].
    """

    frequency: Any
    flap_amplitude: Any
    speed_coefficients: Any
    pitch_coefficients: Any

    def motion(self, row: Any = ()) -> SplineMotion:
        """One of the wingbeats as the blade element takes it."""
        return SplineMotion(**{name: np.asarray(value, float)[row] for name, value in self._asdict().items()})


class WaveformCoordinates:
    """The map from the cube to the waveforms of a problem: first f and φmax where free, then n speeds, then n pitches.

    f and φmax run as in `StrokeCoordinates` (tip speed q = f φmax on a log scale, then φmax), each speed coefficient
    linearly from `SPEED_FLOOR` to 1, each pitch coefficient linearly over ± the largest pitch angle. (On a log scale
    learners fell for speeds at the floor, where no pitch is felt any more; docs/waveform.md.) Of the problem's box only
    the bounds of f and φmax and the upper bound of the pitch amplitude have a meaning here.
    """

    def __init__(self, problem: HoverProblem, knots: int) -> None:
        """Prepare the map.

        Args:
            problem: whose box bounds f, φmax and |θ|.
            knots: n, speed and pitch coefficients a half-cycle.

        Raises:
            TypeError: if `knots` is not a whole number.
            ValueError: for too few or too many knots, or a model that waveforms do not serve.
        """
        self.knots = require_count("knots", knots, FEWEST_KNOTS)
        if self.knots > MOST_KNOTS:
            raise ValueError(f"knots = {knots} is not allowed; allowed: whole numbers up to {MOST_KNOTS}")
        require_served(problem)
        box = problem.box
        own = {name: getattr(box, name) for name in ("frequency", "frequency_ratio", "flap_amplitude")}
        own["flap_amplitude_ratio"] = box.flap_amplitude_ratio
        fixed: dict[str, Any] = {"flap_shape": 0.0, "pitch_shape": 0.0, "pitch_amplitude": 0.0, "pitch_phase": 0.0}
        self.beat = StrokeCoordinates(StrokeBox(**own, **fixed))
        self.pitch_limit = box.pitch_amplitude[1]

    def __len__(self) -> int:
        """Number of axes, m."""
        return len(self.beat) + 2 * self.knots

    @property
    def axis_names(self) -> tuple[str, ...]:
        """What each axis is."""
        coefficients = [f"{name}_{j}" for name in ("speed", "pitch") for j in range(self.knots)]
        return (*self.beat.axis_names, *coefficients)

    def decode(self, points: Real, reference: StrokeReference) -> tuple[Waveform, Any]:
        """Waveforms at points of the cube; a point outside is moved to its nearest face.

        Args:
            points: shape (..., m), float32 or float64, finite; arrays, or tensors, which keep their gradient.
            reference: the own strokes that the box may be relative to, scalars or shape (...).

        Returns:
            The waveforms, of the points' type, and where anything was clipped, shape (...) of bool.
        """
        xp, points = as_arrays(points)
        head = len(self.beat)
        beat, clipped = self.beat.decode(points[..., :head], reference)
        shape = xp.clip(points[..., head:], -1, 1)
        clipped = clipped | xp.any(shape != points[..., head:], axis=-1)
        speed = (1 + SPEED_FLOOR) / 2 + (1 - SPEED_FLOOR) / 2 * shape[..., : self.knots]
        pitch = self.pitch_limit * shape[..., self.knots :]
        return Waveform(beat["frequency"], beat["flap_amplitude"], speed, pitch), clipped

    def encode(self, waveform: Waveform, reference: StrokeReference) -> np.ndarray:
        """Points of the cube for waveforms, the inverse of `decode` inside the box; the largest speed becomes 1.

        Args:
            waveform: whose n is this map's.
            reference: the own strokes that the box may be relative to.

        Returns:
            Points, shape (..., m), clipped to the cube.
        """
        speed, pitch = (np.asarray(value, dtype=float) for value in waveform[2:])
        missing = 1 - speed / np.max(speed, axis=-1, keepdims=True)
        axes = [np.clip(1 - 2 * missing / (1 - SPEED_FLOOR), -1, 1), np.clip(pitch / self.pitch_limit, -1, 1)]
        if len(self.beat):
            values = {"frequency": waveform.frequency, "flap_amplitude": waveform.flap_amplitude}
            head = self.beat.encode(values, reference)
            axes.insert(0, np.broadcast_to(head, (*speed.shape[:-1], len(self.beat))))
        return np.concatenate(axes, axis=-1)


def require_served(problem: HoverProblem) -> None:
    """Refuse a problem that free waveforms are not evaluated for.

    Raises:
        ValueError: for coefficients other than (2.7), (2.12), power that is paid only where positive, or no pitch at
            all.
    """
    model = problem.model
    if not model.is_plate:
        raise ValueError(
            f"coefficients = {shown(model.coefficients)} are not served by free waveforms; allowed: lifting-line, "
            "extended-lifting-line, with profile drag or without"
        )
    if model.accounting != "elastic":
        raise ValueError(f"accounting = {shown(model.accounting)} is not served by free waveforms; allowed: elastic")
    if problem.box.pitch_amplitude[1] == 0:
        raise ValueError("upper bound of pitch_amplitude = 0 lets no waveform lift anything; allowed: above 0")
