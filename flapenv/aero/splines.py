"""Free waveforms of a wingbeat as periodic cubic B-splines, and their cycle averages.

With n knots a half-cycle and x running from 0 to n over it,

    φ̇ ∝ σ(x) = Σ w_j B(x - j - ½),   θ(x) = Σ θ_j B(x - j - ½),   w_{j+n} = -w_j,  θ_{j+n} = -θ_j,

B the cardinal cubic B-spline: both half-strokes mirror each other. Speed coefficients w_j > 0 change sign twice a
cycle, and a spline changes sign no more often than its coefficients (variation diminution), so the wing reverses once
at each end of the stroke, near x = 0. θ lies in the convex hull of ±θ_j, so |θ| <= max |θ_j|.

Two things keep the averages fast and exact. Each half-cycle is integrated from x = 0 to n, as if the wing reversed
there, and what lies between 0 and the reversal r is put right afterwards: of φ̇, |φ̇|φ̇ sin 2θ and |φ̇|³ cos² θ alike
twice the integral from 0 to r is subtracted. And because the integrands vanish at r, no average has a slope by r: r
counts as a constant to differentiation, and an error in it enters squared.
"""

import functools
import math
from typing import NamedTuple

import numpy as np

from flapenv.aero.arrays import Real, as_arrays, as_like, is_tensor

FEWEST_KNOTS = 4
"""Knots a half-cycle, at least."""
POINTS = 7
"""Gauss points a knot interval: the wildest coefficients come out to 1e-5, the best waveforms to 3e-8."""
REACH = 1.5
"""The reversal lies in |x| < REACH knots, where three positive coefficients meet three negative ones."""
NEWTON_STEPS = {4: 5, 8: 8}
"""Of the search for the reversal, by the bytes of a number: the worst of a million draws to 1e-9 and to rounding."""
SLACK = 0.1
"""Newton's rule may leave the bracket by this share of its width before the bracket is halved instead."""
CHUNK_BYTES, BLOCK_ROWS = 96_000, 2048
"""Of a temporary array over the nodes, so that it stays in the cache; rows whose reversals are sought together."""


class SplineAverages(NamedTuple):
    """What a waveform contributes to the forces on any wing, each of shape (...).

    Attributes:
        lift: L = ⟨φ̇|φ̇| sin 2θ⟩/v̄² [-], v̄ = ⟨|φ̇|⟩.
        power: S = ⟨|φ̇|³ cos² θ⟩/v̄³ [-].
        friction: K = ⟨|φ̇|³⟩/v̄³ [-], what profile drag is paid by.
        half_cycle: ∫|σ|dx over a half-cycle [knots], which is what scales φ to its amplitude.
    """

    lift: Real
    power: Real
    friction: Real
    half_cycle: Real


class SplineTables(NamedTuple):
    """Matrices that turn coefficients (..., n) into what the averages need; all in double precision.

    Attributes:
        points: Gauss points a knot interval.
        nodes: x of the quadrature [knots], shape (m,).
        weights: of the quadrature, summing to n, shape (m,).
        basis: values at the nodes, shape (n, m).
        near: pieces around x = 0, a₀, a₁, a₂, a₃, e₊, e₋ of a₀ + a₁x + a₂x² + a₃x³ + e₊(x-½)₊³ + e₋(-½-x)₊³ for
            |x| <= 3/2, shape (6, n).
        total: integral over x from 0 to n, shape (n,).
    """

    points: int
    nodes: np.ndarray
    weights: np.ndarray
    basis: np.ndarray
    near: np.ndarray
    total: np.ndarray


def bspline(x: np.ndarray, order: int = 0) -> np.ndarray:
    """The cardinal cubic B-spline B(x) [-], 0 for |x| >= 2, or a derivative; its integral from -2 for order -1."""
    degree = 3 - order
    left = np.clip(x, -2, 2)[..., None] + 2 - np.arange(4)
    powers = np.where(left > 0, left, 0.0) ** degree
    return powers @ np.array([1, -4, 6, -4]) / math.factorial(degree)


