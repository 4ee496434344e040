"""Force laws: C_L(α) and C_D(α) of a given wing and stroke, in the two forms that averages and strips ask for.

A law is made of sine and cosine of the folded angle of attack, sin α_f = |V·n̂|/|V| and cos α_f = |V·ê_c|/|V| in [0, 1],
so that no angle is ever formed where none is needed. Its constants are scalars or arrays.
"""

import abc
import dataclasses
import math
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import Any, Self

import numpy as np

from flapenv.aero.arrays import Real, as_arrays, as_like, as_result, is_tensor
from flapenv.aero.coefficients import robofly_drag, robofly_lift

SMALLEST_SPEED = 1e-300
"""Stands in for zero where a speed divides; far below any speed there is [m/s]."""


@dataclass(frozen=True, kw_only=True)
class ForceLaw(abc.ABC):
    """Lift and drag coefficients of one wing, or of a batch of wings and strokes.

    Attributes:
        profile_drag: C_D0, added to the drag at every angle (Part II, section 3.2) [-].
    """

    profile_drag: Real = 0.0

    @abc.abstractmethod
    def lift(self, sine: Real, cosine: Real) -> Real:
        """C_L at sin α_f, cos α_f [-]."""

    @abc.abstractmethod
    def plain_drag(self, sine: Real, cosine: Real) -> Real:
        """C_D without the profile drag, at sin α_f, cos α_f [-]."""

    def drag(self, sine: Real, cosine: Real) -> Real:
        """C_D at sin α_f, cos α_f [-]."""
        return self.profile_drag + self.plain_drag(sine, cosine)

    @property
    def lift_constant(self) -> Real:
        """C_T: the lift coefficient at 45°, where sin 2α = 1 [-]."""
        return as_result(self.lift(math.sqrt(0.5), math.sqrt(0.5)))

    @property
    def constants(self) -> dict[str, Real]:
        """The numbers that may be arrays, by the names of their fields."""
        return {name: value for name, value in vars(self).items() if hasattr(value, "ndim")}

    def with_constants(self, constants: Mapping[str, Real]) -> Self:
        """The same law with other numbers in place of its `constants`."""
        return dataclasses.replace(self, **constants)

    def strip_force(self, chordwise: Real, normal: Real) -> tuple[Real, Real]:
        """Force over ½ρ dS of a strip that moves through the air, any way round  (2.4).

            dF = ½ρ dS (|V|² C_L l̂ - C_D |V| V),  l̂ ⊥ V, on the side of the normal force

        Args:
            chordwise: V·ê_c, along the chord from trailing to leading edge [m/s].
            normal: V·n̂ [m/s], broadcast against it.

        Returns:
            Components along ê_c and n̂ [m²/s²].
        """
        xp, chordwise, normal = as_arrays(chordwise, normal)
        speed = xp.sqrt(chordwise**2 + normal**2)
        safe = xp.clip(speed, SMALLEST_SPEED, None)
        sine, cosine = xp.abs(normal) / safe, xp.abs(chordwise) / safe
        lift = -speed * self.lift(sine, cosine) * xp.sign(normal) * xp.sign(chordwise)
        drag = speed * self.drag(sine, cosine)
        return -lift * normal - drag * chordwise, lift * chordwise - drag * normal


