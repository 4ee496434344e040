"""What an environment can fly: insects whose numbers, and all that is computed from them, keep within their type."""

import math
from collections.abc import Sequence

import numpy as np

from flapenv.aero.checks import interval_text, one_line
from flapenv.case import HoverCase, hover_case
from flapenv.insects import Insect
from flapenv.model import HoverModel
from flapenv.problem import HoverProblem

FLYABLE: dict[str, tuple[float, float, str]] = {
    "reference frequency": (1e-3, 1e6, "Hz"),
    "reference amplitude": (1e-3, math.pi, "rad"),
    "wing length": (1e-6, 1e3, "m"),
    "wing length over mean chord": (1e-2, 1e4, ""),
    "induced power factor": (0.0, 1e3, ""),
    "lift at its own stroke over weight": (1e-6, 1e6, ""),
    "power scale at its own stroke": (1e-6, 1e12, "W/kg"),
}
"""Far beyond whatever flaps, yet so near that powers of their products are still numbers of single precision."""


def require_flyable(insects: Sequence[Insect], model: HoverModel) -> None:
    """Refuse insects that are numbers only: whatever an environment computes of the others is finite.

    Args:
        insects: scalar fields each.
        model: that they are flown with.

    Raises:
        ValueError: naming the insect, the quantity, its value and what is allowed.
    """
    for insect in insects:
        stroke, wing = insect.stroke, insect.wing
        _require(insect, "reference frequency", stroke.frequency)
        _require(insect, "reference amplitude", stroke.flap_amplitude)
        _require(insect, "wing length", wing.length)
        _require(insect, "wing length over mean chord", wing.aspect_ratio)
        case = hover_case(insect, model)
        speed = 4 * float(stroke.frequency) * float(stroke.flap_amplitude)
        _require(insect, "induced power factor", case.wing_factor)
        _require(insect, "lift at its own stroke over weight", case.lift_scale * speed**2)
        _require(insect, "power scale at its own stroke", case.power_scale * speed**3)


def _require(insect: Insect, name: str, value: object) -> None:
    """Refuse a number outside of its range in `FLYABLE`."""
    low, high, unit = FLYABLE[name]
    number = float(np.asarray(value))
    if not low <= number <= high:
        where = interval_text(low, high, open_low=False, open_high=False, unit=unit)
        raise ValueError(
            f"insect {one_line(insect.name, 80)}: {name} = {number:.6g} is not allowed in an environment; "
            f"allowed: {where}"
        )


def require_finite_power(cases: HoverCase, problem: HoverProblem, dtype: np.dtype) -> None:
    """Refuse frequencies whose power the type of the computation cannot hold.

    Args:
        cases: the insects' numbers.
        problem: whose box bounds the frequency.
        dtype: of the computation.

    Raises:
        ValueError: naming the bound and the type.
    """
    frequency, amplitude = (problem.box.bounds(name, cases.reference)[1] for name in ("frequency", "flap_amplitude"))
    largest = float(np.max(1e3 * cases.power_scale * (4.0 * frequency * amplitude) ** 3))
    if not largest < float(np.finfo(dtype).max):
        raise ValueError(
            f"upper bound of frequency = {float(np.max(frequency)):.6g} is not allowed with dtype = "
            f"'{dtype.name}', whose numbers end before the power; allowed: a lower one"
        )