def half_cycle_basis(x: np.ndarray, knots: int, order: int = 0) -> np.ndarray:
    """The n antiperiodic basis functions at x in [-n, n], or their derivatives, shape (n, len(x)).

    Their integrals, order -1, are from a place left of -n + ½ that is the same for all x.
    """
    centres = np.arange(knots)[:, None] + 0.5
    return np.sum([(-1) ** turn * bspline(x - centres - turn * knots, order) for turn in (-2, -1, 0, 1)], axis=0)


@functools.lru_cache(maxsize=64)
def spline_tables(knots: int, points: int = POINTS) -> SplineTables:
    """The matrices for n knots a half-cycle; intervals end at x = 0, ½, 1½, ..., n - ½, n."""
    edges = np.concatenate([[0.0], np.arange(knots) + 0.5, [float(knots)]])
    place, share = np.polynomial.legendre.leggauss(points)
    widths = np.diff(edges)[:, None]
    nodes = (edges[:-1, None] + widths * (place + 1) / 2).ravel()
    weights = (widths * share / 2).ravel()
    basis = half_cycle_basis(nodes, knots)
    return SplineTables(points, nodes, weights, basis, near=_near(knots), total=basis @ weights)


def _near(knots: int) -> np.ndarray:
    """`SplineTables.near`."""
    steps = np.array([1, -4, 6, -4, 1]) / 6
    local = np.zeros((6, 6))  # of the coefficients at x = -2½, ..., 2½
    local[1:5, :4] = np.array(
        [
            [1 / 48, -1 / 8, 1 / 4, -1 / 6],
            [23 / 48, -5 / 8, -1 / 4, 1 / 2],
            [23 / 48, 5 / 8, -1 / 4, -1 / 2],
            [1 / 48, 1 / 8, 1 / 4, 1 / 6],
        ]
    )
    local[1:6, 4], local[0:5, 5] = steps, steps
    pieces = np.zeros((knots, 6))
    for row, j in zip(local, range(-3, 3), strict=True):
        pieces[j % knots] += row if j >= 0 else -row
    return np.ascontiguousarray(pieces.T)


