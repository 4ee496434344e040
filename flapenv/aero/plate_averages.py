"""The averages of the paper's force law, written for NumPy alone: no array is allocated while it runs.

What `wingbeat` says in formulas that tensors share is said here once more, step by step into four arrays that are kept.
Fresh arrays of this size cost three times the arithmetic, as the allocator takes their pages from the system anew.
Tests hold both against each other.
"""

import math
import threading

import numpy as np

from flapenv.aero.stroke import SMALLEST_SHAPE

BLOCK_BYTES = 800_000
"""Size of one of the four arrays: above some 200 kB the overhead of the calls is small, and all four stay cached."""

_kept = threading.local()


def plate_averages(
    flap_shape: np.ndarray,
    pitch_amplitude: np.ndarray,
    pitch_shape: np.ndarray,
    pitch_phase: np.ndarray,
    *,
    fractions: np.ndarray,
    weights: np.ndarray,
) -> tuple[np.ndarray, np.ndarray]:
    """⟨φ̇|φ̇| sin 2θ⟩/v̄² and ⟨|φ̇|³ cos² θ⟩/v̄³, as `flapenv.aero.wingbeat.speed_averages` without a law.

    Args:
        flap_shape: Cφ, shape (rows,) [-].
        pitch_amplitude: θmax, shape (rows,) [rad].
        pitch_shape: Cθ, shape (rows,) [-].
        pitch_phase: δ, shape (rows,) [rad].
        fractions: nodes in (0, 1), mirrored about the middle, shape (nodes,).
        weights: there.

    Returns:
        Both averages, shape (rows,), of the arguments' type.
    """
    count, nodes, dtype = len(pitch_phase), len(fractions), pitch_phase.dtype
    block = max(1, min(count, BLOCK_BYTES // (2 * nodes * dtype.itemsize)))
    lift, power = np.empty((2, count), dtype)
    workspace = _workspace(block, nodes, dtype)
    for start in range(0, count, block):
        rows = slice(start, min(start + block, count))
        waveform = flap_shape[rows], pitch_amplitude[rows], pitch_shape[rows], pitch_phase[rows]
        own = workspace[..., : rows.stop - start]
        _block(*waveform, fractions[:, None], weights, own, lift[rows], power[rows])
    return lift, power


def _block(
    flap_shape: np.ndarray,
    pitch_amplitude: np.ndarray,
    pitch_shape: np.ndarray,
    pitch_phase: np.ndarray,
    fractions: np.ndarray,
    weights: np.ndarray,
    workspace: np.ndarray,
    lift: np.ndarray,
    power: np.ndarray,
) -> None:
    """Both averages of one block into `lift` and `power`; workspace (4, pieces, nodes, rows)."""
    flap_shape = np.maximum(flap_shape, SMALLEST_SHAPE)
    pitch_shape = np.maximum(pitch_shape, SMALLEST_SHAPE)
    half_turns = np.round(pitch_phase / math.pi)
    sense = 1 - 2 * (half_turns % 2)  # sign of θ after its reversal
    length = np.empty((2, 1, len(pitch_phase)), pitch_phase.dtype)
    length[0, 0] = half_turns * math.pi - pitch_phase + math.pi / 2  # from stroke to pitch reversal
    length[1, 0] = math.pi - length[0, 0]

    sine, speed, pitch, normal = workspace
    np.sin(np.multiply(length, fractions, out=sine), out=sine)  # cos ωt, and read backwards sin(ωt + δ)
    np.tanh(np.multiply(sine[:, ::-1], pitch_shape, out=pitch), out=pitch)
    np.multiply(pitch, pitch_amplitude / np.tanh(pitch_shape), out=pitch)  # (2.2)
    np.multiply(sine, sine, out=speed)
    np.add(speed, np.maximum((1 - flap_shape) * (1 + flap_shape) / (flap_shape * flap_shape), 1e-36), out=speed)
    np.divide(sine, np.sqrt(speed, out=speed), out=speed)  # φ̇ of (2.1), but for a factor

    np.multiply(np.cos(pitch, out=normal), speed, out=normal)  # |φ̇| sin α
    np.multiply(np.sin(pitch, out=sine), speed, out=sine)  # |φ̇| cos α
    share = length[:, 0] / math.pi
    np.multiply(sine, normal, out=sine)
    lifts = share * (weights @ sine)
    np.multiply(np.multiply(normal, normal, out=normal), speed, out=normal)
    powers = share * (weights @ normal)
    scale = math.pi / 2 / np.arcsin(flap_shape)
    np.multiply(2 * scale * scale * sense, lifts[1] - lifts[0], out=lift)
    np.multiply(scale * scale * scale, powers[0] + powers[1], out=power)


def _workspace(block: int, nodes: int, dtype: np.dtype) -> np.ndarray:
    """Four arrays (pieces, nodes, block) that this thread keeps, grown where they are too small."""
    size = 4 * 2 * nodes * block
    kept: np.ndarray | None = getattr(_kept, dtype.name, None)
    if kept is None or kept.size < size:
        kept = np.empty(size, dtype)
        setattr(_kept, dtype.name, kept)
    return kept[:size].reshape(4, 2, nodes, block)
