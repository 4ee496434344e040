"""Spline waveforms: what their construction promises, their averages against slow ones and known waveforms."""

import math

import numpy as np
import pytest
import torch
from hypothesis import given
from hypothesis import strategies as st

from flapenv.aero.spline_motion import SplineMotion
from flapenv.aero.splines import (
    bspline,
    find_reversal,
    half_cycle_basis,
    half_cycle_integral,
    near_integral,
    near_value,
    peak_slope,
    refined,
    spline_averages,
    spline_tables,
)
from flapenv.aero.wingbeat import TimeRule, speed_averages

FINE = 8_001


@st.composite
def coefficients(draw: st.DrawFn) -> tuple[np.ndarray, np.ndarray]:
    """Speeds from the floor to one, often on either, and pitch coefficients up to 85°."""
    knots = draw(st.sampled_from([4, 5, 8, 13]))
    speed = st.one_of(st.floats(0.01, 1.0), st.sampled_from([0.01, 1.0]))
    limit = math.radians(85)
    pitch = st.one_of(st.floats(-limit, limit), st.sampled_from([-limit, limit]))
    return tuple(np.array(draw(st.lists(one, min_size=knots, max_size=knots))) for one in (speed, pitch))


def motion(speed: np.ndarray, pitch: np.ndarray, amplitude: float = 1.1) -> SplineMotion:
    return SplineMotion(
        frequency=25.0, flap_amplitude=amplitude, speed_coefficients=speed.tolist(), pitch_coefficients=pitch.tolist()
    )


def signed_averages(speed: np.ndarray, pitch: np.ndarray, samples: int = 40_000) -> np.ndarray:
    """L, S and K of any antiperiodic coefficients by plain sums over a half-cycle."""
    x = (np.arange(samples) + 0.5) / samples * speed.shape[-1]
    basis = half_cycle_basis(x, speed.shape[-1])
    rate, angle = speed @ basis, pitch @ basis
    fast = np.abs(rate)
    mean = np.mean(fast)
    return np.array(
        [
            np.mean(rate * fast * np.sin(2 * angle)) / mean**2,
            np.mean(fast**3 * np.cos(angle) ** 2) / mean**3,
            np.mean(fast**3) / mean**3,
        ]
    )


def test_basis_functions_sum_to_one_and_their_derivatives_and_integral_belong_together() -> None:
    x = np.linspace(-2.5, 2.5, 10_001)
    step = x[1] - x[0]
    assert sum(bspline(x[::100] + shift) for shift in range(-5, 6)) == pytest.approx(1)
    for order in (-1, 0, 1):
        assert np.gradient(bspline(x, order), step)[1:-1] == pytest.approx(bspline(x, order + 1)[1:-1], abs=2e-3)
    assert bspline(np.array([5.0]), -1) == pytest.approx(1)


@given(coefficients())
def test_half_strokes_mirror_each_other_and_the_cycle_closes(both: tuple[np.ndarray, np.ndarray]) -> None:
    one = motion(*both)
    phase = np.linspace(-7, 7, 501)
    for method in (one.flap_angle, one.flap_rate, one.flap_acceleration, one.pitch_angle, one.pitch_rate):
        scale = np.max(np.abs(method(phase)))
        assert method(phase + math.pi) == pytest.approx(-method(phase), abs=1e-9 * scale)
        assert method(phase + 2 * math.pi) == pytest.approx(method(phase), abs=1e-9 * scale)


@given(coefficients())
def test_the_wing_reverses_once_at_each_end_and_swings_exactly_its_amplitude(
    both: tuple[np.ndarray, np.ndarray],
) -> None:
    one = motion(*both)
    phase = one.reversal + math.pi * np.linspace(0, 1, 2001)[1:-1]
    rate = one.flap_rate(phase)
    assert np.all(rate > 0)
    angle = one.flap_angle(np.array([one.reversal, one.reversal + math.pi]))
    assert angle == pytest.approx([-1.1, 1.1], abs=1e-9)
    assert np.mean(np.abs(one.flap_rate(2 * math.pi * np.arange(FINE) / FINE))) == pytest.approx(
        one.mean_flap_speed, rel=1e-5
    )


@given(coefficients())
def test_pitch_stays_in_the_hull_of_its_coefficients(both: tuple[np.ndarray, np.ndarray]) -> None:
    angle = motion(*both).pitch_angle(np.linspace(0, 2 * math.pi, 2001))
    assert np.max(np.abs(angle)) <= np.max(np.abs(both[1])) * (1 + 1e-12)


