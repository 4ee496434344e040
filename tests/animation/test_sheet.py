"""Nothing leaves its panel, the loop closes, and two beats share their scales."""

import dataclasses
import math

import numpy as np
import pytest
from drawn_beats import BEST, HAWKMOTH, SERIES, beat

from flapenv import Stroke
from flapenv.animation.panels import SectionPanel, arrow_outline
from flapenv.animation.sheet import MovingSheet


def test_an_arrow_ends_at_its_tip_and_has_no_size_without_a_force() -> None:
    outline = arrow_outline(np.array([1.0, 2.0]), np.array([3.0, 4.0]), 0.1)
    np.testing.assert_allclose(outline[3], [4.0, 6.0])
    np.testing.assert_allclose((outline[0] + outline[-1]) / 2, [1.0, 2.0])
    assert np.ptp(arrow_outline(np.ones(2), np.zeros(2), 0.1), axis=0).tolist() == [0.0, 0.0]


@pytest.mark.parametrize(
    "stroke",
    [
        HAWKMOTH.stroke,
        BEST,
        SERIES,
        dataclasses.replace(HAWKMOTH.stroke, pitch_phase=-math.pi / 2),
        Stroke(frequency=5.0, flap_amplitude=0.02, pitch_amplitude=1.5),
        Stroke(frequency=26.0, flap_amplitude=1.0, pitch_amplitude=0.0),
    ],
)
def test_section_and_arrow_never_leave_their_panel(stroke: object) -> None:
    drawn = beat(stroke)
    sheet = MovingSheet([drawn], 480)
    section = sheet.panels[0][0]
    assert isinstance(section, SectionPanel)
    low, high = np.transpose([section.axes.get_xlim(), section.axes.get_ylim()])
    for points in (drawn.leading, drawn.trailing, drawn.axis + section.unit * drawn.force):
        assert np.all(points >= low)
        assert np.all(points <= high)
    scales = section.axes.transData.transform([[0, 0], [1, 1]])
    assert np.ptp(np.ptp(scales, axis=0)) < 0.1  # both directions alike


def test_the_loop_closes() -> None:
    sheet = MovingSheet([beat(frames=12)], 480)
    images = np.stack([sheet.image(frame) for frame in range(13)]).astype(int)
    np.testing.assert_array_equal(images[12], images[0])
    steps = np.abs(np.diff(images, axis=0)).mean(axis=(1, 2, 3))
    assert np.all(steps > 0.1)
    assert steps[-1] < 1.5 * np.max(steps[:-1])  # from the last to the first is a step like others


def test_two_beats_share_their_scales() -> None:
    sheet = MovingSheet([beat(), beat(BEST)], 480)
    own, best = (panels[0] for panels in sheet.panels)
    assert isinstance(own, SectionPanel)
    assert isinstance(best, SectionPanel)
    assert own.unit == pytest.approx(best.unit, rel=0.02)
    assert sheet.image(0).shape == (2 * 270, 480, 3)
