"""Waveforms, their limits and rates."""

import dataclasses
import math

import numpy as np
import pytest
from conftest import strokes
from hypothesis import given

from flapenv import Stroke
from flapenv.aero.parameters import STROKE_PARAMETERS
from flapenv.aero.stroke import angle_of_attack

PHASE = (np.arange(1000) + 0.5) * 2 * math.pi / 1000
HOVER = Stroke(frequency=26.3, flap_amplitude=1.0, pitch_amplitude=1.0)


def replace(**changes: float) -> Stroke:
    return dataclasses.replace(HOVER, **changes)


def test_flapping_tends_to_a_sinusoid_and_to_a_triangle() -> None:
    np.testing.assert_allclose(replace(flap_shape=0.0).flap_angle(PHASE), np.sin(PHASE), rtol=1e-12)
    triangle = np.arcsin(np.sin(PHASE)) * 2 / math.pi
    np.testing.assert_allclose(replace(flap_shape=1.0).flap_angle(PHASE), triangle, rtol=1e-9, atol=1e-12)


def test_the_triangle_moves_at_the_mean_speed_always() -> None:
    stroke = replace(flap_shape=1.0)
    np.testing.assert_allclose(np.abs(stroke.flap_rate(PHASE)), stroke.mean_flap_speed, rtol=1e-12)


def test_pitching_tends_to_a_sinusoid_and_to_a_square_wave() -> None:
    np.testing.assert_allclose(replace(pitch_shape=0.0).pitch_angle(PHASE), np.cos(PHASE), rtol=1e-12, atol=1e-15)
    np.testing.assert_allclose(replace(pitch_shape=1e9).pitch_angle(PHASE), np.sign(np.cos(PHASE)), rtol=1e-12)


@given(strokes(sharpest_flap=0.9999, sharpest_pitch=100))
def test_angles_stay_within_their_amplitudes_and_reach_them(stroke: Stroke) -> None:
    phase = np.linspace(0, 2 * math.pi, 4001)
    assert np.max(np.abs(stroke.flap_angle(phase))) == pytest.approx(stroke.flap_amplitude, rel=1e-12)
    assert np.max(np.abs(stroke.pitch_angle(phase))) == pytest.approx(stroke.pitch_amplitude, rel=1e-5)


@given(strokes())
def test_half_strokes_mirror_each_other_for_every_pitch_phase(stroke: Stroke) -> None:
    for motion in (stroke.flap_angle, stroke.flap_rate, stroke.pitch_angle, stroke.pitch_rate):
        np.testing.assert_allclose(
            motion(PHASE + math.pi), -motion(PHASE), rtol=1e-9, atol=1e-9 * np.max(motion(PHASE))
        )
    np.testing.assert_allclose(stroke.angle_of_attack(PHASE + math.pi), stroke.angle_of_attack(PHASE), rtol=1e-9)


@given(strokes())
def test_rates_are_the_derivatives_of_the_angles(stroke: Stroke) -> None:
    omega, step = 2 * math.pi * stroke.frequency, 1e-5
    for angle, rate in ((stroke.flap_angle, stroke.flap_rate), (stroke.pitch_angle, stroke.pitch_rate)):
        difference = (angle(PHASE + step) - angle(PHASE - step)) / (2 * step) * omega
        np.testing.assert_allclose(rate(PHASE), difference, atol=1e-5 * np.max(np.abs(difference)))


@given(strokes(sharpest_flap=1.0))
def test_the_mean_speed_is_four_amplitudes_a_beat(stroke: Stroke) -> None:
    corners = np.array([-math.pi / 2, math.pi / 2])
    travelled = 2 * np.diff(stroke.flap_angle(corners))[0] * stroke.frequency
    assert travelled == pytest.approx(stroke.mean_flap_speed, rel=1e-12)


def test_the_angle_of_attack_is_symmetric_between_the_half_strokes() -> None:
    assert angle_of_attack(math.radians(58), 1.0) == pytest.approx(math.radians(32))
    assert angle_of_attack(math.radians(-58), -1.0) == pytest.approx(math.radians(32))
    assert angle_of_attack(math.radians(58), -1.0) == pytest.approx(math.radians(148))  # the wing moves backwards