@given(coefficients())
def test_averages_are_those_of_plain_sums(both: tuple[np.ndarray, np.ndarray]) -> None:
    slow = signed_averages(*both)
    assert np.array(spline_averages(*both, points=14)[:3]) == pytest.approx(slow, abs=2e-6 * max(1, slow[2]))
    assert np.array(spline_averages(*both)[:3]) == pytest.approx(slow, abs=2e-5 * max(1, slow[2]))


def test_more_quadrature_points_converge(rng: np.random.Generator) -> None:
    speed, pitch = 10 ** rng.uniform(-2, 0, (200, 8)), np.radians(rng.uniform(-65, 65, (200, 8)))
    exact = spline_averages(speed, pitch, points=30)
    errors = [
        max(float(np.max(np.abs(a - b))) for a, b in zip(spline_averages(speed, pitch, points=n), exact, strict=True))
        for n in (4, 6, 14)
    ]
    assert errors[0] > 10 * errors[1] > 10 * errors[2]
    assert errors[1] < 5e-5
    assert errors[2] < 1e-6


def test_turning_knots_by_whole_intervals_changes_nothing(rng: np.random.Generator) -> None:
    speed, pitch = rng.uniform(0.01, 1, 6), rng.uniform(-1, 1, 6)
    own = np.array(spline_averages(speed, pitch, points=14)[:3])
    for turn in range(1, 6):
        sign = np.where(np.arange(6) < turn, -1, 1)
        turned = signed_averages(sign * np.roll(speed, turn), sign * np.roll(pitch, turn))
        assert turned == pytest.approx(own, abs=1e-6)


@given(coefficients())
def test_time_run_backwards_has_the_same_averages(both: tuple[np.ndarray, np.ndarray]) -> None:
    speed, pitch = both
    own, back = spline_averages(speed, pitch), spline_averages(speed[::-1], pitch[::-1])
    assert np.array(back) == pytest.approx(np.array(own), rel=1e-9, abs=1e-12)


def test_pitching_the_other_way_turns_lift_to_its_negative_and_leaves_power(rng: np.random.Generator) -> None:
    speed, pitch = rng.uniform(0.01, 1, (9, 8)), rng.uniform(-1, 1, (9, 8))
    own, other = spline_averages(speed, pitch), spline_averages(3 * speed, -pitch)
    assert other.lift == pytest.approx(-own.lift, abs=1e-12)
    assert other.power == pytest.approx(own.power)
    assert other.friction == pytest.approx(own.friction)


def test_coefficients_of_a_sinusoid_give_the_strokes_sinusoid() -> None:
    knots, amplitude = 64, 0.9
    arc = np.sin(math.pi * (np.arange(knots) + 0.5) / knots)
    swing = (math.sin(math.pi / knots / 2) / (math.pi / knots / 2)) ** 4  # what the spline makes of a unit sinusoid
    averages = spline_averages(arc, amplitude / swing * arc, points=14)
    lift, power = speed_averages(0.0, amplitude, 0.0, math.pi / 2, rule=TimeRule(80, 2.0))
    assert averages.lift == pytest.approx(lift, rel=1e-6)
    assert averages.power == pytest.approx(power, rel=1e-6)
    assert averages.friction == pytest.approx(math.pi**2 / 6, rel=1e-6)  # κ₃ of the sinusoid


def test_equal_coefficients_approach_the_triangle_and_the_square_wave() -> None:
    theta, gaps = math.radians(65), []
    for knots in (8, 32, 128, 256):
        averages = spline_averages(np.ones(knots), np.full(knots, theta))
        gaps.append(averages.power / averages.lift**1.5 / (math.cos(theta) ** 2 / math.sin(2 * theta) ** 1.5) - 1)
    assert 0 < gaps[3] < gaps[2] / 1.8 < gaps[1] / 3.5
    assert gaps[3] < 6e-3


@given(coefficients())
def test_the_reversal_is_found_to_rounding_and_in_single_precision_well_enough(
    both: tuple[np.ndarray, np.ndarray],
) -> None:
    speed, _ = both
    near = spline_tables(len(speed)).near
    flap = near @ speed[:, None]
    exact, rough = find_reversal(flap), find_reversal(flap.astype(np.float32))
    assert near_value(flap, exact) == pytest.approx(0, abs=1e-12)
    assert near_integral(flap, rough) == pytest.approx(near_integral(flap, exact), abs=1e-6)


def test_pieces_near_the_reversal_are_the_spline_there(rng: np.random.Generator) -> None:
    for knots in (4, 7):
        speed, x = rng.uniform(0.01, 1, knots), np.linspace(-1.5, 1.5, 101)
        pieces = spline_tables(knots).near @ speed[:, None]
        assert near_value(pieces, x) == pytest.approx(speed @ half_cycle_basis(x, knots))


