"""An insect's wingbeat in full: any motion, any wing, the terms together, against the fast path."""

import dataclasses
import math

import numpy as np
import pytest

from flapenv import FourierMotion, Insect, SampledMotion, Stroke, Wing, evaluate, load_insect, simulate
from flapenv.aero.blade_element import TERMS

FRUITFLY = load_insect("fruitfly")


def test_the_insects_own_beat_has_the_means_of_evaluate(insect: Insect) -> None:
    history, ours = simulate(insect, spacing="gauss", strips=6, steps=2000), evaluate(insect)
    assert history.mean_lift == pytest.approx(ours.lift, rel=1e-6)
    assert history.mean_power() == pytest.approx(ours.power, rel=1e-6)
    assert set(history.terms) == {"translational"}


def test_a_sampled_stroke_lifts_what_the_stroke_lifts() -> None:
    stroke = FRUITFLY.stroke
    drawn = SampledMotion.from_functions(stroke.frequency, stroke.flap_angle, stroke.pitch_angle)
    ours, exact = simulate(FRUITFLY, drawn), simulate(FRUITFLY)
    assert ours.mean_lift == pytest.approx(exact.mean_lift, rel=1e-5)
    assert ours.mean_power() == pytest.approx(exact.mean_power(), rel=1e-5)


def test_a_fourier_motion_gets_the_coefficients_of_its_amplitude_and_speed() -> None:
    stroke = dataclasses.replace(FRUITFLY.stroke, pitch_shape=0.0)
    series = FourierMotion(
        frequency=stroke.frequency,
        flap_sines=[stroke.flap_amplitude],
        pitch_cosines=[0.0, stroke.pitch_amplitude],
    )
    for model in ({}, {"tip_loss": "stroke"}, {"coefficients": "berman-wang"}):
        ours, exact = (simulate(FRUITFLY, motion, model=model) for motion in (series, stroke))
        assert ours.mean_lift == pytest.approx(exact.mean_lift, rel=1e-6)


def test_a_wing_from_a_table_flies_like_the_wing_it_was_measured_on() -> None:
    r_hat = np.sin(np.linspace(0, math.pi / 2, 200)) ** 2
    table = Wing.from_table(r_hat * FRUITFLY.wing.length, FRUITFLY.wing.chord(r_hat))
    own = dataclasses.replace(FRUITFLY, wing=table)
    assert evaluate(own).weight_support == pytest.approx(evaluate(FRUITFLY).weight_support, rel=2e-3)
    assert evaluate(own).weight_support * own.mass * 9.81 == pytest.approx(
        simulate(own, spacing="gauss", steps=2000).mean_lift, rel=1e-6
    )


def test_all_terms_together_are_the_sum_of_each_alone() -> None:
    stroke = dataclasses.replace(FRUITFLY.stroke, pitch_phase=math.radians(110))
    together = simulate(FRUITFLY, stroke, terms=TERMS)
    alone = [simulate(FRUITFLY, stroke, terms=[term]) for term in TERMS]
    np.testing.assert_allclose(together.force, sum(one.force for one in alone), atol=1e-12 * together.force.max())
    np.testing.assert_allclose(together.power, sum(one.power for one in alone), atol=1e-12 * together.power.max())


def test_the_insects_with_a_known_wing_mass_are_three() -> None:
    masses = {name: load_insect(name).wing.mass for name in ("fruitfly", "bumblebee", "hawkmoth", "cranefly")}
    assert masses == pytest.approx({"fruitfly": 8.6e-10, "bumblebee": 4.6e-7, "hawkmoth": 4.7e-5, "cranefly": None})
    with pytest.raises(ValueError, match="wing mass is missing"):
        simulate("cranefly", terms=["inertia"])


@pytest.mark.parametrize(
    ("arguments", "kind", "said"),
    [
        ({"motion": "sine"}, TypeError, "motion = 'sine' is not allowed; allowed: a Stroke"),
        ({"motion": dataclasses.replace(FRUITFLY.stroke, flap_amplitude=2.0)}, ValueError, "flap_amplitude .*k_flap"),
        ({"motion": dataclasses.replace(FRUITFLY.stroke, frequency=[1.0, 2.0])}, TypeError, "array fields"),
        ({"model": {"air_desnity": 1.0}}, TypeError, "did you mean 'air_density'"),
        ({"motion": Stroke}, TypeError, "motion = <class .*Stroke'> is not allowed"),
        ({"motion": object()}, TypeError, "an object with frequency, flap_amplitude, .*pitch_acceleration"),
        ({"model": 0}, TypeError, "model = 0 is not allowed; allowed: a HoverModel or a dict"),
        ({"terms": 3}, ValueError, "terms = 3 is not allowed"),
        ({"strip": 3}, TypeError, "strip = 3 is not an option of simulate; allowed: terms, .*did you mean 'strips'"),
        ({"air_density": 1.0}, TypeError, "air_density = 1.0 is not an option of simulate"),
        ({"spacing": "odd"}, ValueError, "spacing = 'odd' is unknown; allowed: even, gauss"),
    ],
)
def test_bad_input_is_named(arguments: dict[str, object], kind: type[Exception], said: str) -> None:
    with pytest.raises(kind, match=said):
        simulate(FRUITFLY, **arguments)


@pytest.mark.parametrize("sharp", [{"pitch_shape": 200.0}, {"flap_shape": 1 - 1e-9}])
def test_steps_too_few_for_accelerations_are_warned_of(sharp: dict[str, float]) -> None:
    stroke = dataclasses.replace(FRUITFLY.stroke, **sharp)
    with pytest.warns(UserWarning, match="steps = 500 do not resolve the motion"):
        simulate(FRUITFLY, stroke, terms=["translational", "inertia"])
    simulate(FRUITFLY, stroke)  # nothing to say where no rates count
