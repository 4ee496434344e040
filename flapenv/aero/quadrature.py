"""Quadrature rules that more than one formula uses."""

import functools
import math

import numpy as np


@functools.lru_cache(maxsize=64)
def graded_rule(nodes: int) -> tuple[np.ndarray, np.ndarray]:
    """Nodes and weights on (0, 1): Gauss-Legendre in x, crowded to both ends by s = sin²(πx/2).

    Args:
        nodes: how many.

    Returns:
        Nodes and weights, shape (nodes,) each.
    """
    x, weights = np.polynomial.legendre.leggauss(nodes)
    x = (x + 1) / 2
    return np.sin(math.pi * x / 2) ** 2, weights / 2 * math.pi / 2 * np.sin(math.pi * x)


@functools.lru_cache(maxsize=64)
def crowded_rule(nodes: int, crowding: float) -> tuple[np.ndarray, np.ndarray]:
    """Nodes and weights on (0, 1): Gauss-Legendre in x, crowded to both ends by s = (1 + tanh(a x)/tanh a)/2.

    Layers of width w at the ends have e^(-2a) ~ w; the count then grows with log(1/w) only, where that of
    `graded_rule` grows with a power of w.

    Args:
        nodes: how many.
        crowding: a > 0.

    Returns:
        Nodes, mirrored about 1/2 and known from 0 without loss of digits, and weights, shape (nodes,) each.
    """
    x, weights = np.polynomial.legendre.leggauss(nodes)
    points = np.sinh(crowding * (1 + x)) / (2 * np.sinh(crowding) * np.cosh(crowding * x))
    weights = weights * crowding / (2 * math.tanh(crowding) * np.cosh(crowding * x) ** 2)
    points.flags.writeable = weights.flags.writeable = False  # they are kept
    return points, weights


def gauss_rule(points: np.ndarray, weights: np.ndarray, count: int) -> tuple[np.ndarray, np.ndarray]:
    """Gauss' rule for the weight function that many points and weights stand for, by Stieltjes' procedure.

    Args:
        points: of a fine rule, shape (n,), n well above `count`.
        weights: there, >= 0, shape (n,).
        count: nodes wanted; polynomials up to degree 2 count - 1 come out as by the fine rule.

    Returns:
        Nodes and weights, shape (count,) each.

    Source: Gautschi (2004), Orthogonal Polynomials, section 2.2; Golub & Welsch (1969).
    """
    before, polynomial = np.zeros_like(points), np.ones_like(points) / np.sqrt(np.sum(weights))
    diagonal, beside = np.zeros(count), np.zeros(count)
    for k in range(count):
        diagonal[k] = np.sum(weights * points * polynomial**2)
        following = (points - diagonal[k]) * polynomial - beside[k - 1] * before
        beside[k] = math.sqrt(np.sum(weights * following**2))
        if beside[k] < 1e-12:
            raise ValueError(f"the weight function has too few points for a rule of {count} nodes; allowed: fewer")
        before, polynomial = polynomial, following / beside[k]
    jacobi = np.diag(diagonal) + np.diag(beside[:-1], 1) + np.diag(beside[:-1], -1)
    nodes, vectors = np.linalg.eigh(jacobi)
    return nodes, np.sum(weights) * vectors[0] ** 2
