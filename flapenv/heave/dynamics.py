"""One wingbeat of a heaving insect: from height and velocity at its beginning to those at its end.

    m ẇ = L(w - w_g, stroke) - m g,   ż = w

with L the mean vertical force of the beat at a steady speed through the air. Within a beat L is taken as linear about
the w it begins with, so that an exponential step solves the motion exactly (exponential Euler; Hochbruck & Ostermann
2010, Acta Numerica 19). In units of the trim, with λ = G Λ', G = g/(fU), and x = w/U, over one beat

    Δx = G (Λ - 1) φ₁(λ),   Δz/R = (U/fR) (x + G (Λ - 1) φ₂(λ)),   φ₁ = (e^λ - 1)/λ,   φ₂ = (e^λ - 1 - λ)/λ².

The mean of x over the beat exceeds its start by G (Λ - 1) φ₂; the mean force is the one that gives Δx, and the mean
power is taken at the mean of x.
"""

from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np

from flapenv.aero.arrays import Real
from flapenv.aero.checks import is_single, record, shown
from flapenv.aero.heaving import SPAN_NODES, heave_averages, span_rule, stack_rules
from flapenv.case import hover_case, lift_constant, stack_cases
from flapenv.coordinates import StrokeCoordinates
from flapenv.heave.trim import BOX, HeaveTrim, heave_trim
from flapenv.insects import Insect
from flapenv.model import HoverModel

QUADRATURE_TOLERANCE = 1e-5
"""Of the averages over the beat, relative."""
SMALL_EXPONENT = 1e-2
"""Below this φ₂ is summed from its series; the direct form would lose digits."""
LARGEST_EXPONENT = 50.0
"""Of |λ|; no insect comes near it, and nothing overflows."""


@record
class HeaveForces:
    """Mean force and power of a beat at steady speeds through the air; fields of shape (n,).

    Attributes:
        weight_support: Λ, vertical force over weight [-].
        weight_support_slope: dΛ/d(w/U) [-].
        specific_power: P*, what the muscles pay [W/kg].
        specific_power_slope: dP*/d(w/U) [W/kg].
    """

    weight_support: np.ndarray
    weight_support_slope: np.ndarray
    specific_power: np.ndarray
    specific_power_slope: np.ndarray


@record
class HeaveBeat:
    """What a beat came to; fields of shape (n,).

    Attributes:
        height: z/R at its end [-].
        velocity: w/U at its end [-].
        weight_support: Λ averaged over the beat [-].
        specific_power: P* averaged over the beat [W/kg].
    """

    height: np.ndarray
    velocity: np.ndarray
    weight_support: np.ndarray
    specific_power: np.ndarray


