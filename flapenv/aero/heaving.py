"""Cycle averages of a wing whose body rises or sinks: mean vertical force, muscle power, and their slopes by the speed.

A strip of a body that climbs at w through the air moves with V = (φ̇r, w), w upwards, normal to a horizontal stroke
plane. With (2.7) and (2.12) its force is normal to the chord whatever the direction of V,

    dF = -ρ C_T c |V| (V·n̂) n̂ dr,   n̂ = (-cos θ, sin θ),   V·n̂ = -φ̇r cos θ + w sin θ,

which takes one root a strip and no angle. The muscles pay -dF·(V - V_body) = -dF_x φ̇r: what the body gains by rising
is not theirs. As V changes sign with φ̇ in its x-component alone, while θ changes its own, both half-strokes have the
same vertical force and the same power at any steady w, and half a beat is integrated.

In units of v̄ = ⟨|φ̇|⟩ = 4 f φmax, R and μ = w/(v̄R), with u = |φ̇|/v̄, h = √(u² + (μ/r̂)²) = |V|/(v̄r) and sums over strips
of areas ĉ dr̂, H_n = Σ ĉ r̂ⁿ h and K_n = Σ ĉ r̂ⁿ/h:

    lift    A = ⟨u sin θ cos θ H₂ - μ sin² θ H₁⟩           A' = ⟨u sin θ cos θ μ K₀ - sin² θ (H₁ + μ² K₋₁)⟩
    power   B = ⟨u² cos² θ H₃ - μ u sin θ cos θ H₂⟩        B' = ⟨u² cos² θ μ K₁ - u sin θ cos θ (H₂ + μ² K₀)⟩
"""

import math

import numpy as np

from flapenv.aero.checks import record
from flapenv.aero.planform import Planform
from flapenv.aero.quadrature import gauss_rule
from flapenv.aero.stroke import SMALLEST_SHAPE, pitch_waveform
from flapenv.aero.wingbeat import TimeRule

SPAN_NODES = 6
"""Strips of the span: exact at rest, within 1e-4 at a tenth of the tip's speed."""
MANY_STRIPS = 64
"""Strips of a planform that are replaced by fewer with the same moments."""
CHUNK_BYTES = 2**20
"""Of the largest temporary of a chunk of rows: near the cache, and large enough for calls to cost little beside it."""
LEAST_SQUARE = 1e-24
"""Stands in for h² = 0 where 1/h is multiplied by what vanishes with it."""


@record
class SpanRule:
    """Strips that integrate over the span of one wing or of several.

    Attributes:
        radii: r̂ of the strips, shape (..., n) [-].
        speed_weights: ĉ dr̂ r̂ⁿ for n = 1, 2, 3, of H_n; shape (..., 3, n) [-].
        slope_weights: ĉ dr̂ r̂ⁿ for n = -1, 0, 1, of K_n; shape (..., 3, n) [-].
    """

    radii: np.ndarray
    speed_weights: np.ndarray
    slope_weights: np.ndarray


@record
class HeaveAverages:
    """Dimensionless averages over a beat, each of shape (n,) [-].

        mean vertical force   2 ρ C_T c̄ R³ v̄² A,      mean muscle power   2 ρ C_T c̄ R⁴ v̄³ B      (both wings)

    Attributes:
        lift: A; at rest r̂₂² ⟨v² sin 2α⟩/(2 v̄²).
        lift_slope: dA/dμ; at rest -r̂₁ ⟨|φ̇| cos² α⟩/v̄.
        power: B; at rest r̂₃³ ⟨v³ sin² α⟩/v̄³.
        power_slope: dB/dμ.
    """

    lift: np.ndarray
    lift_slope: np.ndarray
    power: np.ndarray
    power_slope: np.ndarray


def span_rule(planform: Planform, count: int = SPAN_NODES) -> SpanRule:
    """Gauss' rule for the chord as weight: Gauss-Jacobi for the beta planform, by Stieltjes' procedure for any other.

    Args:
        planform: of one wing.
        count: strips.
    """
    radii, areas = planform.strips(count)
    if len(radii) != count:
        radii, areas = gauss_rule(*planform.strips(max(MANY_STRIPS, 4 * count)), count)
    speed_weights = areas * radii ** np.arange(1, 4)[:, None]
    return SpanRule(radii=radii, speed_weights=speed_weights, slope_weights=speed_weights / radii**2)


def stack_rules(rules: list[SpanRule], dtype: np.dtype | type = float) -> SpanRule:
    """Rules of several wings with equally many strips as one, the wings along the first axis."""
    fields = {name: [vars(rule)[name] for rule in rules] for name in vars(rules[0])}
    return SpanRule(**{name: np.stack(values).astype(dtype) for name, values in fields.items()})


