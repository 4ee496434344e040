"""Action coordinates."""

import itertools
import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from hypothesis.extra.numpy import arrays

from flapenv import Stroke, StrokeBox, evaluate, load_insect
from flapenv.aero.parameters import StrokeReference
from flapenv.coordinates import SCALINGS, StrokeCoordinates

POINTS = arrays(np.float64, (5, 6), elements=st.floats(-1, 1))
OWN = load_insect("hawkmoth").reference
OPEN = StrokeBox(flap_shape=(0.0, 1.0), pitch_shape=(0.0, 100.0))


@given(POINTS)
def test_every_point_is_a_stroke_of_the_box(points: np.ndarray) -> None:
    for box in (StrokeBox(), OPEN):
        for scaling in SCALINGS:
            for dtype in (np.float32, np.float64):
                values, _ = StrokeCoordinates(box, scaling=scaling).decode(
                    points.astype(dtype), load_insect("hawkmoth").reference
                )
                for name, value in values.items():
                    low, high = box.bounds(name, OWN)
                    assert value.dtype == dtype
                    assert np.all((low <= value.astype(float)) & (value.astype(float) <= high)), name


@given(POINTS)
def test_encoding_undoes_decoding_where_nothing_was_clipped(points: np.ndarray) -> None:
    for scaling in SCALINGS:
        coordinates = StrokeCoordinates(StrokeBox(), scaling=scaling)
        values, clipped = coordinates.decode(points, OWN)
        back = coordinates.encode(values, OWN)
        np.testing.assert_allclose(back[~clipped], points[~clipped], atol=1e-9)


def test_the_first_axis_is_tip_speed_and_the_frequency_follows() -> None:
    coordinates = StrokeCoordinates(StrokeBox())
    assert coordinates.axis_names[0] == "tip_speed"
    points = np.zeros((3, 6))
    points[:, 1] = [-1, 0, 1]
    values, _ = coordinates.decode(points, StrokeReference(100.0, 1.0))
    tip_speed = values["frequency"] * values["flap_amplitude"]
    middle = math.sqrt(0.5 * math.radians(40) * 1.5 * math.radians(90)) * 100  # log scale: the geometric mean
    np.testing.assert_allclose(tip_speed, middle, rtol=1e-12)


def test_points_outside_are_moved_to_the_face_and_flagged_and_so_is_a_clipped_frequency() -> None:
    coordinates = StrokeCoordinates(StrokeBox())
    inside, outside, clipped_frequency = np.zeros(6), np.full(6, 0.0), np.zeros(6)
    outside[3] = 1.5
    clipped_frequency[:2] = (-1, 1)  # slowest tip at the widest stroke
    values, clipped = coordinates.decode(np.stack([inside, outside, clipped_frequency]), StrokeReference(100.0, 1.0))
    assert clipped.tolist() == [False, True, True]
    assert values["pitch_shape"][1] == pytest.approx(10)
    assert values["frequency"][2] == 50


def test_corners_are_not_flagged_in_single_precision() -> None:
    coordinates = StrokeCoordinates(StrokeBox())
    corners = np.array([[-1, -1, -1, -1, -1, -1], [1, 1, 1, 1, 1, 1]], dtype=np.float32)
    for frequency in (26.3, 254.0, 45.5):
        assert coordinates.decode(corners, StrokeReference(frequency, 1.0))[1].tolist() == [False, False]


def test_single_precision_corners_are_valid_strokes_that_evaluate_takes() -> None:
    box = StrokeBox(pitch_amplitude=(0.0, math.pi / 2), pitch_phase=(-2 * math.pi, 2 * math.pi))
    for name in ("hawkmoth", "cranefly"):
        reference = load_insect(name).reference
        for corner in itertools.product([-1, 1], repeat=6):
            values, _ = StrokeCoordinates(box).decode(np.array(corner, dtype=np.float32), reference)
            evaluate(name, Stroke(**{key: float(value) for key, value in values.items()}))


def test_fixed_parameters_have_no_axis_and_a_fixed_amplitude_leaves_the_frequency() -> None:
    box = StrokeBox(flap_amplitude=1.0, pitch_phase=math.pi / 2)
    coordinates = StrokeCoordinates(box)
    assert coordinates.axis_names == ("frequency", "flap_shape", "pitch_shape", "pitch_amplitude")
    values, _ = coordinates.decode(np.zeros((2, 4)), StrokeReference(100.0, 1.0))
    assert values["flap_amplitude"].tolist() == [1, 1]
    assert values["frequency"][0] == pytest.approx(100 * math.sqrt(0.5 * 1.5))


def test_log_scales_reach_the_limits_they_would_not_reach_otherwise() -> None:
    values, _ = StrokeCoordinates(OPEN).decode(
        np.array([[0, 0, 1, -1, 0, 0.0], [0, 0, -1, 1, 0, 0]]), load_insect("hawkmoth").reference
    )
    np.testing.assert_allclose(values["flap_shape"], [1, 0], atol=1e-12)
    np.testing.assert_allclose(values["pitch_shape"], [0, 100], atol=1e-9)


def test_an_unknown_scaling_is_refused() -> None:
    with pytest.raises(ValueError, match="action_scaling = 'linear' is unknown; allowed: tip-speed, log, plain"):
        StrokeCoordinates(StrokeBox(), scaling="linear")
