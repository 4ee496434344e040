"""Every term of the general blade element: signs, symmetry, cancellation, scaling, frames and the energy balance."""

import dataclasses
import math

import numpy as np
import pytest
from conftest import strokes
from hypothesis import given, settings
from hypothesis import strategies as st

from flapenv import FourierMotion, Stroke, Wing, load_insect
from flapenv.aero.axes import LEFT, RIGHT, flapping_directions, to_stroke_plane
from flapenv.aero.blade_element import TERMS, blade_element, rotational_coefficient
from flapenv.aero.force_laws import PlateLaw
from flapenv.aero.history import WingbeatHistory
from flapenv.aero.inertia import wing_inertia

HAWKMOTH = load_insect("hawkmoth")
WING, OWN = HAWKMOTH.wing, HAWKMOTH.stroke
LAW = PlateLaw(constant=1.3)
DELAYED, ADVANCED = math.radians(60), math.radians(120)


def beat(stroke: object = OWN, wing: Wing = WING, **options: object) -> WingbeatHistory:
    defaults = {"terms": TERMS, "strips": 12, "steps": 800, "spacing": "gauss", "air_density": 1.225}
    return blade_element(wing, stroke, LAW, **{**defaults, **options})


def relative_mean_lift(history: WingbeatHistory, term: str) -> float:
    lift = history.terms[term].force[:, 2]
    return float(np.mean(lift) / np.max(np.abs(lift)))


@given(strokes(sharpest_flap=0.95))
@settings(max_examples=25)
def test_rotational_and_added_mass_lift_cancel_for_symmetric_rotation_and_follow_the_phase(stroke: Stroke) -> None:
    means = {}
    for phase in (DELAYED, math.pi / 2, ADVANCED):
        history = beat(dataclasses.replace(stroke, pitch_phase=phase))
        means[phase] = {term: relative_mean_lift(history, term) for term in ("rotational", "added-mass")}
    for term in ("rotational", "added-mass"):
        assert means[math.pi / 2][term] == pytest.approx(0, abs=1e-10)
        assert means[DELAYED][term] < -1e-4
        assert means[ADVANCED][term] == pytest.approx(-means[DELAYED][term], rel=1e-6)


def test_nose_up_rotation_adds_lift() -> None:
    history = beat(dataclasses.replace(OWN, pitch_phase=ADVANCED))
    angles = history.kinematics
    nose_up = -np.sin(angles.pitch) * angles.pitch_rate  # d(cos θ)/dt
    lift = history.terms["rotational"].force[:, 2]
    busy = np.abs(lift) > 1e-6 * np.max(np.abs(lift))
    assert np.all(np.sign(lift[busy]) == np.sign(nose_up[busy]))
    assert rotational_coefficient(0.25) == pytest.approx(math.pi / 2)  # (2.15)


@given(strokes(sharpest_flap=0.95, sharpest_pitch=8.0), st.floats(0.0, 0.5))
@settings(max_examples=25)
def test_mean_power_of_added_mass_and_inertia_is_zero_for_any_periodic_stroke(stroke: Stroke, axis: float) -> None:
    history = beat(stroke, dataclasses.replace(WING, pitch_axis=axis), steps=4000)
    for term in ("added-mass", "added-mass-pitch", "inertia"):
        power = history.terms[term].power
        assert np.mean(power) == pytest.approx(0, abs=1e-10 * max(np.max(np.abs(power)), 1e-300)), term
        assert np.all(np.abs(np.mean(history.terms["inertia"].force, axis=0)) < 1e-9 * history.force.max())


def test_mean_lift_of_the_mid_chord_term_is_that_of_its_formula_and_vanishes_with_the_axis_at_mid_chord() -> None:
    for phase in (DELAYED, math.pi / 2, ADVANCED):
        history = beat(dataclasses.replace(OWN, pitch_phase=phase), strips=400, steps=4000)
        at = history.kinematics
        integral = WING.shape.moment(0, 3) * WING.length * WING.mean_chord**3 / 4  # ∫c² ξ dr, ξ = c/4
        expected = 2 * math.pi / 4 * 1.225 * integral * np.mean(at.pitch_rate**2 * np.cos(at.pitch))
        assert np.mean(history.terms["added-mass-pitch"].force[:, 2]) == pytest.approx(expected, rel=1e-4)
        assert expected > 0
    middle = beat(wing=dataclasses.replace(WING, pitch_axis=0.5))
    assert np.all(middle.terms["added-mass-pitch"].force == 0)


