"""What the blade element returns: every force term over one wingbeat, as forces, torques and power."""

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np

from flapenv.aero.axes import to_earth
from flapenv.aero.checks import require_name
from flapenv.aero.motions import Kinematics

ACCOUNTING = ("elastic", "positive")
"""How negative power counts: stored and returned, or lost."""


@dataclass(frozen=True, kw_only=True)
class TermHistory:
    """One term of the force over the wingbeat, in stroke-plane axes (docs/axes.md).

    Torques and power are the muscles': what they must exert and pay against this term. Rows of the tangential
    force, the torques and the power are the right and the left wing.

    Attributes:
        force: of both wings on the body along x₁, y, z₁, shape (steps, 3) [N].
        tangential_force: of each wing along its ê_φ, shape (2, steps) [N].
        flap_torque: Q_φ about the flapping axis, shape (2, steps) [N m].
        pitch_torque: Q_θ about the pitching axis, shape (2, steps) [N m].
        power: Q_φ φ̇ + Q_θ θ̇, shape (2, steps) [W].
    """

    force: np.ndarray
    tangential_force: np.ndarray
    flap_torque: np.ndarray
    pitch_torque: np.ndarray
    power: np.ndarray


@dataclass(frozen=True, kw_only=True)
class WingbeatHistory:
    """One wingbeat by the blade element; histories of shape (steps,) unless said otherwise.

    Attributes:
        phase: ωt at the instants [rad].
        kinematics: φ, θ and their derivatives there.
        angle_of_attack: α at the radius r̂₂ R of the right wing, in [0, π] [rad].
        stroke_plane_angle: σ [rad].
        terms: the terms that were asked for, by name.
    """

    phase: np.ndarray
    kinematics: Kinematics
    angle_of_attack: np.ndarray
    stroke_plane_angle: float
    terms: Mapping[str, TermHistory]

    @property
    def force(self) -> np.ndarray:
        """Sum of the terms in stroke-plane axes, shape (steps, 3) [N]."""
        return np.sum([term.force for term in self.terms.values()], axis=0)

    @property
    def earth_force(self) -> np.ndarray:
        """Sum of the terms in earth axes: forward, left, up; shape (steps, 3) [N]."""
        return to_earth(self.force, self.stroke_plane_angle)

    @property
    def lift(self) -> np.ndarray:
        """Vertical force of the wing pair [N]."""
        return self.earth_force[:, 2]

    @property
    def flap_torque(self) -> np.ndarray:
        """Sum of the terms' Q_φ, shape (2, steps) [N m]."""
        return np.sum([term.flap_torque for term in self.terms.values()], axis=0)

    @property
    def pitch_torque(self) -> np.ndarray:
        """Sum of the terms' Q_θ, shape (2, steps) [N m]."""
        return np.sum([term.pitch_torque for term in self.terms.values()], axis=0)

    @property
    def wing_power(self) -> np.ndarray:
        """Sum of the terms' power, right and left wing, shape (2, steps) [W]."""
        return np.sum([term.power for term in self.terms.values()], axis=0)

    @property
    def power(self) -> np.ndarray:
        """Power of the wing pair [W]."""
        return np.sum(self.wing_power, axis=0)

    @property
    def mean_lift(self) -> float:
        """Mean vertical force over the cycle [N]."""
        return float(np.mean(self.lift))

    def paid_power(self, accounting: str = "elastic") -> np.ndarray:
        """Power of the wing pair that is paid [W].

        Args:
            accounting: "elastic", where negative power is stored and returned (Sun & Du's convention, and the paper's),
                or "positive", where each wing pays max(0, power) and the rest is lost.

        Raises:
            ValueError: for another accounting.
        """
        require_name("accounting", accounting, ACCOUNTING)
        paid = self.wing_power if accounting == "elastic" else np.maximum(self.wing_power, 0)
        return np.sum(paid, axis=0)

    def mean_power(self, accounting: str = "elastic") -> float:
        """Mean of `paid_power` over the cycle [W].

        Raises:
            ValueError: for another accounting.
        """
        return float(np.mean(self.paid_power(accounting)))