def test_single_precision_and_any_number_of_rows_agree(rng: np.random.Generator) -> None:
    speed, pitch = rng.uniform(0.01, 1, (9000, 8)), rng.uniform(-1, 1, (9000, 8))
    whole = spline_averages(speed, pitch)
    single = spline_averages(speed.astype(np.float32), pitch.astype(np.float32))
    assert single.lift.dtype == single.power.dtype == single.half_cycle.dtype == np.float32
    for ours, theirs in zip(whole, single, strict=True):
        assert ours == pytest.approx(theirs, rel=1e-5, abs=1e-5)
    row = spline_averages(speed[8000], pitch[8000])
    assert [float(value[8000]) for value in whole] == pytest.approx([float(value) for value in row])
    assert spline_averages(speed.reshape(9, 1000, 8), pitch.reshape(9, 1000, 8)).lift.shape == (9, 1000)


def test_tensors_give_the_same_averages_and_exact_gradients(rng: np.random.Generator) -> None:
    turns_beyond_a_knot = [[1, 0.01, 0.01, 0.01, 0.02]]
    speed = np.concatenate([rng.uniform(0.01, 1, (3, 5)), turns_beyond_a_knot])
    pitch = rng.uniform(-1, 1, (4, 5))
    tensors = [torch.tensor(value, requires_grad=True) for value in (speed, pitch)]
    for ours, theirs in zip(spline_averages(speed, pitch), spline_averages(*tensors), strict=True):
        assert theirs.detach().numpy() == pytest.approx(ours, rel=1e-12)
    assert torch.autograd.gradcheck(lambda *both: tuple(spline_averages(*both, points=14)), tensors, atol=1e-5)


@given(coefficients())
def test_peak_slopes_are_those_of_the_spline(both: tuple[np.ndarray, np.ndarray]) -> None:
    for values in both:
        slopes = np.abs(values @ half_cycle_basis(np.linspace(0, len(values), 20_001), len(values), 1))
        assert peak_slope(values) == pytest.approx(np.max(slopes), rel=1e-5)


def test_refined_coefficients_are_the_same_motion_half_a_fine_knot_later(rng: np.random.Generator) -> None:
    values = rng.uniform(-1, 1, 6)
    x = np.linspace(0, 6, 500)
    fine = refined(values) @ half_cycle_basis((2 * x - 0.5 + 12) % 24 - 12, 12)
    assert fine == pytest.approx(values @ half_cycle_basis(x, 6))
    assert refined(np.stack([values, values])).shape == (2, 12)


def test_accelerations_and_rates_are_derivatives(rng: np.random.Generator) -> None:
    one = motion(rng.uniform(0.01, 1, 7), rng.uniform(-1, 1, 7))
    phase = np.linspace(0, 2 * math.pi, 5 * FINE)
    omega = 2 * math.pi * one.frequency
    for angle, rate in (
        (one.flap_angle, one.flap_rate),
        (one.flap_rate, one.flap_acceleration),
        (one.pitch_angle, one.pitch_rate),
        (one.pitch_rate, one.pitch_acceleration),
    ):
        slope = omega * np.gradient(angle(phase), phase)[1:-1]
        assert slope == pytest.approx(rate(phase)[1:-1], abs=1e-3 * np.max(np.abs(slope)))


def test_integrals_over_the_half_cycle_scale_with_the_speed(rng: np.random.Generator) -> None:
    speed = rng.uniform(0.01, 1, (3, 8))
    x = np.linspace(0, 8, 10 * FINE)
    sums = np.trapezoid(np.abs(speed @ half_cycle_basis(x, 8)), x, axis=-1)
    assert half_cycle_integral(speed) == pytest.approx(sums, rel=1e-8)


@pytest.mark.parametrize(
    ("change", "kind", "said"),
    [
        ({"frequency": 0.0}, ValueError, "frequency = 0"),
        ({"flap_amplitude": 4.0}, ValueError, "flap_amplitude = 4"),
        ({"speed_coefficients": [1, 0, 1, 1]}, ValueError, r"speed_coefficients\[1\] = 0"),
        ({"speed_coefficients": [1, 1, 1]}, TypeError, r"shapes \(3,\) and \(4,\)"),
        ({"pitch_coefficients": [0, 0, math.nan, 0]}, ValueError, r"pitch_coefficients\[2\] = nan"),
        ({"pitch": [0, 0, 0, 0]}, TypeError, "no field 'pitch'"),
    ],
)
def test_bad_motions_are_named(change: dict, kind: type[Exception], said: str) -> None:
    good = {"frequency": 20.0, "flap_amplitude": 1.0, "speed_coefficients": [1] * 4, "pitch_coefficients": [0.5] * 4}
    with pytest.raises(kind, match=said):
        SplineMotion(**(good | change))