def test_added_mass_at_mid_chord_is_the_mass_times_the_normal_acceleration_there() -> None:
    """(2.16) with Vₙ at mid-chord, differentiated numerically: both added-mass terms together."""
    stroke = dataclasses.replace(OWN, pitch_phase=ADVANCED, pitch_shape=2.0)
    history = beat(stroke, strips=5, steps=10_000, spacing="even", terms=("added-mass", "added-mass-pitch"))
    r_hat = (np.arange(5) + 0.5) / 5
    step = 1 / (10_000 * stroke.frequency)
    total = np.zeros_like(history.phase)
    for radius, chord in zip(r_hat * WING.length, WING.chord(r_hat), strict=True):
        v = -history.kinematics.flap_rate * radius * np.cos(history.kinematics.pitch)
        v += chord / 4 * history.kinematics.pitch_rate
        rate = (np.roll(v, -1) - np.roll(v, 1)) / (2 * step)
        total -= math.pi / 4 * 1.225 * chord**2 * rate * WING.length / 5
    lift = 2 * total * np.sin(history.kinematics.pitch)
    np.testing.assert_allclose(history.lift, lift, atol=1e-5 * np.max(np.abs(lift)))


@given(strokes(sharpest_flap=0.95), st.floats(-math.pi, math.pi))
@settings(max_examples=25)
def test_tilting_the_stroke_plane_rotates_the_force_and_leaves_the_power(stroke: Stroke, angle: float) -> None:
    level, tilted = beat(stroke, steps=200), beat(stroke, steps=200, stroke_plane_angle=angle)
    sine, cosine = math.sin(angle), math.cos(angle)
    x, y, z = level.earth_force.T
    turned = np.stack([cosine * x + sine * z, y, -sine * x + cosine * z], axis=-1)
    np.testing.assert_allclose(tilted.earth_force, turned, atol=1e-12 * np.max(np.abs(turned)))
    np.testing.assert_array_equal(tilted.power, level.power)


def test_a_stroke_plane_that_leans_forward_pulls_forward() -> None:
    history = beat(stroke_plane_angle=math.radians(20), terms=["translational"])
    assert np.mean(history.earth_force[:, 0]) == pytest.approx(math.tan(math.radians(20)) * history.mean_lift)


@given(strokes(sharpest_flap=0.95))
@settings(max_examples=25)
def test_every_term_goes_with_the_square_of_the_frequency_and_its_power_with_the_cube(stroke: Stroke) -> None:
    slow, fast = beat(stroke, steps=200), beat(dataclasses.replace(stroke, frequency=2 * stroke.frequency), steps=200)
    for term in TERMS:
        force, power = slow.terms[term].force, slow.terms[term].power
        np.testing.assert_allclose(fast.terms[term].force, 4 * force, atol=1e-12 * np.max(np.abs(force)))
        np.testing.assert_allclose(fast.terms[term].power, 8 * power, atol=1e-12 * np.max(np.abs(power)))


def test_mirrored_strokes_give_mirrored_forces() -> None:
    """φ → -φ, θ → -θ: the same lift, the opposite thrust, the same power."""
    series = {"flap_cosines": [0.2, 0.1], "flap_sines": [0.9], "pitch_cosines": [0.1, 0.8], "pitch_sines": [0.2]}
    there = FourierMotion(frequency=26.0, **series)
    back = FourierMotion(frequency=26.0, **{name: [-value for value in row] for name, row in series.items()})
    a, b = beat(there), beat(back)
    for term in TERMS:
        force, mirrored = a.terms[term].force, b.terms[term].force
        np.testing.assert_allclose(mirrored, force * (-1, 1, 1), atol=1e-12 * np.max(np.abs(force)))
    np.testing.assert_allclose(a.power, b.power, atol=1e-12 * np.max(np.abs(a.power)))


