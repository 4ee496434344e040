"""The fast averages against closed forms and the converged oracle."""

import itertools
import math

import numpy as np
import pytest
import torch
from conftest import strokes
from hypothesis import given

from flapenv import Stroke, load_insect
from flapenv.aero.blade_element import blade_element
from flapenv.aero.force_laws import PlateLaw
from flapenv.aero.wingbeat import TimeRule, speed_averages, time_rule

HAWKMOTH = load_insect("hawkmoth")
AREA_SPEED = 1.225 * HAWKMOTH.wing.area * HAWKMOTH.wing.length**2


def oracle_averages(stroke: Stroke, steps: int) -> tuple[float, float]:
    """Lift and power averages of the waveform from the converged blade-element oracle."""
    history = blade_element(
        HAWKMOTH.wing, stroke, PlateLaw(constant=1.0), air_density=1.225, strips=4, steps=steps, spacing="gauss"
    )
    speed = stroke.mean_flap_speed
    lift = history.mean_lift / (AREA_SPEED * HAWKMOTH.wing.moment(2) * speed**2)
    power = history.mean_power() / (2 * AREA_SPEED * HAWKMOTH.wing.length * HAWKMOTH.wing.moment(3) * speed**3)
    return lift, power


def fast_averages(stroke: Stroke, **changes: float) -> tuple[float, float]:
    """The same from the fast path."""
    rule = time_rule(stroke.flap_shape, stroke.pitch_shape, **changes)
    return speed_averages(stroke.flap_shape, stroke.pitch_amplitude, stroke.pitch_shape, stroke.pitch_phase, rule=rule)


def box_strokes(rng: np.random.Generator, count: int) -> list[Stroke]:
    """Random strokes of problem A's box and all of its corners."""
    low = np.array([40, 0.01, 0.1, 45, 60])
    high = np.array([90, 0.99, 10, 65, 120])
    corners = np.array(list(itertools.product(*zip(low, high, strict=True))))
    rows = np.concatenate([rng.uniform(low, high, (count - len(corners), 5)), corners])
    return [
        Stroke(
            frequency=20.0,
            flap_amplitude=math.radians(row[0]),
            flap_shape=row[1],
            pitch_shape=row[2],
            pitch_amplitude=math.radians(row[3]),
            pitch_phase=math.radians(row[4]),
        )
        for row in rows
    ]


def test_the_fast_path_meets_the_converged_oracle_on_1000_strokes_of_the_box(rng: np.random.Generator) -> None:
    for stroke in box_strokes(rng, 1000):
        np.testing.assert_allclose(fast_averages(stroke, tolerance=1e-6), oracle_averages(stroke, 4000), rtol=1e-5)


@pytest.mark.parametrize("phase_deg", [60, 75, 89.9, 90, 97, 120])
@pytest.mark.parametrize(("flap_shape", "pitch_shape"), [(0.9999, 100.0), (0.9999, 0.1), (0.01, 100.0), (0.0, 0.0)])
def test_the_fast_path_meets_the_oracle_where_both_waveforms_are_sharp(
    flap_shape: float, pitch_shape: float, phase_deg: float
) -> None:
    stroke = Stroke(
        frequency=20.0,
        flap_amplitude=1.5,
        pitch_amplitude=math.radians(65),
        flap_shape=flap_shape,
        pitch_shape=pitch_shape,
        pitch_phase=math.radians(phase_deg),
    )
    np.testing.assert_allclose(fast_averages(stroke, tolerance=1e-6), oracle_averages(stroke, 60_000), rtol=1e-5)


@pytest.mark.parametrize(("flap_shape", "pitch_shape"), [(0.99, 10.0), (0.9999, 100.0), (0.3, 1e5)])
@pytest.mark.parametrize("pitch_deg", [85, 90])
def test_a_feathering_wing_keeps_the_tolerance_down_to_5_degrees_and_in_units_of_the_speed_at_none(
    flap_shape: float, pitch_shape: float, pitch_deg: int
) -> None:
    rest = (flap_shape, math.radians(pitch_deg), pitch_shape, math.radians(80))
    ours = speed_averages(*rest, rule=time_rule(flap_shape, pitch_shape, tolerance=1e-6))
    many = speed_averages(*rest, rule=TimeRule(1200, 3.0))
    np.testing.assert_allclose(ours, many, **({"rtol": 1e-5} if pitch_deg < 90 else {"rtol": 0, "atol": 1e-5}))


@given(strokes(sharpest_flap=1.0, sharpest_pitch=200))
def test_the_default_tolerance_is_met_by_far_more_nodes(stroke: Stroke) -> None:
    many = speed_averages(
        stroke.flap_shape, stroke.pitch_amplitude, stroke.pitch_shape, stroke.pitch_phase, rule=TimeRule(600, 3.0)
    )
    np.testing.assert_allclose(fast_averages(stroke), many, rtol=1e-8)


@pytest.mark.parametrize("flap_shape", [1 - 1e-4, 1 - 1e-6, 1 - 1e-8, 1 - 1e-12, 1 - 1e-16])
@pytest.mark.parametrize("pitch_shape", [1.0, 30.0])
def test_almost_triangles_beside_a_triangle_keep_the_tolerance(flap_shape: float, pitch_shape: float) -> None:
    shapes = np.array([0.2, flap_shape, 1.0])
    rule = time_rule(shapes, pitch_shape)
    ours = speed_averages(shapes, 1.1, pitch_shape, 1.3, rule=rule)
    many = speed_averages(shapes, 1.1, pitch_shape, 1.3, rule=TimeRule(1500, 3.0))
    np.testing.assert_allclose(ours, many, rtol=2e-7)


