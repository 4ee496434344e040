"""Translational force coefficients from wing geometry, (2.7)-(2.12)."""

import math

from flapenv.aero.arrays import Real, as_arrays, as_result

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


def translational_lift_constant(
    aspect_ratio: Real, edge_correction: Real, k: Real, section_lift_slope: Real = SECTION_LIFT_SLOPE
) -> Real:
    """C_T = C_Lα/2 [-]  (2.9); arguments as in `lift_curve_slope`."""
    return lift_curve_slope(aspect_ratio, edge_correction, k, section_lift_slope) / 2  # (2.9)


def lift_coefficient(alpha: Real, lift_constant: Real) -> Real:
    """C_L = C_T sin 2α [-]  (2.7); alpha [rad], lift_constant C_T [-], broadcast."""
    xp, alpha, lift_constant = as_arrays(alpha, lift_constant)
    return as_result(lift_constant * xp.sin(2 * alpha))  # (2.7)


def drag_coefficient(alpha: Real, lift_constant: Real) -> Real:
    """C_D = C_L tan α = 2 C_T sin² α [-]  (2.12), finite at 90°; alpha [rad], lift_constant C_T [-], broadcast."""
    xp, alpha, lift_constant = as_arrays(alpha, lift_constant)
    return as_result(2 * lift_constant * xp.sin(alpha) ** 2)  # (2.12)
