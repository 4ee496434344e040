"""What no CFD case covers."""

import dataclasses
import math

import pytest

from flapenv import INSECTS, PROBLEMS, Insect, StrokeBox, Wing, load_insect, optimum
from flapenv.assessment import outside_validated, reynolds_number
from flapenv.assessment.validity import ANGLES, CASES, angle_at_mid_stroke, outside_box


def test_reynolds_numbers_of_the_cases_run_from_the_fruit_fly_to_the_hawkmoth() -> None:
    """By hand from Table 1, ν = 1.46e-5 m²/s: 4 · 254 Hz · 75° · 0.60 · 2.02 mm · 0.67 mm/ν = 74, and so on."""
    numbers = {name: reynolds_number(load_insect(name), load_insect(name).stroke) for name in INSECTS}
    assert min(numbers, key=lambda name: numbers[name]) == "fruitfly"
    assert max(numbers, key=lambda name: numbers[name]) == "hawkmoth"
    assert numbers["fruitfly"] == pytest.approx(
        4 * 254 * math.radians(75) * 0.60 * 2.02e-3 * 0.67e-3 / 1.46e-5, rel=0.01
    )
    assert numbers["hawkmoth"] == pytest.approx(
        4 * 26.3 * math.radians(60.5) * 0.53 * 51.9e-3 * 18.26e-3 / 1.46e-5, rel=0.05
    )


def test_the_reynolds_number_scales_as_speed_times_size_times_density(hawkmoth: Insect) -> None:
    base = reynolds_number(hawkmoth, hawkmoth.stroke)
    faster = dataclasses.replace(hawkmoth.stroke, frequency=2 * hawkmoth.stroke.frequency)
    assert reynolds_number(hawkmoth, faster) == pytest.approx(2 * base)
    half = dataclasses.replace(
        hawkmoth, wing=dataclasses.replace(hawkmoth.wing, length=0.025, mean_chord=0.025 / hawkmoth.wing.aspect_ratio)
    )
    assert reynolds_number(half, hawkmoth.stroke) == pytest.approx(base * (0.025 / 0.0519) ** 2)
    assert reynolds_number(hawkmoth, hawkmoth.stroke, air_density=0.6125) == pytest.approx(base / 2)


def test_no_own_stroke_is_outside_but_the_fruit_flys_angle(insect: Insect) -> None:
    outside = outside_validated(insect, insect.stroke)
    assert [quantity.name for quantity in outside] == (["α at mid-stroke"] if insect.name == "fruitfly" else [])
    assert {quantity.basis for quantity in outside} <= {ANGLES}  # CFD was run on it


def test_the_optimum_is_outside_in_its_waveform_and_amplitude(insect: Insect) -> None:
    outside = {quantity.name: quantity for quantity in outside_validated(insect, optimum(insect).stroke)}
    assert {"φmax", "Cφ", "Cθ"} <= set(outside)
    assert {quantity.basis for quantity in outside.values()} == {CASES}
    assert "α at mid-stroke" not in outside
    assert outside["φmax"].text == "φmax = 90°, beyond 45 to 88.5°"


@pytest.mark.parametrize(
    ("change", "name"),
    [
        ({"pitch_amplitude": math.radians(70)}, "α at mid-stroke"),
        ({"pitch_amplitude": math.radians(40)}, "α at mid-stroke"),
        ({"frequency": 20.0}, "f"),
        ({"frequency": 300.0}, "f"),
        ({"flap_amplitude": math.radians(40)}, "φmax"),
        ({"flap_shape": 0.5}, "Cφ"),
        ({"pitch_shape": 4.0}, "Cθ"),
        ({"pitch_phase": math.radians(80)}, "δ"),
    ],
)
def test_each_number_of_a_stroke_is_held_against_the_cases(change: dict[str, float], name: str) -> None:
    bee = load_insect("bumblebee")
    outside = outside_validated(bee, dataclasses.replace(bee.stroke, **change))
    assert name in [quantity.name for quantity in outside]
    assert all(not quantity.low <= quantity.value <= quantity.high for quantity in outside)


