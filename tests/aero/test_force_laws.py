"""Force laws: the vector form against angles, limits, folding, and the published fits."""

import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from flapenv.aero.coefficients import (
    checked_coefficients,
    drag_coefficient,
    extended_lift_curve_slope,
    fold,
    lift_coefficient,
    polhamus_factor,
    polhamus_lift,
    robofly_drag,
    robofly_lift,
)
from flapenv.aero.force_laws import BermanWangLaw, FittedLaw, ForceLaw, PlateLaw, PolhamusLaw, robofly

LAWS = {
    "plate": PlateLaw(constant=1.3),
    "plate with profile drag": PlateLaw(constant=1.3, profile_drag=0.2),
    "polhamus": PolhamusLaw(slope=2.6, suction=0.7),
    "berman-wang": BermanWangLaw(constant=1.8, zero_drag=0.2, normal_drag=3.3),
    "robofly": FittedLaw(function=robofly),
}
ALPHA = np.radians(np.arange(0, 91, 1.0))
speeds = st.floats(-20, 20).filter(lambda v: abs(v) > 1e-3)


@pytest.fixture(params=LAWS)
def law(request: pytest.FixtureRequest) -> ForceLaw:
    return LAWS[request.param]


@given(along=speeds, theta=st.floats(-math.pi, math.pi))
def test_the_vector_form_is_the_papers_lift_and_drag_beyond_90_degrees_too(along: float, theta: float) -> None:
    """A planar stroke at φ̇r = along: α = 90° - θ sgn φ̇ in (2.7) and (2.12), drag against the motion, lift upwards."""
    chordwise, normal = along * math.sin(theta), -along * math.cos(theta)
    force_c, force_n = PlateLaw(constant=1.3).strip_force(chordwise, normal)
    forward = force_c * math.sin(theta) - force_n * math.cos(theta)
    upward = force_c * math.cos(theta) + force_n * math.sin(theta)
    alpha = math.pi / 2 - theta * math.copysign(1, along)
    assert upward == pytest.approx(along**2 * lift_coefficient(alpha, 1.3), abs=1e-12 * along**2)
    assert forward == pytest.approx(-along * abs(along) * drag_coefficient(alpha, 1.3), abs=1e-12 * along**2)
    assert force_c == 0  # normal to the chord


@given(chordwise=speeds, normal=speeds)
def test_the_direct_vector_form_is_the_general_one(chordwise: float, normal: float) -> None:
    law = LAWS["plate with profile drag"]
    direct, general = law.strip_force(chordwise, normal), ForceLaw.strip_force(law, chordwise, normal)
    np.testing.assert_allclose(direct, general, atol=1e-12 * (chordwise**2 + normal**2))


@given(chordwise=speeds, normal=speeds)
def test_every_law_opposes_motion_by_its_drag_and_mirrors_with_the_plate(chordwise: float, normal: float) -> None:
    for name, law in LAWS.items():
        along_c, along_n = law.strip_force(chordwise, normal)
        speed = math.hypot(chordwise, normal)
        drag = law.drag(abs(normal) / speed, abs(chordwise) / speed)
        assert along_c * chordwise + along_n * normal == pytest.approx(-drag * speed**3, rel=1e-9), name
        np.testing.assert_allclose(law.strip_force(-chordwise, normal), (-along_c, along_n), rtol=1e-12)
        np.testing.assert_allclose(law.strip_force(chordwise, -normal), (along_c, -along_n), rtol=1e-12)
        np.testing.assert_allclose(
            law.strip_force(2 * chordwise, 2 * normal), (4 * along_c, 4 * along_n), rtol=1e-9, atol=1e-9 * speed**2
        )


def test_still_air_exerts_no_force(law: ForceLaw) -> None:
    np.testing.assert_array_equal(law.strip_force(np.zeros(3), np.zeros(3)), np.zeros((2, 3)))


def test_the_lift_constant_is_the_lift_at_45_degrees(law: ForceLaw) -> None:
    assert law.lift_constant == pytest.approx(float(law.lift(math.sqrt(0.5), math.sqrt(0.5))))


