"""The curve on which the optima of many wings lie."""

import math

import numpy as np
import pytest

from flapenv.problem import PROBLEMS, StrokeBox
from flapenv.shape_curve import cost_of_lift, curve, largest_lift, lifting, neighbours, shapes_of

B = PROBLEMS["fixed-frequency"].box


def test_a_corner_between_two_points_of_the_grid_is_met_from_both_sides() -> None:
    """A coordinate that reaches its face between two points: x = min(2.3 s, 1)."""
    grid = np.linspace(0, 1, 11)
    points = np.minimum(2.3 * grid, 1.0)[:, None]
    asked = np.array([0.05, 0.42, 0.4347, 0.45, 0.97])
    exact = np.minimum(2.3 * asked, 1.0)
    off = np.min([np.abs(candidate[:, 0] - exact) for candidate in neighbours(grid, points, asked)], axis=0)
    np.testing.assert_allclose(off, 0, atol=1e-12)
    middle = neighbours(grid, points, asked)[0][:, 0]
    assert np.max(np.abs(middle - exact)) > 0.01  # what lies between alone would miss it


def test_more_lift_costs_more_along_the_curve_at_the_price_it_says() -> None:
    largest = largest_lift(B)[1]
    grid = np.linspace(0.6, 0.95, 8) * largest
    points = curve(B, "fixed", grid)
    shapes = shapes_of(B)
    lift, power = shapes.numbers(points)
    np.testing.assert_allclose(lift, grid, rtol=1e-6)
    assert np.all(np.diff(power) > 0)
    price = cost_of_lift(shapes, points, np.zeros(len(grid)))
    between = np.diff(power) / np.diff(grid)
    assert np.all((between > price[:-1]) & (between < price[1:]))  # convex, and its slope is the multiplier


def test_lifting_meets_what_is_needed_from_either_side() -> None:
    shapes, (limit, largest) = shapes_of(B), largest_lift(B)
    points = curve(B, "fixed", np.array([0.7, 0.8]) * largest)
    for share in (0.698, 0.702, 0.798, 0.802):
        needed = np.full(2, share * largest)
        lift, _ = shapes.numbers(lifting(shapes, points, limit, needed))
        near = np.abs(np.array([0.7, 0.8]) - share) < 0.01
        np.testing.assert_allclose(lift[near], needed[near], rtol=1e-9)


@pytest.mark.parametrize("ratio", [0.0, 0.1])
def test_the_numbers_are_those_of_the_triangle_with_a_square_pitch_in_the_limit(ratio: float) -> None:
    box = StrokeBox(flap_shape=1.0, pitch_shape=1e9, pitch_phase=math.pi / 2)
    shapes = shapes_of(box)
    points = np.array([[-1.0], [1.0]])
    pitch = shapes.values(points)["pitch_amplitude"]
    lift, power = shapes.numbers(points, ratio)
    np.testing.assert_allclose(lift, np.sin(2 * pitch), rtol=1e-6)
    np.testing.assert_allclose(power, np.cos(pitch) ** 2 + ratio / 2, rtol=1e-6)
