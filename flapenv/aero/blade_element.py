"""The blade element, strip by strip and instant by instant: any wing, any motion, every force term of the paper.

It is built on velocities and normals, not on angles, knows nothing of symmetry or exact moments, and is the oracle that
every faster path is tested against. With V the velocity of a strip through the air, without its spanwise part,

    translational     dF = ½ρ c (|V|² C_L l̂ - C_D |V| V) dr                  (2.4), (2.7), (2.12)
    rotational        dF = -ρ C_rot c² |V| θ̇ n̂ dr, C_rot = π(0.75 - x̂₀)      (2.13)-(2.15), Ω = θ̇
    added-mass        dF = -(πρc²/4) V̇ₙ n̂ dr, Vₙ = V·n̂                      (2.16)
    added-mass-pitch  what (2.16) adds if Vₙ is that of mid-chord, Vₙ + ξθ̇, ξ = (½ - x̂₀)c, and acts there
    inertia           of a flat plate of even surface mass                   `flapenv.aero.inertia`

V is the velocity on the pitching axis, where the first three act. Muscles hold the wing against all of it: with M the
moment about that axis, Q_φ = -∫r dF·ê_φ, Q_θ = -∫dM and the power is Q_φ φ̇ + Q_θ θ̇, which is the work done relative to
the body.

The paper says that added mass gives no net force over symmetric half-strokes. That holds on the pitching axis. At
mid-chord the normal force gains a mean lift ∫(πρc²/4) ξ⟨θ̇² cos θ⟩ dr whatever the phase, positive where mid-chord lies
behind the axis; in potential flow a force along the chord takes it back, which the sharp leading edge of (2.5) does
not carry. So it is a term of its own.
"""

import math
import warnings
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from flapenv.aero.axes import LEFT, RIGHT, flapping_directions, to_stroke_plane
from flapenv.aero.checks import require_count, require_name, require_real, require_scalar, shown
from flapenv.aero.force_laws import ForceLaw
from flapenv.aero.history import TermHistory, WingbeatHistory
from flapenv.aero.inertia import wing_inertia
from flapenv.aero.motions import Kinematics, Motion
from flapenv.aero.quadrature import graded_rule
from flapenv.aero.wing import Wing

STRIPS, STEPS = 50, 500
"""The paper's resolution (Part II, section 3.3)."""
TERMS = ("translational", "rotational", "added-mass", "added-mass-pitch", "inertia")
"""The force terms; the paper's tables hold the first alone."""
SPACINGS = ("even", "gauss", "graded")
LARGEST_CHANGE = 0.25
"""Of the flapping rate or the pitching angle between two instants, that still resolves their derivatives."""
SMALLEST_TURN = 1e-6
"""Range of pitching angles below which nothing turns [rad]."""
BLOCK = 2**18
"""Strips times instants that are computed at once, to bound the memory."""


def rotational_coefficient(pitch_axis: float) -> float:
    """C_rot = π(0.75 - x̂₀) [-]  (2.15).

    Args:
        pitch_axis: x̂₀, the pitching axis behind the leading edge [chords].
    """
    return math.pi * (0.75 - pitch_axis)  # (2.15)


@dataclass(frozen=True, kw_only=True)
class _Strips:
    """Strips of one wing, shape (s,): radius [m], chord [m], area [m²]; and the pitching axis [chords]."""

    radius: np.ndarray
    chord: np.ndarray
    area: np.ndarray
    pitch_axis: float

    @property
    def middle(self) -> np.ndarray:
        """Distance of mid-chord behind the pitching axis [m]."""
        return (0.5 - self.pitch_axis) * self.chord


@dataclass(frozen=True, kw_only=True)
class _Flow:
    """Velocity of the pitching axis through the air, (n, 1) or (n, s), and its rates [m/s], [m/s²]."""

    along: np.ndarray  # V·ê_φ
    along_rate: np.ndarray
    upward: float  # V·ẑ₁, the same along the wing and over the beat
    sine: np.ndarray  # of θ
    cosine: np.ndarray
    pitch_rate: np.ndarray
    pitch_acceleration: np.ndarray

    @property
    def chordwise(self) -> np.ndarray:
        """V·ê_c."""
        return self.along * self.sine + self.upward * self.cosine

    @property
    def normal(self) -> np.ndarray:
        """V·n̂."""
        return -self.along * self.cosine + self.upward * self.sine


