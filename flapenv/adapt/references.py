"""What an agent is measured against: strokes and controllers that fly the same hidden draws with the same noise.

All of them beat waveforms whose averages L and S are known beforehand, so that a beat costs a few multiplications.

- The fixed stroke: one stroke for all conditions, the best there is on average.
- The felt-lift controller: one waveform, φmax ← φmax Λ̂^(-κ) (1 + margin), Λ̂ the weight support it felt.
- The ladder controller: h ← h Λ̂^(-κ) (1 + margin), h the place on the lift ladder, which it climbs knowing the nominal
  wing's optimum for every load: first by φmax, then by the waveform.
"""

from typing import Any, Protocol

import numpy as np

from flapenv.adapt.ladder import BOX
from flapenv.adapt.task import BEATS, NOISE, AdaptTask, Draws, Flight, choose
from flapenv.aero.arrays import Real
from flapenv.aero.checks import record
from flapenv.aero.parameters import StrokeReference
from flapenv.aero.wingbeat import speed_averages
from flapenv.case import HoverCase
from flapenv.coordinates import StrokeCoordinates
from flapenv.objective import QUADRATURE_TOLERANCE

COORDINATES = StrokeCoordinates(BOX)
"""Actions of the task: φmax and the waveform."""


@record
class Beats:
    """Strokes as wings feel them; arrays of shape (n,).

    Attributes:
        amplitude: φmax [rad].
        lift: L of the waveform [-].
        power: S of the waveform [-].
    """

    amplitude: np.ndarray
    lift: np.ndarray
    power: np.ndarray


def beats_of(actions: np.ndarray) -> Beats:
    """What strokes at points of the cube amount to, shape (..., 5) in, fields of shape (...) out."""
    values, _ = COORDINATES.decode(np.asarray(actions, dtype=float), StrokeReference(1.0, 1.0))
    del values["frequency"]
    amplitude = values.pop("flap_amplitude")
    lift, power = speed_averages(**values, rule=BOX.time_rule(tolerance=QUADRATURE_TOLERANCE))
    return Beats(amplitude=np.asarray(amplitude), lift=np.asarray(lift), power=np.asarray(power))


class Controller(Protocol):
    """Something that beats in every row and may listen to what it felt; made at the beginning of an episode."""

    def beats(self) -> Beats:
        """The strokes of the next beat."""

    def feel(self, weight_support: np.ndarray, mask: np.ndarray) -> None:
        """Take in the felt weight support of the last beat in the rows of the mask."""

    def carry(self, mask: np.ndarray, before: Any) -> None:
        """Go on where another of the same kind stands, in the rows of the mask."""


class FixedStroke:
    """The same stroke on every beat."""

    kept = ()

    def __init__(self, beats: Beats) -> None:
        """Take the strokes, of every row (n,) or of all."""
        self._beats = beats

    def beats(self) -> Beats:
        """The stroke."""
        return self._beats

    def feel(self, weight_support: np.ndarray, mask: np.ndarray) -> None:
        """Nothing to learn."""

    def carry(self, mask: np.ndarray, before: Any) -> None:
        """Nothing to remember."""


class FeltLift:
    """φmax ← φmax Λ̂^(-κ) (1 + margin), within the box, at one waveform."""

    kept = ("_amplitude",)

    def __init__(self, beats: Beats, gain: Real, margin: Real) -> None:
        """Take the first stroke, κ and the margin, of every row (n,) or of all."""
        self._first, self._gain, self._margin = beats, gain, margin
        self._amplitude = np.array(beats.amplitude)

    def beats(self) -> Beats:
        """The waveform at the present φmax."""
        return Beats(amplitude=self._amplitude, lift=self._first.lift, power=self._first.power)

    def feel(self, weight_support: np.ndarray, mask: np.ndarray) -> None:
        """Correct φmax."""
        wanted = self._amplitude * weight_support**-self._gain * (1 + self._margin)
        low, high = BOX.bounds("flap_amplitude", StrokeReference(1.0, 1.0))
        self._amplitude = np.where(mask, np.clip(wanted, low, high), self._amplitude)

    def carry(self, mask: np.ndarray, before: "FeltLift") -> None:
        """Take over φmax."""
        self._amplitude = np.where(mask, before._amplitude, self._amplitude)


