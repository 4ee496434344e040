"""The linear part of the beat map."""

import math

import numpy as np
import pytest

from flapenv import load_insect
from flapenv.heave.dynamics import HeaveDynamics
from flapenv.heave.linear import linear_beat

MOTH = HeaveDynamics([load_insect("hawkmoth")])
BEAT = linear_beat(MOTH, 0)
AXES = MOTH.coordinates.names


def test_by_state_it_is_the_exponential_of_the_damping() -> None:
    strokes, _ = MOTH.decode(MOTH.trim_actions(), np.zeros(1, dtype=int))
    slope = MOTH.forces(np.zeros(1, dtype=int), strokes, np.zeros(1)).weight_support_slope[0]
    decay = math.exp(MOTH.trim.gravity[0] * slope)
    assert BEAT.by_state[1, 1] == pytest.approx(decay, rel=1e-4)
    assert BEAT.by_state[1, 2] == pytest.approx(1 - decay, rel=1e-4)
    assert BEAT.by_state[0, 0] == pytest.approx(1)
    assert BEAT.by_state[:2, 1] + BEAT.by_state[:2, 2] == pytest.approx([MOTH.trim.reach[0], 1], rel=1e-4)
    assert BEAT.by_state[2, 1] == pytest.approx(-BEAT.by_state[2, 2])
    assert not BEAT.by_state[1:, 0].any()


def test_amplitude_is_the_one_input_that_pushes_both_ways_and_the_cheapest() -> None:
    lift, power = BEAT.by_action[2], BEAT.by_action[3]
    flap = AXES.index("flap_amplitude")
    assert abs(BEAT.hover[flap]) < 0.9
    assert lift[flap] > 0
    for axis, name in enumerate(AXES):
        if name == "pitch_phase":
            assert abs(lift[axis]) < 1e-4  # symmetric rotation: lift has no slope
        elif name != "flap_amplitude":
            assert BEAT.hover[axis] == pytest.approx(1)  # on the edge of the box
            assert lift[axis] < 0  # moving off it adds lift
            assert power[axis] / lift[axis] > power[flap] / lift[flap]  # at a higher price
    prices = {name: power[axis] / lift[axis] for axis, name in enumerate(AXES) if name != "pitch_phase"}
    page = {"flap_amplitude": 1.51, "flap_shape": 1.59, "pitch_amplitude": 2.75, "pitch_shape": 4.0}
    assert prices == pytest.approx(page, abs=0.06)
