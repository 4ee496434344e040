"""The adaptation task: conditions drawn and changed, what each of them costs at best, and the reward of a beat."""

import dataclasses
from typing import Any

import numpy as np

from flapenv.adapt.conditions import DENSITY_RATIO, NOMINAL, PAYLOAD, SPAN_LOST, Condition, ConditionTable
from flapenv.adapt.ladder import BOX, lift_ladder
from flapenv.aero.checks import record, shown
from flapenv.case import HoverCase, lift_constant
from flapenv.insects import Insect
from flapenv.model import warn_of_aspect_ratio
from flapenv.objective import LEAST_PENALTY
from flapenv.optimum import lower_bound
from flapenv.problem import HoverProblem

BEATS = 20
"""Wingbeats of an episode, a horizon that is part of the task."""
CHANGE = (5, 15)
"""Beats flown before the condition changes, both ends included."""
FREQUENCY_RATIO = 1.15
"""The fixed frequency over the one of problem A's optimum."""
LEAST_MARGIN = 1.05
"""Largest weight support of the box in every condition that is drawn."""
NOISE = 0.02
"""Standard deviation of the logarithm of what is felt over what is."""
PROBLEM = HoverProblem(name="adapt", box=BOX)
"""The box, the coefficients, and the floor of a beat's reward."""


@record
class Flight:
    """What flying in a condition amounts to; arrays of shape (n,), or fields of the case that hold none.

    Attributes:
        case: the numbers behind Λ and P* per kilogram carried, the task's frequency as the reference.
        reference_power: the proven lower bound of P* in this box and condition [W/kg].
        best_power: P* of the optimum [W/kg].
        multiplier: dP*/dΛ of the optimum [W/kg].
        lift_penalty: λ, the price of missing weight support in units of `reference_power` [-].
        max_weight_support: Λ_max, the largest Λ of the box [-].
    """

    case: HoverCase
    reference_power: np.ndarray
    best_power: np.ndarray
    multiplier: np.ndarray
    lift_penalty: np.ndarray
    max_weight_support: np.ndarray

    def cast(self, dtype: Any) -> "Flight":
        """The same in another floating type."""
        return _apply(lambda value: np.asarray(value, dtype=dtype), self)

    @property
    def best_reward(self) -> np.ndarray:
        """What the optimum is paid a beat [-]."""
        return -self.best_power / self.reference_power


def choose(mask: np.ndarray, yes: Any, no: Any) -> Any:
    """Row by row one of two records of the same kind, `yes` where the mask holds; what has no rows is `no`'s."""
    return _apply(lambda a, b: np.where(mask, a, b) if np.shape(a) == mask.shape else b, yes, no)


def _apply(function: Any, first: Any, *rest: Any) -> Any:
    """A record made of the fields of others, and of records in them."""
    if not dataclasses.is_dataclass(first):
        return function(first, *rest)
    names = [field.name for field in dataclasses.fields(first)]
    kind: Any = type(first)
    return kind(**{name: _apply(function, *(getattr(one, name) for one in (first, *rest))) for name in names})


@record
class Draws:
    """Hidden conditions of episodes; arrays of shape (n,).

    Attributes:
        before: the condition at first.
        after: the condition from the change on.
        change_beat: beats flown before the change; `BEATS` or more for none.
    """

    before: Condition
    after: Condition
    change_beat: np.ndarray