class LadderClimber:
    """h ← h Λ̂^(-κ) (1 + margin), within the ladder; h is the weight support that the nominal wing would have."""

    kept = ("_height",)

    def __init__(self, task: AdaptTask, index: np.ndarray, height: Real, gain: Real, margin: Real) -> None:
        """Take the insect of every row (n,), and the first place, κ and the margin, of every row or of all."""
        self._task, self._gain, self._margin = task, gain, margin
        self._height = np.array(height)
        self._nominal: HoverCase = task.nominal.rows(index)
        self._full = task.ladder.full_lift(self._nominal, task.model)

    def beats(self) -> Beats:
        """The cheapest stroke of the place."""
        rung = self._task.ladder.rung(self._nominal, self._task.model, self._height / self._full)
        return Beats(amplitude=rung.flap_amplitude, lift=rung.lift, power=rung.power)

    def feel(self, weight_support: np.ndarray, mask: np.ndarray) -> None:
        """Climb or descend."""
        wanted = self._height * weight_support**-self._gain * (1 + self._margin)
        top = self._full * self._task.ladder.largest_lift
        self._height = np.where(mask, np.minimum(wanted, top), self._height)

    def carry(self, mask: np.ndarray, before: "LadderClimber") -> None:
        """Take over the place."""
        self._height = np.where(mask, before._height, self._height)


def beat_reward(task: AdaptTask, flight: Flight, beats: Beats) -> tuple[np.ndarray, np.ndarray]:
    """Reward and true weight support of a beat, shape (n,) each [-]."""
    weight_support, specific_power, _ = task.loads(flight.case, beats.amplitude, beats.lift, beats.power)
    return task.reward_terms(flight, weight_support, specific_power)[0], weight_support


@record
class Trials:
    """Hidden draws on which controllers are tuned or compared.

    Attributes:
        index: which insect each of them is, shape (n,).
        draws: their conditions.
        flights: what the conditions amount to, before the change and after it.
        noise: what is felt over what is, shape (BEATS, n) [-].
    """

    index: np.ndarray
    draws: Draws
    flights: tuple[Flight, Flight]
    noise: np.ndarray


def trials(task: AdaptTask, index: np.ndarray, rng: np.random.Generator) -> Trials:
    """Draw conditions and noise for rows.

    Args:
        task: the insects.
        index: which each row is, shape (n,).
        rng: what they are drawn from.
    """
    draws = task.draw(rng, index)
    flights = task.flight(index, draws.before), task.flight(index, draws.after)
    noise = np.exp(NOISE * rng.standard_normal((BEATS, len(index))))
    return Trials(index=index, draws=draws, flights=flights, noise=noise)


def fly_beats(task: AdaptTask, controller: Controller, given: Trials) -> tuple[np.ndarray, np.ndarray]:
    """Rewards and true weight support of a controller beat by beat, shape (BEATS, n) each [-].

    Args:
        task: the insects.
        controller: for as many rows, at its beginning.
        given: the draws.
    """
    everyone = np.ones(len(given.index), dtype=bool)
    before, after = given.flights
    rewards, lifted = np.zeros((2, BEATS, len(given.index)))
    for beat in range(BEATS):
        flight = choose(beat < given.draws.change_beat, before, after)
        rewards[beat], lifted[beat] = beat_reward(task, flight, controller.beats())
        controller.feel(lifted[beat] * given.noise[beat], everyone)
    return rewards, lifted


def fly(task: AdaptTask, controller: Controller, given: Trials) -> np.ndarray:
    """Undiscounted returns of a controller, shape (n,) [-]; arguments as in `fly_beats`."""
    return np.sum(fly_beats(task, controller, given)[0], axis=0)


def best_returns(given: Trials) -> np.ndarray:
    """Returns of the optimum with full knowledge, beat by beat, shape (n,) [-]."""
    before, after = given.flights
    first = np.minimum(given.draws.change_beat, BEATS)
    return first * before.best_reward + (BEATS - first) * after.best_reward


def fixed_returns(task: AdaptTask, beats: Beats, given: Trials) -> np.ndarray:
    """Returns of fixed strokes, without flying beat by beat; the same as `fly` gives, shape (n,) [-]."""
    first = np.minimum(given.draws.change_beat, BEATS)
    before, after = (beat_reward(task, flight, beats)[0] for flight in given.flights)
    return first * before + (BEATS - first) * after
