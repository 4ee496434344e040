"""Where a heaving insect hovers: the frequency it keeps, the stroke that holds it, and the units of its motion.

The frequency is fixed, so that every beat lasts the same, at the one with which the best stroke of amplitude
`HOVER_AMPLITUDE` carries the weight; the amplitude then has room both ways. Without profile drag the waveform x =
(Cφ, Cθ, θmax, δ) of least power at a given amplitude and free frequency is the same for every wing: at Λ = 1,
P* = 2 A_P C_T A_L^(-3/2) S(x)/L(x)^(3/2) (`flapenv.many_optima`), so it is solved once, and f follows from Λ ∝ f².

Heights are in wing lengths R, speeds in the mean speed of the tip at hover, U = 4 f φmax R.
"""

import dataclasses
import functools
import math
from collections.abc import Sequence

import numpy as np

from flapenv.aero.arrays import Real
from flapenv.aero.checks import record
from flapenv.aero.parameters import StrokeReference
from flapenv.aero.stroke import Stroke
from flapenv.insects import Insect, load_insect
from flapenv.model import HoverModel
from flapenv.optimum import optimum
from flapenv.performance import evaluate
from flapenv.problem import HoverProblem, StrokeBox

HOVER_AMPLITUDE = math.radians(75)
"""φmax of the stroke that hovers [rad]."""
BOX = StrokeBox(frequency_ratio=(1.0, 1.0))
"""Strokes of an episode: problem A's box at the trim's own frequency."""
ANY_FREQUENCY = (0.05, 20.0)
"""Where the frequency of the trim is sought, over an insect's own; wide, so that it is never at a bound."""


@record
class HeaveTrim:
    """Hovering of one or several insects; fields of the insects' shape.

    Attributes:
        stroke: the stroke that holds the weight with the least power at this frequency.
        specific_power: P*_hover [W/kg].
        length: R [m].
        tip_speed: U = 4 f φmax R [m/s].
        gravity: g/(f U), what a beat of free fall adds to w/U [-].
        reach: U/(f R) = 4 φmax, the wing lengths travelled in a beat at U [-].
    """

    stroke: Stroke
    specific_power: Real
    length: Real
    tip_speed: Real
    gravity: Real
    reach: Real

    @property
    def reference(self) -> StrokeReference:
        """What `BOX` is relative to: the frequency kept, and φmax."""
        return StrokeReference(self.stroke.frequency, self.stroke.flap_amplitude)

    def of(self, index: np.ndarray) -> "HeaveTrim":
        """The trims of the insects at `index`."""
        parts = {name: np.asarray(value)[index] for name, value in vars(self).items() if name != "stroke"}
        stroke = Stroke(**{name: np.asarray(value)[index] for name, value in vars(self.stroke).items()})
        return HeaveTrim(stroke=stroke, **parts)


@functools.cache
def trim_waveform() -> Stroke:
    """The waveform of least power at `HOVER_AMPLITUDE` in `BOX`, the same for every wing; its frequency is any."""
    box = StrokeBox(frequency_ratio=ANY_FREQUENCY, flap_amplitude=(HOVER_AMPLITUDE, HOVER_AMPLITUDE))
    return optimum(load_insect("hawkmoth"), HoverProblem(box=box)).stroke


def heave_trim(insects: Sequence[Insect]) -> HeaveTrim:
    """Trims of several insects under the default model, fields of shape (n,).

    Args:
        insects: scalar fields each.
    """
    model = HoverModel()
    trims = [_trim(insect, model) for insect in insects]
    stroke = Stroke(**{name: np.array([vars(one.stroke)[name] for one in trims]) for name in vars(trims[0].stroke)})
    rest = {name: np.array([vars(one)[name] for one in trims]) for name in vars(trims[0]) if name != "stroke"}
    return HeaveTrim(stroke=stroke, **rest)


def _trim(insect: Insect, model: HoverModel) -> HeaveTrim:
    """The trim of one insect."""
    frequency = insect.stroke.frequency
    stroke = dataclasses.replace(trim_waveform(), frequency=frequency)
    frequency = frequency / math.sqrt(evaluate(insect, stroke).weight_support)  # Λ ∝ f²
    stroke = dataclasses.replace(stroke, frequency=frequency)
    length, amplitude = float(insect.wing.length), float(stroke.flap_amplitude)
    tip_speed = 4 * frequency * amplitude * length
    return HeaveTrim(
        stroke=stroke,
        specific_power=evaluate(insect, stroke).specific_power,
        length=length,
        tip_speed=tip_speed,
        gravity=model.gravity / (frequency * tip_speed),
        reach=4 * amplitude,
    )