def test_the_second_half_stroke_mirrors_the_first() -> None:
    history = beat(dataclasses.replace(OWN, pitch_phase=ADVANCED))
    first, second = np.split(history.force, 2)
    np.testing.assert_allclose(second, first * (-1, 1, 1), atol=1e-9 * np.max(np.abs(first)))


@given(
    velocity=st.tuples(*[st.floats(-2, 2)] * 3),
    angle=st.floats(-1, 1),
    stroke=strokes(sharpest_flap=0.9, sharpest_pitch=4.0),
)
@settings(max_examples=25)
def test_muscle_power_is_torque_times_rate_and_balances_the_energy(
    velocity: tuple[float, float, float], angle: float, stroke: Stroke
) -> None:
    """What the muscles pay is what the wings lose to the air, less what the air's force does on the moving body."""
    history = beat(stroke, steps=400, body_velocity=velocity, stroke_plane_angle=angle, terms=["translational"])
    at = history.kinematics
    paid = history.flap_torque * at.flap_rate + history.pitch_torque * at.pitch_rate
    np.testing.assert_allclose(history.wing_power, paid, rtol=1e-12)
    body = to_stroke_plane(np.array(velocity), angle)
    r_hat, share = WING.shape.strips(12)
    lost = np.zeros(400)
    for side in (RIGHT, LEFT):
        along, _ = flapping_directions(at.flap, side)
        v = at.flap_rate[:, None] * r_hat * WING.length + (along @ body)[:, None]
        sine, cosine = np.sin(at.pitch)[:, None], np.cos(at.pitch)[:, None]
        chordwise, normal = v * sine + body[2] * cosine, -v * cosine + body[2] * sine
        speed = np.hypot(chordwise, normal)
        drag = 0.5 * 1.225 * speed**2 * LAW.drag(np.abs(normal) / speed, np.abs(chordwise) / speed)
        lost += (drag * speed * share * WING.area).sum(axis=1)
    on_body = history.earth_force @ np.array(velocity)
    np.testing.assert_allclose(history.power, lost + on_body, atol=1e-10 * np.max(np.abs(lost)))


def test_a_climbing_body_meets_less_lift_by_the_derivative_of_section_8() -> None:
    """∂F_z/∂w_b = -2ρ C_T c̄ R² r̂₁ ⟨|φ̇| cos² α⟩ for small speeds, two wings."""
    wing = Wing(length=0.05, mean_chord=0.018, r1_hat=0.46)
    stroke = Stroke(frequency=26.0, flap_amplitude=1.0, pitch_amplitude=0.9, pitch_shape=5.0)
    small = 1e-6
    up, down = (
        beat(stroke, wing, body_velocity=(0, 0, w), terms=["translational"], steps=4001).mean_lift
        for w in (small, -small)
    )
    history = beat(stroke, wing, terms=["translational"], steps=4001)
    at, alpha = history.kinematics, history.angle_of_attack
    weight = np.mean(np.abs(at.flap_rate) * np.cos(alpha) ** 2)
    expected = -2 * 1.225 * 1.3 * 0.018 * 0.05**2 * wing.r1_hat * weight
    assert (up - down) / (2 * small) == pytest.approx(expected, rel=2e-3)
    assert beat(stroke, wing, body_velocity=(0, 0, 0.3), terms=["translational"]).mean_lift < history.mean_lift


def test_flying_forward_brakes_a_level_stroke_plane_and_slipping_sideways_pushes_back() -> None:
    forward = beat(body_velocity=(1.0, 0, 0), terms=["translational"])
    assert np.mean(forward.earth_force[:, 0]) < 0
    assert np.mean(forward.earth_force[:, 1]) == pytest.approx(0, abs=1e-12)
    left = beat(body_velocity=(0, 1.0, 0), terms=["translational"])
    right = beat(body_velocity=(0, -1.0, 0), terms=["translational"])
    assert np.mean(left.earth_force[:, 1]) < 0
    np.testing.assert_allclose(left.wing_power, right.wing_power[::-1], rtol=1e-12)


