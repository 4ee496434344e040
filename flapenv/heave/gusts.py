"""Vertical gusts, one value a beat: first-order autoregressive, the same for an episode whatever is done in it.

    g_{k+1} = φ g_k + σ √(1 - φ²) ξ_k,   φ = e^(-1/correlation),   g_0 = σ ξ

Every episode of every row draws from a stream of its own, SplitMix64 (Steele, Lea & Flood 2014, OOPSLA) begun at a
number made of the batch's key, the row and the episode; nothing that happens in other rows or in earlier episodes
shifts it, so that two policies meet the same gusts.
"""

import math
from collections.abc import Mapping
from enum import IntEnum

import numpy as np

from flapenv.aero.checks import record, require_scalar

GOLDEN = np.uint64(0x9E3779B97F4A7C15)
"""Step of SplitMix64, 2⁶⁴ over the golden ratio."""
LARGEST_GUST = 5.0
"""Gusts are cut at this many σ: once in two million beats, and what is felt has a bound."""


@record
class GustModel:
    """Strength and persistence of the gusts.

    Attributes:
        strength: σ of w_g/U [-], >= 0.
        correlation: beats after which the correlation has fallen to 1/e, > 0.
    """

    strength: float = 0.02
    correlation: float = 20.0

    def __post_init__(self) -> None:
        """Check both."""
        object.__setattr__(self, "strength", require_scalar("gust strength", self.strength, 0.0, 0.1))
        low, high = 1e-3, 1e6
        object.__setattr__(self, "correlation", require_scalar("gust correlation", self.correlation, low, high))

    @property
    def persistence(self) -> float:
        """φ of the recursion [-]."""
        return math.exp(-1 / self.correlation)

    @property
    def innovation(self) -> float:
        """σ √(1 - φ²), the standard deviation of what is added a beat [-]."""
        return self.strength * math.sqrt(-math.expm1(-2 / self.correlation))

    def first(self, normal: np.ndarray) -> np.ndarray:
        """Gusts of first beats from standard normal numbers, of the stationary distribution."""
        return self.strength * np.clip(normal, -LARGEST_GUST, LARGEST_GUST)

    def following(self, gust: np.ndarray, normal: np.ndarray) -> np.ndarray:
        """Gusts of the beats after those with `gust`."""
        after = self.persistence * gust + self.innovation * normal
        return np.clip(after, -LARGEST_GUST * self.strength, LARGEST_GUST * self.strength)


def as_gusts(value: GustModel | Mapping[str, float] | None) -> GustModel:
    """A `GustModel` from itself, the dict of its fields, or None for the default.

    Raises:
        TypeError: for anything else.
    """
    if value is None:
        return GustModel()
    if isinstance(value, Mapping):
        return GustModel(**value)
    if isinstance(value, GustModel):
        return value
    raise TypeError(f"gusts = {value!r} are not allowed; allowed: a GustModel, a dict of its fields, or None")


class Place(IntEnum):
    """Where in an episode's stream of random numbers each thing is drawn; a normal number takes two places."""

    INSECT = 0
    HEIGHT = 1
    VELOCITY = 2
    FIRST_GUST = 3
    LATER_GUSTS = 5
    PER_GUST = 2


class EpisodeStreams:
    """Random numbers of each row's episode, by their place in it."""

    kept = ("_key", "_episode", "_seed")

    def __init__(self, rows: int) -> None:
        """Begin without a key; `begin` sets it."""
        self._number = np.arange(1, rows + 1, dtype=np.uint64)
        self._key, self._episode, self._seed = np.zeros((3, rows), dtype=np.uint64)

    def begin(self, mask: np.ndarray, key: int | None) -> None:
        """Begin another episode in the rows of `mask`; with a key, the first of its series."""
        if key is not None:
            self._key[mask] = np.uint64(key)
            self._episode[mask] = 0
        self._episode[mask] += np.uint64(1)
        row = _mixed(self._key + GOLDEN * self._number)
        self._seed[mask] = _mixed(row + GOLDEN * self._episode)[mask]

    def uniform(self, place: int | np.ndarray) -> np.ndarray:
        """A number in (0, 1) of each row, shape (rows,); `place` counts from 0, one for all or one for each."""
        count = np.atleast_1d(place).astype(np.uint64) + np.uint64(1)  # arrays wrap around without a warning
        bits = _mixed(self._seed + GOLDEN * count) >> np.uint64(11)
        return (bits.astype(float) + 0.5) * 2.0**-53

    def normal(self, place: int | np.ndarray) -> np.ndarray:
        """A standard normal number of each row, shape (rows,), by Box & Muller from `place` and the one after it."""
        radius = np.sqrt(-2 * np.log(self.uniform(place)))
        return radius * np.cos(2 * math.pi * self.uniform(np.asarray(place) + 1))


def _mixed(bits: np.ndarray) -> np.ndarray:
    """The finalizer of SplitMix64."""
    bits = (bits ^ (bits >> np.uint64(30))) * np.uint64(0xBF58476D1CE4E5B9)
    bits = (bits ^ (bits >> np.uint64(27))) * np.uint64(0x94D049BB133111EB)
    return bits ^ (bits >> np.uint64(31))
