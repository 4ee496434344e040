"""Force coefficients (2.7)-(2.12)."""

import math

import numpy as np
import pytest

from flapenv.aero.coefficients import (
    SECTION_LIFT_SLOPE,
    drag_coefficient,
    lift_coefficient,
    lift_curve_slope,
    translational_lift_constant,
)

ALPHA = np.radians(np.arange(0, 181, 1.0))


def test_the_section_slope_is_009_per_degree() -> None:
    assert pytest.approx(5.157, abs=5e-4) == SECTION_LIFT_SLOPE  # Part II, section 2.3.2


def test_the_slope_tends_to_the_sections_for_a_slender_ideal_wing() -> None:
    assert lift_curve_slope(1e9, 1.0, 1.0) == pytest.approx(SECTION_LIFT_SLOPE, rel=1e-8)


def test_the_slope_falls_with_induced_power_and_rises_with_aspect_ratio() -> None:
    k = np.linspace(1, 2, 11)
    assert np.all(np.diff(lift_curve_slope(3.0, 1.2, k)) < 0)
    assert np.all(np.diff(lift_curve_slope(np.linspace(2, 6, 9), 1.2, 1.5)) > 0)


@pytest.mark.parametrize(
    ("aspect_ratio", "k", "low", "high"),
    [(2.83, 1.27, 1.33, 1.35), (3.16, 1.29, 1.40, 1.42), (2.02 / 0.67, 1.37, 1.34, 1.36)],
)
def test_revolving_wings_have_the_lift_constants_of_figure_5(
    aspect_ratio: float, k: float, low: float, high: float
) -> None:
    from flapenv import Wing

    edge = Wing(length=aspect_ratio, mean_chord=1.0, r1_hat=0.5).edge_correction("ellipse")
    assert low - 0.005 <= translational_lift_constant(aspect_ratio, edge, k) <= high + 0.005


def test_lift_is_that_of_the_slope_at_small_angles_and_greatest_at_45_degrees() -> None:
    slope = 3.0
    assert lift_coefficient(1e-6, slope / 2) == pytest.approx(slope * 1e-6, rel=1e-9)  # (2.8), (2.9)
    assert math.degrees(ALPHA[np.argmax(lift_coefficient(ALPHA, 1.5))]) == 45
    assert lift_coefficient(math.pi / 2, 1.5) == pytest.approx(0, abs=1e-15)


def test_drag_is_lift_times_the_tangent_and_finite_at_90_degrees() -> None:
    inner = ALPHA[(ALPHA > 0.01) & (np.abs(ALPHA - math.pi / 2) > 0.01)]
    np.testing.assert_allclose(drag_coefficient(inner, 1.5), lift_coefficient(inner, 1.5) * np.tan(inner), rtol=1e-12)
    assert drag_coefficient(math.pi / 2, 1.5) == pytest.approx(3.0)  # C_N at 90 degrees is 2 C_T
    assert np.all(drag_coefficient(ALPHA, 1.5) >= 0)


def test_the_force_is_normal_to_the_chord() -> None:
    chordwise = drag_coefficient(ALPHA, 1.5) * np.cos(ALPHA) - lift_coefficient(ALPHA, 1.5) * np.sin(ALPHA)
    np.testing.assert_allclose(chordwise, 0, atol=1e-14)