def test_only_positive_power_is_paid_where_none_is_stored() -> None:
    history = beat()
    assert history.mean_power("positive") == pytest.approx(
        float(np.mean(np.maximum(history.wing_power, 0).sum(axis=0)))
    )
    assert history.mean_power("positive") > history.mean_power("elastic")
    quiet = beat(terms=["translational"])
    assert quiet.mean_power("positive") == pytest.approx(quiet.mean_power("elastic"))  # drag never gives back
    with pytest.raises(ValueError, match="accounting = 'free' is unknown; allowed: elastic, positive"):
        history.mean_power("free")


def test_inertia_is_that_of_lagranges_equations() -> None:
    """Torques from the kinetic energy, differentiated numerically along the motion; and the pair's momentum."""
    stroke = dataclasses.replace(OWN, pitch_shape=2.0, pitch_phase=ADVANCED)
    history = beat(stroke, terms=["inertia"], steps=40_000)
    at, inertia, step = history.kinematics, wing_inertia(WING), 1 / (40_000 * stroke.frequency)
    a, b, d = inertia.radius, inertia.product, inertia.chord
    flap_momentum = (a + d * np.sin(at.pitch) ** 2) * at.flap_rate - b * np.cos(at.pitch) * at.pitch_rate
    pitch_momentum = d * at.pitch_rate - b * np.cos(at.pitch) * at.flap_rate
    by_pitch = np.sin(at.pitch) * at.flap_rate * (d * np.cos(at.pitch) * at.flap_rate + b * at.pitch_rate)

    def rate(values: np.ndarray) -> np.ndarray:
        return (np.roll(values, -1, axis=0) - np.roll(values, 1, axis=0)) / (2 * step)

    for found, expected in (
        (history.flap_torque[0], rate(flap_momentum)),
        (history.pitch_torque[1], rate(pitch_momentum) - by_pitch),
    ):
        np.testing.assert_allclose(found, expected, atol=1e-5 * np.max(np.abs(expected)))
    forward = inertia.first_radius * np.sin(at.flap) - inertia.first_chord * np.sin(at.pitch) * np.cos(at.flap)
    upward = -inertia.first_chord * np.cos(at.pitch)
    for axis, place in ((0, forward), (2, upward)):
        expected = -2 * rate(rate(place))
        np.testing.assert_allclose(history.force[:, axis], expected, atol=1e-4 * np.max(np.abs(expected)))


def test_moments_of_mass_of_a_rectangular_plate_are_those_of_the_textbook() -> None:
    plate = Wing.from_table([0, 0.1], [0.02, 0.02], mass=3e-3, pitch_axis=0.5)
    inertia = wing_inertia(plate)
    assert inertia.radius == pytest.approx(3e-3 * 0.1**2 / 3)
    assert inertia.chord == pytest.approx(3e-3 * 0.02**2 / 12)
    assert inertia.product == 0
    leading = wing_inertia(dataclasses.replace(plate, pitch_axis=0.0))
    assert leading.chord == pytest.approx(3e-3 * 0.02**2 / 3)
    assert leading.product == pytest.approx(3e-3 * 0.1 / 2 * 0.02 / 2)


@pytest.mark.parametrize(
    ("options", "kind", "said"),
    [
        ({"terms": ["lift"]}, ValueError, "terms = 'lift' is unknown; allowed: translational, rotational"),
        ({"terms": []}, ValueError, r"terms = \[\] is not allowed"),
        ({"terms": "inertia"}, ValueError, "terms = 'inertia' is not allowed; allowed: a list of"),
        ({"body_velocity": (1.0, 2.0)}, TypeError, r"body_velocity has shape \(2,\)"),
        ({"body_velocity": (1.0, 2.0, math.nan)}, ValueError, r"body_velocity\[2\] = nan"),
        ({"stroke_plane_angle": math.inf}, ValueError, "stroke_plane_angle = inf"),
        ({"wing": dataclasses.replace(WING, mass=None)}, ValueError, r"wing mass is missing.*Wing\(\.\.\., mass="),
        ({"stroke": dataclasses.replace(OWN, flap_shape=1.0)}, ValueError, "flap_shape = 1 .* infinite at its corners"),
    ],
)
def test_bad_input_is_named(options: dict[str, object], kind: type[Exception], said: str) -> None:
    with pytest.raises(kind, match=said):
        beat(**options)