def spline_averages(speed: Real, pitch: Real, *, friction: bool = True, points: int = POINTS) -> SplineAverages:
    """L, S and K of spline waveforms.

    Args:
        speed: w, > 0, of any scale, shape (..., n); arrays, or tensors, which keep their (first) gradient.
        pitch: θ coefficients [rad], shape (..., n).
        friction: whether K is wanted; 0 where not.
        points: Gauss points a knot interval.

    Returns:
        The averages, shape (...) each.
    """
    xp, speed, pitch = as_arrays(speed, pitch)
    speed, pitch = xp.broadcast_tensors(speed, pitch) if is_tensor(speed) else np.broadcast_arrays(speed, pitch)
    shape, knots = speed.shape[:-1], speed.shape[-1]
    speed, pitch = speed.reshape(-1, knots), pitch.reshape(-1, knots)
    tables = spline_tables(knots, points)
    averages: tuple[Real, ...]
    if is_tensor(speed):
        averages = _averages(speed, pitch, tables, len(speed), friction=friction)
    else:
        rows = max(1, CHUNK_BYTES // (tables.nodes.size * speed.itemsize))
        blocks = range(0, max(1, len(speed)), BLOCK_ROWS)
        parts = [
            _averages(speed[i : i + BLOCK_ROWS], pitch[i : i + BLOCK_ROWS], tables, rows, friction=friction)
            for i in blocks
        ]
        averages = parts[0] if len(parts) == 1 else tuple(np.concatenate(part) for part in zip(*parts, strict=True))
    return SplineAverages(*(value.reshape(shape) for value in averages))


def _averages(
    speed: Real, pitch: Real, tables: SplineTables, rows: int, *, friction: bool
) -> tuple[Real, Real, Real, Real]:
    """`spline_averages` of coefficients (block, n), which asks for the whole integrals of some rows at a time."""
    knots = speed.shape[-1]
    (near,) = as_like(speed, tables.near)
    flap, turn = near @ speed.T, near @ pitch.T
    reversal = find_reversal(flap)
    half_cycle = _half_cycle(speed, flap, reversal)
    wrong = _up_to(flap, turn, reversal, tables.points)
    starts = range(0, len(speed), rows) if rows < len(speed) else (0,)
    parts: list[tuple[Real, ...]] = [
        _whole(speed[i : i + rows], pitch[i : i + rows], tables, friction=friction) for i in starts
    ]
    whole = parts[0] if len(parts) == 1 else tuple(np.concatenate(part) for part in zip(*parts, strict=True))
    inverse = knots / half_cycle
    square = inverse * inverse / knots
    lift, power, cube = (total - 2 * part for total, part in zip(whole, wrong, strict=True))
    return lift * square, power * (square * inverse), cube * (square * inverse) if friction else 0 * cube, half_cycle


def half_cycle_integral(speed: Real) -> Real:
    """`SplineAverages.half_cycle` of speed coefficients (..., n), shape (...)."""
    _, speed = as_arrays(speed)
    rows = speed.reshape(-1, speed.shape[-1])
    flap = as_like(rows, spline_tables(speed.shape[-1]).near)[0] @ rows.T
    return _half_cycle(rows, flap, find_reversal(flap)).reshape(speed.shape[:-1])


def _half_cycle(speed: Real, flap: Real, reversal: Real) -> Real:
    """∫|σ|dx from one reversal to the next, shape (rows,)."""
    return speed @ as_like(speed, spline_tables(speed.shape[-1]).total)[0] - 2 * near_integral(flap, reversal)


def _whole(speed: Real, pitch: Real, tables: SplineTables, *, friction: bool) -> tuple[Real, Real, Real]:
    """∫σ² sin 2θ dx, ∫σ³ cos² θ dx and ∫σ³ dx from 0 to n, shape (rows,)."""
    xp, speed, pitch = as_arrays(speed, pitch)
    basis, weights = as_like(speed, tables.basis, tables.weights)
    sigma, theta = speed @ basis, pitch @ basis
    along = sigma * xp.cos(theta)
    product = sigma * along
    lift, power = (product * xp.sin(theta)) @ (2 * weights), (product * along) @ weights
    return lift, power, (sigma * sigma * sigma) @ weights if friction else power


def _up_to(flap: Real, turn: Real, reversal: Real, points: int) -> tuple[Real, Real, Real]:
    """The integrals of `_whole` from 0 to the reversal, in two pieces where a knot lies between, shape (rows,)."""
    xp, flap, turn, reversal = as_arrays(flap, turn, reversal)
    place, share = np.polynomial.legendre.leggauss((points + 3) // 2)  # short pieces, where σ is small
    fractions, weights = as_like(flap, (place + 1) / 2, share / 2)
    knot = xp.clip(reversal, -0.5, 0.5)
    pieces = knot, reversal - knot
    x = xp.concatenate([fractions[:, None] * knot, knot + fractions[:, None] * pieces[1]])
    sigma, theta = near_value(flap[:, None], x), near_value(turn[:, None], x)
    along = sigma * xp.cos(theta)
    product = sigma * along
    weighed = xp.concatenate([weights[:, None] * piece for piece in pieces])
    parts = 2 * product * xp.sin(theta), product * along, sigma * sigma * sigma
    lift, power, cube = (xp.sum(weighed * part, axis=0) for part in parts)
    return lift, power, cube


def near_value(pieces: Real, x: Real) -> Real:
    """A spline at |x| <= `REACH`, from the pieces of `SplineTables.near` along the first axis."""
    xp, pieces, x = as_arrays(pieces, x)
    a0, a1, a2, a3, after, before = pieces
    right, left = xp.clip(x - 0.5, 0, None), xp.clip(-0.5 - x, 0, None)
    return ((a3 * x + a2) * x + a1) * x + a0 + after * (right * right * right) + before * (left * left * left)


def near_integral(pieces: Real, x: Real) -> Real:
    """Integral of `near_value` from 0 to x."""
    xp, pieces, x = as_arrays(pieces, x)
    a0, a1, a2, a3, after, before = pieces
    right, left = xp.clip(x - 0.5, 0, None) ** 2, xp.clip(-0.5 - x, 0, None) ** 2
    return (((a3 / 4 * x + a2 / 3) * x + a1 / 2) * x + a0) * x + (after * right * right - before * left * left) / 4


def find_reversal(flap: Real) -> Real:
    """Where σ passes zero upwards [knots], by Newton's rule on its cubic, kept within the bracket.

    Args:
        flap: pieces of σ around x = 0 from `SplineTables.near`, shape (6, rows).

    Returns:
        x of the reversal, in (-`REACH`, `REACH`), shape (rows,), a constant to differentiation.
    """
    pieces = np.asarray(flap.detach().cpu().numpy() if is_tensor(flap) else flap)
    a0, a1, a2, a3, after, before = pieces
    right = near_value(pieces, np.float32(0.5)) <= 0
    left = near_value(pieces, np.float32(-0.5)) > 0
    jump = np.where(right, after, np.where(left, before, 0))
    turned = np.where(left, -jump, jump)
    a0, a1, a2, a3 = a0 - jump / 8, a1 + 0.75 * turned, a2 - 1.5 * jump, a3 + turned  # the cubic of that interval
    low = np.where(right, 0.5, np.where(left, -1.5, -0.5)).astype(pieces.dtype)
    high = low + 1
    x = low + np.float32(0.5)
    for _ in range(NEWTON_STEPS[pieces.itemsize]):
        value = ((a3 * x + a2) * x + a1) * x + a0
        positive = value > 0
        high, low = np.where(positive, x, high), np.where(positive, low, x)
        slope = (3 * a3 * x + 2 * a2) * x + a1
        guess = x - value / np.where(slope == 0, 1, slope)
        inside = np.clip(guess, low, high)
        near = np.abs(guess - inside) <= SLACK * (high - low)  # a root at an end is met from within
        x = np.where(near, inside, (low + high) / 2)
    return as_like(flap, x)[0]


def peak_slope(coefficients: np.ndarray) -> np.ndarray:
    """Largest |dσ/dx| of antiperiodic splines, exactly: it lies at a knot, or between two where σ'' changes sign.

    Args:
        coefficients: shape (..., n).

    Returns:
        Shape (...) [1/knot].
    """
    rows = coefficients.reshape(-1, coefficients.shape[-1]).T
    shift = np.eye(len(rows), k=1, dtype=rows.dtype)  # takes each coefficient to the next one's place
    shift[-1, 0] = -1
    slope, bend = (shift - shift.T) @ rows / 2, (shift + shift.T - 2 * np.eye(len(rows), dtype=rows.dtype)) @ rows
    next_bend = shift @ bend
    turning = bend * next_bend < 0
    inner = slope + bend * bend / (2 * np.where(turning, bend - next_bend, np.inf))
    return np.max(np.maximum(np.abs(slope), np.abs(inner)), axis=0).reshape(coefficients.shape[:-1])


def refined(coefficients: np.ndarray) -> np.ndarray:
    """The same spline on twice the knots, (..., n) to (..., 2n), by Lane and Riesenfeld's subdivision.

    The waveform starts half a fine knot later, which no average sees. The coefficient at the reversal may come out of
    either sign or zero, so that a refined speed may need lifting to the floor: spaces of doubled knots are nested, the
    sets of allowed waveforms are nested but for that.
    """
    before = np.concatenate([-coefficients[..., -1:], coefficients[..., :-1]], axis=-1)
    after = np.concatenate([coefficients[..., 1:], -coefficients[..., :1]], axis=-1)
    own, between = (before + 6 * coefficients + after) / 8, (coefficients + after) / 2
    return np.stack([own, between], axis=-1).reshape(*coefficients.shape[:-1], -1)