class HeaveDynamics:
    """The beat map of several insects, one of them in each row."""

    def __init__(self, insects: Sequence[Insect], dtype: Any = np.float64) -> None:
        """Trim every insect and reduce it to numbers.

        Args:
            insects: at least one, scalar fields each.
            dtype: of the averages over the beat; the state is integrated in double precision.

        Raises:
            TypeError: for an insect with array fields.
        """
        for insect in insects:
            if not is_single(insect):
                raise TypeError(f"insect {shown(insect.name)} has array fields; allowed: scalar fields")
        self.insects, self.dtype, self.model = tuple(insects), np.dtype(dtype), HoverModel()
        self.coordinates = StrokeCoordinates(BOX)
        self.time = BOX.time_rule(tolerance=QUADRATURE_TOLERANCE)
        self.trim: HeaveTrim = heave_trim(self.insects)
        self._case = stack_cases([hover_case(insect, self.model) for insect in self.insects])
        shapes = [insect.wing.shape for insect in self.insects]
        self._rule = stack_rules([span_rule(shape, SPAN_NODES) for shape in shapes], self.dtype)
        moments = np.array([[shape.moment(2), shape.moment(3)] for shape in shapes]).T
        self._lift_scale = 2 * self._case.lift_scale / moments[0]
        self._power_scale = 2 * self._case.power_scale / moments[1]

    def decode(self, actions: np.ndarray, index: np.ndarray) -> tuple[dict[str, np.ndarray], np.ndarray]:
        """Strokes of actions, shape (n, 5), and where they were clipped; `index` as in `forces`."""
        frequency, amplitude = (np.asarray(own, self.dtype)[index] for own in self.trim.reference)
        reference = self.trim.reference._replace(frequency=frequency, flap_amplitude=amplitude)
        return self.coordinates.decode(actions.astype(self.dtype), reference)

    def trim_actions(self) -> np.ndarray:
        """The action that hovers, for every insect, shape (insects, 5)."""
        return self.coordinates.encode(vars(self.trim.stroke), self.trim.reference)

    def forces(self, index: np.ndarray, strokes: Mapping[str, Real], airspeed: np.ndarray) -> HeaveForces:
        """Mean force and power at a steady speed of climb through the air.

        Args:
            index: which insect each row is, shape (n,).
            strokes: the stroke's fields by name, each of shape (n,), inside `BOX`.
            airspeed: (w - w_g)/U, shape (n,) [-].
        """
        case = self._case.rows(index)
        frequency, amplitude = (np.asarray(strokes[name], dtype=float) for name in ("frequency", "flap_amplitude"))
        speed = 4 * frequency * amplitude
        per_speed = self.trim.tip_speed[index] / (speed * self.trim.length[index])  # dμ/d(w/U)
        averages = heave_averages(
            self._rule,
            index,
            airspeed * per_speed,
            flap_shape=strokes["flap_shape"],
            pitch_amplitude=strokes["pitch_amplitude"],
            pitch_shape=strokes["pitch_shape"],
            pitch_phase=strokes["pitch_phase"],
            time=self.time,
        )
        constant = lift_constant(case, self.model, speed, amplitude)
        lift = self._lift_scale[index] * constant * speed**2
        power = self._power_scale[index] * constant * speed**3
        return HeaveForces(
            weight_support=lift * averages.lift,
            weight_support_slope=lift * averages.lift_slope * per_speed,
            specific_power=power * averages.power,
            specific_power_slope=power * averages.power_slope * per_speed,
        )

    def beat(
        self,
        index: np.ndarray,
        strokes: Mapping[str, Real],
        height: np.ndarray,
        velocity: np.ndarray,
        gust: np.ndarray,
        *,
        beats: float = 1.0,
    ) -> HeaveBeat:
        """Step from the beginning of a beat to its end.

        Args:
            index: which insect each row is, shape (n,).
            strokes: the stroke's fields by name, each of shape (n,), inside `BOX`.
            height: z/R at the beginning, shape (n,) [-].
            velocity: w/U at the beginning, shape (n,) [-].
            gust: w_g/U, steady over the step, shape (n,) [-].
            beats: length of the step; a part of a beat for tests of convergence.
        """
        at = self.forces(index, strokes, velocity - gust)
        gravity = self.trim.gravity[index] * beats
        first, second = _phi(np.clip(gravity * at.weight_support_slope, -LARGEST_EXPONENT, LARGEST_EXPONENT))
        fall = gravity * (at.weight_support - 1)
        gain, mean_gain = fall * first, fall * second
        return HeaveBeat(
            height=height + self.trim.reach[index] * beats * (velocity + mean_gain),
            velocity=velocity + gain,
            weight_support=1 + gain / gravity,
            specific_power=at.specific_power + at.specific_power_slope * mean_gain,
        )


def _phi(exponent: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """φ₁ = (e^λ - 1)/λ and φ₂ = (e^λ - 1 - λ)/λ², 1 and 1/2 at λ = 0."""
    small = np.abs(exponent) < SMALL_EXPONENT
    safe = np.where(small, 1.0, exponent)
    series = 0.5 + exponent * (1 / 6 + exponent * (1 / 24 + exponent * (1 / 120 + exponent / 720)))
    second = np.where(small, series, (np.expm1(safe) - safe) / (safe * safe))
    return 1 + exponent * second, second
