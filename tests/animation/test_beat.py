"""What is drawn of a wingbeat is the physics."""

import dataclasses
import math

import numpy as np
import pytest
from drawn_beats import BEST, HAWKMOTH, SERIES, beat

import flapenv.animation.__main__ as command
from flapenv import Insect, evaluate, optimum, simulate
from flapenv.aero import TERMS
from flapenv.aero.axes import LEFT, RIGHT
from flapenv.aero.inertia import wing_inertia


def test_the_mean_of_the_arrows_vertical_part_is_the_weight_support(insect: Insect) -> None:
    for stroke in (insect.stroke, optimum(insect).stroke):
        drawn, ours = beat(stroke, insect), evaluate(insect, stroke)
        assert drawn.weight_support == np.mean(drawn.force[:, 1])
        assert drawn.weight_support == pytest.approx(ours.weight_support, rel=1e-5)
        assert drawn.mean_power == pytest.approx(ours.specific_power, rel=1e-5)


@pytest.mark.parametrize("motion", [HAWKMOTH.stroke, BEST, SERIES])
def test_the_arrow_is_normal_to_the_chord_and_its_drag_brakes(motion: object) -> None:
    drawn = beat(motion)
    chord = drawn.leading - drawn.trailing
    np.testing.assert_allclose(np.sum(chord * drawn.force, axis=1), 0, atol=1e-9 * np.max(np.abs(drawn.force)))
    assert np.all(drawn.force[:, 0] * drawn.history.kinematics.flap_rate <= 1e-12)


def test_the_arrow_along_the_stroke_times_the_speed_of_its_centre_is_the_power() -> None:
    drawn = beat()
    arm = HAWKMOTH.wing.moment(3) / HAWKMOTH.wing.moment(2) * HAWKMOTH.wing.length  # of drag ∝ r²
    power = -drawn.force[:, 0] * 9.81 * arm * drawn.history.kinematics.flap_rate
    np.testing.assert_allclose(power, drawn.specific_power, rtol=1e-3)


@pytest.mark.parametrize("term", TERMS)
def test_the_tangential_force_of_both_wings_gives_the_forward_force_of_the_pair(term: str) -> None:
    stroke = dataclasses.replace(HAWKMOTH.stroke, pitch_phase=math.radians(100))
    history = simulate(HAWKMOTH, stroke, terms=[term], steps=2000)
    found = history.terms[term]
    forward = np.sum(found.tangential_force, axis=0) * np.cos(history.kinematics.flap)
    if term == "inertia":  # pulls along the wing too
        at, moments = history.kinematics, wing_inertia(HAWKMOTH.wing)
        turning = 2 * np.cos(at.pitch) * at.pitch_rate * at.flap_rate + np.sin(at.pitch) * at.flap_acceleration
        forward += 2 * (moments.first_radius * at.flap_rate**2 - moments.first_chord * turning) * np.sin(at.flap)
    np.testing.assert_allclose(forward, found.force[:, 0], atol=1e-9 * np.max(np.abs(found.force)))


def test_the_section_is_as_long_as_its_chord_and_lies_on_its_arc() -> None:
    drawn, wing = beat(), HAWKMOTH.wing
    r_hat = math.sqrt(wing.moment(2))
    length = np.hypot(*(drawn.leading - drawn.trailing).T)
    np.testing.assert_allclose(length * wing.mean_chord, wing.chord(np.array([r_hat]))[0])
    np.testing.assert_allclose(
        drawn.axis[:, 0] * wing.mean_chord, drawn.history.kinematics.flap * r_hat * wing.length, atol=1e-15
    )
    np.testing.assert_allclose(
        drawn.axis, (1 - wing.pitch_axis) * drawn.leading + wing.pitch_axis * drawn.trailing, atol=1e-12
    )


def test_inertia_enters_the_power_and_not_the_arrow() -> None:
    air, all_ = beat(terms=["translational", "added-mass"]), beat(terms=["translational", "added-mass", "inertia"])
    np.testing.assert_array_equal(air.force, all_.force)
    assert np.max(np.abs(air.specific_power - all_.specific_power)) > 10
    paid = evaluate(HAWKMOTH, accounting="positive")
    assert beat(model=command.PROBLEMS["inertial"].model).mean_power == pytest.approx(paid.specific_power, rel=1e-3)


@pytest.mark.parametrize("frames", [2, 7, 60, 5000])
def test_frames_divide_the_cycle_evenly(frames: int) -> None:
    drawn = beat(frames=frames)
    np.testing.assert_allclose(drawn.time[drawn.rows], (np.arange(frames) + 0.5) / frames, rtol=1e-12)


@pytest.mark.parametrize("motion", [HAWKMOTH.stroke, SERIES])
def test_the_trail_holds_sections_of_this_half_stroke_only(motion: object) -> None:
    drawn = beat(motion)
    lengths = []
    for row in drawn.rows:
        stamps, fresh = drawn.trail(row)
        assert all(drawn.sense(stamp) == drawn.sense(row) for stamp in stamps)
        assert np.all((fresh > 0) & (fresh < 1))
        behind = drawn.sense(row) * (drawn.axis[row, 0] - drawn.axis[stamps, 0])
        assert np.all(behind > 0)
        lengths.append(len(stamps))
    assert min(lengths) <= 1
    assert max(lengths) >= 10


def test_the_wings_from_above_mirror_each_other_and_lead_with_their_leading_edge() -> None:
    drawn = beat()
    row = int(drawn.rows[0])  # forward, in the middle
    right, left = drawn.outline(row, RIGHT), drawn.outline(row, LEFT)
    np.testing.assert_allclose(right * [1, -1], left, atol=1e-12)
    assert np.all(right[1:, 1] < 1e-9)  # the right wing is to the right of the root
    half = len(right) // 2
    middle = half // 2
    assert right[middle, 0] > right[-1 - middle, 0]
    assert np.hypot(*right[half - 1]) == pytest.approx(1.0)
