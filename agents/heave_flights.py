"""Any policy of Heave-v0 flown through the same gusts, and compared with a front of controllers at equal height."""

from collections.abc import Callable, Sequence
from typing import Any

import numpy as np

from agents.predictor import begin
from flapenv.aero.checks import record, require_count, shown
from flapenv.envs.heave_batch import HeaveVectorEnv

Policy = Callable[[np.ndarray], np.ndarray]
"""Observations (rows, n) in, actions (rows, 5) out; `start()`, where it has one, is called before an episode."""
EPISODES = 256
RESAMPLES = 2000
CONFIDENCE = 0.95


@record
class Flights:
    """What a policy did in many episodes; arrays of shape (episodes,).

    Attributes:
        power_excess: mean of P*/P*_hover - 1 over the beats flown, what the motion at the end is worth taken off [-].
        square_height: mean of (z/R)² over them [-].
        beats: flown before the end.
        lost: whether the row left the band.
        returns: sum of the rewards.
    """

    power_excess: np.ndarray
    square_height: np.ndarray
    beats: np.ndarray
    lost: np.ndarray
    returns: np.ndarray

    @property
    def rms_height(self) -> float:
        """√⟨(z/R)²⟩ over all episodes [-]."""
        return float(np.sqrt(np.mean(self.square_height)))

    @property
    def mean_power_excess(self) -> float:
        """Mean of P*/P*_hover - 1 over all episodes [-]."""
        return float(np.mean(self.power_excess))


@record
class FrontComparison:
    """A policy beside a front at equal rms height.

    Attributes:
        rms_height: of the policy [R].
        power_excess: of the policy [-].
        front_power_excess: of the front at the policy's rms height [-]; at its nearer end where it lies beyond.
        difference: of the two; negative where the policy needs less [-].
        interval: of the difference, 95 % by bootstrap over the episodes, which both flew through the same gusts [-].
        inside: whether the policy's rms height lies within the front's.
        lost: episodes in which the policy left the band; with any, power and height are those of what was flown.
    """

    rms_height: float
    power_excess: float
    front_power_excess: float
    difference: float
    interval: tuple[float, float]
    inside: bool
    lost: int


def fly(
    policy: Policy,
    *,
    episodes: int = EPISODES,
    seed: int = 0,
    options: dict[str, Any] | None = None,
    **arguments: Any,
) -> Flights:
    """Fly a policy through whole episodes; those of one seed have the same insects, starts and gusts for every policy.

    Args:
        policy: observations to actions, noise-free; NumPy arrays.
        episodes: rows of the batch, one episode each.
        seed: of the batch.
        options: of its reset, such as the insect of each row.
        **arguments: of `HeaveVectorEnv`, such as insect.

    Raises:
        TypeError: for a count that is not a whole number, infos, which are its own, or what the environment refuses.
    """
    require_count("episodes", episodes)
    if "infos" in arguments:
        raise TypeError(f"infos = {shown(arguments['infos'])} is not an argument here; allowed: leave it out")
    env = HeaveVectorEnv(episodes, infos=["power_excess", "height_ratio", "reward/end"], **arguments)
    observations, _ = env.reset(seed=seed, options=options)
    begin(policy)
    flying, lost = np.ones(episodes, dtype=bool), np.zeros(episodes, dtype=bool)
    power, square, beats, returns = np.zeros((4, episodes))
    for _ in range(env.beats):
        observations, rewards, terminated, truncated, info = env.step(policy(observations))
        beats += flying
        returns += np.where(flying, rewards, 0)
        power += np.where(flying, info["power_excess"] - info["reward/end"], 0)
        square += np.where(flying, info["height_ratio"], 0) ** 2
        lost |= flying & terminated
        flying &= ~(terminated | truncated)
        if not flying.any():
            break
    return Flights(power_excess=power / beats, square_height=square / beats, beats=beats, lost=lost, returns=returns)


def compare_with_front(flights: Flights, front: Sequence[Flights], *, seed: int = 0) -> FrontComparison:
    """The policy's power against the front's at equal rms height, linear in the logarithm of height between points.

    Args:
        flights: of the policy.
        front: of the controllers, through the same gusts, at least two.
        seed: of the bootstrap.

    Raises:
        ValueError: for a front of one point, or of other numbers of episodes.
    """
    count = len(flights.beats)
    if len(front) < 2 or any(len(one.beats) != count for one in front):
        raise ValueError(
            f"front has flights of {[len(one.beats) for one in front]} episodes; allowed: two or more of {count} each"
        )
    rng = np.random.default_rng(seed)
    shares = rng.multinomial(count, np.full(count, 1 / count), size=RESAMPLES) / count
    shares = np.concatenate([np.full((1, count), 1 / count), shares])  # the first is the sample itself
    every = [flights, *front]
    square = shares @ np.stack([one.square_height for one in every], axis=1)
    power = shares @ np.stack([one.power_excess for one in every], axis=1)
    level = 0.5 * np.log(np.maximum(square, 1e-30))
    chosen = 1 + _undominated(level[0, 1:], power[0, 1:])
    there = np.empty(len(level))
    for number, (x, p) in enumerate(zip(level, power, strict=True)):
        rising = chosen[np.argsort(x[chosen])]  # a resample may order the front anew
        there[number] = np.interp(x[0], x[rising], p[rising])
    difference = power[:, 0] - there
    tail = 50 * (1 - CONFIDENCE)
    low, high = np.percentile(difference[1:], [tail, 100 - tail])
    return FrontComparison(
        rms_height=float(np.exp(level[0, 0])),
        power_excess=float(power[0, 0]),
        front_power_excess=float(there[0]),
        difference=float(difference[0]),
        interval=(float(low), float(high)),
        inside=bool(level[0, chosen[0]] <= level[0, 0] <= level[0, chosen[-1]]),
        lost=int(np.sum(flights.lost)),
    )


def _undominated(level: np.ndarray, power: np.ndarray) -> np.ndarray:
    """Points that no other beats in both, by rising level."""
    order = np.argsort(level)
    least = np.minimum.accumulate(np.concatenate([[np.inf], power[order][:-1]]))
    return order[power[order] < least]
