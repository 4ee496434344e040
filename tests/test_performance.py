"""Weight support and power: scaling, limits, options and batches."""

import dataclasses
import math
import tracemalloc

import numpy as np
import pytest
import torch
from conftest import strokes, yardstick_stroke
from hypothesis import given

from flapenv import HoverModel, Insect, Stroke, Wing, WingFactors, evaluate, load_insect
from flapenv.case import hover_case, stack_cases, wing_factors
from flapenv.performance import yardstick
from flapenv.simulation import evaluate_by_blade_element

HAWKMOTH = load_insect("hawkmoth")


@given(strokes())
def test_lift_goes_with_the_square_and_power_with_the_cube_of_the_frequency(stroke: Stroke) -> None:
    slow = evaluate(HAWKMOTH, stroke)
    fast = evaluate(HAWKMOTH, dataclasses.replace(stroke, frequency=2 * stroke.frequency))
    assert fast.lift == pytest.approx(4 * slow.lift, rel=1e-12)
    assert fast.power == pytest.approx(8 * slow.power, rel=1e-12)


@given(strokes())
def test_power_is_positive_and_the_fields_agree_with_each_other(stroke: Stroke) -> None:
    result = evaluate(HAWKMOTH, stroke)
    assert result.specific_power > 0
    assert result.lift == pytest.approx(result.weight_support * HAWKMOTH.mass * 9.81)
    assert result.power == pytest.approx(result.specific_power * HAWKMOTH.mass)


def test_evaluate_meets_the_refined_oracle_for_every_insect(insect: Insect) -> None:
    ours = evaluate(insect)
    oracle = evaluate_by_blade_element(insect, strips=6, steps=4000, spacing="gauss")
    np.testing.assert_allclose((ours.weight_support, ours.specific_power), oracle, rtol=1e-8)


def test_weight_and_air_scale_as_they_must() -> None:
    model = HoverModel()
    plain = evaluate(HAWKMOTH)
    dense = evaluate(HAWKMOTH, air_density=2 * model.air_density)
    light = evaluate(HAWKMOTH, gravity=model.gravity / 2)
    assert dense.lift == pytest.approx(2 * plain.lift)
    assert dense.specific_power == pytest.approx(2 * plain.specific_power)
    assert light.weight_support == pytest.approx(2 * plain.weight_support)
    assert light.specific_power == pytest.approx(plain.specific_power)


def test_geometrically_similar_insects_at_the_same_speed_carry_the_same_pressure() -> None:
    own = dataclasses.replace(HAWKMOTH, k_table=None)
    half = dataclasses.replace(
        own,
        mass=own.mass / 4,
        wing=Wing(length=own.wing.length / 2, mean_chord=own.wing.mean_chord / 2, r1_hat=own.wing.r1_hat),
        stroke=dataclasses.replace(own.stroke, frequency=2 * own.stroke.frequency),
    )
    a, b = evaluate(own), evaluate(half)
    assert b.weight_support == pytest.approx(a.weight_support, rel=1e-12)
    assert b.specific_power == pytest.approx(a.specific_power, rel=1e-12)


def test_the_hoverflys_ideal_downwash_overestimates_lift_by_22_to_25_percent() -> None:
    ideal = evaluate("hoverfly", induced=False)
    assert 1.22 <= ideal.weight_support <= 1.25  # Fig. 6: 23 % over unity
    assert 1.22 <= ideal.weight_support / evaluate("hoverfly").weight_support <= 1.25
    assert ideal.induced_power_factor == 1


def test_k_belongs_to_the_wing_but_for_its_flapping_part() -> None:
    narrow = dataclasses.replace(HAWKMOTH.stroke, flap_amplitude=math.radians(45))
    wide = dataclasses.replace(HAWKMOTH.stroke, flap_amplitude=math.radians(90))
    k = [evaluate(HAWKMOTH, stroke).induced_power_factor for stroke in (narrow, wide)]
    assert k[0] / k[1] == pytest.approx(math.sqrt(2))
    assert k[1] == pytest.approx(HAWKMOTH.k_table.k_revolving)


def test_tip_loss_of_the_stroke_falls_as_the_stroke_quickens_and_is_the_tables_at_the_own_stroke() -> None:
    own = dataclasses.replace(HAWKMOTH, k_table=None)
    same = [evaluate(own, tip_loss=which).induced_power_factor for which in ("reference", "stroke")]
    assert same[0] == pytest.approx(same[1], rel=1e-12)
    quick = dataclasses.replace(own.stroke, frequency=3 * own.stroke.frequency)
    assert evaluate(own, quick, tip_loss="stroke").induced_power_factor < same[0]
    assert evaluate(own, quick).induced_power_factor == same[0]


