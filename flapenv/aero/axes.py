"""Axes and signs: earth, stroke plane, strip. docs/axes.md draws them.

Earth axes: x forward, y to the left, z up. The stroke plane is turned about y by σ, 0 where it is horizontal, positive
where its normal leans forward: x₁ = (cos σ, 0, -sin σ), z₁ = (sin σ, 0, cos σ). The paper counts σ from a vertical
stroke plane, so that its -90° is σ = 0 here. Both wings flap forward with positive φ, mirror images of each other.

Strip axes of one wing: ê_φ along increasing φ, ẑ₁ along the stroke plane's normal, ê_r outwards. The chord direction
from trailing to leading edge is ê_c = sin θ ê_φ + cos θ ẑ₁, its normal n̂ = -cos θ ê_φ + sin θ ẑ₁.
"""

import math

import numpy as np

RIGHT, LEFT = 1, -1
"""The two wings; the sign that tells them apart."""


def to_earth(vectors: np.ndarray, stroke_plane_angle: float) -> np.ndarray:
    """Vectors (..., 3) in stroke-plane axes turned into earth axes.

    Args:
        vectors: components along x₁, y, z₁.
        stroke_plane_angle: σ [rad].
    """
    return vectors @ _rotation(stroke_plane_angle)


def to_stroke_plane(vectors: np.ndarray, stroke_plane_angle: float) -> np.ndarray:
    """Vectors (..., 3) in earth axes turned into stroke-plane axes; arguments as in `to_earth`."""
    return vectors @ _rotation(stroke_plane_angle).T


def _rotation(angle: float) -> np.ndarray:
    """Rows x₁, y, z₁ in earth axes, exact at multiples of 90°."""
    cosine, sine = (0.0 if abs(value) < 1e-15 else value for value in (math.cos(angle), math.sin(angle)))
    return np.array([[cosine, 0.0, -sine], [0.0, 1.0, 0.0], [sine, 0.0, cosine]])


def flapping_directions(flap_angle: np.ndarray, side: int) -> tuple[np.ndarray, np.ndarray]:
    """ê_φ and ê_r of one wing in stroke-plane axes, shape (n, 3) each.

    Args:
        flap_angle: φ, shape (n,) [rad].
        side: `RIGHT` or `LEFT`.
    """
    sine, cosine, none = np.sin(flap_angle), np.cos(flap_angle), np.zeros_like(flap_angle)
    return np.stack([cosine, side * sine, none], axis=-1), np.stack([sine, -side * cosine, none], axis=-1)