class AdaptTask:
    """The task for a set of insects: their frequencies, their conditions, and what these cost."""

    def __init__(self, insects: tuple[Insect, ...]) -> None:
        """Fix the frequencies and interpolate the conditions.

        Args:
            insects: scalar fields, each able to hover in problem A.

        Raises:
            ValueError: for an insect that cannot hover in problem A. One that can has Λ_max >= 1.15² here without any
                burden, and conditions to draw from.
        """
        self.insects, self.model, self.ladder = insects, PROBLEM.model, lift_ladder()
        for insect in insects:
            warn_of_aspect_ratio(insect.name, insect.wing.aspect_ratio, self.model, stacklevel=3)
        self.table = ConditionTable(insects, self.model)
        self.frequency = FREQUENCY_RATIO * self._best_frequency()
        self.nominal = self.cases(np.arange(len(insects)), NOMINAL)

    def _best_frequency(self) -> np.ndarray:
        """The frequency of problem A's optimum, at the largest amplitude with the ladder's first waveform [Hz].

        `optimum` finds the same; here it is free.
        """
        case, ladder = self.table.nominal, self.ladder
        low, high = HoverProblem().box.bounds("frequency", case.reference)
        largest = ladder.full_lift(dataclasses.replace(case, reference_frequency=high), self.model)
        for insect, lift in zip(self.insects, largest * ladder.largest_lift, strict=True):
            if lift < 1:
                raise ValueError(
                    f"insect {shown(insect.name)} is not allowed: its largest weight support in problem A is "
                    f"{lift:.3f}; allowed: insects that can hover there"
                )
        return np.clip(high / np.sqrt(largest * ladder.lift[0]), low, high)

    def cases(self, index: np.ndarray, condition: Condition) -> HoverCase:
        """The cases of insects in conditions, at the task's frequency; arguments as in `flight`."""
        case = self.table.cases(index, condition)
        return dataclasses.replace(case, reference_frequency=self.frequency[index])

    def flight(self, index: np.ndarray, condition: Condition) -> Flight:
        """What conditions amount to.

        Args:
            index: which insect each row is, shape (n,).
            condition: fields of shape (n,) or scalars.
        """
        case, ladder = self.cases(index, condition), self.ladder
        full = ladder.full_lift(case, self.model)
        rung = ladder.rung(case, self.model, 1 / full)
        _, power, steepness = self.loads(case, rung.flap_amplitude, rung.lift, rung.power)
        bound = np.asarray(lower_bound(case, PROBLEM))
        on_curve = np.isfinite(rung.slope)
        lowest = rung.flap_amplitude <= ladder.amplitude[0]
        relative = np.where(on_curve, rung.slope * rung.lift / rung.power, np.where(lowest, 0.0, steepness))
        multiplier = power * relative
        return Flight(
            case=case,
            reference_power=bound,
            best_power=power,
            multiplier=multiplier,
            lift_penalty=np.maximum(LEAST_PENALTY, 2 * multiplier / bound),
            max_weight_support=full * ladder.largest_lift,
        )

    def loads(
        self, case: HoverCase, amplitude: np.ndarray, lift: np.ndarray, power: np.ndarray
    ) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        """Λ [-], P* [W/kg] and d log P*/d log Λ along φmax [-] of waveforms with the averages L and S.

        Args:
            case: fields of shape (n,).
            amplitude: φmax [rad], shape (n,).
            lift: L [-], shape (n,) or a scalar.
            power: S [-], shape (n,) or a scalar.
        """
        speed = 4 * case.reference_frequency * amplitude
        constant = lift_constant(case, self.model, speed, amplitude)
        ideal = lift_constant(dataclasses.replace(case, wing_factor=0.0 * case.wing_factor), self.model, speed, 1.0)
        growth = (1 - constant / ideal) / 2  # d log C_T/d log φmax, as 1/C_T grows with k_flap ∝ φmax^(-1/2)
        weight_support = case.lift_scale * constant * speed**2 * lift
        specific_power = 2 * case.power_scale * constant * speed**3 * power
        return weight_support, specific_power, (3 + growth) / (2 + growth)

    def reward_terms(
        self, flight: Flight, weight_support: np.ndarray, specific_power: np.ndarray
    ) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        """A beat's reward, and the terms of power and of lift that it is the sum of, but for the floor [-]."""
        power_term = -specific_power / flight.reference_power
        lift_term = -flight.lift_penalty * np.maximum(0, 1 - weight_support)
        return np.maximum(power_term + lift_term, PROBLEM.reward_floor), power_term, lift_term

    def draw(self, rng: np.random.Generator, index: np.ndarray) -> Draws:
        """Hidden conditions for rows, in row order; rows that cannot hover in both of theirs are drawn again.

        Args:
            rng: what they are drawn from.
            index: which insect each row is, shape (n,).
        """
        drawn = self._propose(rng, len(index))
        again = np.flatnonzero(~self._feasible(index, drawn))
        while again.size:
            fresh = self._propose(rng, again.size)
            drawn = _apply(lambda old, new, rows=again: _put(old, rows, new), drawn, fresh)
            again = again[~self._feasible(index[again], fresh)]
        return drawn

    def acceptance(self, rng: np.random.Generator, index: np.ndarray) -> float:
        """Share of proposed conditions that can be hovered in, before the change and after it; arguments as `draw`."""
        return float(np.mean(self._feasible(index, self._propose(rng, len(index)))))

    def _propose(self, rng: np.random.Generator, count: int) -> Draws:
        """Conditions within their ranges: one change, of the payload to any other or of the span to less."""
        shares = rng.random((count, 6)).T
        payload, density, lost, fresh = (
            low + (high - low) * share
            for (low, high), share in zip((PAYLOAD, DENSITY_RATIO, SPAN_LOST, PAYLOAD), shares[:4], strict=True)
        )
        damaged = shares[4] < 0.5
        worse = lost + (SPAN_LOST[1] - lost) * shares[3]
        first, last = CHANGE
        return Draws(
            before=Condition(payload=payload, density_ratio=density, span_lost=lost),
            after=Condition(
                payload=np.where(damaged, payload, fresh),
                density_ratio=density,
                span_lost=np.where(damaged, worse, lost),
            ),
            change_beat=first + np.floor(shares[5] * (last - first + 1)).astype(np.intp),
        )

    def _feasible(self, index: np.ndarray, draws: Draws) -> np.ndarray:
        """Whether the box lifts enough in both conditions, shape (n,)."""
        both = [
            self.ladder.full_lift(self.cases(index, condition), self.model) * self.ladder.largest_lift >= LEAST_MARGIN
            for condition in (draws.before, draws.after)
        ]
        return np.logical_and(*both)


def _put(old: np.ndarray, rows: np.ndarray, new: np.ndarray) -> np.ndarray:
    """A copy with other values in some rows."""
    changed = np.array(old)
    changed[rows] = new
    return changed