def test_a_wing_without_a_table_gets_its_factors_from_geometry() -> None:
    computed = wing_factors(dataclasses.replace(HAWKMOTH, k_table=None))
    assert computed.k_ind == pytest.approx(HAWKMOTH.k_table.k_ind, abs=0.015)
    assert computed.k_tip == pytest.approx(HAWKMOTH.k_table.k_tip, abs=0.005)
    assert computed.k_revolving == computed.k_ind * computed.k_tip


def test_batches_of_strokes_and_insects_equal_single_evaluations() -> None:
    frequencies = np.array([20.0, 26.3, 40.0])
    together = evaluate(HAWKMOTH, dataclasses.replace(HAWKMOTH.stroke, frequency=frequencies, flap_shape=[0, 0.5, 0.9]))
    for i, (frequency, shape) in enumerate(zip(frequencies, (0, 0.5, 0.9), strict=True)):
        alone = evaluate(HAWKMOTH, dataclasses.replace(HAWKMOTH.stroke, frequency=frequency, flap_shape=shape))
        assert together.weight_support[i] == pytest.approx(alone.weight_support, rel=1e-8)
        assert together.specific_power[i] == pytest.approx(alone.specific_power, rel=1e-8)
    herd = dataclasses.replace(HAWKMOTH, mass=np.array([1e-3, 2e-3]))
    np.testing.assert_allclose(
        evaluate(herd).weight_support,
        [evaluate(dataclasses.replace(HAWKMOTH, mass=m)).weight_support for m in (1e-3, 2e-3)],
    )


def test_tensors_go_through_and_keep_their_gradient() -> None:
    frequency = torch.tensor([20.0, 30.0], dtype=torch.float64, requires_grad=True)
    result = evaluate(HAWKMOTH, dataclasses.replace(HAWKMOTH.stroke, frequency=frequency))
    arrays = evaluate(HAWKMOTH, dataclasses.replace(HAWKMOTH.stroke, frequency=np.array([20.0, 30.0])))
    np.testing.assert_allclose(result.specific_power.detach().numpy(), arrays.specific_power, rtol=1e-12)
    (slope,) = torch.autograd.grad(result.specific_power.sum(), frequency)
    np.testing.assert_allclose(slope.numpy(), 3 * arrays.specific_power / np.array([20.0, 30.0]), rtol=1e-12)


def test_every_field_has_the_broadcast_shape() -> None:
    result = evaluate(HAWKMOTH, dataclasses.replace(HAWKMOTH.stroke, frequency=np.array([20.0, 30.0])))
    assert {np.shape(value) for value in vars(result).values()} == {(2,)}


def test_tensors_and_arrays_mix() -> None:
    mixed = dataclasses.replace(
        HAWKMOTH.stroke, frequency=torch.tensor([20.0, 30.0]).double(), flap_amplitude=np.array([1.0, 1.2])
    )
    arrays = dataclasses.replace(mixed, frequency=np.array([20.0, 30.0]))
    np.testing.assert_allclose(evaluate(HAWKMOTH, mixed).power.numpy(), evaluate(HAWKMOTH, arrays).power, rtol=1e-12)
    with pytest.raises(ValueError, match="flap_amplitude"):
        evaluate(HAWKMOTH, dataclasses.replace(mixed, flap_amplitude=torch.tensor(3.0)))


def test_the_oracle_takes_one_stroke_and_refuses_what_evaluate_refuses() -> None:
    with pytest.raises(TypeError, match="array fields"):
        evaluate_by_blade_element(HAWKMOTH, dataclasses.replace(HAWKMOTH.stroke, frequency=np.full(500, 26.0)))
    with pytest.raises(ValueError, match="flap_amplitude"):
        evaluate_by_blade_element(HAWKMOTH, dataclasses.replace(HAWKMOTH.stroke, flap_amplitude=2.0))
    with pytest.raises(TypeError, match=r"stroke = \{\}"):
        evaluate_by_blade_element(HAWKMOTH, {})


def test_a_scalar_evaluation_returns_python_floats() -> None:
    assert {type(value) for value in vars(evaluate("hawkmoth")).values()} == {float}


