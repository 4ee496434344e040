"""Weight support and power of free waveforms: one path for the environment, its optimiser and single motions."""

import math
from typing import Any, NamedTuple

import numpy as np

from flapenv.aero import induced
from flapenv.aero.arrays import Real, as_arrays
from flapenv.aero.checks import shown
from flapenv.aero.spline_motion import SplineMotion
from flapenv.aero.splines import POINTS, half_cycle_integral, peak_slope, spline_averages
from flapenv.case import HoverCase, hover_case, induced_power_factor, lift_constant
from flapenv.insects import Insect, as_insect
from flapenv.model import HoverModel, warn_of_aspect_ratio
from flapenv.performance import HoverPerformance
from flapenv.problem import HoverProblem
from flapenv.waveform.coordinates import Waveform, require_served

PRECISE_POINTS = 12
"""Gauss points a knot interval where the averages count to some eight digits."""


class WaveformPerformance(NamedTuple):
    """What waveforms give, each of shape (...).

    Attributes:
        weight_support: Λ [-].
        specific_power: P* [W/kg].
        half_cycle: ∫|σ|dx over a half-cycle, as in `SplineAverages` [knots].
    """

    weight_support: Real
    specific_power: Real
    half_cycle: Real


def waveform_performance(
    case: HoverCase, model: HoverModel, waveform: Waveform, *, points: int = POINTS
) -> WaveformPerformance:
    """Λ [-] and P* [W/kg] of waveforms that are known to be valid.

        Λ = lift_scale C_T v̄² L,   P* = 2 power_scale v̄³ (C_T S + C_D0 K/2),   v̄ = 4 f φmax

    Args:
        case: the insect's numbers, fields of shape (...) or scalars.
        model: plate coefficients and elastic power.
        waveform: arrays or tensors.
        points: Gauss points a knot interval.

    Returns:
        Weight support and specific power among others, shape (...).
    """
    averages = spline_averages(
        waveform.speed_coefficients, waveform.pitch_coefficients, friction=model.profile_drag > 0, points=points
    )
    _, frequency, amplitude, lift_scale, power_scale, lift, power, friction = as_arrays(
        waveform.frequency, waveform.flap_amplitude, case.lift_scale, case.power_scale, *averages[:3]
    )
    speed = 4 * frequency * amplitude
    constant = lift_constant(case, model, speed, amplitude)
    square = speed * speed
    drag = constant * power + model.profile_drag / 2 * friction if model.profile_drag else constant * power
    return WaveformPerformance(
        weight_support=lift_scale * constant * square * lift,
        specific_power=2 * power_scale * (square * speed) * drag,
        half_cycle=averages.half_cycle,
    )


def peak_rates(waveform: Waveform, half_cycle: np.ndarray | None = None) -> tuple[np.ndarray, np.ndarray]:
    """φ̈max/ω² = max |d²φ/d(ωt)²| and θ̇max/ω = max |dθ/d(ωt)|, amplitudes included, exactly, shape (...) each [rad].

    A sinusoid has φmax and θmax, a triangle or a square wave infinity.

    Args:
        waveform: arrays.
        half_cycle: `WaveformPerformance.half_cycle` where it is known already.
    """
    speed, pitch = waveform.speed_coefficients, waveform.pitch_coefficients
    rate = speed.shape[-1] / math.pi  # dx/d(ωt)
    scale = 2 * waveform.flap_amplitude / (half_cycle_integral(speed) if half_cycle is None else half_cycle)
    return scale * rate * rate * peak_slope(speed), rate * peak_slope(pitch)


def evaluate_waveform(insect: Insect | str, motion: SplineMotion, **model: Any) -> HoverPerformance:
    """Weight support and power of an insect beating a spline waveform, as `flapenv.evaluate` gives them of a stroke.

    Args:
        insect: one insect or a name of `INSECTS`.
        motion: the wingbeat.
        **model: options of `HoverModel`.

    Returns:
        Performance in SI units, to 1e-7.

    Raises:
        TypeError: for an unknown option, or an insect or a motion of another kind.
        ValueError: for an option out of range, a model that waveforms are not served with, or φmax > 90° where k_flap
            is used.
    """
    insect, options = as_insect(insect), HoverModel(**model)
    if not isinstance(motion, SplineMotion):
        raise TypeError(f"motion = {shown(motion)} is not allowed; allowed: a SplineMotion")
    require_served(HoverProblem(model=options))
    if options.uses_k:
        induced.k_flap(motion.flap_amplitude)
    warn_of_aspect_ratio(insect.name, insect.wing.aspect_ratio, options, stacklevel=3)
    case = hover_case(insect, options)
    waveform = Waveform(
        motion.frequency,
        motion.flap_amplitude,
        np.array(motion.speed_coefficients),
        np.array(motion.pitch_coefficients),
    )
    weight_support, specific_power, _ = waveform_performance(case, options, waveform, points=PRECISE_POINTS)
    speed, amplitude = motion.mean_flap_speed, motion.flap_amplitude
    return HoverPerformance(
        weight_support=float(weight_support),
        specific_power=float(specific_power),
        lift=float(weight_support) * insect.mass * options.gravity,
        power=float(specific_power) * insect.mass,
        lift_constant=lift_constant(case, options, speed, amplitude),
        induced_power_factor=induced_power_factor(case, options, speed, amplitude),
    )
