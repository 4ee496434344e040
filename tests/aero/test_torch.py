"""The same formulas on tensors: equal to NumPy's numbers, with slopes that finite differences confirm."""

import dataclasses
import math

import numpy as np
import pytest
import torch
from conftest import strokes
from hypothesis import given, settings

from flapenv import Stroke, evaluate, load_insect
from flapenv.aero.wingbeat import TimeRule, speed_averages

FIELDS = ("frequency", "flap_amplitude", "pitch_amplitude", "flap_shape", "pitch_shape", "pitch_phase")
HAWKMOTH = load_insect("hawkmoth")


def tensor(value: float) -> torch.Tensor:
    return torch.tensor([value], dtype=torch.float64, requires_grad=True)


@given(strokes(sharpest_flap=1.0, sharpest_pitch=100.0))
@settings(max_examples=40)
def test_tensors_agree_with_numpy_to_1e_12_in_double_precision(stroke: Stroke) -> None:
    fields = {name: float(getattr(stroke, name)) for name in FIELDS}
    ours = evaluate(HAWKMOTH, Stroke(**{name: tensor(value) for name, value in fields.items()}))
    arrays = evaluate(HAWKMOTH, stroke)
    assert ours.weight_support.item() == pytest.approx(arrays.weight_support, rel=1e-12, abs=1e-14)
    assert ours.specific_power.item() == pytest.approx(arrays.specific_power, rel=1e-12)


@pytest.mark.parametrize("flap_shape", [0.0, 1e-6, 1e-3, 0.5, 0.99, 0.9999, 1 - 1e-6, 1 - 1e-8])
@pytest.mark.parametrize("pitch_shape", [1e-3, 5.0])
def test_slopes_agree_with_finite_differences_towards_the_sinusoid_and_the_triangle(
    flap_shape: float, pitch_shape: float
) -> None:
    step = min(1e-6, (1 - flap_shape) * 1e-2)
    arguments = tensor(flap_shape), tensor(1.0), tensor(pitch_shape), tensor(1.4)
    assert torch.autograd.gradcheck(
        lambda *values: speed_averages(*values, rule=TimeRule(400, 3.0)), arguments, eps=step, rtol=1e-3, atol=1e-4
    )


def test_every_slope_of_the_performance_agrees_with_finite_differences() -> None:
    stroke = dataclasses.replace(HAWKMOTH.stroke, flap_shape=0.7, pitch_phase=1.4)

    def performance(*values: torch.Tensor) -> tuple[torch.Tensor, torch.Tensor]:
        ours = evaluate(HAWKMOTH, Stroke(**dict(zip(FIELDS, values, strict=True))))
        return ours.weight_support, ours.specific_power

    assert torch.autograd.gradcheck(performance, tuple(tensor(float(getattr(stroke, name))) for name in FIELDS))


def test_at_the_triangle_itself_the_unbounded_slope_is_left_out_and_the_others_stand() -> None:
    values = tensor(1.0), tensor(1.0), tensor(5.0), tensor(math.pi / 2)
    lift, power = speed_averages(*values, rule=TimeRule(100, 3.0))
    for average in (lift, power):
        slopes = torch.autograd.grad(average.sum(), values, retain_graph=True)
        assert slopes[0].item() == 0
        assert np.all(np.isfinite([slope.item() for slope in slopes]))
        assert slopes[1].item() != 0