def blade_element(
    wing: Wing,
    motion: Motion,
    law: ForceLaw,
    *,
    air_density: float,
    terms: Sequence[str] = ("translational",),
    stroke_plane_angle: float = 0.0,
    body_velocity: Sequence[float] = (0.0, 0.0, 0.0),
    strips: int = STRIPS,
    steps: int = STEPS,
    spacing: str = "even",
) -> WingbeatHistory:
    """Sum every force term over the strips of both wings at each instant of one wingbeat.

    Args:
        wing: one wing, scalar fields.
        motion: a `Stroke` with scalar fields, or any motion that answers as `Motion` says.
        law: C_L and C_D, scalar constants.
        air_density: ρ [kg/m³].
        terms: which of `TERMS` to sum.
        stroke_plane_angle: σ, 0 horizontal, positive where the stroke plane's normal leans forward [rad].
        body_velocity: of the body through the air in earth axes: forward, left, up; shape (3,) [m/s].
        strips: strips over the span.
        steps: instants over the cycle, midway between even divisions.
        spacing: "even" strips at mid-strip as in the paper, or "gauss" points weighted with the chord, which
            for the beta planform integrate the span exactly from two points up where V ∝ r; or "graded" points, crowded
            to both ends, which converge fastest where the chord enters squared: added mass and rotation.

    Returns:
        The history over one wingbeat.

    Raises:
        TypeError: for a count that is not a whole number, or fields that are not single numbers.
        ValueError: for an unknown term or spacing, a number out of range, a wing without mass where inertia is asked
            for, or a triangular stroke where accelerations count.

    Warns:
        UserWarning: where the steps are too few for the terms of rates and accelerations.

    Source: Nabawy & Crowther (2014), Part II, (2.3)-(2.16) and section 3.3.
    """
    require_count("strips", strips)
    require_count("steps", steps)
    require_name("spacing", spacing, SPACINGS)
    if isinstance(terms, str) or not isinstance(terms, Sequence) or not len(terms):
        raise ValueError(f"terms = {shown(terms)} is not allowed; allowed: a list of {', '.join(TERMS)}")
    for term in terms:
        require_name("terms", term, TERMS)
    require_real("air_density", air_density, 0.0, open_low=True, unit="kg/m³")
    angle = require_scalar("stroke_plane_angle", stroke_plane_angle, -math.pi, math.pi, unit="rad")
    velocity = np.asarray(require_real("body_velocity", body_velocity, unit="m/s"))
    if velocity.shape != (3,):
        raise TypeError(f"body_velocity has shape {velocity.shape}; allowed: (3,), forward, left and up [m/s]")

    phase = 2 * math.pi * (np.arange(steps) + 0.5) / steps
    at = Kinematics.of(motion, phase)
    if getattr(motion, "flap_shape", 0.0) == 1 and {"added-mass", "added-mass-pitch", "inertia"} & set(terms):
        raise ValueError(
            "flap_shape = 1 is not allowed with added mass or inertia: a triangle's acceleration is infinite at its "
            "corners; allowed: below 1"
        )
    if set(terms) - {"translational"}:
        _warn_unless_resolved(at)
    body = to_stroke_plane(velocity, angle)
    cut = _cut(wing, strips, spacing)
    density = float(air_density)
    found = {
        term: _inertia(wing, at) if term == "inertia" else _aerodynamic(term, cut, at, law, density, body)
        for term in dict.fromkeys(terms)
    }
    representative = _flow(at, np.array([math.sqrt(wing.moment(2)) * wing.length]), body, RIGHT)
    alpha = np.arctan2(np.abs(representative.normal), representative.chordwise)[:, 0]  # (2.3)
    return WingbeatHistory(phase=phase, kinematics=at, angle_of_attack=alpha, stroke_plane_angle=angle, terms=found)


def _warn_unless_resolved(at: Kinematics) -> None:
    """Say where rates and accelerations are too sharp for the instants they are taken at."""
    swing = np.max(np.abs(np.diff(at.flap_rate, append=at.flap_rate[:1]))) / np.max(np.abs(at.flap_rate))
    turn = np.max(np.abs(np.diff(at.pitch, append=at.pitch[:1]))) / max(np.ptp(at.pitch), SMALLEST_TURN)
    if max(swing, turn) > LARGEST_CHANGE:
        warnings.warn(
            f"steps = {len(at.flap)} do not resolve the motion: between two instants the flapping rate changes by "
            f"{100 * swing:.0f} % of its largest value, the pitching angle by {100 * turn:.0f} % of its range; terms "
            "of rates and accelerations need more steps, or a gentler stroke",
            stacklevel=4,
        )


def _cut(wing: Wing, strips: int, spacing: str) -> _Strips:
    """The wing cut into strips."""
    if spacing == "even":
        r_hat = (np.arange(strips) + 0.5) / strips
        area = wing.chord(r_hat) * wing.length / strips
    elif spacing == "gauss":
        r_hat, shares = wing.shape.strips(strips)
        area = shares * wing.area
    else:
        r_hat, widths = graded_rule(strips)
        area = wing.chord(r_hat) * wing.length * widths
    return _Strips(radius=r_hat * wing.length, chord=wing.chord(r_hat), area=area, pitch_axis=wing.pitch_axis)