def test_the_yardstick_is_the_triangle_with_constant_angle() -> None:
    cases = stack_cases([hover_case(HAWKMOTH, HoverModel())])
    stroke = yardstick_stroke(26.3)
    weight_support, power = yardstick(cases, HoverModel())
    ours = evaluate(HAWKMOTH, stroke)
    assert ours.weight_support == pytest.approx(weight_support[0], rel=1e-5)
    assert ours.specific_power == pytest.approx(power[0] * math.sin(math.radians(35)) ** 2, rel=1e-5)


@pytest.mark.parametrize(
    ("options", "kind", "said"),
    [
        ({"air_desnity": 1.2}, TypeError, "did you mean 'air_density'"),
        ({"air_density": 0.0}, ValueError, r"air_density = 0 .*\[1e-15, 1e\+15\] kg/m³"),
        ({"gravity": float("nan")}, ValueError, "gravity = nan"),
        ({"tip_loss": "none"}, ValueError, "tip_loss = 'none' is unknown; allowed: reference, stroke"),
        ({"induced": 1}, TypeError, "induced = 1 is not allowed; allowed: True, False"),
    ],
)
def test_bad_model_options_are_named(options: dict[str, object], kind: type[Exception], said: str) -> None:
    with pytest.raises(kind, match=said):
        evaluate("hawkmoth", **options)


def test_amplitudes_beyond_90_degrees_are_refused_only_where_k_flap_is_used() -> None:
    wide = dataclasses.replace(HAWKMOTH.stroke, flap_amplitude=2.0)
    with pytest.raises(ValueError, match=r"flap_amplitude .*k_flap.* = 2 "):
        evaluate(HAWKMOTH, wide)
    assert evaluate(HAWKMOTH, wide, induced=False).weight_support > 1


@pytest.mark.parametrize("accounting", ["elastic", "positive"])
def test_parts_and_threads_change_nothing_and_bound_the_memory(accounting: str, rng: np.random.Generator) -> None:
    count = 3000 if accounting == "positive" else 70_000
    stroke = Stroke(frequency=rng.uniform(20, 30, count), flap_amplitude=1.0, pitch_amplitude=0.9, flap_shape=0.5)
    tracemalloc.start()
    whole = evaluate("hawkmoth", stroke, accounting=accounting, tolerance=1e-5)
    peak = tracemalloc.get_traced_memory()[1]
    tracemalloc.stop()
    threaded = evaluate("hawkmoth", stroke, accounting=accounting, tolerance=1e-5, threads=2)
    np.testing.assert_allclose(threaded.specific_power, whole.specific_power, rtol=1e-12)
    first = dataclasses.replace(stroke, frequency=stroke.frequency[:5])
    alone = evaluate("hawkmoth", first, accounting=accounting, tolerance=1e-5)
    np.testing.assert_allclose(whole.weight_support[:5], alone.weight_support, rtol=1e-12)
    np.testing.assert_allclose(whole.specific_power[:5], alone.specific_power, rtol=1e-12)
    assert peak < 1e8


def test_a_table_of_strokes_keeps_its_shape_whatever_the_parts() -> None:
    frequency = np.linspace(20, 30, 3 * 40_000).reshape(3, 40_000)
    found = evaluate("hawkmoth", Stroke(frequency=frequency, flap_amplitude=1.0, pitch_amplitude=0.9), tolerance=1e-4)
    assert np.shape(found.specific_power) == frequency.shape
    assert np.all(np.diff(np.asarray(found.specific_power).reshape(-1)) > 0)


@pytest.mark.parametrize("threads", [1, 2])
def test_many_strokes_take_insects_with_tables_as_few_do(threads: int) -> None:
    fruitfly, many = load_insect("fruitfly"), 70_000
    factors = WingFactors(k_ind=np.array([1.1, 1.2, 1.3]), k_tip=np.ones(3))
    own = dataclasses.replace(fruitfly.stroke, frequency=np.array([100.0, 200.0, 300.0]))
    frequency = np.linspace(150, 250, many)
    for insect, values in (
        (dataclasses.replace(fruitfly, k_table=factors), frequency[:, None]),
        (dataclasses.replace(fruitfly, stroke=own), frequency),
    ):
        stroke = Stroke(frequency=values, flap_amplitude=1.2, pitch_amplitude=0.8)
        few = dataclasses.replace(stroke, frequency=values[:5])
        whole = evaluate(insect, stroke, tolerance=1e-4, threads=threads).specific_power
        np.testing.assert_allclose(
            np.asarray(whole)[:5], evaluate(insect, few, tolerance=1e-4).specific_power, rtol=1e-12
        )
