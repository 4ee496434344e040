"""Best free waveforms that come with the package, so that nothing is searched for when an environment is made.

A waveform contributes L, S and K, the same for every wing (`flapenv.aero.splines`). With plate coefficients, elastic
power and a k_tip that stays that of the reference stroke, wings therefore share their best waveforms (as in
`flapenv.many_optima`):

- f free and inside its bounds ("free"): P* at Λ = 1 is 2 A_P C_T A_L^(-3/2) (S + e K/2)/L^(3/2), so one waveform
  serves all wings of one e = C_D0/C_T, at the largest φmax.
- f and φmax fixed ("fixed"): the least S with L >= s, s = 1/(A_L v̄²), one number a wing.

The table is written by `python -m flapenv.waveform --data`.
"""

import csv
import functools
import importlib.resources
import math
from typing import NamedTuple

import numpy as np

from flapenv.aero.splines import spline_averages
from flapenv.case import HoverCase, lift_constant
from flapenv.problem import HoverProblem
from flapenv.waveform.coordinates import Waveform
from flapenv.waveform.performance import PRECISE_POINTS

FILE = "spline_optima.csv"
MATCH = 1e-6
"""A wing has a row's waveform where its e, its s and its limit of |θ| are the row's to this."""
COLUMNS = (
    "kind",
    "problem",
    "insect",
    "knots",
    "pitch_limit_rad",
    "drag_ratio",
    "needed_lift",
    "cost_of_lift",
    "speed_coefficients",
    "pitch_coefficients_rad",
)


class ShippedWaveform(NamedTuple):
    """One row of the table.

    Attributes:
        kind: "free" or "fixed".
        problem: the problem it was found in.
        insect: the insect it was found with.
        knots: n.
        pitch_limit: largest |θ| [rad].
        drag_ratio: e [-].
        needed_lift: s; 0 where the frequency is free [-].
        cost_of_lift: (L/P) dP/dL of the constrained optimum, with P = S + e K/2 [-].
        speed_coefficients: w, shape (n,) [-].
        pitch_coefficients: shape (n,) [rad].
    """

    kind: str
    problem: str
    insect: str
    knots: int
    pitch_limit: float
    drag_ratio: float
    needed_lift: float
    cost_of_lift: float
    speed_coefficients: tuple[float, ...]
    pitch_coefficients: tuple[float, ...]

    @property
    def numbers(self) -> tuple[float, float]:
        """L and S + e K/2 [-]."""
        speed, pitch = np.array(self.speed_coefficients), np.array(self.pitch_coefficients)
        lift, power, friction, _ = spline_averages(speed, pitch, points=PRECISE_POINTS)
        return float(lift), float(power + self.drag_ratio / 2 * friction)


class KnownOptimum(NamedTuple):
    """The least power of a wing on n knots.

    Attributes:
        specific_power: P* [W/kg].
        multiplier: dP*/dΛ [W/kg].
        waveform: its wingbeat.
    """

    specific_power: float
    multiplier: float
    waveform: Waveform


@functools.lru_cache(maxsize=1)
def shipped_waveforms() -> tuple[ShippedWaveform, ...]:
    """All rows of the table."""
    text = importlib.resources.files("flapenv").joinpath("data", FILE).read_text(encoding="utf-8")
    rows = []
    for row in csv.DictReader(line for line in text.splitlines() if not line.startswith("#")):
        speed, pitch = (tuple(map(float, row[name].split())) for name in COLUMNS[-2:])
        limit, ratio, needed, cost = (float(row[name]) for name in COLUMNS[4:8])
        label = row["kind"], row["problem"], row["insect"], int(row["knots"])
        rows.append(ShippedWaveform(*label, limit, ratio, needed, cost, speed, pitch))
    return tuple(rows)


def wants(case: HoverCase, problem: HoverProblem) -> tuple[str, float, float] | None:
    """Which waveform one wing wants: "free" or "fixed", e and s; None where no wing shares its waveform with others."""
    model, box = problem.model, problem.box
    if not model.has_proven_bound or model.tip_loss != "reference":
        return None
    (_, frequency), (_, amplitude) = (box.bounds(name, case.reference) for name in ("frequency", "flap_amplitude"))
    speed = 4 * float(frequency) * float(amplitude)
    constant = float(lift_constant(case, model, speed, amplitude))
    ratio = model.profile_drag / constant
    if box.is_free("frequency"):
        return "free", ratio, 0.0
    if box.is_free("flap_amplitude"):
        return None
    return "fixed", ratio, 1 / (float(case.lift_scale) * constant * speed**2)


def known_optimum(case: HoverCase, problem: HoverProblem, knots: int) -> KnownOptimum | None:
    """The least power of one wing on n knots where the table has its waveform, else None."""
    wanted = wants(case, problem)
    if wanted is None:
        return None
    kind, ratio, needed = wanted
    limit = problem.box.pitch_amplitude[1]
    for row in shipped_waveforms():
        same = row.kind == kind and row.knots == knots
        pairs = (row.pitch_limit, limit), (row.drag_ratio, ratio), (row.needed_lift, needed)
        if same and all(abs(one - other) <= MATCH * abs(other) for one, other in pairs):
            return _on(row, case, problem)
    return None


def _on(row: ShippedWaveform, case: HoverCase, problem: HoverProblem) -> KnownOptimum | None:
    """A row's waveform on a wing that wants it; None where its frequency lies outside the bounds."""
    (lowest, highest), (_, amplitude) = (
        problem.box.bounds(name, case.reference) for name in ("frequency", "flap_amplitude")
    )
    lift, power = row.numbers
    constant = float(lift_constant(case, problem.model, 4 * float(highest) * float(amplitude), amplitude))
    scale = float(case.lift_scale) * constant * (4 * float(amplitude)) ** 2 * lift
    frequency = 1 / math.sqrt(scale) if row.kind == "free" else float(highest)
    if not lowest <= frequency <= highest:
        return None
    speed = 4 * frequency * float(amplitude)
    specific_power = 2 * float(case.power_scale) * constant * speed**3 * power
    return KnownOptimum(
        specific_power=specific_power,
        multiplier=row.cost_of_lift * specific_power,
        waveform=Waveform(
            np.array(frequency),
            np.array(float(amplitude)),
            np.array(row.speed_coefficients),
            np.array(row.pitch_coefficients),
        ),
    )
