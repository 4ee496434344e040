"""Cycle averages of a wing on a body that rises or sinks."""

import dataclasses
import math

import numpy as np
import pytest
from conftest import strokes, wings
from hypothesis import given
from hypothesis import strategies as st

from flapenv import INSECTS, Insect, Stroke, TabulatedPlanform, Wing, load_insect, simulate
from flapenv.aero.heaving import HeaveAverages, heave_averages, span_rule, stack_rules
from flapenv.aero.planform import HALF_ELLIPSE, BetaPlanform
from flapenv.aero.wingbeat import TimeRule, speed_averages
from flapenv.case import hover_case, lift_constant
from flapenv.model import HoverModel

SHAPES = ("flap_shape", "pitch_amplitude", "pitch_shape", "pitch_phase")
AIR = HoverModel().air_density

FINE, COARSE = TimeRule(80, 2.0), TimeRule(24, 1.6)


def averages(
    wing: Wing, stroke: Stroke, climb: float | np.ndarray, *, strips: int = 6, time: TimeRule = FINE
) -> HeaveAverages:
    """Averages of one stroke at one or many speeds of climb."""
    climb = np.atleast_1d(np.asarray(climb, dtype=float))
    shapes = {name: np.full(climb.shape, float(getattr(stroke, name))) for name in SHAPES}
    rule = stack_rules([span_rule(wing.shape, strips)])
    return heave_averages(rule, np.zeros(len(climb), dtype=int), climb, **shapes, time=time)


def scales(insect: Insect, stroke: Stroke) -> tuple[float, float, float]:
    """What turns the averages into newtons and watts, and v̄R."""
    wing, speed = insect.wing, stroke.mean_flap_speed
    constant = lift_constant(hover_case(insect, HoverModel()), HoverModel(), speed, stroke.flap_amplitude)
    lift = 2 * AIR * constant * wing.mean_chord * wing.length**3 * speed**2
    return lift, lift * wing.length * speed, speed * wing.length


def awry(insect: Insect) -> Stroke:
    """A stroke with nothing symmetric about it but its halves."""
    return dataclasses.replace(insect.stroke, flap_shape=0.6, pitch_shape=2.0, pitch_phase=math.radians(75))


@given(wing=wings(), stroke=strokes())
def test_at_rest_the_averages_are_those_of_hovering(wing: Wing, stroke: Stroke) -> None:
    found = averages(wing, stroke, 0.0)
    lift, power = speed_averages(*(np.array([getattr(stroke, name)]) for name in SHAPES), rule=FINE)
    assert found.lift[0] == pytest.approx(wing.moment(2) * lift[0] / 2, rel=1e-9, abs=1e-12)
    assert found.power[0] == pytest.approx(wing.moment(3) * power[0], rel=1e-9)


@pytest.mark.parametrize("climb", [-0.4, -0.1, 0.03, 0.1, 0.4])
@pytest.mark.parametrize("name", ["hawkmoth", "fruitfly"])
def test_force_and_power_are_the_blade_elements_with_a_moving_body(name: str, climb: float) -> None:
    insect = load_insect(name)
    stroke = awry(insect)
    lift, power, speed = scales(insect, stroke)
    history = simulate(insect, stroke, body_velocity=(0, 0, climb * speed), strips=40, steps=8000, spacing="gauss")
    found = averages(insect.wing, stroke, climb)
    at_rest = averages(insect.wing, stroke, 0.0)
    assert lift * found.lift[0] == pytest.approx(float(np.mean(history.lift)), abs=1e-4 * lift * at_rest.lift[0])
    assert power * found.power[0] == pytest.approx(float(np.mean(history.power)), rel=1e-4)


def test_both_half_strokes_carry_the_same_at_any_steady_climb() -> None:
    insect = load_insect("bumblebee")
    for climb in (-1.0, 0.5):
        history = simulate(insect, awry(insect), body_velocity=(0, 0, climb), steps=4000, spacing="gauss")
        # the forward half-stroke runs from -90° to 90°
        forward = np.cos(history.phase) > 0
        for quantity in (history.lift, history.power):
            assert np.mean(quantity[forward]) == pytest.approx(float(np.mean(quantity[~forward])), rel=1e-10)


def test_to_first_order_two_wings_damp_with_r1_and_the_mean_cos_squared_of_alpha() -> None:
    insect = load_insect("hawkmoth")
    stroke, wing = awry(insect), insect.wing
    phase = 2 * math.pi * (np.arange(200_000) + 0.5) / 200_000
    mean = np.mean(np.abs(stroke.flap_rate(phase)) * np.sin(stroke.pitch_angle(phase)) ** 2)  # cos² α = sin² θ
    constant = lift_constant(
        hover_case(insect, HoverModel()), HoverModel(), stroke.mean_flap_speed, stroke.flap_amplitude
    )
    expected = -2 * AIR * constant * wing.mean_chord * wing.length**2 * wing.r1_hat * mean
    lift, _, speed = scales(insect, stroke)
    assert averages(wing, stroke, 0.0).lift_slope[0] * lift / speed == pytest.approx(expected, rel=1e-8)

    small = 1e-3 * speed
    up, down = (
        np.mean(simulate(insect, stroke, body_velocity=(0, 0, w), steps=4000, strips=40, spacing="gauss").lift)
        for w in (small, -small)
    )
    assert (up - down) / (2 * small) == pytest.approx(expected, rel=1e-3)


