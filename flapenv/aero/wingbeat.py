"""The fast path: cycle averages by exact span moments and a quadrature in time whose node count follows the stroke.

Both half-strokes mirror each other for every pitch phase, so half a beat is integrated. It is split where the wing
passes the vertical (sin(ωt+δ) = 0); each piece then runs from a stroke reversal to a pitch reversal, and its nodes
crowd towards both ends, where Cφ → 1 and Cθ → ∞ put thin layers. Distances are measured from those ends, so that no
digits are lost there in single precision.
"""

import math

import numpy as np

from flapenv.aero.arrays import Real, as_arrays, as_like, as_numpy
from flapenv.aero.checks import require_scalar
from flapenv.aero.force_laws import ForceLaw, PlateLaw
from flapenv.aero.quadrature import graded_rule
from flapenv.aero.stroke import flap_speed, pitch_waveform

THINNEST_LAYER = 1e-7
"""Layers thinner than this [rad] are not resolved, whatever the tolerance: they carry less than their width."""


def time_nodes(flap_shape: Real, pitch_shape: Real, *, tolerance: float = 1e-9) -> int:
    """Nodes per piece of a half-stroke for a relative error of the averages below `tolerance`.

    Grows with the digits wanted and, slowly, with the sharpest layer w = min(√(1-Cφ²), 1/Cθ, 1): n ∝ w^(-0.21), fitted
    to the measured convergence and held by a test. Layers thinner than the tolerance carry less than it and are not
    resolved, nor are those thinner than `THINNEST_LAYER`; the triangle itself, Cφ = 1, has none.

    As θmax → 90° the wing feathers all the way between its reversals, and what power is left comes from the layers
    alone: there the error of the power is relative to v̄³, not to the power itself. Up to 85° (α_min of 5°) it is not.

    Args:
        flap_shape: Cφ, the largest of which counts [-].
        pitch_shape: Cθ, the largest of which counts [-].
        tolerance: relative error of both averages, in [1e-12, 0.1].

    Returns:
        The node count.
    """
    tolerance = require_scalar("tolerance", tolerance, 1e-12, 0.1)
    flap_shape, sharpest_pitch = as_numpy(flap_shape), float(np.max(as_numpy(pitch_shape)))
    sharpest_flap = float(np.max(flap_shape[flap_shape < 1], initial=0.0))
    flap_layer = math.sqrt((1 - sharpest_flap) * (1 + sharpest_flap))
    layer = max(min(flap_layer, 1 / max(sharpest_pitch, 1.0)), tolerance, THINNEST_LAYER)
    return math.ceil(21 * layer**-0.21 * -math.log10(tolerance) / 6)


def speed_averages(
    flap_shape: Real,
    pitch_amplitude: Real,
    pitch_shape: Real,
    pitch_phase: Real,
    *,
    nodes: int,
    law: ForceLaw | None = None,
) -> tuple[Real, Real]:
    """⟨φ̇|φ̇| sin 2θ⟩/v̄² and ⟨|φ̇|³ cos² θ⟩/v̄³ with v̄ = ⟨|φ̇|⟩ = 4 f φmax: lift and power of the waveform alone.

    With α = 90° - θ sgn φ̇ these are ⟨v² sin 2α⟩/v̄² and ⟨v³ sin² α⟩/v̄³; the triangle with a square pitch gives
    sin 2α and sin² α. With a `law` they are ⟨v² C_L⟩/v̄² and ⟨v³ C_D⟩/v̄³.

    Args:
        flap_shape: Cφ [-], broadcast with the rest, shape (...).
        pitch_amplitude: θmax [rad].
        pitch_shape: Cθ [-].
        pitch_phase: δ [rad].
        nodes: per piece of the half-stroke, from `time_nodes`.
        law: force law whose constants broadcast with the rest, or None for sin 2α and sin² α.

    Returns:
        The lift and the power average [-], shape (...).
    """
    constants = list(law.constants.values()) if law else []
    xp, flap_shape, pitch_amplitude, pitch_shape, pitch_phase, *constants = as_arrays(
        flap_shape, pitch_amplitude, pitch_shape, pitch_phase, *constants
    )
    law = law and law.along_nodes(constants)
    flap_shape, pitch_amplitude, pitch_shape = (
        value[..., None] for value in (flap_shape, pitch_amplitude, pitch_shape)
    )
    fractions, weights = as_like(pitch_phase, *graded_rule(nodes))
    half_turns = xp.round(pitch_phase / math.pi)
    sense = (1 - 2 * (half_turns % 2))[..., None]  # sign of θ after its reversal
    before = (half_turns * math.pi - pitch_phase + math.pi / 2)[..., None]  # from stroke to pitch reversal
    lift = power = 0.0
    for length, sign in ((before, -sense), (math.pi - before, sense)):
        speed = flap_speed(xp.sin(length * fractions), flap_shape) * (math.pi / 2)
        pitch = pitch_amplitude * pitch_waveform(xp.sin(length * (1 - fractions)), pitch_shape)
        share = length[..., 0] / math.pi
        sine, cosine = xp.sin(pitch), xp.cos(pitch)  # cosine and sine of the folded angle of attack
        dynamic = speed * speed
        if law is None:
            lift = lift + share * sign[..., 0] * ((dynamic * sine * cosine) @ (2 * weights))
            power = power + share * ((dynamic * speed * cosine * cosine) @ weights)
        else:
            lift = lift + share * sign[..., 0] * ((dynamic * law.lift(cosine, sine) * xp.sign(sine)) @ weights)
            power = power + share * ((dynamic * speed * law.drag(cosine, sine)) @ weights)
    return lift, power


def force_averages(
    law: ForceLaw,
    *,
    flap_shape: Real,
    pitch_amplitude: Real,
    pitch_shape: Real,
    pitch_phase: Real,
    nodes: int,
) -> tuple[Real, Real, Real]:
    """A scale, and ⟨v² C_L⟩/v̄² and ⟨v³ C_D⟩/(2 v̄³) over it, of any force law.

    The scale is C_T where the force is normal to the chord, which needs no coefficient at the nodes, and 1 elsewhere.

    Args:
        law: the force law; its constants broadcast with the rest, shape (...).
        flap_shape: Cφ [-].
        pitch_amplitude: θmax [rad].
        pitch_shape: Cθ [-].
        pitch_phase: δ [rad].
        nodes: per piece of the half-stroke, from `time_nodes`.

    Returns:
        The scale, the lift and the power average [-], shape (...).
    """
    if isinstance(law, PlateLaw) and law.profile_drag == 0:
        averages = speed_averages(flap_shape, pitch_amplitude, pitch_shape, pitch_phase, nodes=nodes)
        return law.constant, *averages
    lift, power = speed_averages(flap_shape, pitch_amplitude, pitch_shape, pitch_phase, nodes=nodes, law=law)
    return 1.0, lift, power / 2
