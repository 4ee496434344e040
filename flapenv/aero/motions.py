"""Any periodic wing motion: what the blade element asks of one, and motions from Fourier series, samples, functions.

Phases ωt are in radians, angles in radians, rates and accelerations per second and per second squared.
"""

import abc
import functools
import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Any, Protocol

import numpy as np

from flapenv.aero.checks import record, require_count, require_real, require_scalar, shown

FUNCTION_SAMPLES = 720
"""Samples a cycle that a motion given as functions is drawn through."""
LARGEST_GAP = 4.0
"""Sampled times may lie apart by at most this many times their median spacing."""
CLOSURE = 1e-6
"""How far [rad] the end of a cycle may lie from its beginning."""


class Motion(Protocol):
    """What the blade element asks of a wing motion; every method takes phases ωt [rad] of shape (n,)."""

    @property
    def frequency(self) -> Any:
        """The frequency f [Hz]."""

    @property
    def flap_amplitude(self) -> Any:
        """The flapping amplitude φmax, half of the angle swept [rad]."""

    @property
    def mean_flap_speed(self) -> Any:
        """⟨|φ̇|⟩ [rad/s]."""

    def flap_angle(self, phase: np.ndarray) -> np.ndarray:
        """φ [rad]."""

    def flap_rate(self, phase: np.ndarray) -> np.ndarray:
        """φ̇ [rad/s]."""

    def flap_acceleration(self, phase: np.ndarray) -> np.ndarray:
        """φ̈ [rad/s²]."""

    def pitch_angle(self, phase: np.ndarray) -> np.ndarray:
        """θ [rad]."""

    def pitch_rate(self, phase: np.ndarray) -> np.ndarray:
        """θ̇ [rad/s]."""

    def pitch_acceleration(self, phase: np.ndarray) -> np.ndarray:
        """θ̈ [rad/s²]."""


@dataclass(frozen=True, kw_only=True)
class Kinematics:
    """Both angles and their derivatives at the same instants, shape (n,) each.

    Attributes:
        flap: φ [rad].
        flap_rate: φ̇ [rad/s].
        flap_acceleration: φ̈ [rad/s²].
        pitch: θ [rad].
        pitch_rate: θ̇ [rad/s].
        pitch_acceleration: θ̈ [rad/s²].
    """

    flap: np.ndarray
    flap_rate: np.ndarray
    flap_acceleration: np.ndarray
    pitch: np.ndarray
    pitch_rate: np.ndarray
    pitch_acceleration: np.ndarray

    @classmethod
    def of(cls, motion: Motion, phase: np.ndarray) -> "Kinematics":
        """The kinematics of a motion at phases ωt [rad]."""
        return cls(
            flap=motion.flap_angle(phase),
            flap_rate=motion.flap_rate(phase),
            flap_acceleration=motion.flap_acceleration(phase),
            pitch=motion.pitch_angle(phase),
            pitch_rate=motion.pitch_rate(phase),
            pitch_acceleration=motion.pitch_acceleration(phase),
        )


class _AngleMotion(abc.ABC):
    """What follows from the two angles and their derivatives by the phase."""

    frequency: float

    @abc.abstractmethod
    def _flap(self, phase: np.ndarray, order: int) -> np.ndarray:
        """φ differentiated `order` times by the phase [rad]."""

    @abc.abstractmethod
    def _pitch(self, phase: np.ndarray, order: int) -> np.ndarray:
        """θ differentiated `order` times by the phase [rad]."""

    @property
    def _omega(self) -> float:
        return 2 * math.pi * self.frequency

    @functools.cached_property
    def _survey(self) -> tuple[float, float]:
        """Half of the angle swept [rad] and mean of |dφ/d(ωt)| [-], on a fine grid."""
        phase = np.linspace(0, 2 * math.pi, 8 * FUNCTION_SAMPLES + 1)
        flap = self._flap(phase, 0)
        return float(np.ptp(flap)) / 2, float(np.sum(np.abs(np.diff(flap)))) / (2 * math.pi)

    @property
    def flap_amplitude(self) -> float:
        """φmax, half of the angle swept [rad]."""
        return self._survey[0]

    @property
    def mean_flap_speed(self) -> float:
        """⟨|φ̇|⟩ [rad/s]."""
        return self._omega * self._survey[1]

    def flap_angle(self, phase: np.ndarray) -> np.ndarray:
        """φ [rad]."""
        return self._flap(phase, 0)

    def flap_rate(self, phase: np.ndarray) -> np.ndarray:
        """φ̇ [rad/s]."""
        return self._omega * self._flap(phase, 1)

    def flap_acceleration(self, phase: np.ndarray) -> np.ndarray:
        """φ̈ [rad/s²]."""
        return self._omega**2 * self._flap(phase, 2)

    def pitch_angle(self, phase: np.ndarray) -> np.ndarray:
        """θ [rad]."""
        return self._pitch(phase, 0)

    def pitch_rate(self, phase: np.ndarray) -> np.ndarray:
        """θ̇ [rad/s]."""
        return self._omega * self._pitch(phase, 1)

    def pitch_acceleration(self, phase: np.ndarray) -> np.ndarray:
        """θ̈ [rad/s²]."""
        return self._omega**2 * self._pitch(phase, 2)


