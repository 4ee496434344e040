"""Numbers that the page may send: everything up to both ends of a control, nothing beyond, told in the page's words."""

import math

import pytest

import flapenv
from agents.explorer.controls import WING_CONTROLS, Control, stroke_controls

HAWKMOTH = flapenv.load_insect("hawkmoth")
CONTROLS = {control.name: control for control in (*stroke_controls(HAWKMOTH), *WING_CONTROLS)}
RANGES = {
    "frequency": (7.89, 52.6),  # 0.3 to 2 times its own 26.3 Hz
    "flap_amplitude": (10, 90),
    "flap_shape": (0, 0.999),
    "pitch_shape": (0, 100),
    "alpha_mid": (1, 89),
    "pitch_phase": (30, 150),
    "mass": (1e-3, 1e6),
    "wing_length": (0.1, 1000),
    "mean_chord": (0.01, 500),
    "r1_hat": (0.38, 0.65),
    "reference_frequency": (0.1, 5000),
}
FRACTION = 1e-6
"""Of an end or of 1, by which a number lies just outside."""


def test_every_control_is_tried() -> None:
    assert RANGES.keys() == CONTROLS.keys()


@pytest.mark.parametrize("name", RANGES)
def test_both_ends_are_allowed_and_nothing_just_outside(name: str) -> None:
    control, (low, high) = CONTROLS[name], RANGES[name]
    assert (control.checked(low), control.checked(high)) == (pytest.approx(low), pytest.approx(high))
    for outside in (low - FRACTION * (abs(low) or 1), high + FRACTION * high):
        with pytest.raises(ValueError, match="is not allowed; allowed: ") as refused:
            control.checked(outside)
        assert str(refused.value).startswith(f"{control.short_label} = ")


@pytest.mark.parametrize("bad", [math.nan, math.inf, -math.inf, 10**400])
def test_what_is_not_finite_is_refused(bad: float) -> None:
    with pytest.raises(ValueError, match="is not allowed"):
        CONTROLS["alpha_mid"].checked(bad)


@pytest.mark.parametrize("bad", ["30", [30], {"a": 1}, True, (30,)])
def test_what_is_no_number_is_shown_as_it_came(bad: object) -> None:
    with pytest.raises(TypeError) as refused:
        CONTROLS["alpha_mid"].checked(bad)
    assert str(refused.value) == f"angle of attack α_mid = {bad!r} is not a number; allowed: 1° to 89°"


@pytest.mark.parametrize(
    ("control", "wanted"),
    [
        (CONTROLS["alpha_mid"], "angle of attack α_mid is missing; allowed: 1° to 89°"),
        (CONTROLS["mean_chord"], "mean chord c̄ is missing; allowed: 0.01 mm to 500 mm"),
        (CONTROLS["flap_shape"], "Cφ is missing; allowed: 0 to 0.999"),
    ],
)
def test_mistakes_speak_as_the_page_does_with_units_as_one_writes_them(control: Control, wanted: str) -> None:
    with pytest.raises(ValueError, match=f"^{wanted}$"):
        control.checked(None)