def test_a_tenth_below_the_least_or_above_the_largest_case_is_flagged() -> None:
    """The ends are the hawkmoth's Re, AR and f, the fruit fly's f and Re, the hoverfly's and the ladybird's φmax ..."""
    for share, low in ((0.9, True), (1.1, False)):
        for field in ("frequency", "flap_amplitude"):
            values = [getattr(load_insect(name).stroke, field) for name in INSECTS]
            end = share * (min(values) if low else max(values))
            stroke = dataclasses.replace(load_insect("honeybee").stroke, **{field: end})
            symbol = {"frequency": "f", "flap_amplitude": "φmax"}[field]
            assert symbol in [one.name for one in outside_validated(load_insect("honeybee"), stroke)]
        name = "fruitfly" if low else "hawkmoth"
        case = load_insect(name)
        stroke = dataclasses.replace(case.stroke, frequency=share * case.stroke.frequency)
        assert "Re" in [one.name for one in outside_validated(case, stroke)]
        r1_hat = share * (0.46 if low else 0.56)
        wing = dataclasses.replace(case.wing, r1_hat=r1_hat)
        assert "r̂₁" in [one.name for one in outside_validated(dataclasses.replace(case, wing=wing), case.stroke)]


def test_a_stroke_a_thousandth_beyond_a_bound_is_beyond_the_box() -> None:
    best = optimum("hawkmoth").stroke
    for share, beyond in ((1 + 1e-3, ["θmax"]), (1 + 1e-6, [])):
        stroke = dataclasses.replace(best, pitch_amplitude=share * math.radians(65))
        assert [one.name for one in outside_box(load_insect("hawkmoth"), stroke, StrokeBox())] == beyond


def test_a_wing_of_another_shape_or_size_is_flagged(hawkmoth: Insect) -> None:
    slender = dataclasses.replace(hawkmoth, wing=Wing(length=0.0519, mean_chord=0.008, r1_hat=0.5))
    assert "AR" in [quantity.name for quantity in outside_validated(slender, hawkmoth.stroke)]
    bird = dataclasses.replace(hawkmoth, wing=Wing(length=0.2, mean_chord=0.06, r1_hat=0.5))
    assert "Re" in [quantity.name for quantity in outside_validated(bird, hawkmoth.stroke)]


def test_the_angle_at_mid_stroke_knows_a_delayed_rotation(hawkmoth: Insect) -> None:
    assert angle_at_mid_stroke(hawkmoth.stroke) == pytest.approx(math.pi / 2 - hawkmoth.stroke.pitch_amplitude)
    late = dataclasses.replace(hawkmoth.stroke, pitch_phase=math.radians(30), pitch_shape=1.0)
    assert angle_at_mid_stroke(late) > angle_at_mid_stroke(hawkmoth.stroke)


def test_an_optimum_is_never_beyond_its_own_box_and_another_boxs_may_be(insect: Insect) -> None:
    for name in ("free-frequency", "fixed-frequency", "profile-drag"):
        assert not outside_box(insect, optimum(insect, name).stroke, PROBLEMS[name].box)
    own = outside_box(insect, insect.stroke, StrokeBox())
    assert {quantity.name for quantity in own} <= {"Cφ", "θmax"}  # a sinusoid; the fruit fly's 46°
    assert "Cφ" in {quantity.name for quantity in own}


def test_limits_of_ones_own_are_told_in_degrees() -> None:
    limits = StrokeBox(frequency=(30, 40), flap_amplitude=(math.radians(40), math.radians(55)))
    found = {one.name: one.text for one in outside_box(load_insect("hawkmoth"), load_insect("hawkmoth").stroke, limits)}
    assert found["f"] == "f = 26.3 Hz, beyond 30 to 40 Hz"
    assert found["φmax"] == "φmax = 60.5°, beyond 40 to 55°"
