"""Where the model has been held against CFD, and what of a stroke and its wing lies outside of that or of a box."""

import functools
import math

from flapenv.aero.checks import record
from flapenv.aero.parameters import STROKE_PARAMETERS, StrokeParameter
from flapenv.aero.stroke import Stroke
from flapenv.insects import INSECTS, Insect, load_insect
from flapenv.problem import StrokeBox

ANGLE = "α at mid-stroke"
AIR_VISCOSITY = 1.789e-5
"""μ of air at 15 °C [Pa s] (International Standard Atmosphere); it hardly changes with density."""
SMALLEST_ANGLE, LARGEST_ANGLE = math.radians(25), math.radians(45)
"""Angles of attack that wings usually have, where the model's accuracy is good [rad] (Part II, section 2.3.2)."""
CASES, ANGLES, BOX = "the CFD cases", "the angles that the model is made for", "the problem's box"
"""What ranges are of."""
ROUNDING = 1e-4
"""Of a bound, by which a stroke found in single precision may be beyond it."""
SLACK = 0.01
"""Of an end of a range, by which a value must be beyond it before it is worth a word."""


@record
class Quantity:
    """A quantity of a beating wing with a range it is held against.

    Attributes:
        name: what it is, in words.
        value: of the stroke that is judged [unit].
        low: lower end of the range [unit].
        high: upper end [unit].
        unit: as it is printed.
        basis: what the range is of.
    """

    name: str
    value: float
    low: float
    high: float
    unit: str = ""
    basis: str

    def is_outside(self, slack: float) -> bool:
        """Whether the value is beyond one of the ends by more than `slack` times that end."""
        return not self.low - slack * abs(self.low) <= self.value <= self.high + slack * abs(self.high)

    @property
    def range_text(self) -> str:
        """The range with its unit, "45 to 88.5°"."""
        where = f"{self.low:.4g}" if math.isclose(self.low, self.high) else f"{self.low:.4g} to {self.high:.4g}"
        return f"{where}{self._unit}"

    @property
    def text(self) -> str:
        """The quantity beside its range, "φmax = 90°, beyond 45 to 88.5°"."""
        return f"{self.name} = {self.value:.4g}{self._unit}, beyond {self.range_text}"

    @property
    def _unit(self) -> str:
        """As it follows a number."""
        return self.unit if self.unit in ("", "°") else f" {self.unit}"


def reynolds_number(insect: Insect, stroke: Stroke, *, air_density: float = 1.225) -> float:
    """Re = ρ c̄ Ū/μ with the mean speed at the radius of the second moment, Ū = 4 f φmax r̂₂ R [-].

    Args:
        insect: one insect, scalar fields.
        stroke: one stroke, scalar fields.
        air_density: ρ [kg/m³].

    Source: Sun & Du (2003), whose U = 2 Φ n r₂ is Ū with Φ = 2 φmax.
    """
    wing = insect.wing
    speed = stroke.mean_flap_speed * math.sqrt(wing.moment(2)) * wing.length
    return float(air_density * wing.mean_chord * speed / AIR_VISCOSITY)


def angle_at_mid_stroke(stroke: Stroke) -> float:
    """α in the middle of a half-stroke, where the wing is fastest [rad]."""
    return float(stroke.angle_of_attack(0.0))


def outside_validated(insect: Insect, stroke: Stroke, *, air_density: float = 1.225) -> tuple[Quantity, ...]:
    """What of the stroke and the wing none of the eight CFD cases covers, or the model was not made for.

    α is held against the 25° to 45° for which the paper calls the model accurate, all else against the least and the
    largest value of the eight insects' own wings and strokes: Re, AR, r̂₁, f, φmax, Cφ, Cθ and δ.

    Args:
        insect: one insect, scalar fields.
        stroke: one stroke, scalar fields.
        air_density: ρ [kg/m³].
    """
    ranges, judged = _validated_ranges(), []
    for (name, unit), value in _quantities(insect, stroke, air_density).items():
        low, high = ranges[name]
        basis = ANGLES if name == ANGLE else CASES
        judged.append(Quantity(name=name, value=value, low=low, high=high, unit=unit, basis=basis))
    return tuple(quantity for quantity in judged if quantity.is_outside(SLACK))


def outside_box(insect: Insect, stroke: Stroke, box: StrokeBox) -> tuple[Quantity, ...]:
    """Every parameter of the stroke that a search in the box would not have found.

    Args:
        insect: one insect, whose own stroke the box may be relative to.
        stroke: one stroke, scalar fields.
        box: the box.
    """
    judged = []
    for name, parameter in STROKE_PARAMETERS.items():
        low, high = (_shown(parameter, bound) for bound in box.bounds(name, insect.reference))
        value, unit = _shown(parameter, getattr(stroke, name)), _shown_unit(parameter)
        judged.append(Quantity(name=parameter.symbol, value=value, low=low, high=high, unit=unit, basis=BOX))
    return tuple(quantity for quantity in judged if quantity.is_outside(ROUNDING))


def _quantities(insect: Insect, stroke: Stroke, air_density: float) -> dict[tuple[str, str], float]:
    """What is held against the CFD cases, by name and unit."""
    found = {
        (ANGLE, "°"): math.degrees(angle_at_mid_stroke(stroke)),
        ("Re", ""): reynolds_number(insect, stroke, air_density=air_density),
        ("AR", ""): float(insect.wing.aspect_ratio),
        ("r̂₁", ""): float(insect.wing.r1_hat),
    }
    for name, parameter in STROKE_PARAMETERS.items():
        if name != "pitch_amplitude":  # which α at mid-stroke says
            found[parameter.symbol, _shown_unit(parameter)] = _shown(parameter, getattr(stroke, name))
    return found


def _shown(parameter: StrokeParameter, value: float) -> float:
    """A value as it is printed, angles in degrees."""
    return math.degrees(value) if parameter.unit == "rad" else float(value)


def _shown_unit(parameter: StrokeParameter) -> str:
    """Its unit."""
    return "°" if parameter.unit == "rad" else parameter.unit


@functools.cache
def _validated_ranges() -> dict[str, tuple[float, float]]:
    """Least and largest value of every quantity over the eight insects' own strokes; α as the paper states it."""
    insects = [load_insect(name) for name in INSECTS]
    cases = [_quantities(insect, insect.stroke, 1.225) for insect in insects]
    ranges = {key[0]: (min(values), max(values)) for key in cases[0] for values in ([case[key] for case in cases],)}
    ranges[ANGLE] = math.degrees(SMALLEST_ANGLE), math.degrees(LARGEST_ANGLE)
    return ranges
