"""Quadrature rules."""

import math

import numpy as np
import pytest

from flapenv.aero.quadrature import crowded_rule, gauss_rule, graded_rule


@pytest.mark.parametrize("nodes", [8, 24, 25, 120])
@pytest.mark.parametrize("crowding", [0.3, 1.6, 7.0])
def test_the_crowded_rule_is_mirrored_and_its_nodes_lie_inside(nodes: int, crowding: float) -> None:
    points, weights = crowded_rule(nodes, crowding)
    assert np.all((points > 0) & (points < 1) & (weights > 0))
    assert np.all(np.diff(points) > 0)
    np.testing.assert_allclose(points + points[::-1], 1, rtol=1e-12)
    np.testing.assert_allclose(weights, weights[::-1], rtol=1e-9)


def test_layers_at_both_ends_are_resolved_with_the_logarithm_of_their_width() -> None:
    def error(width: float, nodes: int) -> float:
        points, weights = crowded_rule(nodes, 0.43 * math.log(4 / width))
        value = weights @ (1 / np.hypot(width, points) + 1 / np.hypot(width, 1 - points))
        return abs(value / (2 * math.asinh(1 / width)) - 1)

    for width, nodes in ((0.1, 20), (1e-2, 28), (1e-4, 48), (1e-6, 72)):
        assert error(width, nodes) < 1e-6
        assert error(width, nodes // 2) > error(width, nodes)
    points, weights = graded_rule(72)
    plain = weights @ (1 / np.hypot(1e-6, points) + 1 / np.hypot(1e-6, 1 - points))
    assert abs(plain / (2 * math.asinh(1e6)) - 1) > 1e-5  # what the other rule makes of the sharpest


def test_without_crowding_it_is_gauss_own_rule() -> None:
    points, weights = crowded_rule(6, 1e-6)
    x, w = np.polynomial.legendre.leggauss(6)
    np.testing.assert_allclose(points, (1 + x) / 2, rtol=1e-9)
    np.testing.assert_allclose(weights, w / 2, rtol=1e-9)


def test_gauss_rule_of_a_weight_keeps_its_moments() -> None:
    points, weights = graded_rule(60)
    few, own = gauss_rule(points, weights * points * (1 - points), 5)
    for power in range(10):
        assert own @ few**power == pytest.approx((weights * points * (1 - points)) @ points**power, rel=1e-10)