@pytest.mark.parametrize("name", INSECTS)
def test_climbing_lowers_the_angle_of_attack_the_lift_and_the_muscles_power(name: str) -> None:
    insect = load_insect(name)
    found = averages(insect.wing, insect.stroke, np.linspace(-0.2, 0.2, 21))
    assert np.all(np.diff(found.lift) < 0)
    assert np.all(np.diff(found.power) < 0)
    assert np.all(found.lift_slope < 0)
    up, rest = (
        simulate(insect, body_velocity=(0, 0, w), steps=400).angle_of_attack
        for w in (0.05 * scales(insect, insect.stroke)[2], 0.0)
    )
    assert np.median(up) < np.median(rest)


@given(stroke=strokes(), climb=st.floats(-2, 2))
def test_the_air_is_never_given_less_than_nothing(stroke: Stroke, climb: float) -> None:
    found = averages(load_insect("dronefly").wing, stroke, climb)
    assert found.power[0] - climb * found.lift[0] >= -1e-12  # muscles' work less that on the body, -dF·V summed


@given(
    stroke=strokes(sharpest_pitch=6.0, sharpest_flap=0.9), climb=st.floats(-0.5, 0.5).filter(lambda x: abs(x) > 0.02)
)
def test_the_slopes_are_the_differences(stroke: Stroke, climb: float) -> None:
    step = 1e-4
    down, here, up = (averages(load_insect("cranefly").wing, stroke, climb + d) for d in (-step, 0.0, step))
    assert here.lift_slope[0] == pytest.approx((up.lift[0] - down.lift[0]) / (2 * step), rel=1e-4, abs=1e-6)
    assert here.power_slope[0] == pytest.approx((up.power[0] - down.power[0]) / (2 * step), rel=1e-4, abs=1e-6)


def test_a_very_fast_climb_leaves_the_drag_of_plates_alone() -> None:
    stroke = awry(load_insect("ladybird"))
    phase = 2 * math.pi * (np.arange(20_000) + 0.5) / 20_000
    blunt = np.mean(np.sin(stroke.pitch_angle(phase)) ** 2)
    for climb in (-1e4, 1e4):
        found = averages(load_insect("ladybird").wing, stroke, climb)
        assert found.lift[0] / climb**2 == pytest.approx(-math.copysign(blunt, climb), rel=1e-3)


@pytest.mark.parametrize("name", INSECTS)
def test_six_strips_are_enough_at_a_tenth_of_the_tips_speed(name: str) -> None:
    insect = load_insect(name)
    for climb in (-0.1, 0.02, 0.1):
        for stroke in (insect.stroke, awry(insect)):
            rough, fine = (averages(insect.wing, stroke, climb, strips=strips) for strips in (6, 60))
            assert rough.lift[0] == pytest.approx(fine.lift[0], rel=1e-4)
            assert rough.power[0] == pytest.approx(fine.power[0], rel=1e-4)
            assert rough.lift_slope[0] == pytest.approx(fine.lift_slope[0], rel=1e-3)


def test_more_strips_err_less_and_fewer_more() -> None:
    insect = load_insect("hawkmoth")
    fine = averages(insect.wing, insect.stroke, 0.1, strips=80).lift[0]
    errors = [abs(averages(insect.wing, insect.stroke, 0.1, strips=n).lift[0] / fine - 1) for n in (2, 4, 8, 16)]
    assert errors == sorted(errors, reverse=True)
    assert errors[0] > 100 * errors[3]


@pytest.mark.parametrize(
    "planform",
    [BetaPlanform(r1_hat=0.5), HALF_ELLIPSE, TabulatedPlanform(r_hat=(0, 0.3, 0.7, 1), chord=(0.2, 1, 0.9, 0))],
)
def test_the_strips_of_any_planform_keep_its_moments(planform: object) -> None:
    rule = span_rule(planform)
    assert rule.radii.shape == (6,)
    for order in range(1, 4):
        assert np.sum(rule.speed_weights[order - 1]) == pytest.approx(planform.moment(order), rel=1e-4)
        assert np.sum(rule.slope_weights[order - 1] * rule.radii**2) == pytest.approx(planform.moment(order), rel=1e-4)


def test_rows_are_averaged_apart_whatever_their_number_and_order() -> None:
    rng = np.random.default_rng(0)
    rules = stack_rules([span_rule(load_insect(name).wing.shape) for name in ("hawkmoth", "honeybee")])
    count = 700  # several chunks
    wing, climb = rng.integers(2, size=count), rng.normal(0, 0.05, count)
    shapes = {
        "flap_shape": rng.uniform(0.01, 0.99, count),
        "pitch_amplitude": rng.uniform(0.8, 1.1, count),
        "pitch_shape": rng.uniform(0.1, 10, count),
        "pitch_phase": rng.uniform(1.1, 2.0, count),
    }
    whole = heave_averages(rules, wing, climb, **shapes, time=COARSE)
    order = rng.permutation(count)
    mixed = heave_averages(rules, wing[order], climb[order], **{k: v[order] for k, v in shapes.items()}, time=COARSE)
    for name, values in vars(whole).items():
        np.testing.assert_allclose(getattr(mixed, name), values[order], rtol=1e-12)


def test_single_precision_keeps_six_digits() -> None:
    insect = load_insect("hawkmoth")
    shapes = {name: np.full(3, float(getattr(insect.stroke, name))) for name in SHAPES}
    climb, wing = np.array([-0.1, 0.0, 0.1]), np.zeros(3, dtype=int)
    double, single = (
        heave_averages(stack_rules([span_rule(insect.wing.shape)], dtype), wing, climb, **shapes, time=COARSE)
        for dtype in (np.float64, np.float32)
    )
    for name, values in vars(double).items():
        assert getattr(single, name).dtype == np.float32
        np.testing.assert_allclose(getattr(single, name), values, rtol=3e-6)