def test_polhamus_two_forms_are_one() -> None:
    slope, k, aspect_ratio = 2.4, 1.3, 3.2
    rearranged = slope / 2 * np.sin(2 * ALPHA) * polhamus_factor(ALPHA, slope, k, aspect_ratio)  # (3.2)
    np.testing.assert_allclose(polhamus_lift(ALPHA, slope, k, aspect_ratio), rearranged, atol=1e-14)
    law = PolhamusLaw(slope=slope, suction=1 - k * slope / (math.pi * aspect_ratio))
    np.testing.assert_allclose(law.lift(np.sin(ALPHA), np.cos(ALPHA)), rearranged, atol=1e-14)
    normal_force = law.lift(np.sin(ALPHA), np.cos(ALPHA)) * np.sin(ALPHA)
    np.testing.assert_allclose(law.drag(np.sin(ALPHA), np.cos(ALPHA)) * np.cos(ALPHA), normal_force, atol=1e-14)


def test_polhamus_factor_is_near_one_above_it_and_grows_with_aspect_ratio() -> None:
    aspect_ratio = np.linspace(1, 6, 11)
    slope = extended_lift_curve_slope(aspect_ratio)
    factor = polhamus_factor(math.pi / 4, slope, 1.0, aspect_ratio)  # Fig. 4b: k = 1 at 45°
    assert np.all(np.diff(factor) > 0)
    assert np.all((factor > 1) & (factor < 1.3))  # "of the order of unity", "slightly higher than unity"


def test_the_extended_lifting_line_has_the_limits_of_slender_and_of_long_wings() -> None:
    assert extended_lift_curve_slope(1e-6) == pytest.approx(math.pi * 1e-6 / 2, rel=1e-6)
    assert extended_lift_curve_slope(1e6, 5.0) == pytest.approx(5.0, rel=1e-5)
    assert np.all(np.diff(extended_lift_curve_slope(np.linspace(0.5, 8, 20))) > 0)


def test_robofly_fits_have_the_published_numbers() -> None:
    # Dickinson, Lehmann & Sane (1999): 0.225 + 1.58 sin(2.13 x 45 - 7.2), 1.92 - 1.55 cos(2.04 x 45 - 9.82), in degrees
    assert robofly_lift(math.pi / 4) == pytest.approx(0.225 + 1.58 * math.sin(math.radians(88.65)), rel=1e-12)
    assert robofly_drag(math.pi / 4) == pytest.approx(1.92 - 1.55 * math.cos(math.radians(81.98)), rel=1e-12)
    assert robofly_drag(0.0) == pytest.approx(0.393, abs=1e-3)


@given(st.floats(-20, 20))
def test_angles_beyond_90_degrees_are_folded(alpha: float) -> None:
    folded, sign = fold(alpha)
    assert 0 <= folded <= math.pi / 2
    assert math.sin(folded) == pytest.approx(abs(math.sin(alpha)), abs=1e-12)
    assert abs(sign) == 1
    assert robofly_drag(alpha) == pytest.approx(robofly_drag(math.pi - alpha), abs=1e-9)
    assert robofly_drag(alpha) == pytest.approx(robofly_drag(-alpha), abs=1e-9)
    if abs(math.sin(2 * alpha)) > 1e-6:  # the fit jumps where a plate has no lift
        assert robofly_lift(alpha) == pytest.approx(-robofly_lift(math.pi - alpha), abs=1e-9)
        assert robofly_lift(alpha) == pytest.approx(-robofly_lift(-alpha), abs=1e-9)


def test_robofly_at_120_degrees_is_minus_its_lift_at_60() -> None:
    assert robofly_lift(math.radians(120)) == pytest.approx(-robofly_lift(math.radians(60)))


@pytest.mark.parametrize(
    ("function", "kind", "said"),
    [
        (7, TypeError, "coefficients = 7 are not allowed"),
        (lambda alpha: alpha, TypeError, "does not give a pair"),
        (lambda alpha: (1.0, alpha), TypeError, r"C_L has shape \(\)"),
        (lambda alpha: (alpha, alpha - 1), ValueError, r"C_D\[0\] = -1 "),
        (lambda alpha: (alpha / 0, alpha), ValueError, r"C_L\[0\] = nan"),
    ],
)
def test_bad_functions_are_refused(function: object, kind: type[Exception], said: str) -> None:
    with np.errstate(all="ignore"), pytest.raises(kind, match=said):
        checked_coefficients(function)
