"""The oracle: the paper's resolution, convergence and scaling."""

import dataclasses

import numpy as np
import pytest

from flapenv import Insect, evaluate
from flapenv.aero.blade_element import STEPS, STRIPS, blade_element
from flapenv.aero.force_laws import PlateLaw
from flapenv.simulation import evaluate_by_blade_element

LAW = PlateLaw(constant=1.3)


def test_the_papers_resolution_is_50_strips_by_500_steps_and_misses_the_exact_moments_by_little(insect: Insect) -> None:
    assert (STRIPS, STEPS) == (50, 500)
    exact, coarse = evaluate(insect), evaluate_by_blade_element(insect)
    np.testing.assert_allclose(coarse, (exact.weight_support, exact.specific_power), rtol=3e-3)


def test_even_strips_converge_to_the_exact_moments(hawkmoth: Insect) -> None:
    exact = evaluate(hawkmoth)
    errors = [
        abs(evaluate_by_blade_element(hawkmoth, strips=strips, steps=2000)[1] / exact.specific_power - 1)
        for strips in (25, 50, 100, 400)
    ]
    assert errors == sorted(errors, reverse=True)
    assert errors[-1] < 2e-4


def test_two_gauss_jacobi_strips_are_exact_in_the_span(hawkmoth: Insect) -> None:
    exact = evaluate(hawkmoth)
    fine = evaluate_by_blade_element(hawkmoth, strips=2, steps=5000, spacing="gauss")
    np.testing.assert_allclose(fine, (exact.weight_support, exact.specific_power), rtol=1e-8)


def test_doubling_the_frequency_gives_four_times_the_lift_and_eight_times_the_power(hawkmoth: Insect) -> None:
    faster = dataclasses.replace(hawkmoth.stroke, frequency=2 * hawkmoth.stroke.frequency)
    slow, fast = (blade_element(hawkmoth.wing, stroke, LAW, air_density=1.225) for stroke in (hawkmoth.stroke, faster))
    assert fast.mean_lift == pytest.approx(4 * slow.mean_lift, rel=1e-12)
    assert fast.mean_power() == pytest.approx(8 * slow.mean_power(), rel=1e-12)


def test_power_is_never_negative_and_both_half_strokes_lift_alike(hawkmoth: Insect) -> None:
    history = blade_element(hawkmoth.wing, hawkmoth.stroke, LAW, air_density=1.225)
    assert np.all(history.power >= 0)
    np.testing.assert_allclose(history.lift[:250], history.lift[250:], rtol=1e-9, atol=1e-9 * np.max(history.lift))


@pytest.mark.parametrize(
    ("arguments", "said"),
    [
        ({"strips": 0}, "strips = 0"),
        ({"steps": -3}, "steps = -3"),
        ({"spacing": "odd"}, "spacing = 'odd' is unknown; allowed: even, gauss"),
        ({"air_density": float("nan")}, "air_density = nan"),
    ],
)
def test_bad_resolution_is_refused(hawkmoth: Insect, arguments: dict[str, object], said: str) -> None:
    with pytest.raises(ValueError, match=said):
        blade_element(hawkmoth.wing, hawkmoth.stroke, LAW, **{"air_density": 1.225, **arguments})
