"""The wing's own inertia: moments of mass, the torques that move them, and what the body feels of it.

A wing of even surface mass, a flat plate that turns about its root (φ) and its pitching axis (θ). With ξ the distance
behind that axis, Lagrange's equations of the kinetic energy

    T = ½ (I_r + I_ξ sin² θ) φ̇² + ½ I_ξ θ̇² - I_rξ cos θ φ̇ θ̇

give the torques below; gravity on the wing is left out. Derived here (Part II leaves inertia out, because it cancels
where negative power is stored).
"""

from dataclasses import dataclass

import numpy as np

from flapenv.aero.motions import Kinematics
from flapenv.aero.wing import Wing


@dataclass(frozen=True, kw_only=True)
class WingInertia:
    """Moments of mass of one wing, dm = (m_w/S) dr dξ, exactly.

    Attributes:
        first_radius: ∫r dm [kg m].
        first_chord: ∫ξ dm [kg m].
        radius: I_r = ∫r² dm [kg m²].
        product: I_rξ = ∫r ξ dm [kg m²].
        chord: I_ξ = ∫ξ² dm [kg m²].
    """

    first_radius: float
    first_chord: float
    radius: float
    product: float
    chord: float

    def flap_torque(self, at: Kinematics) -> np.ndarray:
        """Q_φ = (I_r + I_ξ sin² θ) φ̈ + 2 I_ξ sin θ cos θ θ̇φ̇ - I_rξ (θ̈ cos θ - θ̇² sin θ), shape (n,) [N m]."""
        sine, cosine = np.sin(at.pitch), np.cos(at.pitch)
        return (
            (self.radius + self.chord * sine**2) * at.flap_acceleration
            + 2 * self.chord * sine * cosine * at.pitch_rate * at.flap_rate
            - self.product * (at.pitch_acceleration * cosine - at.pitch_rate**2 * sine)
        )

    def pitch_torque(self, at: Kinematics) -> np.ndarray:
        """Q_θ = I_ξ θ̈ - I_rξ φ̈ cos θ - I_ξ φ̇² sin θ cos θ, shape (n,) [N m]."""
        sine, cosine = np.sin(at.pitch), np.cos(at.pitch)
        return (
            self.chord * at.pitch_acceleration
            - self.product * at.flap_acceleration * cosine
            - self.chord * at.flap_rate**2 * sine * cosine
        )

    def tangential_force(self, at: Kinematics) -> np.ndarray:
        """Force of one wing's inertia along its ê_φ, -M_r φ̈ + M_ξ (θ̈ cos θ - (θ̇² + φ̇²) sin θ), shape (n,) [N]."""
        turning = at.pitch_rate**2 + at.flap_rate**2
        return -self.first_radius * at.flap_acceleration + self.first_chord * (
            at.pitch_acceleration * np.cos(at.pitch) - turning * np.sin(at.pitch)
        )

    def pair_force(self, at: Kinematics) -> np.ndarray:
        """Force of both wings' inertia on the body, minus the rate of their momentum, in stroke-plane axes (n, 3) [N].

        One wing's ∫x dm is M_r sin φ - M_ξ sin θ cos φ forward and -M_ξ cos θ up; sideways the wings cancel.
        """
        sin_f, cos_f, sin_p, cos_p = np.sin(at.flap), np.cos(at.flap), np.sin(at.pitch), np.cos(at.pitch)
        sin_f_acc = cos_f * at.flap_acceleration - sin_f * at.flap_rate**2
        cos_f_acc = -sin_f * at.flap_acceleration - cos_f * at.flap_rate**2
        sin_p_acc = cos_p * at.pitch_acceleration - sin_p * at.pitch_rate**2
        cos_p_acc = -sin_p * at.pitch_acceleration - cos_p * at.pitch_rate**2
        product_acc = sin_p_acc * cos_f - 2 * cos_p * sin_f * at.pitch_rate * at.flap_rate + sin_p * cos_f_acc
        forward = self.first_radius * sin_f_acc - self.first_chord * product_acc
        upward = -self.first_chord * cos_p_acc
        return -2 * np.stack([forward, np.zeros_like(forward), upward], axis=-1)


def wing_inertia(wing: Wing) -> WingInertia:
    """Moments of mass of a wing with scalar fields.

    Raises:
        ValueError: if the wing has no mass.
    """
    if wing.mass is None:
        raise ValueError(
            "wing mass is missing where inertia is asked for; allowed: Wing(..., mass=...) [kg] of one wing"
        )
    length, mean_chord, axis, shape = wing.length, wing.mean_chord, wing.pitch_axis, wing.shape
    middle = 0.5 - axis  # of the chord, behind the axis
    return WingInertia(
        first_radius=wing.mass * length * shape.moment(1),
        first_chord=wing.mass * mean_chord * middle * shape.moment(0, 2),
        radius=wing.mass * length**2 * shape.moment(2),
        product=wing.mass * length * mean_chord * middle * shape.moment(1, 2),
        chord=wing.mass * mean_chord**2 * ((1 - axis) ** 3 + axis**3) / 3 * shape.moment(0, 3),
    )
