"""The averages of the paper's force law compiled by numba (the extra "fast"), in single precision.

Imported only where it is asked for. Sixty-four strokes go through every operation together, which fill the processor's
vector registers; sine and hyperbolic tangent are polynomials good to single precision, as calls of library functions
could not be interleaved so. Tests hold every function here against NumPy's, and the averages against `plate_averages`.
"""

import math
from typing import Any

import numba
import numpy as np

from flapenv.aero.stroke import SMALLEST_SHAPE

LANES = 64
"""Strokes that go together; a number known when compiling, without which nothing is vectorised."""
PI, RIGHT_ANGLE = np.float32(math.pi), np.float32(math.pi / 2)
# sin x = x P(x²) on [0, π/2] to 5e-9, tanh x = x P(x²)/Q(x²) on [0, 8.2] to 8e-9: least squares at Chebyshev points,
# reweighted until the largest relative error is least
S1, S3, S5, S7, S9 = (np.float32(c) for c in (1.0, -1.666665673e-1, 8.333025500e-3, -1.980742090e-4, 2.601906999e-6))
P0, P1, P2, P3, P4 = (np.float32(c) for c in (1.0, 1.34321257e-1, 3.55669041e-3, 2.16373410e-5, 1.48406514e-8))
Q1, Q2, Q3, Q4 = (np.float32(c) for c in (4.67654526e-1, 2.61083134e-2, 3.38644779e-4, 8.37064192e-7))
ONE, LARGEST = np.float32(1.0), np.float32(8.2)

OPTIONS: dict[str, Any] = {"fastmath": True, "error_model": "numpy", "boundscheck": False, "nogil": True, "cache": True}


def _sine(angle: Any) -> Any:
    """Sin x for x in [0, π/2]."""
    z = angle * angle
    return angle * (S1 + z * (S3 + z * (S5 + z * (S7 + z * S9))))


def _hyperbolic_tangent(value: Any) -> Any:
    """Tanh x for x >= 0."""
    x = min(value, LARGEST)
    z = x * x
    return x * (P0 + z * (P1 + z * (P2 + z * (P3 + z * P4)))) / (ONE + z * (Q1 + z * (Q2 + z * (Q3 + z * Q4))))


sine: Any = numba.njit(inline="always", **OPTIONS)(_sine)
hyperbolic_tangent: Any = numba.njit(inline="always", **OPTIONS)(_hyperbolic_tangent)


def _piece(own: Any, fractions: Any, weights: Any, sines: Any) -> None:
    """Both integrands over one piece of a half-stroke of `LANES` strokes: rows 4 and 5 of `own` from rows 0 to 3."""
    nodes = len(fractions)
    rest, shape, scale, span, lift, power = own[0], own[1], own[2], own[3], own[4], own[5]
    for k in range(nodes):
        place, at = fractions[k], sines[k]
        for i in range(LANES):
            angle = span[i] * place
            at[i] = sine(min(angle, PI - angle))  # cos ωt, and read backwards sin(ωt + δ)
    for i in range(LANES):
        lift[i] = np.float32(0)
        power[i] = np.float32(0)
    for k in range(nodes):
        weight, ahead, behind = weights[k], sines[k], sines[nodes - 1 - k]
        for i in range(LANES):
            speed = ahead[i] / math.sqrt(rest[i] + ahead[i] * ahead[i])  # φ̇ of (2.1), but for a factor
            pitch = scale[i] * hyperbolic_tangent(shape[i] * behind[i])  # (2.2)
            normal = speed * sine(RIGHT_ANGLE - pitch)  # |φ̇| sin α
            lift[i] += weight * (normal * speed * sine(pitch))
            power[i] += weight * (normal * normal * speed)


piece: Any = numba.njit(inline="always", **OPTIONS)(_piece)


def _half_beats(
    length: Any,
    roundness: Any,
    pitch_shape: Any,
    pitch_scale: Any,
    fractions: Any,
    weights: Any,
    lift: Any,
    power: Any,
) -> None:
    """Both integrands over both pieces of a half-stroke, of strokes in groups of `LANES`."""
    rows = len(roundness)
    sines = np.empty((len(fractions), LANES), np.float32)
    own = np.ones((6, LANES), np.float32)  # what the strokes of a group need, side by side
    for start in range(0, rows, LANES):
        count = min(LANES, rows - start)
        for i in range(count):
            own[0, i], own[1, i], own[2, i] = roundness[start + i], pitch_shape[start + i], pitch_scale[start + i]
        for half in range(2):
            for i in range(count):
                own[3, i] = length[half, start + i]
            piece(own, fractions, weights, sines)
            for i in range(count):
                lift[half, start + i] = own[4, i]
                power[half, start + i] = own[5, i]


half_beats: Any = numba.njit(**OPTIONS)(_half_beats)


def compiled_averages(
    flap_shape: np.ndarray,
    pitch_amplitude: np.ndarray,
    pitch_shape: np.ndarray,
    pitch_phase: np.ndarray,
    *,
    fractions: np.ndarray,
    weights: np.ndarray,
) -> tuple[np.ndarray, np.ndarray]:
    """As `flapenv.aero.plate_averages.plate_averages`, to single precision; arguments and returns are its own."""
    flap_shape, pitch_amplitude, pitch_shape, phase = (
        np.ascontiguousarray(value, dtype=np.float32)
        for value in (flap_shape, pitch_amplitude, pitch_shape, pitch_phase)
    )
    flap_shape, pitch_shape = np.maximum(flap_shape, SMALLEST_SHAPE), np.maximum(pitch_shape, SMALLEST_SHAPE)
    half_turns = np.round(phase / math.pi)
    length = np.empty((2, len(phase)), np.float32)
    length[0] = half_turns * math.pi - phase + math.pi / 2  # from stroke to pitch reversal
    length[1] = math.pi - length[0]
    roundness = np.maximum((1 - flap_shape) * (1 + flap_shape) / (flap_shape * flap_shape), 1e-36)
    lift, power = np.empty_like(length), np.empty_like(length)
    scale = pitch_amplitude / np.tanh(pitch_shape)
    half_beats(
        length, roundness, pitch_shape, scale, fractions.astype(np.float32), weights.astype(np.float32), lift, power
    )
    share = length / math.pi
    speed = math.pi / 2 / np.arcsin(flap_shape)
    sense = 1 - 2 * (half_turns % 2)  # sign of θ after its reversal
    lift *= share
    power *= share
    both = 2 * speed * speed * sense * (lift[1] - lift[0]), speed * speed * speed * (power[0] + power[1])
    return both[0].astype(pitch_phase.dtype, copy=False), both[1].astype(pitch_phase.dtype, copy=False)