@dataclass(frozen=True, kw_only=True)
class PlateLaw(ForceLaw):
    """C_N = 2 C_T sin α, normal to the chord: C_L = C_N cos α = C_T sin 2α, C_D = C_N sin α  (2.5)-(2.7), (2.12).

    The force is normal because the leading edge carries no suction: (2.5) and (2.6) in one.

    Attributes:
        constant: C_T [-].
    """

    constant: Real

    def lift(self, sine: Real, cosine: Real) -> Real:
        """C_T sin 2α [-]  (2.7)."""
        return self.constant * (2 * sine * cosine)

    def plain_drag(self, sine: Real, cosine: Real) -> Real:
        """2 C_T sin² α [-]  (2.12)."""
        return self.constant * (2 * sine * sine) + 0 * cosine

    @property
    def lift_constant(self) -> Real:
        """C_T [-]."""
        return self.constant

    def strip_force(self, chordwise: Real, normal: Real) -> tuple[Real, Real]:
        """-2 C_T |V| (V·n̂) n̂ - C_D0 |V| V: the vector form, without any angle; arguments as in `ForceLaw`."""
        xp, chordwise, normal = as_arrays(chordwise, normal)
        speed = xp.sqrt(chordwise**2 + normal**2)
        friction = self.profile_drag * speed
        return -friction * chordwise, -(2 * self.constant * speed + friction) * normal


@dataclass(frozen=True, kw_only=True)
class PolhamusLaw(ForceLaw):
    """C_L = ½ K_P sin 2α K_Polhamus, C_D = C_L tan α: the leading-edge suction analogy  (3.1), (3.2), (2.12).

    Attributes:
        slope: K_P = C_Lα [1/rad].
        suction: 1 - k K_P/(π AR), the sine's share of K_Polhamus [-].
    """

    slope: Real
    suction: Real

    def lift(self, sine: Real, cosine: Real) -> Real:
        """½ K_P sin 2α (cos α + (1 - k K_P/(π AR)) sin α) [-]  (3.2)."""
        return self.slope * sine * cosine * (cosine + self.suction * sine)

    def plain_drag(self, sine: Real, cosine: Real) -> Real:
        """K_P sin² α (cos α + (1 - k K_P/(π AR)) sin α) [-], as for any force normal to the chord."""
        return self.slope * sine * sine * (cosine + self.suction * sine)


@dataclass(frozen=True, kw_only=True)
class BermanWangLaw(ForceLaw):
    """C_L = C_T sin 2α, C_D = C_D0 cos² α + C_D90 sin² α (Berman & Wang 2007).

    Attributes:
        constant: C_T [-].
        zero_drag: C_D0 [-].
        normal_drag: C_D90 [-].
    """

    constant: Real
    zero_drag: Real
    normal_drag: Real

    def lift(self, sine: Real, cosine: Real) -> Real:
        """C_T sin 2α [-]."""
        return self.constant * (2 * sine * cosine)

    @property
    def lift_constant(self) -> Real:
        """C_T [-]."""
        return self.constant

    def plain_drag(self, sine: Real, cosine: Real) -> Real:
        """C_D0 cos² α + C_D90 sin² α [-]."""
        return self.zero_drag * (cosine * cosine) + self.normal_drag * (sine * sine)


@dataclass(frozen=True, kw_only=True)
class FittedLaw(ForceLaw):
    """C_L(α) and C_D(α) as functions of the angle alone, the same for every wing.

    What the function gives is brought to the type of its argument, so that a table of double precision does not slow a
    computation in single precision. Tensors pass only through a function that takes them.

    Attributes:
        function: (C_L, C_D) at α in [0, 90°] [rad], arrays of its shape.
    """

    function: Callable[[Any], tuple[Any, Any]]

    def lift(self, sine: Real, cosine: Real) -> Real:
        """C_L [-]."""
        return self._value(0, sine, cosine)

    def plain_drag(self, sine: Real, cosine: Real) -> Real:
        """C_D [-]."""
        return self._value(1, sine, cosine)

    def _value(self, which: int, sine: Real, cosine: Real) -> Real:
        """C_L or C_D in the type of the angle."""
        xp, sine, cosine = as_arrays(sine, cosine)
        angle = xp.atan2(sine, cosine)
        value = self.function(angle)[which]
        return value if is_tensor(value) else as_like(angle, np.asarray(value))[0]


def robofly(alpha: Real) -> tuple[Real, Real]:
    """(C_L, C_D) of `robofly_lift` and `robofly_drag`; alpha [rad]."""
    return robofly_lift(alpha), robofly_drag(alpha)
