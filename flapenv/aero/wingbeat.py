"""The fast path: cycle averages by exact span moments and a quadrature in time whose node count follows the stroke.

Both half-strokes mirror each other for every pitch phase, so half a beat is integrated. It is split where the wing
passes the vertical (sin(ωt+δ) = 0); each piece then runs from a stroke reversal to a pitch reversal, and its nodes
crowd towards both ends, where Cφ → 1 and Cθ → ∞ put thin layers. Distances are measured from those ends, so that no
digits are lost there in single precision. Nodes lie mirrored in the piece: the sines of the distances from one end,
read backwards, are those from the other.

Nodes run along the first axis and strokes along the last, in blocks that stay in a core's cache. For arrays and the
paper's force law `plate_averages` does the same without allocating.
"""

import math
from collections.abc import Sequence
from typing import NamedTuple

import numpy as np

from flapenv.aero.accelerators import PlateKernel
from flapenv.aero.arrays import Real, as_arrays, as_like, as_numpy, is_tensor
from flapenv.aero.checks import require_scalar
from flapenv.aero.force_laws import ForceLaw, PlateLaw
from flapenv.aero.plate_averages import plate_averages
from flapenv.aero.quadrature import crowded_rule
from flapenv.aero.stroke import flap_speed, pitch_waveform

THINNEST_LAYER = 1e-7
"""Layers thinner than this [rad] are not resolved, whatever the tolerance: they carry less than their width."""
BLOCK_BYTES = 60_000
"""Size of an array of one block; a dozen of them live at once."""


class TimeRule(NamedTuple):
    """The quadrature of one piece of a half-stroke; `time_rule` chooses it.

    Attributes:
        nodes: how many.
        crowding: how strongly they crowd towards both ends, 0 for not at all.
    """

    nodes: int
    crowding: float

    @property
    def points(self) -> tuple[np.ndarray, np.ndarray]:
        """Nodes in (0, 1), mirrored about the middle, and weights, shape (nodes,) each."""
        return crowded_rule(self.nodes, self.crowding)

    def refined(self, factor: int) -> "TimeRule":
        """The same with so many times the nodes."""
        return TimeRule(factor * self.nodes, self.crowding)


def time_rule(flap_shape: Real, pitch_shape: Real, *, tolerance: float = 1e-9) -> TimeRule:
    """The rule with which both averages come out to a relative error below `tolerance`.

    Nodes grow with the digits wanted and with the logarithm of the sharpest layer w = min(√(1-Cφ²), 1/Cθ, 1); the laws
    of count and crowding are fitted to the measured convergence and held by a test. Layers thinner than a tenth of the
    tolerance are not resolved, as they carry less than it, nor those thinner than `THINNEST_LAYER`; the triangle
    itself, Cφ = 1, has none.

    As θmax → 90° the wing feathers all the way between its reversals, and what lift and power are left come from the
    layers alone: there the errors are relative to v̄² and v̄³, not to the averages themselves. Up to 85° (α_min of 5°)
    they are not.

    Args:
        flap_shape: Cφ, the largest of which counts [-].
        pitch_shape: Cθ, the largest of which counts [-].
        tolerance: relative error of both averages, in [1e-12, 0.1].

    Returns:
        The rule.
    """
    tolerance = require_scalar("tolerance", tolerance, 1e-12, 0.1)
    flap_shape, sharpest_pitch = as_numpy(flap_shape), float(np.max(as_numpy(pitch_shape)))
    sharpest_flap = float(np.max(flap_shape[flap_shape < 1], initial=0.0))
    flap_layer = math.sqrt((1 - sharpest_flap) * (1 + sharpest_flap))
    layer = max(min(flap_layer, 1 / max(sharpest_pitch, 1.0)), tolerance / 10, THINNEST_LAYER)
    digits, decades = -math.log10(tolerance), -math.log10(layer)
    nodes = math.ceil(8 + 1.45 * digits + (1.72 * digits - 0.3) * decades)
    return TimeRule(nodes, 0.43 * math.log(4 / layer))


