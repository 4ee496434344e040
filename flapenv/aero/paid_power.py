"""Power of a wing whose muscles store nothing: the positive part of aerodynamic, added-mass and inertial power.

The two latter are the rate of an energy that the wing carries, here of one wing,

    E = ½ (I_r + I_ξ sin² θ) φ̇² + ½ I_ξ θ̇² - I_rξ cos θ φ̇ θ̇ + ½ M (φ̇ cos θ)²,    M = (πρ/4) ∫c² r² dr      (2.16)

so that their mean is zero over any cycle; they count because only ⟨max(0, P)⟩ is paid. Both half-strokes mirror each
other, and the power repeats twice a beat.
"""

import math
from typing import Any

from flapenv.aero.arrays import Real, as_arrays, as_like
from flapenv.aero.force_laws import ForceLaw
from flapenv.aero.quadrature import graded_rule
from flapenv.aero.stroke import flap_bend, flap_speed, pitch_bend, pitch_speed, pitch_waveform
from flapenv.aero.wingbeat import TimeRule

NODE_FACTOR = 9
"""Nodes for each one that the smooth averages need: where the power changes sign the integrand has corners."""
SMALLEST_POWER = 1e-30
"""Stands in for zero where a power divides [W/kg]."""


def positive_power(
    law: ForceLaw,
    aerodynamic: Real,
    inertia: Real,
    *,
    frequency: Real,
    flap_amplitude: Real,
    flap_shape: Real,
    pitch_amplitude: Real,
    pitch_shape: Real,
    pitch_phase: Real,
    rule: TimeRule,
) -> Real:
    """⟨max(0, A |φ̇|³ C_D + Ė)⟩ over the cycle, in the unit that A and E give [W/kg, for instance].

    Args:
        law: C_D; constants of shape (...).
        aerodynamic: A, what multiplies |φ̇|³ C_D, shape (...).
        inertia: I_r, I_rξ, I_ξ and M of E along the last axis, in the same unit as A times the square of a second,
            shape (..., 4).
        frequency: f [Hz], shape (...).
        flap_amplitude: φmax [rad].
        flap_shape: Cφ < 1 [-].
        pitch_amplitude: θmax [rad].
        pitch_shape: Cθ [-].
        pitch_phase: δ [rad].
        rule: of a piece of the half-stroke for smooth averages, from `time_rule`.

    Returns:
        The mean, shape (...).
    """
    constants = law.constants
    fields: Any = aerodynamic, inertia, frequency, flap_amplitude, flap_shape, pitch_amplitude, pitch_shape, pitch_phase
    xp, *fields, pitch_phase = as_arrays(*fields[:-1], *constants.values(), fields[-1])
    aerodynamic, inertia, frequency, flap_amplitude, flap_shape, pitch_amplitude, pitch_shape, *own = fields
    spread = (value[..., None] if value.ndim else value for value in own)
    law = law.with_constants(dict(zip(constants, spread, strict=True)))
    aerodynamic, frequency, flap_amplitude, flap_shape, pitch_amplitude, pitch_shape = (
        value[..., None] for value in (aerodynamic, frequency, flap_amplitude, flap_shape, pitch_amplitude, pitch_shape)
    )
    flap_inertia, product, pitch_inertia, added_mass = (inertia[..., i, None] for i in range(4))
    omega = 2 * math.pi * frequency
    fractions, weights = as_like(pitch_phase, *graded_rule(NODE_FACTOR * rule.nodes))
    half_turns = xp.round(pitch_phase / math.pi)
    sense = (1 - 2 * (half_turns % 2))[..., None]
    before = (half_turns * math.pi - pitch_phase + math.pi / 2)[..., None]  # from stroke to pitch reversal
    paid = 0.0
    for length, side in ((before, -1.0), (math.pi - before, 1.0)):
        from_reversal, from_vertical = length * fractions, length * (1 - fractions)
        # φ from the stroke reversal that the piece begins or ends at; forward half-stroke
        sin_phase, cos_phase = side * xp.cos(from_reversal), xp.sin(from_reversal)
        sin_pitch, cos_pitch = side * sense * xp.sin(from_vertical), sense * xp.cos(from_vertical)
        flap_rate = omega * flap_amplitude * flap_speed(cos_phase, flap_shape)
        flap_acceleration = omega**2 * flap_amplitude * flap_bend(sin_phase, cos_phase, flap_shape)
        pitch = pitch_amplitude * pitch_waveform(sin_pitch, pitch_shape)
        pitch_rate = omega * pitch_amplitude * pitch_speed(sin_pitch, cos_pitch, pitch_shape)
        pitch_acceleration = omega**2 * pitch_amplitude * pitch_bend(sin_pitch, cos_pitch, pitch_shape)
        sine, cosine = xp.sin(pitch), xp.cos(pitch)
        turn = pitch_rate * flap_rate * sine
        change = (
            (flap_inertia + pitch_inertia * sine**2) * flap_rate * flap_acceleration
            + pitch_inertia * cosine * turn * flap_rate
            + pitch_inertia * pitch_rate * pitch_acceleration
            - product * (cosine * (flap_acceleration * pitch_rate + flap_rate * pitch_acceleration) - turn * pitch_rate)
            + added_mass * flap_rate * cosine * (flap_acceleration * cosine - turn)
        )
        power = aerodynamic * flap_rate**3 * law.drag(xp.abs(cosine), xp.abs(sine)) + change
        paid = paid + length[..., 0] / math.pi * _positive_mean(power, fractions, weights)
    return paid


def _positive_mean(power: Real, fractions: Real, weights: Real) -> Real:
    """∫₀¹ max(0, P) ds from values at the nodes of a smooth rule, shape (..., nodes).

    Where P changes sign between two nodes a Gauss rule, locally even with gap h, meets a kink of slope p at distances a
    and b from them, and finds p (ab - h²/6)/2 too much (Euler and Maclaurin). With P straight between the nodes that is
    h (|P₁ P₂|/(|P₁| + |P₂|) - (|P₁| + |P₂|)/6)/2, which is taken off.
    """
    xp, power, fractions, weights = as_arrays(power, fractions, weights)
    first, second = power[..., :-1], power[..., 1:]
    product, spread = first * second, xp.clip(xp.abs(first) + xp.abs(second), SMALLEST_POWER, None)
    excess = xp.where(product < 0, -product / spread - spread / 6, 0 * spread)
    return xp.clip(power, 0, None) @ weights - excess @ (fractions[1:] - fractions[:-1]) / 2