def heave_averages(
    rule: SpanRule,
    wing: np.ndarray,
    climb: np.ndarray,
    *,
    flap_shape: np.ndarray,
    pitch_amplitude: np.ndarray,
    pitch_shape: np.ndarray,
    pitch_phase: np.ndarray,
    time: TimeRule,
) -> HeaveAverages:
    """Averages of many beats at steady speeds of climb, in chunks of rows that fit the cache.

    Args:
        rule: of the wings, with one leading axis; its type is that of the computation.
        wing: which of them each row has, shape (n,).
        climb: μ = (w_b - w_g)/(v̄R), upwards positive, shape (n,) [-].
        flap_shape: Cφ, shape (n,) [-].
        pitch_amplitude: θmax, shape (n,) [rad].
        pitch_shape: Cθ, shape (n,) [-].
        pitch_phase: δ, shape (n,) [rad].
        time: of a piece of the half-stroke, from `flapenv.aero.wingbeat.time_rule`.

    Returns:
        The averages, shape (n,).

    Source: derived here (module docstring) from Nabawy & Crowther (2014), Part II, (2.7), (2.12).
    """
    dtype = rule.radii.dtype
    columns = [
        np.asarray(value, dtype=dtype) for value in (climb, flap_shape, pitch_amplitude, pitch_shape, pitch_phase)
    ]
    count = len(columns[0])
    size = max(1, CHUNK_BYTES // (2 * time.nodes * rule.radii.shape[-1] * dtype.itemsize))
    out = np.empty((4, count), dtype=dtype)
    scratch = np.empty(
        (min(size, count), rule.radii.shape[-1] + 6, 2 * time.nodes), dtype=dtype
    )  # fresh memory is slow
    for start in range(0, count, size):
        rows = slice(start, start + size)
        own = SpanRule(**{name: value[wing[rows]] for name, value in vars(rule).items()})
        _average(own, *(column[rows] for column in columns), time=time, scratch=scratch, out=out[:, rows])
    return HeaveAverages(lift=out[0], lift_slope=out[1], power=out[2], power_slope=out[3])


def _average(
    rule: SpanRule,
    climb: np.ndarray,
    flap_shape: np.ndarray,
    pitch_amplitude: np.ndarray,
    pitch_shape: np.ndarray,
    pitch_phase: np.ndarray,
    *,
    time: TimeRule,
    scratch: np.ndarray,
    out: np.ndarray,
) -> None:
    """The four averages of a chunk, into `out` of shape (4, n); strips and sums live in `scratch`."""
    square, sine, cosine, weights = _instants(flap_shape, pitch_amplitude, pitch_shape, pitch_phase, time)
    speed = np.sqrt(square)
    normal = np.multiply(sine, weights)  # weighted: sin θ, then u sin θ cos θ and sin² θ
    mixed = normal * cosine
    mixed *= speed
    upright = np.multiply(normal, sine, out=normal)
    along = np.multiply(square, weights, out=speed)
    along *= cosine
    along *= cosine  # weighted u² cos² θ

    relative = climb[:, None] / rule.radii
    sums, h = scratch[: len(climb), :6], scratch[: len(climb), 6:]
    np.add(square[:, None, :], (relative * relative + LEAST_SQUARE)[:, :, None], out=h)
    np.sqrt(h, out=h)
    np.matmul(rule.speed_weights, h, out=sums[:, :3])
    np.reciprocal(h, out=h)
    np.matmul(rule.slope_weights, h, out=sums[:, 3:])
    h1, h2, h3, k_inverse, k0, k1 = np.moveaxis(sums, 1, 0)

    mixed_h2, mixed_k0, upright_h1 = _sum(mixed, h2), _sum(mixed, k0), _sum(upright, h1)
    out[0] = mixed_h2 - climb * upright_h1
    out[1] = climb * mixed_k0 - upright_h1 - climb * climb * _sum(upright, k_inverse)
    out[2] = _sum(along, h3) - climb * mixed_h2
    out[3] = climb * _sum(along, k1) - mixed_h2 - climb * climb * mixed_k0


def _instants(
    flap_shape: np.ndarray,
    pitch_amplitude: np.ndarray,
    pitch_shape: np.ndarray,
    pitch_phase: np.ndarray,
    time: TimeRule,
) -> tuple[np.ndarray, np.ndarray, np.ndarray, np.ndarray]:
    """u², sin θ, cos θ and the weights of the average at the nodes of the forward half-stroke, shape (n, 2 nodes) each.

    The half-stroke is split where the wing passes the vertical, as in `flapenv.aero.wingbeat`.
    """
    fractions, shares = (values.astype(pitch_phase.dtype) for values in time.points)
    nodes = time.nodes
    half_turns = np.round(pitch_phase / math.pi)
    sense = (1 - 2 * (half_turns % 2))[:, None]  # sign of θ after its reversal
    before = (half_turns * math.pi - pitch_phase + math.pi / 2)[:, None]  # from stroke to pitch reversal
    shape = (len(pitch_phase), 2 * nodes)
    flap, pitch, weights = (np.empty(shape, dtype=pitch_phase.dtype) for _ in range(3))
    for piece, length, sign in ((slice(nodes), before, -sense), (slice(nodes, None), math.pi - before, sense)):
        np.sin(length * fractions, out=flap[:, piece])
        np.multiply(flap[:, piece][:, ::-1], sign, out=pitch[:, piece])  # from the vertical: nodes lie mirrored
        np.multiply(length * (1 / math.pi), shares, out=weights[:, piece])
    square = _speed_square(np.multiply(flap, flap, out=flap), np.clip(flap_shape, SMALLEST_SHAPE, None)[:, None])
    theta = pitch_waveform(pitch, pitch_shape[:, None])
    theta *= pitch_amplitude[:, None]
    sine = np.sin(theta)
    return square, sine, np.cos(theta, out=theta), weights


def _speed_square(cosine_square: np.ndarray, shape: np.ndarray) -> np.ndarray:
    """u² = (π/2)² Cφ² cos² ωt/(asin² Cφ (1 - Cφ² sin² ωt)): the square of (2.1)'s rate over its mean, rootless."""
    square = cosine_square * (shape * shape)
    square += (1 - shape) * (1 + shape)
    np.divide(cosine_square, square, out=square)
    square *= (math.pi / 2 * shape / np.arcsin(shape)) ** 2
    return square


def _sum(one: np.ndarray, other: np.ndarray) -> np.ndarray:
    """Sums of products along the nodes."""
    return np.einsum("rt,rt->r", one, other)