def _flow(at: Kinematics, radius: np.ndarray, body: np.ndarray, side: int) -> _Flow:
    """How the strips of one wing move through the air, at all instants of `at`."""
    along, outward = flapping_directions(at.flap, side)
    return _Flow(
        along=at.flap_rate[:, None] * radius + (along @ body)[:, None],
        along_rate=at.flap_acceleration[:, None] * radius - (at.flap_rate * (outward @ body))[:, None],
        upward=float(body[2]),
        sine=np.sin(at.pitch)[:, None],
        cosine=np.cos(at.pitch)[:, None],
        pitch_rate=at.pitch_rate[:, None],
        pitch_acceleration=at.pitch_acceleration[:, None],
    )


def _aerodynamic(
    term: str, cut: _Strips, at: Kinematics, law: ForceLaw, density: float, body: np.ndarray
) -> TermHistory:
    """One aerodynamic term of both wings; the left wing mirrors the right unless the body slips sideways."""
    right = _one_wing(term, cut, at, law, density, body, RIGHT)
    left = right if body[1] == 0 else _one_wing(term, cut, at, law, density, body, LEFT)
    total = np.zeros((len(at.flap), 3))
    for side, (along_force, upward_force, _, _) in ((RIGHT, right), (LEFT, left)):
        along, _ = flapping_directions(at.flap, side)
        total += along_force[:, None] * along
        total[:, 2] += upward_force
    flap_torque, pitch_torque = (-np.stack([right[i], left[i]]) for i in (2, 3))
    return TermHistory(
        force=total,
        tangential_force=np.stack([right[0], left[0]]),
        flap_torque=flap_torque,
        pitch_torque=pitch_torque,
        power=flap_torque * at.flap_rate + pitch_torque * at.pitch_rate,
    )


def _one_wing(
    term: str, cut: _Strips, at: Kinematics, law: ForceLaw, density: float, body: np.ndarray, side: int
) -> tuple[np.ndarray, ...]:
    """Force along ê_φ and ẑ₁ [N] and moments about the flapping and the pitching axis [N m] of one wing's term."""
    blocks = max(1, math.ceil(len(at.flap) * len(cut.radius) / BLOCK))
    parts = []
    for rows in np.array_split(np.arange(len(at.flap)), blocks):
        part = Kinematics(**{name: value[rows] for name, value in vars(at).items()})
        flow = _flow(part, cut.radius, body, side)
        chordwise, normal, moment = _strip_forces(term, cut, flow, law, density)
        along = chordwise * flow.sine - normal * flow.cosine
        upward = chordwise * flow.cosine + normal * flow.sine
        parts.append((along.sum(axis=1), upward.sum(axis=1), along @ cut.radius, moment.sum(axis=1)))
    return tuple(np.concatenate(column) for column in zip(*parts, strict=True))


def _strip_forces(
    term: str, cut: _Strips, flow: _Flow, law: ForceLaw, density: float
) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Forces on every strip along ê_c and n̂ [N] and moments about the pitching axis [N m], shape (n, s) each."""
    none = np.zeros((len(flow.along), len(cut.radius)))
    if term == "translational":
        chordwise, normal = law.strip_force(flow.chordwise, flow.normal)
        return 0.5 * density * cut.area * chordwise, 0.5 * density * cut.area * normal, none  # (2.4)
    if term == "rotational":
        speed = np.hypot(flow.along, flow.upward)
        circulation = rotational_coefficient(cut.pitch_axis) * flow.pitch_rate * cut.chord  # Γ/c  (2.14)
        return none, -density * circulation * speed * cut.area, none  # (2.13)
    mass = math.pi / 4 * density * cut.chord * cut.area
    on_axis = -mass * (
        -flow.along_rate * flow.cosine + (flow.along * flow.sine + flow.upward * flow.cosine) * flow.pitch_rate
    )
    if term == "added-mass":
        return none, on_axis, none  # (2.16)
    behind = -mass * cut.middle * flow.pitch_acceleration
    return none, behind, cut.middle * (on_axis + behind)


def _inertia(wing: Wing, at: Kinematics) -> TermHistory:
    """The wings' own inertia, by exact moments of mass."""
    moments = wing_inertia(wing)
    tangential, flap_torque, pitch_torque = (
        np.stack([value, value])
        for value in (moments.tangential_force(at), moments.flap_torque(at), moments.pitch_torque(at))
    )
    return TermHistory(
        force=moments.pair_force(at),
        tangential_force=tangential,
        flap_torque=flap_torque,
        pitch_torque=pitch_torque,
        power=flap_torque * at.flap_rate + pitch_torque * at.pitch_rate,
    )
