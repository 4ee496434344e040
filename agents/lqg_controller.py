"""Linear-quadratic-Gaussian control of height in Heave-v0, with integral action.

The controller sees what an agent sees (height, velocity, the last weight support) and steers within the same box. Its
Kalman filter holds the gust as a state, which it infers from how the body answered the last beat; its regulator holds
the integral of height. Of the five inputs it uses φmax alone: the other four hover on the edge of their box or, as the
pitch phase, where lift has no slope, so that to first order they cannot push both ways, and every step they take from
there costs power that φmax would not.
"""

from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from flapenv.aero.checks import record
from flapenv.envs.heave_batch import SUPPORT_UNIT, VELOCITY_UNIT
from flapenv.heave.dynamics import HeaveDynamics
from flapenv.heave.gusts import GustModel
from flapenv.heave.linear import LinearBeat, linear_beat
from flapenv.insects import Insect, as_insect

INPUT = "flap_amplitude"
INTEGRAL_WEIGHT = 1e-3
"""Of (Σ z/R)² beside (z/R)²: takes some 30 beats to remove what linear theory does not foresee."""
MEASUREMENT_NOISE, MODEL_NOISE = 1e-9, 1e-6
"""Standard deviations the filter assumes of its measurements, which are exact, and of the linear model beside the gust:
enough to keep its equation well posed."""


@record
class Design:
    """Gains of one controller.

    Attributes:
        beat: the linear beat map.
        axis: of the action that it steers.
        transition: of the filter's state (z/R, w/U, w_g/U, last Λ - 1), shape (4, 4).
        entry: of the input into it, shape (4,).
        filter_gain: from the surprise in (z/R, w/U, last Λ - 1) to that state, shape (4, 3).
        feedback: from (z/R, w/U, w_g/U, Σ z/R) to the input, shape (4,).
    """

    beat: LinearBeat
    axis: int
    transition: np.ndarray
    entry: np.ndarray
    filter_gain: np.ndarray
    feedback: np.ndarray


def design(insect: Insect | str, ratio: float, gusts: GustModel | None = None) -> Design:
    """Solve both Riccati equations for one insect.

    Args:
        insect: scalar fields, or a name.
        ratio: weight of the input over that of (z/R)².
        gusts: what the filter expects.

    Source: Anderson & Moore (1979), Optimal Filtering; Stengel (1994), Optimal Control and Estimation, chapter 6.
    """
    from scipy.linalg import solve_discrete_are

    gusts = gusts or GustModel()
    dynamics = HeaveDynamics([as_insect(insect)])
    beat, axis = linear_beat(dynamics, 0), dynamics.coordinates.names.index(INPUT)
    transition, entry = np.zeros((4, 4)), np.zeros(4)
    transition[[0, 1, 3], :3] = beat.by_state[:3]
    transition[2, 2] = gusts.persistence
    entry[[0, 1, 3]] = beat.by_action[:3, axis]

    seen = np.eye(4)[[0, 1, 3]]
    noise = np.diag([0.0, 0.0, max(gusts.innovation, 1e-6) ** 2, 0.0]) + MODEL_NOISE**2 * np.eye(4)
    scatter = MEASUREMENT_NOISE**2 * np.eye(3)
    spread = solve_discrete_are(transition.T, seen.T, noise, scatter)
    filter_gain = np.linalg.solve(seen @ spread @ seen.T + scatter, seen @ spread).T

    steered = np.eye(4)
    steered[:3, :3] = transition[:3, :3]
    steered[3] = (1.0, 0.0, 0.0, 1.0)
    push = np.array([entry[0], entry[1], 0.0, 0.0])[:, None]
    weights = np.diag([1.0, 0.0, 0.0, INTEGRAL_WEIGHT])
    price = np.array([[ratio]])
    cost = solve_discrete_are(steered, push, weights, price)
    feedback = np.linalg.solve(push.T @ cost @ push + price, push.T @ cost @ steered)[0]
    return Design(beat=beat, axis=axis, transition=transition, entry=entry, filter_gain=filter_gain, feedback=feedback)


class Lqg:
    """A controller that flies many rows at once: observations in, actions out; `start` before each episode."""

    def __init__(self, made: Design) -> None:
        """Keep the gains."""
        self.design = made
        self._state: np.ndarray | None = None

    def start(self) -> None:
        """Forget the last episode."""
        self._state = None

    def __call__(self, observations: np.ndarray) -> np.ndarray:
        """Actions, shape (rows, 5), for observations of Heave-v0, shape (rows, n)."""
        made = self.design
        seen = observations[:, :3] * np.array([1.0, VELOCITY_UNIT, SUPPORT_UNIT])
        if self._state is None:
            rows = len(seen)
            self._state, self._sum = np.zeros((rows, 4)), np.zeros(rows)
            self._state[:, [0, 1, 3]] = seen
        else:
            self._state += (seen - self._state[:, [0, 1, 3]]) @ made.filter_gain.T
        base = made.beat.hover[made.axis]
        wanted = -np.column_stack([self._state[:, :3], self._sum]) @ made.feedback
        given = np.clip(base + wanted, -1, 1) - base
        self._sum += np.where(given == wanted, seen[:, 0], 0.0)  # the integral waits where the box has an end
        self._state = self._state @ made.transition.T + given[:, None] * made.entry
        actions = np.tile(made.beat.hover, (len(seen), 1))
        actions[:, made.axis] = base + given
        return actions


class OneEach:
    """Controllers side by side, each of the next rows of a batch; `start` before each episode."""

    def __init__(self, controllers: Sequence[Lqg], rows: int) -> None:
        """Take the controllers and how many rows each has."""
        self._controllers, self._rows = controllers, rows

    def start(self) -> None:
        """Forget the last episode."""
        for one in self._controllers:
            one.start()

    def __call__(self, observations: np.ndarray) -> np.ndarray:
        """Actions of all rows."""
        starts = range(0, len(observations), self._rows)
        parts = [
            one(observations[start : start + self._rows]) for one, start in zip(self._controllers, starts, strict=True)
        ]
        return np.concatenate(parts)


def lqg(insect: Insect | str, ratio: float, gusts: GustModel | None = None) -> Lqg:
    """The controller of one insect; arguments as in `design`."""
    return Lqg(design(insect, ratio, gusts))


def proportional_derivative(insect: Insect | str, ratio: float, gusts: GustModel | None = None) -> Lqg:
    """The same gains on height and velocity, without gust and integral; arguments as in `design`."""
    made = design(insect, ratio, gusts)
    return Lqg(replace(made, feedback=made.feedback * np.array([1.0, 1.0, 0.0, 0.0])))
