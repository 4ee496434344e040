"""Power that is only paid where positive: against the blade element, its limits, tensors and single precision."""

import dataclasses

import numpy as np
import pytest
import torch
from conftest import strokes
from hypothesis import given, settings
from hypothesis import strategies as st

from flapenv import Stroke, Wing, evaluate, load_insect
from flapenv.aero.paid_power import _positive_mean
from flapenv.aero.quadrature import graded_rule
from flapenv.simulation import evaluate_by_blade_element

HAWKMOTH = load_insect("hawkmoth")


@given(
    stroke=strokes(sharpest_flap=0.98, sharpest_pitch=6.0),
    phase=st.floats(-6, 6),
    axis=st.floats(0, 1),
    coefficients=st.sampled_from(["lifting-line", "robofly", "berman-wang"]),
)
@settings(max_examples=30)
def test_it_is_what_the_blade_element_finds(stroke: Stroke, phase: float, axis: float, coefficients: str) -> None:
    insect = dataclasses.replace(HAWKMOTH, wing=dataclasses.replace(HAWKMOTH.wing, pitch_axis=axis))
    stroke = dataclasses.replace(stroke, pitch_phase=phase)
    options = {"accounting": "positive", "coefficients": coefficients}
    ours = evaluate(insect, stroke, **options).specific_power
    _, oracle = evaluate_by_blade_element(insect, stroke, strips=24, steps=4000, spacing="graded", **options)
    assert ours == pytest.approx(oracle, rel=2e-4)


def test_a_wing_from_a_table_pays_too() -> None:
    wing = Wing.from_table([0, 0.02, 0.05], [0.012, 0.022, 0.008], mass=4e-5, pitch_axis=0.3)
    insect = dataclasses.replace(HAWKMOTH, wing=wing)
    ours = evaluate(insect, accounting="positive").specific_power
    _, oracle = evaluate_by_blade_element(insect, strips=100, steps=4000, spacing="gauss", accounting="positive")
    assert ours == pytest.approx(oracle, rel=2e-4)


@given(strokes(sharpest_flap=0.98, sharpest_pitch=6.0))
@settings(max_examples=30)
def test_it_is_never_less_than_elastic_power_and_tends_to_it_as_the_wing_loses_its_mass(stroke: Stroke) -> None:
    elastic = evaluate(HAWKMOTH, stroke).specific_power
    paid = []
    for mass in (1e-4, 1e-5, 1e-12):
        light = dataclasses.replace(HAWKMOTH, wing=dataclasses.replace(HAWKMOTH.wing, mass=mass))
        paid.append(evaluate(light, stroke, accounting="positive").specific_power)
    assert paid[0] >= paid[1] * (1 - 1e-4) >= paid[2] * (1 - 1e-3)
    assert paid[2] >= elastic * (1 - 1e-4)


def test_it_goes_with_the_cube_of_the_frequency_and_through_batches_and_tensors() -> None:
    stroke = dataclasses.replace(HAWKMOTH.stroke, flap_shape=0.9, pitch_shape=3.0, pitch_phase=1.4)
    once, twice = (
        evaluate(HAWKMOTH, dataclasses.replace(stroke, frequency=f), accounting="positive").specific_power
        for f in (20.0, 40.0)
    )
    assert twice == pytest.approx(8 * once, rel=1e-12)
    frequency = torch.tensor([20.0, 40.0], dtype=torch.float64, requires_grad=True)
    tensors = evaluate(HAWKMOTH, dataclasses.replace(stroke, frequency=frequency), accounting="positive")
    np.testing.assert_allclose(tensors.specific_power.detach().numpy(), [once, twice], rtol=1e-12)
    (slope,) = torch.autograd.grad(tensors.specific_power.sum(), frequency)
    np.testing.assert_allclose(slope.numpy(), 3 * np.array([once / 20, twice / 40]), rtol=1e-10)


def test_a_kink_between_two_nodes_is_integrated_to_third_order() -> None:
    kinks = np.linspace(0.3, 0.5, 21)
    exact = 2 / 3 - 1.5 * kinks + kinks**2 - kinks**3 / 6  # ∫ (s - k)(2 - s) ds from k to 1
    errors = []
    for nodes in (25, 50, 100):
        s, weights = graded_rule(nodes)
        found = [float(_positive_mean((s - kink) * (2 - s), s, weights)) for kink in kinks]
        errors.append(np.max(np.abs(np.array(found) - exact)))
    assert errors[1] < errors[0] / 5
    assert errors[2] < errors[1] / 5
