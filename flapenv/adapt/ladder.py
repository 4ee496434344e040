"""The lift ladder: the cheapest strokes of a fixed frequency, in the order of the lift they give.

All that a waveform contributes to any wing is L = ⟨v² sin 2α⟩/v̄² and S = ⟨v³ sin² α⟩/v̄³ (`flapenv.shape_curve`), and at
a fixed frequency v̄ = 4 f φmax. At Λ = 1

    P* = 2 A_P C_T v̄³ S = 2 A_P C_T^(-1/2) A_L^(-3/2) S/L^(3/2),    A_L C_T v̄² L = 1,

with A_L and A_P free of C_T here. C_T grows with φmax. The least S/L^1.5 of the box belongs to one waveform, the
corner; along the curve of the least S for a given L it rises from there on. So the optimum is

- the corner, with the φmax that carries the weight, while that is not above the largest φmax;
- else the largest φmax, with the waveform of the least S that gives the lift still missing.

That is one sequence of strokes, the same for all wings but for how C_T runs with φmax. Its curved part is shipped
(`flapenv.adapt.rungs` writes it) and interpolated.
"""

import csv
import functools
import math
from importlib import resources

import numpy as np

from flapenv.aero.checks import record
from flapenv.aero.parameters import StrokeReference
from flapenv.case import HoverCase, lift_constant
from flapenv.model import HoverModel
from flapenv.problem import StrokeBox
from flapenv.shape_curve import Shapes

BOX = StrokeBox(frequency_ratio=(1.0, 1.0))
"""Problem A's box with the frequency fixed at what the case calls its reference frequency."""
RUNGS_FILE = "adapt_ladder.csv"
NEWTON_STEPS = 4
"""For φmax of a given lift; in logarithms the function is nearly straight."""


@record
class Rung:
    """Strokes of the ladder; arrays of one shape.

    Attributes:
        flap_amplitude: φmax [rad].
        lift: L of the waveform [-].
        power: S of the waveform [-].
        slope: dS/dL along the ladder where φmax is at its bound; nan below it [-].
    """

    flap_amplitude: np.ndarray
    lift: np.ndarray
    power: np.ndarray
    slope: np.ndarray


class LiftLadder:
    """The cheapest waveforms by their lift, and with them the optimum of any wing at a fixed frequency."""

    def __init__(self) -> None:
        """Read the shipped waveforms and evaluate them."""
        from scipy.interpolate import PchipInterpolator

        with resources.files("flapenv").joinpath("data", RUNGS_FILE).open(encoding="utf-8") as file:
            rows = list(csv.DictReader(file))
        shapes = Shapes(BOX)
        self.points = np.array([[float(row[name]) for name in shapes.coordinates.names] for row in rows])
        self._shapes = shapes
        lift, power = shapes.numbers(self.points)
        self.lift, self.power = np.asarray(lift), np.asarray(power)
        self._curve = PchipInterpolator(self.lift, self.power)
        self._slope = self._curve.derivative()
        self.amplitude = BOX.bounds("flap_amplitude", StrokeReference(1.0, 1.0))

    @property
    def largest_lift(self) -> float:
        """L of the last rung, the largest of the box [-]."""
        return float(self.lift[-1])

    def full_lift(self, case: HoverCase, model: HoverModel) -> np.ndarray:
        """Λ per unit of L at the largest φmax, A_L C_T v̄² there [-]."""
        highest = self.amplitude[1]
        speed = 4 * case.reference_frequency * highest
        return np.asarray(case.lift_scale * lift_constant(case, model, speed, highest) * speed**2)

    def rung(self, case: HoverCase, model: HoverModel, lift: np.ndarray) -> Rung:
        """The cheapest strokes of a weight support.

        Args:
            case: the wings, frequency fixed at `reference_frequency`, fields of shape (n,).
            model: the coefficients.
            lift: Λ wanted over what the wing gives per unit of L at the largest φmax, shape (n,) [-]; beyond the
                ends of the ladder its end.
        """
        corner, highest = self.lift[0], self.amplitude[1]
        wanted = np.minimum(lift, self.largest_lift)
        growth = amplitude_growth(case, model)
        amplitude = highest * _amplitude(np.minimum(wanted / corner, 1.0), growth)
        on_curve = wanted > corner
        height = np.where(on_curve, wanted, corner)
        return Rung(
            flap_amplitude=np.where(on_curve, highest, np.maximum(amplitude, self.amplitude[0])),
            lift=height,
            power=self._curve(height),
            slope=np.where(on_curve, self._slope(height), np.nan),
        )

    def waveform(self, lift: np.ndarray) -> dict[str, np.ndarray]:
        """Fields of the waveforms that give L, between the rungs on a straight line; shape (n,) each."""
        axes = [np.interp(lift, self.lift, column) for column in self.points.T]
        return {name: np.asarray(value) for name, value in self._shapes.values(np.stack(axes, axis=-1)).items()}


def amplitude_growth(case: HoverCase, model: HoverModel) -> np.ndarray:
    """B = k_ind k_tip a/(π AR E), so that C_T ∝ 1/(1 + b √(90°/φmax)) [-]  (2.9), (2.10)."""
    return np.asarray(
        case.wing_factor * model.section_lift_slope / (math.pi * case.aspect_ratio * case.edge_correction)
    )


def _amplitude(share: np.ndarray, growth: np.ndarray) -> np.ndarray:
    """φmax over 90° at which C_T φmax² is a share of what it is at 90°: x⁵ (1+b)/(x+b) = share, x = √(φmax/90°)."""
    share = np.maximum(share, np.finfo(float).tiny)
    root = share**0.23
    for _ in range(NEWTON_STEPS):
        excess = 5 * np.log(root) + np.log1p(growth) - np.log(root + growth) - np.log(share)
        root = root * np.exp(-excess / (5 - root / (root + growth)))
    return root**2


@functools.lru_cache(maxsize=1)
def lift_ladder() -> LiftLadder:
    """The ladder, read once."""
    return LiftLadder()