@record
class FourierMotion(_AngleMotion):
    """A motion by its Fourier coefficients, φ(ωt) = a₀/2 + Σ aₙ cos nωt + bₙ sin nωt, and θ alike.

    Attributes:
        frequency: f [Hz], > 0.
        flap_cosines: a₀, a₁, ... of φ [rad].
        flap_sines: b₁, b₂, ... of φ [rad].
        pitch_cosines: a₀, a₁, ... of θ [rad].
        pitch_sines: b₁, b₂, ... of θ [rad].

    Raises:
        TypeError: for an unknown field or coefficients that are not sequences of real numbers.
        ValueError: for NaN or inf, or a wing that does not flap.
    """

    frequency: float
    flap_cosines: Sequence[float] = (0.0,)
    flap_sines: Sequence[float] = (0.0,)
    pitch_cosines: Sequence[float] = (0.0,)
    pitch_sines: Sequence[float] = (0.0,)

    def __post_init__(self) -> None:
        """Check every coefficient."""
        object.__setattr__(self, "frequency", _frequency(self.frequency))
        for name in ("flap_cosines", "flap_sines", "pitch_cosines", "pitch_sines"):
            row = np.atleast_1d(np.asarray(require_real(name, getattr(self, name), unit="rad")))
            if row.ndim != 1:
                raise TypeError(f"{name} has shape {row.shape}; allowed: a sequence of coefficients")
            object.__setattr__(self, name, tuple(row.tolist()))
        _require_flapping(self)

    def _flap(self, phase: np.ndarray, order: int) -> np.ndarray:
        return _series(phase, self.flap_cosines, self.flap_sines, order)

    def _pitch(self, phase: np.ndarray, order: int) -> np.ndarray:
        return _series(phase, self.pitch_cosines, self.pitch_sines, order)


@record
class SampledMotion(_AngleMotion):
    """A motion drawn through samples of one cycle by periodic cubic splines, of φ and θ against the phase.

    Attributes:
        frequency: f [Hz], > 0.
        flap_angle_samples: φ [rad], shape (n,), n >= 4.
        pitch_angle_samples: θ [rad], shape (n,).
        time: fractions of the cycle t/T, rising in [0, 1], shape (n,); even from 0, the end left out, where None. If it
            runs from 0 to 1, the last sample must repeat the first.

    Raises:
        TypeError: for columns that are not real numbers of equal length, or too few.
        ValueError: for NaN or inf, times that do not rise, a gap in them, a cycle that does not close, or a wing that
            does not flap.
    """

    frequency: float
    flap_angle_samples: Sequence[float]
    pitch_angle_samples: Sequence[float]
    time: Sequence[float] | None = None

    def __post_init__(self) -> None:
        """Check the samples."""
        object.__setattr__(self, "frequency", _frequency(self.frequency))
        columns = {}
        for name in ("flap_angle_samples", "pitch_angle_samples"):
            columns[name] = np.atleast_1d(np.asarray(require_real(name, getattr(self, name), unit="rad")))
        count = len(columns["flap_angle_samples"])
        if self.time is not None:
            columns["time"] = np.atleast_1d(np.asarray(require_real("time", self.time, 0.0, 1.0, unit="cycles")))
        shapes = ", ".join(f"{name} {column.shape}" for name, column in columns.items())
        if any(column.shape != (count,) for column in columns.values()) or count < 4:
            raise TypeError(f"samples have shapes {shapes}; allowed: columns of equal length, at least four rows")
        angles = columns["flap_angle_samples"], columns["pitch_angle_samples"]
        if self.time is not None:
            _require_no_gap(columns["time"])
            if columns["time"][0] == 0 and columns["time"][-1] == 1:
                for name, column in zip(columns, angles, strict=False):
                    _require_closed(name, float(column[0]), float(column[-1]))
        elif all(abs(column[0] - column[-1]) < CLOSURE for column in angles):
            raise ValueError(
                "the last sample repeats the first, which even samples without time must not; allowed: leave it out, "
                "or give time, from 0 to 1"
            )
        for name, column in columns.items():
            object.__setattr__(self, name, tuple(column.tolist()))
        _require_flapping(self)

    @classmethod
    def from_functions(
        cls,
        frequency: float,
        flap_angle: Callable[[np.ndarray], Any],
        pitch_angle: Callable[[np.ndarray], Any],
        *,
        samples: int = FUNCTION_SAMPLES,
    ) -> "SampledMotion":
        """A motion from two functions of the phase, sampled evenly.

        Args:
            frequency: f [Hz].
            flap_angle: φ [rad] at phases ωt [rad], an array in and one of the same shape out.
            pitch_angle: θ [rad], likewise.
            samples: a cycle; the more, the sharper the features that are kept.

        Raises:
            TypeError: for what is not a function of that kind.
            ValueError: if a function is not periodic with 2π, or gives NaN or inf.
        """
        phase = 2 * math.pi * np.arange(require_count("samples", samples, low=4)) / samples
        columns = []
        for name, function in (("flap_angle", flap_angle), ("pitch_angle", pitch_angle)):
            if not callable(function):
                raise TypeError(f"{name} = {shown(function)} is not allowed; allowed: a function of the phase")
            first, second = (
                np.asarray(require_real(f"{name}'s value", function(turn), unit="rad"))
                for turn in (phase, phase + 2 * math.pi)
            )
            if first.shape != phase.shape:
                raise TypeError(f"{name} gives shape {first.shape} for phases of shape {phase.shape}; allowed: it")
            off = int(np.argmax(np.abs(second - first)))
            _require_closed(name, float(first[off]), float(second[off]))
            columns.append(first.tolist())
        return cls(frequency=frequency, flap_angle_samples=columns[0], pitch_angle_samples=columns[1])

    def _flap(self, phase: np.ndarray, order: int) -> np.ndarray:
        return self._splines(phase, order)[..., 0]

    def _pitch(self, phase: np.ndarray, order: int) -> np.ndarray:
        return self._splines(phase, order)[..., 1]

    @functools.cached_property
    def _splines(self) -> Any:
        """Both splines against the phase, periodic."""
        from scipy.interpolate import CubicSpline

        angles = np.stack([self.flap_angle_samples, self.pitch_angle_samples], axis=-1)
        time = np.arange(len(angles)) / len(angles) if self.time is None else np.asarray(self.time)
        if time[-1] < 1 + time[0]:  # close the cycle where the samples leave its end out
            time, angles = np.append(time, 1 + time[0]), np.concatenate([angles, angles[:1]])
        angles[-1] = angles[0]  # to the last digit, as a periodic spline wants it
        return CubicSpline(2 * math.pi * time, angles, bc_type="periodic")