def test_the_smallest_angle_of_attack_is_reached_at_mid_stroke_when_rotation_is_symmetric() -> None:
    stroke = replace(pitch_amplitude=math.radians(58))
    assert stroke.angle_of_attack(np.array([0.0]))[0] == pytest.approx(math.radians(32), rel=1e-3)
    assert np.min(stroke.angle_of_attack(PHASE)) == pytest.approx(math.radians(32), rel=1e-3)


def test_limits_and_corners_give_no_warning_and_no_nan() -> None:
    phase = np.array([0.0, math.pi / 2, math.pi, -math.pi / 2, 3 * math.pi / 2])
    for flap_shape in (0.0, 1e-300, 1e-9, 1 - 1e-16, 1.0):
        for pitch_shape in (0.0, 1e-300, 1e-9, 1e9, 1e300):
            stroke = replace(flap_shape=flap_shape, pitch_shape=pitch_shape)
            for motion in (stroke.flap_angle, stroke.flap_rate, stroke.pitch_angle, stroke.pitch_rate):
                with np.errstate(over="ignore"):  # a square wave's rate may be infinite, and is only there
                    values = motion(phase)
                assert not np.isnan(values).any()
            assert np.isfinite(stroke.angle_of_attack(phase)).all()


@pytest.mark.parametrize("name", STROKE_PARAMETERS)
def test_the_valid_range_of_every_parameter_is_held(name: str) -> None:
    row = STROKE_PARAMETERS[name]
    bad = [row.low - 1e-6, float("nan"), float("inf"), -float("inf")]
    bad += [row.high * (1 + 1e-6) + 1e-6] if math.isfinite(row.high) else []
    for value in bad:
        with pytest.raises(ValueError, match=rf"{name} = .* allowed: finite, in "):
            replace(**{name: value})
    for value in [row.low + 1e-6] + ([row.high] if math.isfinite(row.high) else [1e6]):
        assert getattr(replace(**{name: value}), name) == value


def test_replace_validates_again() -> None:
    with pytest.raises(ValueError, match="flap_amplitude = 4"):
        dataclasses.replace(HOVER, flap_amplitude=4.0)
    with pytest.raises(TypeError, match="Stroke has no field 'amplitude'"):
        Stroke(frequency=1.0, amplitude=1.0, pitch_amplitude=1.0)


@pytest.mark.parametrize(
    ("field", "value", "said"),
    [
        ("flap_amplitude", 60, "flap_amplitude = 60 is not allowed; .*; 60 looks like degrees: 1.0472 rad$"),
        ("flap_amplitude", 180, "180 looks like degrees: 3.1416 rad$"),
        ("pitch_amplitude", 45.0, "45 looks like degrees: 0.7854 rad$"),
        ("pitch_phase", 90, "90 looks like degrees: 1.5708 rad$"),
        ("pitch_phase", -90, "-90 looks like degrees: -1.5708 rad$"),
        ("flap_amplitude", np.array([1.0, 60.0, 70.0]), r"flap_amplitude\[1\] = 60 .*; 60 looks like degrees: 1.0472"),
    ],
)
def test_degrees_where_radians_are_due_are_told(field: str, value: object, said: str) -> None:
    numbers = {"frequency": 26.3, "flap_amplitude": 1.0, "pitch_amplitude": 1.0}
    with pytest.raises(ValueError, match=said):
        Stroke(**{**numbers, field: value})


@pytest.mark.parametrize(
    ("field", "value"),
    [
        ("flap_amplitude", 3.15),
        ("flap_amplitude", -60),
        ("flap_amplitude", 200),
        ("pitch_amplitude", 100),
        ("pitch_phase", 400),
        ("pitch_phase", math.nan),
        ("frequency", -60),
        ("flap_shape", 60),
    ],
)
def test_nothing_is_guessed_of_numbers_that_are_wrong_in_degrees_too(field: str, value: float) -> None:
    numbers = {"frequency": 26.3, "flap_amplitude": 1.0, "pitch_amplitude": 1.0}
    with pytest.raises(ValueError, match="is not allowed; allowed: finite, in") as caught:
        Stroke(**{**numbers, field: value})
    assert "degrees" not in str(caught.value)