def speed_averages(
    flap_shape: Real,
    pitch_amplitude: Real,
    pitch_shape: Real,
    pitch_phase: Real,
    *,
    rule: TimeRule,
    law: ForceLaw | None = None,
    kernel: PlateKernel = plate_averages,
) -> tuple[Real, Real]:
    """⟨φ̇|φ̇| sin 2θ⟩/v̄² and ⟨|φ̇|³ cos² θ⟩/v̄³ with v̄ = ⟨|φ̇|⟩ = 4 f φmax: lift and power of the waveform alone.

    With α = 90° - θ sgn φ̇ these are ⟨v² sin 2α⟩/v̄² and ⟨v³ sin² α⟩/v̄³; the triangle with a square pitch gives
    sin 2α and sin² α. With a `law` they are ⟨v² C_L⟩/v̄² and ⟨v³ C_D⟩/v̄³.

    Args:
        flap_shape: Cφ [-], broadcast with the rest, shape (...).
        pitch_amplitude: θmax [rad].
        pitch_shape: Cθ [-].
        pitch_phase: δ [rad].
        rule: of a piece of the half-stroke, from `time_rule`.
        law: force law whose constants broadcast with the rest, or None for sin 2α and sin² α.
        kernel: what computes without a law, for arrays; see `flapenv.aero.accelerators`.

    Returns:
        The lift and the power average [-], shape (...).
    """
    constants = law.constants if law else {}
    xp, *fields = as_arrays(flap_shape, pitch_amplitude, pitch_shape, pitch_phase, *constants.values())
    shape = np.broadcast_shapes(*(field.shape for field in fields))
    rows = [field if field.shape == shape else xp.broadcast_to(field, shape) for field in fields]
    rows = rows if len(shape) == 1 else [row.reshape(-1) for row in rows]
    fractions, weights = as_like(rows[3], *rule.points)
    count = rows[0].shape[0]
    if law is None and not is_tensor(rows[0]):
        lift, power = kernel(*rows, fractions=fractions, weights=weights)
        return lift.reshape(shape), power.reshape(shape)
    block = count if is_tensor(rows[0]) else max(1, BLOCK_BYTES // (2 * rule.nodes * rows[0].itemsize))
    lifts, powers = [], []
    for start in range(0, max(count, 1), max(block, 1)):
        waveform, own = rows[:4], rows[4:]
        if block < count:
            waveform, own = ([row[start : start + block] for row in part] for part in (waveform, own))
        block_law = law and law.with_constants(dict(zip(constants, own, strict=True)))
        lift, power = _block_averages(waveform, (fractions, weights), block_law)
        lifts.append(lift)
        powers.append(power)
    if len(lifts) == 1:
        return lifts[0].reshape(shape), powers[0].reshape(shape)
    return np.concatenate(lifts).reshape(shape), np.concatenate(powers).reshape(shape)


def _block_averages(waveform: Sequence[Real], points: tuple[Real, Real], law: ForceLaw | None) -> tuple[Real, Real]:
    """Both averages of strokes along one axis, shape (rows,)."""
    xp, flap_shape, pitch_amplitude, pitch_shape, pitch_phase = as_arrays(*waveform)
    fractions, weights = points
    half_turns = xp.round(pitch_phase / math.pi)
    sense = 1 - 2 * (half_turns % 2)  # sign of θ after its reversal
    before = half_turns * math.pi - pitch_phase + math.pi / 2  # from stroke to pitch reversal
    length = xp.stack([before, math.pi - before])
    sines = xp.sin(
        length[:, None] * fractions[:, None]
    )  # (pieces, nodes, rows), of the distance from the stroke reversal
    speed = flap_speed(sines, flap_shape, math.pi / 2)
    pitch = pitch_waveform(_backwards(sines), pitch_shape, pitch_amplitude)  # distance from the pitch reversal
    sine, cosine = xp.sin(pitch), xp.cos(pitch)  # cosine and sine of the folded angle of attack
    if law is None:
        normal = speed * cosine
        lift, power = 2 * (normal * sine * speed), normal * normal * speed
    else:
        dynamic = speed * speed
        lift, power = dynamic * law.lift(cosine, sine) * xp.sign(sine), dynamic * speed * law.drag(cosine, sine)
    share = length / math.pi
    lift, power = share * (weights @ lift), share * (weights @ power)
    return sense * (lift[1] - lift[0]), power[0] + power[1]


def _backwards(values: Real) -> Real:
    """Values at the mirrored nodes, which run along the middle axis."""
    return values.flip(1) if is_tensor(values) else values[:, ::-1]


def force_averages(
    law: ForceLaw,
    *,
    flap_shape: Real,
    pitch_amplitude: Real,
    pitch_shape: Real,
    pitch_phase: Real,
    rule: TimeRule,
    kernel: PlateKernel = plate_averages,
) -> tuple[Real, Real, Real]:
    """A scale, and ⟨v² C_L⟩/v̄² and ⟨v³ C_D⟩/(2 v̄³) over it, of any force law.

    The scale is C_T where the force is normal to the chord, which needs no coefficient at the nodes, and 1 elsewhere.

    Args:
        law: the force law; its constants broadcast with the rest, shape (...).
        flap_shape: Cφ [-].
        pitch_amplitude: θmax [rad].
        pitch_shape: Cθ [-].
        pitch_phase: δ [rad].
        rule: of a piece of the half-stroke, from `time_rule`.
        kernel: as in `speed_averages`.

    Returns:
        The scale, the lift and the power average [-], shape (...).
    """
    if isinstance(law, PlateLaw) and law.profile_drag == 0:
        averages = speed_averages(flap_shape, pitch_amplitude, pitch_shape, pitch_phase, rule=rule, kernel=kernel)
        return law.constant, *averages
    lift, power = speed_averages(flap_shape, pitch_amplitude, pitch_shape, pitch_phase, rule=rule, law=law)
    return 1.0, lift, power / 2
