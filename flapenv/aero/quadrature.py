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
