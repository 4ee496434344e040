"""The six numbers that describe a stroke: the one table behind its checks, the boxes, the actions and the docs."""

import math
from dataclasses import dataclass
from typing import Any, Literal, NamedTuple

import numpy as np

from flapenv.aero.arrays import as_numpy
from flapenv.aero.checks import HUGEST, TINIEST, require_real

CLEARLY = 1.1
"""How far over its range an angle must be for degrees to be guessed: 3.15 is a rounded π."""


@dataclass(frozen=True, kw_only=True)
class StrokeParameter:
    """One row of the table.

    Attributes:
        name: field of `Stroke` and key of every box.
        symbol: the paper's symbol.
        meaning: what it is, in words.
        unit: SI unit of the value, empty for a ratio.
        low: lower end of what is physically meaningful [unit].
        high: upper end [unit].
        box: the default search box [unit]; for the frequency in multiples of the reference frequency.
        scale: how an action in [-1, 1] runs over the box: "linear", "log" (of the value) or "log-complement"
            (of one minus the value).
        log_floor: what a logarithmic scale is shifted by in a box that comes closer to its pole than this: nearer
            than that the waveform hardly changes any more.
    """

    name: str
    symbol: str
    meaning: str
    unit: str
    low: float
    high: float
    box: tuple[float, float]
    scale: Literal["linear", "log", "log-complement"]
    log_floor: float = 0.0

    def check(self, value: object, *, field: str | None = None) -> object:
        """`value` if it lies in the valid range.

        Raises:
            TypeError: if it is not real.
            ValueError: if it is outside, NaN or infinite; an angle that looks like degrees is told in radians.
        """
        try:
            return require_real(field or self.name, value, self.low, self.high, unit=self.unit)
        except ValueError as mistake:
            raise ValueError(f"{mistake}{self._guess(as_numpy(value))}") from None

    def _guess(self, values: np.ndarray) -> str:
        """What was meant by the first angle outside of the range, if it would lie within in degrees."""
        if self.unit == "rad":
            for value in np.ravel(values):
                too_large = abs(value) > CLEARLY * self.high
                if too_large and self.low <= math.radians(value) <= self.high:
                    return f"; {value:.6g} looks like degrees: {math.radians(value):.5g} rad"
        return ""


class StrokeReference(NamedTuple):
    """What of an insect's own stroke a box may be relative to: scalars or arrays.

    Attributes:
        frequency: f [Hz].
        flap_amplitude: φmax [rad].
    """

    frequency: Any
    flap_amplitude: Any


STROKE_PARAMETERS: dict[str, StrokeParameter] = {
    row.name: row
    for row in (
        StrokeParameter(
            name="frequency",
            symbol="f",
            meaning="flapping frequency",
            unit="Hz",
            low=TINIEST,
            high=HUGEST,
            box=(0.5, 1.5),
            scale="log",
        ),
        StrokeParameter(
            name="flap_amplitude",
            symbol="φmax",
            meaning="flapping amplitude, half of the angle swept in a half-stroke",
            unit="rad",
            low=TINIEST,
            high=math.pi,
            box=(math.radians(40), math.radians(90)),
            scale="linear",
        ),
        StrokeParameter(
            name="flap_shape",
            symbol="Cφ",
            meaning="flapping waveform: 0 a sinusoid, 1 a triangle",
            unit="",
            low=0.0,
            high=1.0,
            box=(0.01, 0.99),
            scale="log-complement",
            log_floor=5e-5,
        ),
        StrokeParameter(
            name="pitch_shape",
            symbol="Cθ",
            meaning="pitching waveform: 0 a sinusoid, large a square wave",
            unit="",
            low=0.0,
            high=math.inf,
            box=(0.1, 10.0),
            scale="log",
            log_floor=0.05,
        ),
        StrokeParameter(
            name="pitch_amplitude",
            symbol="θmax",
            meaning="pitching amplitude, 90° minus the smallest angle of attack of the cycle",
            unit="rad",
            low=0.0,
            high=math.pi / 2,
            box=(math.radians(45), math.radians(65)),
            scale="linear",
        ),
        StrokeParameter(
            name="pitch_phase",
            symbol="δ",
            meaning="pitching phase: 90° symmetric rotation, more advanced, less delayed",
            unit="rad",
            low=-2 * math.pi,
            high=2 * math.pi,
            box=(math.radians(60), math.radians(120)),
            scale="linear",
        ),
    )
}
"""By name, in the order of the action's rows."""
