"""The stroke: waveforms of the flapping and pitching angles over one wingbeat, (2.1)-(2.3), and their rates."""

import math

from flapenv.aero.arrays import Real, as_arrays, without_slope
from flapenv.aero.checks import record
from flapenv.aero.parameters import STROKE_PARAMETERS

SMALLEST_SHAPE = 1e-8
"""Below this Cφ or Cθ both waveforms are their sinusoidal limit to rounding; it stands in for zero."""


def flap_waveform(sin_phase: Real, flap_shape: Real) -> Real:
    """φ/φmax = asin(Cφ sin ωt)/asin(Cφ) [-]  (2.1).

    Args:
        sin_phase: sin ωt [-], any shape.
        flap_shape: Cφ in [0, 1] [-], broadcast against `sin_phase`; both limits are exact.

    Returns:
        The flapping angle over its amplitude, in [-1, 1].
    """
    xp, sin_phase, shape = as_arrays(sin_phase, flap_shape)
    shape = xp.clip(without_slope(shape, shape == 1), SMALLEST_SHAPE, None)
    return xp.asin(shape * sin_phase) / xp.asin(shape)


def flap_speed(cos_phase: Real, flap_shape: Real, scale: Real = 1.0) -> Real:
    """φ̇/(ω φmax) = Cφ cos ωt/(asin(Cφ) √(1 - Cφ² sin² ωt)) [-], the rate of (2.1).

    Computed as cos ωt/(asin(Cφ) √(ρ + cos² ωt)), ρ = (1-Cφ)(1+Cφ)/Cφ², which keeps its digits as Cφ → 1. The
    derivatives by Cφ of the averages grow without bound there, as (1-Cφ)^(-1/2); at the triangle itself tensors get 0.

    Args:
        cos_phase: cos ωt [-], any shape.
        flap_shape: Cφ in [0, 1] [-], broadcast against `cos_phase`; both limits are exact.
        scale: a factor, broadcast against `flap_shape`.

    Returns:
        The flapping rate over ω φmax times the scale, ±2/π for the triangle; 0 at its corners.
    """
    xp, cos_phase, shape, scale = as_arrays(cos_phase, flap_shape, scale)
    shape = xp.clip(without_slope(shape, shape == 1), SMALLEST_SHAPE, None)
    roundness = xp.clip((1 - shape) * (1 + shape) / (shape * shape), 1e-36, None)  # at the corners 0 over a little
    return cos_phase / xp.sqrt(roundness + cos_phase * cos_phase) * (scale / xp.asin(shape))


def pitch_waveform(sin_pitch_phase: Real, pitch_shape: Real, scale: Real = 1.0) -> Real:
    """θ/θmax = tanh(Cθ sin(ωt + δ))/tanh(Cθ) [-]  (2.2).

    Args:
        sin_pitch_phase: sin(ωt + δ) [-], any shape.
        pitch_shape: Cθ >= 0 [-], broadcast against `sin_pitch_phase`; Cθ = 0 and Cθ → ∞ are exact.
        scale: a factor, such as θmax, broadcast against `pitch_shape`.

    Returns:
        The pitching angle over its amplitude, in [-1, 1], times the scale.
    """
    xp, sin_pitch_phase, shape, scale = as_arrays(sin_pitch_phase, pitch_shape, scale)
    shape = xp.clip(shape, SMALLEST_SHAPE, None)
    return xp.tanh(shape * sin_pitch_phase) * (scale / xp.tanh(shape))


def angle_of_attack(pitch_angle: Real, flap_rate: Real) -> Real:
    """α = 90° - θ sgn φ̇ [rad], in (0, π)  (2.3), planar stroke.

    Args:
        pitch_angle: θ [rad], any shape.
        flap_rate: φ̇, of which only the sign counts, broadcast against `pitch_angle`.

    Returns:
        The angle of attack [rad].
    """
    xp, pitch_angle, flap_rate = as_arrays(pitch_angle, flap_rate)
    return math.pi / 2 - pitch_angle * xp.sign(flap_rate)


def flap_bend(sin_phase: Real, cos_phase: Real, flap_shape: Real) -> Real:
    """φ̈/(ω² φmax) = -Cφ (1-Cφ²) sin ωt/(asin(Cφ) (1-Cφ² sin² ωt)^1.5) [-], from (2.1).

    The triangle, Cφ = 1, has none but at its corners, where it is infinite and 0 is returned.

    Args:
        sin_phase: sin ωt [-], any shape.
        cos_phase: cos ωt [-], from which the root is taken without losing digits.
        flap_shape: Cφ in [0, 1] [-].
    """
    xp, sin_phase, cos_phase, shape = as_arrays(sin_phase, cos_phase, flap_shape)
    shape = xp.clip(without_slope(shape, shape == 1), SMALLEST_SHAPE, None)
    rest = (1 - shape) * (1 + shape)
    root = xp.sqrt(xp.clip(rest + (shape * cos_phase) ** 2, 1e-36, None))
    return -(shape / xp.asin(shape)) * (rest / root**3) * sin_phase


def pitch_speed(sin_pitch_phase: Real, cos_pitch_phase: Real, pitch_shape: Real) -> Real:
    """θ̇/(ω θmax) = Cθ cos(ωt+δ) sech²(Cθ sin(ωt+δ))/tanh(Cθ) [-], from (2.2).

    Args:
        sin_pitch_phase: sin(ωt + δ) [-], any shape.
        cos_pitch_phase: cos(ωt + δ) [-].
        pitch_shape: Cθ >= 0 [-].
    """
    xp, sine, cosine, shape = as_arrays(sin_pitch_phase, cos_pitch_phase, pitch_shape)
    shape = xp.clip(shape, SMALLEST_SHAPE, None)
    return shape * cosine * _sech_squared(shape * sine) / xp.tanh(shape)