@pytest.mark.parametrize("flap_shape", [0.0, 0.3, 0.9, 0.999, 1.0])
def test_a_square_pitch_gives_the_closed_forms_of_kappa_2_and_kappa_3(flap_shape: float) -> None:
    theta = math.radians(60)
    lift, power = speed_averages(flap_shape, theta, 1e9, math.pi / 2, rule=TimeRule(200, 3.0))
    if flap_shape == 0:
        kappa2, kappa3 = math.pi**2 / 8, math.pi**2 / 6
    else:
        c, root, arc = flap_shape, math.sqrt(1 - flap_shape**2), math.asin(flap_shape)
        kappa2, kappa3 = math.pi**2 / 4 * (1 - root) / arc**2, math.pi**2 / 4 * (arc - c * root) / arc**3
    assert lift == pytest.approx(kappa2 * math.sin(2 * theta), rel=1e-6)
    assert power == pytest.approx(kappa3 * math.cos(theta) ** 2, rel=1e-6)


def test_the_sinusoid_needs_a_fifth_more_power_than_the_triangle_for_the_same_lift() -> None:
    lift, power = (
        np.array(value)
        for value in speed_averages(np.array([0.0, 1.0]), 1.0, 1e9, math.pi / 2, rule=TimeRule(200, 3.0))
    )
    ratio = (power[0] / power[1]) / (lift[0] / lift[1]) ** 1.5  # P ∝ v³, Λ ∝ v²
    assert ratio == pytest.approx(1.200, abs=5e-4)


@given(strokes())
def test_advanced_and_delayed_rotation_lift_the_same(stroke: Stroke) -> None:
    rest = (stroke.flap_shape, stroke.pitch_amplitude, stroke.pitch_shape)
    ahead = speed_averages(*rest, stroke.pitch_phase, rule=TimeRule(60, 3.0))
    behind = speed_averages(*rest, math.pi - stroke.pitch_phase, rule=TimeRule(60, 3.0))
    np.testing.assert_allclose(ahead, behind, rtol=1e-10)


def test_reversed_pitching_turns_the_lift_down_and_in_phase_pitching_lifts_nothing() -> None:
    up = speed_averages(0.5, 1.0, 3.0, math.pi / 2, rule=TimeRule(60, 3.0))
    down = speed_averages(0.5, 1.0, 3.0, -math.pi / 2, rule=TimeRule(60, 3.0))
    still = speed_averages(0.5, 1.0, 3.0, 0.0, rule=TimeRule(60, 3.0))
    turned = speed_averages(0.5, 1.0, 3.0, 5 * math.pi / 2 - 2 * math.pi, rule=TimeRule(60, 3.0))
    assert down[0] == pytest.approx(-up[0])
    assert down[1] == pytest.approx(up[1])
    assert still[0] == pytest.approx(0, abs=1e-12)
    np.testing.assert_allclose(turned, up, rtol=1e-12)


def test_every_limit_is_finite_without_a_warning_in_both_precisions() -> None:
    limits = ([0.0, 1e-9, 0.5, 1.0], [0.0, 1.0, math.pi / 2], [0.0, 1e-9, 5.0, 1e9], [-6.28, 0, 1.57])
    grid = np.array(list(itertools.product(*limits)))
    for dtype in (np.float32, np.float64):
        lift, power = speed_averages(*grid.T.astype(dtype), rule=TimeRule(80, 3.0))
        assert lift.dtype == power.dtype == dtype
        assert np.isfinite(lift).all()
        assert np.isfinite(power).all()
        assert (power >= 0).all()


def test_single_precision_costs_a_few_units_in_the_last_place(rng: np.random.Generator) -> None:
    rows = box_strokes(rng, 400)
    names = ("flap_shape", "pitch_amplitude", "pitch_shape", "pitch_phase")
    values = [np.array([getattr(stroke, name) for stroke in rows]) for name in names]
    double = speed_averages(*values, rule=TimeRule(40, 3.0))
    single = speed_averages(*(value.astype(np.float32) for value in values), rule=TimeRule(40, 3.0))
    np.testing.assert_allclose(single, double, rtol=3e-6)


def test_sharper_waveforms_and_more_digits_ask_for_more_nodes() -> None:
    assert time_rule(0.5, 1.0) < time_rule(0.99, 10.0) < time_rule(0.9999, 100.0) < time_rule(0.9999, 1e5)
    assert time_rule(0.99, 10.0, tolerance=1e-6) < time_rule(0.99, 10.0, tolerance=1e-9)
    assert time_rule(1.0, 1e12).nodes < 1000
    with pytest.raises(ValueError, match="tolerance = 0 "):
        time_rule(0.5, 1.0, tolerance=0.0)


def test_averages_of_tensors_equal_those_of_arrays() -> None:
    values = [np.array([0.3, 0.99]), np.array([1.0, 1.1]), np.array([2.0, 10.0]), np.array([1.4, 1.7])]
    tensors = [torch.tensor(value, requires_grad=True) for value in values]
    ours, theirs = speed_averages(*values, rule=TimeRule(40, 3.0)), speed_averages(*tensors, rule=TimeRule(40, 3.0))
    np.testing.assert_allclose([value.detach().numpy() for value in theirs], ours, rtol=1e-13)
    theirs[1].sum().backward()
    assert all(torch.isfinite(tensor.grad).all() for tensor in tensors)
