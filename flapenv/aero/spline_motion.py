"""One wing motion of periodic cubic B-splines, as the blade element takes it."""

import math
from collections.abc import Sequence

import numpy as np

from flapenv.aero.checks import record, require_real, require_scalar
from flapenv.aero.splines import FEWEST_KNOTS, find_reversal, half_cycle_basis, half_cycle_integral, spline_tables


@record
class SplineMotion:
    """A motion whose flapping rate and pitching angle are antiperiodic cubic splines (`flapenv.aero.splines`).

    φ̇ is scaled so that φ runs from -φmax to φmax and back exactly. The forward half-stroke begins near ωt = -90°, as
    that of a `Stroke` does.

    Attributes:
        frequency: f [Hz], > 0.
        flap_amplitude: φmax [rad], in (0, π].
        speed_coefficients: w of the forward half-stroke, > 0, of any scale, shape (n,) [-].
        pitch_coefficients: of θ over it, shape (n,) [rad].

    Raises:
        TypeError: for an unknown field, or coefficients that are not sequences of equal length.
        ValueError: for a value outside its range, NaN or inf.
    """

    frequency: float
    flap_amplitude: float
    speed_coefficients: Sequence[float]
    pitch_coefficients: Sequence[float]

    def __post_init__(self) -> None:
        """Check every field."""
        frequency = require_scalar("frequency", self.frequency, 0.0, open_low=True, unit="Hz")
        amplitude = require_scalar("flap_amplitude", self.flap_amplitude, 0.0, math.pi, open_low=True, unit="rad")
        speed = np.asarray(require_real("speed_coefficients", self.speed_coefficients, 0.0, open_low=True))
        pitch = np.asarray(require_real("pitch_coefficients", self.pitch_coefficients, unit="rad"))
        if speed.ndim != 1 or speed.shape != pitch.shape or len(speed) < FEWEST_KNOTS:
            raise TypeError(
                f"coefficients have shapes {speed.shape} and {pitch.shape}; allowed: two of (n,), n >= {FEWEST_KNOTS}"
            )
        for name, value in (("frequency", frequency), ("flap_amplitude", amplitude)):
            object.__setattr__(self, name, value)
        object.__setattr__(self, "speed_coefficients", tuple(speed.tolist()))
        object.__setattr__(self, "pitch_coefficients", tuple(pitch.tolist()))

    @property
    def knots(self) -> int:
        """n, knots a half-cycle."""
        return len(self.speed_coefficients)

    @property
    def mean_flap_speed(self) -> float:
        """⟨|φ̇|⟩ = 4 f φmax [rad/s]."""
        return 4 * self.frequency * self.flap_amplitude

    @property
    def reversal(self) -> float:
        """Phase ωt at which the wing turns forward [rad]."""
        flap = spline_tables(self.knots).near @ np.array(self.speed_coefficients)[:, None]
        return float(find_reversal(flap)[0]) / self._rate - math.pi / 2

    def flap_angle(self, phase: np.ndarray) -> np.ndarray:
        """φ [rad]."""
        along = self._flap(np.append(phase, self.reversal), -1) / self._rate
        return along[:-1].reshape(np.shape(phase)) - along[-1] - self.flap_amplitude

    def flap_rate(self, phase: np.ndarray) -> np.ndarray:
        """φ̇ [rad/s]."""
        return self._omega * self._flap(phase, 0)

    def flap_acceleration(self, phase: np.ndarray) -> np.ndarray:
        """φ̈ [rad/s²]."""
        return self._omega**2 * self._rate * self._flap(phase, 1)

    def pitch_angle(self, phase: np.ndarray) -> np.ndarray:
        """θ [rad]."""
        return self._pitch(phase, 0)

    def pitch_rate(self, phase: np.ndarray) -> np.ndarray:
        """θ̇ [rad/s]."""
        return self._omega * self._rate * self._pitch(phase, 1)

    def pitch_acceleration(self, phase: np.ndarray) -> np.ndarray:
        """θ̈ [rad/s²]."""
        return (self._omega * self._rate) ** 2 * self._pitch(phase, 2)

    @property
    def _omega(self) -> float:
        return 2 * math.pi * self.frequency

    @property
    def _rate(self) -> float:
        """dx/d(ωt) [knots/rad]."""
        return self.knots / math.pi

    def _flap(self, phase: np.ndarray, order: int) -> np.ndarray:
        """dφ/d(ωt) [rad/rad], its derivative by x, or its integral over x, which starts anywhere."""
        speed = np.array(self.speed_coefficients)
        scale = 2 * self.flap_amplitude * self._rate / float(half_cycle_integral(speed))
        return scale * self._spline(speed, phase, order)

    def _pitch(self, phase: np.ndarray, order: int) -> np.ndarray:
        return self._spline(np.array(self.pitch_coefficients), phase, order)

    def _spline(self, coefficients: np.ndarray, phase: np.ndarray, order: int) -> np.ndarray:
        """A spline, its derivative by x or its integral at phases ωt."""
        phase = np.asarray(phase, dtype=float)
        x = (phase.ravel() + math.pi / 2) * self._rate
        x = (x + self.knots) % (2 * self.knots) - self.knots
        return (coefficients @ half_cycle_basis(x, self.knots, order)).reshape(phase.shape)