def pitch_bend(sin_pitch_phase: Real, cos_pitch_phase: Real, pitch_shape: Real) -> Real:
    """θ̈/(ω² θmax) = -Cθ sech² u (sin(ωt+δ) + 2 Cθ cos²(ωt+δ) tanh u)/tanh(Cθ) [-], u = Cθ sin(ωt+δ).

    Arguments as in `pitch_speed`.
    """
    xp, sine, cosine, shape = as_arrays(sin_pitch_phase, cos_pitch_phase, pitch_shape)
    shape = xp.clip(shape, SMALLEST_SHAPE, None)
    bend = sine + 2 * shape * cosine**2 * xp.tanh(shape * sine)
    return -shape * _sech_squared(shape * sine) * bend / xp.tanh(shape)


def _sech_squared(value: Real) -> Real:
    """sech², without overflow [-]."""
    xp, value = as_arrays(value)
    decay = xp.exp(-2 * xp.abs(value))
    return 4 * decay / (1 + decay) ** 2


@record
class Stroke:
    """One wingbeat's kinematics (Nabawy & Crowther 2014, Part II, section 2.2).

    Every field is a scalar, an array or a torch tensor; arrays broadcast against each other. The waveform by default
    is the one with which the paper meets Sun & Du's CFD (section 3.3): sinusoidal flapping, Cθ = 5, symmetric
    rotation.

    Attributes:
        frequency: f [Hz], > 0.
        flap_amplitude: φmax [rad], in (0, π].
        pitch_amplitude: θmax = 90° - α_mid [rad], in [0, π/2].
        flap_shape: Cφ [-], in [0, 1].
        pitch_shape: Cθ [-], >= 0.
        pitch_phase: δ [rad], in [-2π, 2π].

    Raises:
        TypeError: for an unknown or missing field, or one that is not real.
        ValueError: for a value outside its range, NaN or inf.
    """

    frequency: Real
    flap_amplitude: Real
    pitch_amplitude: Real
    flap_shape: Real = 0.0
    pitch_shape: Real = 5.0
    pitch_phase: Real = math.pi / 2

    def __post_init__(self) -> None:
        """Check every field."""
        for name, parameter in STROKE_PARAMETERS.items():
            object.__setattr__(self, name, parameter.check(getattr(self, name)))

    @property
    def mean_flap_speed(self) -> Real:
        """⟨|φ̇|⟩ = 4 f φmax [rad/s]."""
        return 4 * self.frequency * self.flap_amplitude

    def flap_angle(self, phase: Real) -> Real:
        """φ(ωt) [rad]  (2.1); phases [rad] broadcast against the fields."""
        xp, phase, amplitude = as_arrays(phase, self.flap_amplitude)
        return amplitude * flap_waveform(xp.sin(phase), self.flap_shape)

    def flap_rate(self, phase: Real) -> Real:
        """φ̇(ωt) [rad/s], the rate of (2.1); phases [rad] broadcast against the fields."""
        xp, phase, amplitude, frequency = as_arrays(phase, self.flap_amplitude, self.frequency)
        return 2 * math.pi * frequency * amplitude * flap_speed(xp.cos(phase), self.flap_shape)

    def pitch_angle(self, phase: Real) -> Real:
        """θ(ωt) [rad]  (2.2); phases [rad] broadcast against the fields."""
        xp, phase, amplitude, delta = as_arrays(phase, self.pitch_amplitude, self.pitch_phase)
        return amplitude * pitch_waveform(xp.sin(phase + delta), self.pitch_shape)

    def pitch_rate(self, phase: Real) -> Real:
        """θ̇(ωt) [rad/s], the rate of (2.2); phases [rad] broadcast against the fields."""
        xp, phase, amplitude, frequency, delta = as_arrays(
            phase, self.pitch_amplitude, self.frequency, self.pitch_phase
        )
        phase = phase + delta
        return 2 * math.pi * frequency * amplitude * pitch_speed(xp.sin(phase), xp.cos(phase), self.pitch_shape)

    def flap_acceleration(self, phase: Real) -> Real:
        """φ̈(ωt) [rad/s²], from (2.1); phases [rad] broadcast against the fields."""
        xp, phase, amplitude, frequency = as_arrays(phase, self.flap_amplitude, self.frequency)
        return (2 * math.pi * frequency) ** 2 * amplitude * flap_bend(xp.sin(phase), xp.cos(phase), self.flap_shape)

    def pitch_acceleration(self, phase: Real) -> Real:
        """θ̈(ωt) [rad/s²], from (2.2); phases [rad] broadcast against the fields."""
        xp, phase, amplitude, frequency, delta = as_arrays(
            phase, self.pitch_amplitude, self.frequency, self.pitch_phase
        )
        phase = phase + delta
        return (2 * math.pi * frequency) ** 2 * amplitude * pitch_bend(xp.sin(phase), xp.cos(phase), self.pitch_shape)

    def angle_of_attack(self, phase: Real) -> Real:
        """α(ωt) [rad]  (2.3)."""
        return angle_of_attack(self.pitch_angle(phase), self.flap_rate(phase))
