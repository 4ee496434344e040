"""Translational force coefficients as functions of the angle of attack: the paper's (2.7)-(2.12), and others'."""

import math

import numpy as np

from flapenv.aero.arrays import Real, as_arrays, as_result
from flapenv.aero.checks import require_real, shown

SECTION_LIFT_SLOPE = 0.09 * 180 / math.pi
"""C_Lα,2d = 0.09 per degree [1/rad], Okamoto et al.'s flat plates at insect Reynolds numbers (Part II, 2.3.2)."""


def lift_curve_slope(
    aspect_ratio: Real, edge_correction: Real, k: Real, section_lift_slope: Real = SECTION_LIFT_SLOPE
) -> Real:
    """C_Lα = a₂d/(E + k a₂d/(π AR)), Prandtl's lifting line with Jones' edge correction  (2.10).

    Args:
        aspect_ratio: AR of one wing [-].
        edge_correction: E [-].
        k: induced power factor, k_ind k_tip k_flap when flapping, k_ind k_tip when revolving [-].
        section_lift_slope: a₂d [1/rad].

    Returns:
        The slope at small angles of attack [1/rad], of the broadcast shape.
    """
    _, aspect_ratio, edge_correction, k, slope = as_arrays(aspect_ratio, edge_correction, k, section_lift_slope)
    return as_result(slope / (edge_correction + k * slope / (math.pi * aspect_ratio)))  # (2.10)


def extended_lift_curve_slope(aspect_ratio: Real, section_lift_slope: Real = SECTION_LIFT_SLOPE) -> Real:
    """C_Lα = π AR/(1 + √((π AR/a₂d)² + 1)), the extended lifting line, meant for AR < 3 (Part II, 2.3.2 and 3.1).

    It knows neither edge correction nor k. Its limits are π AR/2 for AR → 0 and a₂d for AR → ∞.

    Args:
        aspect_ratio: AR of one wing [-].
        section_lift_slope: a₂d [1/rad].

    Returns:
        The slope at small angles of attack [1/rad], of the broadcast shape.
    """
    xp, aspect_ratio, slope = as_arrays(aspect_ratio, section_lift_slope)
    span = math.pi * aspect_ratio
    return as_result(span / (1 + xp.sqrt((span / slope) ** 2 + 1)))


def translational_lift_constant(
    aspect_ratio: Real, edge_correction: Real, k: Real, section_lift_slope: Real = SECTION_LIFT_SLOPE
) -> Real:
    """C_T = C_Lα/2 [-]  (2.9), for which (2.7) has the slope C_Lα at small α  (2.8).

    Arguments as in `lift_curve_slope`.
    """
    return lift_curve_slope(aspect_ratio, edge_correction, k, section_lift_slope) / 2  # (2.9)


def lift_coefficient(alpha: Real, lift_constant: Real) -> Real:
    """C_L = C_T sin 2α [-]  (2.7); alpha [rad], lift_constant C_T [-], broadcast."""
    xp, alpha, lift_constant = as_arrays(alpha, lift_constant)
    return as_result(lift_constant * xp.sin(2 * alpha))  # (2.7)


def drag_coefficient(alpha: Real, lift_constant: Real) -> Real:
    """C_D = C_L tan α = 2 C_T sin² α [-]  (2.12), finite at 90°; alpha [rad], lift_constant C_T [-], broadcast."""
    xp, alpha, lift_constant = as_arrays(alpha, lift_constant)
    return as_result(2 * lift_constant * xp.sin(alpha) ** 2)  # (2.12)


def polhamus_lift(alpha: Real, slope: Real, k: Real, aspect_ratio: Real) -> Real:
    """C_L = K_P sin α cos² α + (K_P - K_P² K_i) cos α sin² α, the leading-edge suction analogy, unswept  (3.1).

    Args:
        alpha: α [rad].
        slope: K_P = C_Lα, of potential flow at small angles [1/rad].
        k: induced power factor, which gives K_i = k/(π AR) [-].
        aspect_ratio: AR of one wing [-].

    Returns:
        The lift coefficient [-], of the broadcast shape.

    Source: Polhamus (1966), as in Nabawy & Crowther (2014), Part II, section 3.1.
    """
    xp, alpha, slope, k, aspect_ratio = as_arrays(alpha, slope, k, aspect_ratio)
    sine, cosine = xp.sin(alpha), xp.cos(alpha)
    induced = slope**2 * k / (math.pi * aspect_ratio)  # K_P² K_i
    return as_result(slope * sine * cosine**2 + (slope - induced) * cosine * sine**2)  # (3.1)