def _frequency(value: object) -> float:
    """A checked frequency [Hz]."""
    return require_scalar("frequency", value, 0.0, open_low=True, unit="Hz")


def _series(phase: np.ndarray, cosines: Sequence[float], sines: Sequence[float], order: int) -> np.ndarray:
    """Derivative of the given order by the phase, of a Fourier series."""
    total = np.full(np.shape(phase), cosines[0] / 2 if order == 0 else 0.0)
    turn = order * math.pi / 2  # each derivative advances sine and cosine by a quarter
    for n, a in enumerate(cosines[1:], start=1):
        total += a * n**order * np.cos(n * np.asarray(phase) + turn)
    for n, b in enumerate(sines, start=1):
        total += b * n**order * np.sin(n * np.asarray(phase) + turn)
    return total


def _require_flapping(motion: _AngleMotion) -> None:
    """Refuse a wing that does not flap, or flaps beyond a half turn."""
    require_real("flapping amplitude of the motion", motion.flap_amplitude, 0.0, math.pi, open_low=True, unit="rad")


def _require_no_gap(time: np.ndarray) -> None:
    """Refuse times that do not rise or leave a hole, over the end of the cycle too."""
    whole = time[0] == 0 and time[-1] == 1
    steps = np.diff(time) if whole else np.diff(np.append(time, 1 + time[0]))
    if np.any(steps <= 0):
        i = int(np.argmax(steps <= 0))
        raise ValueError(f"time[{i + 1}] = {time[(i + 1) % len(time)]:.6g} does not exceed time[{i}]; allowed: rising")
    typical, i = float(np.median(steps)), int(np.argmax(steps))
    if steps[i] > LARGEST_GAP * typical:
        raise ValueError(
            f"time has a gap of {steps[i]:.4g} cycles after {time[i]:.4g}, {steps[i] / typical:.1f} times the median "
            f"spacing; allowed: up to {LARGEST_GAP:g} times (fill the gap, or resample)"
        )


def _require_closed(name: str, first: float, last: float) -> None:
    """Refuse a cycle that does not end where it began."""
    if abs(last - first) > CLOSURE:
        raise ValueError(
            f"{name} is not periodic: {first:.6g} rad, and {last:.6g} rad a cycle later; allowed: a difference up to "
            f"{CLOSURE:g} rad"
        )
