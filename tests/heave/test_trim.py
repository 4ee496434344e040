"""Where a heaving insect hovers."""

import dataclasses
import math

import numpy as np
import pytest

from flapenv import INSECTS, HoverProblem, StrokeBox, evaluate, load_insect, optimum
from flapenv.aero.stroke import Stroke
from flapenv.heave.trim import HOVER_AMPLITUDE, heave_trim, trim_waveform


@pytest.mark.parametrize("name", ["fruitfly", "ladybird"])
def test_the_frequency_is_that_of_the_optimum_with_the_amplitude_limited(name: str) -> None:
    trim = heave_trim([load_insect(name)])
    limited = StrokeBox(frequency_ratio=(0.3, 3.0), flap_amplitude=(math.radians(40), HOVER_AMPLITUDE))
    best = optimum(name, HoverProblem(box=limited))
    assert trim.stroke.frequency[0] == pytest.approx(best.stroke.frequency, rel=1e-5)
    assert trim.specific_power[0] == pytest.approx(best.specific_power, rel=1e-5)


def test_no_stroke_of_the_episode_hovers_with_less_at_that_frequency() -> None:
    insect = load_insect("bumblebee")
    trim = heave_trim([insect])
    best = optimum(insect, HoverProblem(box=StrokeBox(frequency=float(trim.stroke.frequency[0]))))
    assert trim.specific_power[0] == pytest.approx(best.specific_power, rel=1e-5)
    assert best.stroke.flap_amplitude == pytest.approx(HOVER_AMPLITUDE, rel=1e-4)
    assert best.max_weight_support > 2


def test_the_best_waveform_is_the_same_for_every_wing() -> None:
    box = StrokeBox(frequency_ratio=(0.3, 3.0), flap_amplitude=(HOVER_AMPLITUDE, HOVER_AMPLITUDE))
    shared = trim_waveform()
    for name in ("honeybee", "cranefly"):
        own = optimum(name, HoverProblem(box=box)).stroke
        for field in ("flap_shape", "pitch_shape", "pitch_amplitude", "pitch_phase"):
            assert getattr(own, field) == pytest.approx(getattr(shared, field), rel=1e-5)


def test_every_insect_carries_its_weight_and_the_units_fit() -> None:
    insects = [load_insect(name) for name in INSECTS]
    trim = heave_trim(insects)
    for i, insect in enumerate(insects):
        stroke = Stroke(**{name: float(values[i]) for name, values in vars(trim.stroke).items()})
        assert evaluate(insect, stroke).weight_support == pytest.approx(1, abs=1e-9)
        speed = 4 * stroke.frequency * stroke.flap_amplitude * insect.wing.length
        assert trim.tip_speed[i] == pytest.approx(speed)
        assert trim.gravity[i] == pytest.approx(9.81 / (stroke.frequency * speed))
        assert trim.reach[i] == pytest.approx(speed / (stroke.frequency * insect.wing.length))


def test_the_numbers_of_the_page_are_those_of_the_code() -> None:
    ladybird, honeybee, cranefly = (load_insect(name) for name in ("ladybird", "honeybee", "cranefly"))
    trim = heave_trim([ladybird, honeybee, cranefly])
    assert trim.stroke.frequency[0] / ladybird.stroke.frequency == pytest.approx(1.52, abs=0.005)  # A's box ends at 1.5
    assert trim.gravity[1:] == pytest.approx([0.0064, 0.108], rel=0.01)


def test_a_heavier_insect_beats_faster_as_the_root_of_its_weight() -> None:
    insect = load_insect("hoverfly")
    heavy = dataclasses.replace(insect, name="loaded", mass=1.44 * insect.mass)
    trim = heave_trim([insect, heavy])
    assert trim.stroke.frequency[1] == pytest.approx(1.2 * trim.stroke.frequency[0])
    np.testing.assert_allclose(trim.specific_power[1], 1.2 * trim.specific_power[0])