def polhamus_factor(alpha: Real, slope: Real, k: Real, aspect_ratio: Real) -> Real:
    """K_Polhamus = cos α + (1 - k K_P/(π AR)) sin α [-], what (3.1) has beyond ½ K_P sin 2α  (3.2).

    Arguments as in `polhamus_lift`.
    """
    xp, alpha, slope, k, aspect_ratio = as_arrays(alpha, slope, k, aspect_ratio)
    return as_result(xp.cos(alpha) + (1 - k * slope / (math.pi * aspect_ratio)) * xp.sin(alpha))  # (3.2)


def fold(alpha: Real) -> tuple[Real, Real]:
    """An angle of attack as a plate feels it: folded into [0, 90°], and the sign that the lift then has.

    A plate at 180° - α meets the flow with its other edge: the same drag and the opposite lift, as at -α.

    Args:
        alpha: α [rad], any.

    Returns:
        The folded angle [rad] and the sign, +1 or -1 [-].
    """
    xp, alpha = as_arrays(alpha)
    sine, cosine = xp.sin(alpha), xp.cos(alpha)
    one = xp.ones_like(sine)
    return xp.atan2(xp.abs(sine), xp.abs(cosine)), xp.where(sine * cosine < 0, -one, one)


def robofly_lift(alpha: Real) -> Real:
    """C_L = 0.225 + 1.58 sin(2.13 α - 7.2°) [-], fitted to a dynamically scaled fruit fly; alpha [rad].

    Fitted between 0 and 90°; angles beyond are folded into it, see `fold`.

    Source: Dickinson, Lehmann & Sane (1999), Science 284.
    """
    xp, alpha = as_arrays(alpha)
    folded, sign = fold(alpha)
    return as_result(sign * (0.225 + 1.58 * xp.sin(2.13 * folded - math.radians(7.2))))


def robofly_drag(alpha: Real) -> Real:
    """C_D = 1.92 - 1.55 cos(2.04 α - 9.82°) [-]; alpha [rad], folded as in `robofly_lift`, with the same source."""
    xp, alpha = as_arrays(alpha)
    folded, _ = fold(alpha)
    return as_result(1.92 - 1.55 * xp.cos(2.04 * folded - math.radians(9.82)))


def berman_wang_drag(alpha: Real, zero_drag: Real, normal_drag: Real) -> Real:
    """C_D = C_D0 cos² α + C_D90 sin² α [-]; their lift is (2.7) with a C_T of their own.

    Args:
        alpha: α [rad].
        zero_drag: C_D0, at 0° [-].
        normal_drag: C_D90, at 90° [-].

    Source: Berman & Wang (2007), JFM 582.
    """
    xp, alpha, zero_drag, normal_drag = as_arrays(alpha, zero_drag, normal_drag)
    return as_result(zero_drag * xp.cos(alpha) ** 2 + normal_drag * xp.sin(alpha) ** 2)


def checked_coefficients(function: object) -> None:
    """Try a user's `f(alpha) -> (C_L, C_D)` over [0, 90°].

    Raises:
        TypeError: if it is not callable, or does not answer with two arrays of alpha's shape.
        ValueError: for NaN, inf, a negative C_D or none at all.
    """
    if not callable(function):
        raise TypeError(f"coefficients = {shown(function)} are not allowed; allowed: a name, or a function of alpha")
    alpha = np.linspace(0, math.pi / 2, 91)
    answer = function(alpha)
    if not isinstance(answer, tuple) or len(answer) != 2:
        raise TypeError("coefficients' function does not give a pair; allowed: (C_L, C_D) of alpha [rad]")
    for name, value, low in (("C_L", answer[0], -math.inf), ("C_D", answer[1], 0.0)):
        checked = require_real(f"coefficients' {name}", value, low)
        if np.shape(checked) != alpha.shape:
            raise TypeError(f"coefficients' {name} has shape {np.shape(checked)} for angles of {alpha.shape}")
    if not np.any(answer[1]):
        raise ValueError("coefficients' C_D is zero at every angle; allowed: a force that costs power")
