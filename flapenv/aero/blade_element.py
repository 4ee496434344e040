"""The oracle: the paper's blade-element method read plainly, strip by strip and instant by instant.

Every faster path is tested against it. It takes any planar motion, knows nothing of symmetry and uses the formulas in
the paper's own form (angle of attack, lift and drag coefficient), not the ones the fast path simplifies to.
"""

import math
from dataclasses import dataclass

import numpy as np

from flapenv.aero.checks import require_count, require_name, require_real
from flapenv.aero.coefficients import drag_coefficient, lift_coefficient
from flapenv.aero.stroke import Motion, angle_of_attack
from flapenv.aero.wing import Wing

STRIPS, STEPS = 50, 500
"""The paper's resolution (Part II, section 3.3)."""


@dataclass(frozen=True, kw_only=True)
class BladeElementHistory:
    """Angles, forces and power over one wingbeat, each of shape (steps,).

    Attributes:
        phase: ωt at the instants [rad].
        flap_angle: φ [rad].
        flap_rate: φ̇ [rad/s].
        pitch_angle: θ [rad].
        angle_of_attack: α [rad].
        lift: vertical force of the wing pair [N].
        power: aerodynamic power of the wing pair [W].
    """

    phase: np.ndarray
    flap_angle: np.ndarray
    flap_rate: np.ndarray
    pitch_angle: np.ndarray
    angle_of_attack: np.ndarray
    lift: np.ndarray
    power: np.ndarray

    @property
    def mean_lift(self) -> float:
        """Mean over the cycle [N]."""
        return float(np.mean(self.lift))

    @property
    def mean_power(self) -> float:
        """Mean over the cycle, negative power returned ("elastic" accounting) [W]."""
        return float(np.mean(self.power))


def blade_element(
    wing: Wing,
    motion: Motion,
    lift_constant: float,
    *,
    air_density: float,
    strips: int = STRIPS,
    steps: int = STEPS,
    spacing: str = "even",
) -> BladeElementHistory:
    """Sum the translational force over the strips of both wings at each instant  (2.3), (2.4), (2.7), (2.12).

        dL = ½ρ V² C_L c dr,   dD = ½ρ V² C_D c dr,   V = |φ̇| r,   P = ∫ V dD

    Args:
        wing: one wing, scalar fields.
        motion: a `Stroke` with scalar fields, or any motion that answers as `Motion` says.
        lift_constant: C_T [-].
        air_density: ρ [kg/m³].
        strips: strips over the span.
        steps: instants over the cycle, midway between even divisions.
        spacing: "even" strips at mid-strip as in the paper, or "gauss-jacobi" points weighted with the chord, which
            integrate the span exactly from two points up.

    Returns:
        The history over one wingbeat.

    Raises:
        TypeError: for a count that is not a whole number.
        ValueError: for an unknown spacing, a count below one or a number that is not finite and positive.
    """
    require_count("strips", strips)
    require_count("steps", steps)
    require_name("spacing", spacing, ("even", "gauss-jacobi"))
    require_real("lift_constant", lift_constant, 0.0, open_low=True)
    require_real("air_density", air_density, 0.0, open_low=True, unit="kg/m³")

    radius, strip_area = _even_strips(wing, strips) if spacing == "even" else _gauss_jacobi_strips(wing, strips)
    phase = 2 * math.pi * (np.arange(steps) + 0.5) / steps
    flap_rate, pitch = motion.flap_rate(phase), motion.pitch_angle(phase)
    alpha = angle_of_attack(pitch, flap_rate)  # (2.3)
    speed = np.abs(flap_rate)[:, None] * radius
    strip_force = 0.5 * air_density * speed**2 * strip_area  # times C_L or C_D: (2.4)
    lift = strip_force * lift_coefficient(alpha, lift_constant)[:, None]
    drag = strip_force * drag_coefficient(alpha, lift_constant)[:, None]
    return BladeElementHistory(
        phase=phase,
        flap_angle=motion.flap_angle(phase),
        flap_rate=flap_rate,
        pitch_angle=pitch,
        angle_of_attack=alpha,
        lift=2 * np.sum(lift, axis=1),
        power=2 * np.sum(drag * speed, axis=1),
    )


def _even_strips(wing: Wing, strips: int) -> tuple[np.ndarray, np.ndarray]:
    """Radius [m] and area [m²] of equal strips, the chord taken in their middle."""
    r_hat = (np.arange(strips) + 0.5) / strips
    return r_hat * wing.length, wing.chord(r_hat) * wing.length / strips


def _gauss_jacobi_strips(wing: Wing, strips: int) -> tuple[np.ndarray, np.ndarray]:
    """Radius [m] and area [m²] of the Gauss-Jacobi points of the beta planform."""
    from scipy.special import roots_jacobi

    p, q = wing.beta_exponents
    x, weights = roots_jacobi(strips, q - 1, p - 1)
    return (x + 1) / 2 * wing.length, weights / np.sum(weights) * wing.area
