"""The references that fly beside every row of an environment, on the same conditions with the same noise."""

from collections.abc import Sequence

import numpy as np

from flapenv.adapt.references import (
    COORDINATES,
    Beats,
    Controller,
    FeltLift,
    FixedStroke,
    LadderClimber,
    beat_reward,
    beats_of,
)
from flapenv.adapt.task import AdaptTask, Flight
from flapenv.adapt.tuning import NAMES, Tuned

UNTUNED = Tuned(
    fixed_action=(0.0,) * len(COORDINATES),
    felt_action=(0.0,) * len(COORDINATES),
    felt_gain=0.0,
    felt_margin=0.0,
    ladder_height=1.0,
    ladder_gain=0.0,
    ladder_margin=0.0,
)
"""Fills the rows of insects without references, whose returns are not shown."""


class Company:
    """The optimum with full knowledge, and where they are wanted the tuned references, with their returns so far.

    Attributes:
        returns: sums of rewards since each row's episode began by the names of `flapenv.adapt.tuning.NAMES`, shape
            (rows,) each [-].
        known: of every insect, whether the tuned references fly with it.
    """

    kept = ("controllers", "returns")

    def __init__(self, task: AdaptTask, tuned: Sequence[Tuned | None], rows: int, *, wanted: bool) -> None:
        """Take the references of every insect of the task; None where there are none but the optimum."""
        self._task, self._wanted = task, wanted
        self.known = np.array([wanted and one is not None for one in tuned])
        filled = [one or UNTUNED for one in tuned]
        self._tuned = {name: np.array([getattr(one, name) for one in filled]) for name in vars(UNTUNED)}
        self._fixed, self._felt = (beats_of(self._tuned[name]) for name in ("fixed_action", "felt_action"))
        self.controllers: dict[str, Controller] = {}
        self.returns = {name: np.zeros(rows) for name in NAMES}
        self.begin(np.ones(rows, dtype=bool), np.zeros(rows, dtype=np.intp))

    def begin(self, mask: np.ndarray, insect: np.ndarray) -> None:
        """Start again in the rows of the mask, and go on in the others.

        Args:
            mask: shape (rows,).
            insect: which flies in each row now, shape (rows,).
        """
        for total in self.returns.values():
            total[mask] = 0
        if not self._wanted:
            return
        own = {name: value[insect] for name, value in self._tuned.items()}
        climb = (own[f"ladder_{name}"] for name in ("height", "gain", "margin"))
        fresh: dict[str, Controller] = {
            "fixed_stroke": FixedStroke(_rows(self._fixed, insect)),
            "felt_lift": FeltLift(_rows(self._felt, insect), own["felt_gain"], own["felt_margin"]),
            "lift_ladder": LadderClimber(self._task, insect, *climb),
        }
        for name, before in self.controllers.items():
            fresh[name].carry(~mask, before)
        self.controllers = fresh

    def fly(self, flight: Flight, noise: np.ndarray, mask: np.ndarray) -> None:
        """One beat in the rows of the mask.

        Args:
            flight: the present conditions.
            noise: felt weight support over the true one, shape (rows,) [-].
            mask: shape (rows,).
        """
        self.returns["full_knowledge"] += np.where(mask, flight.best_reward, 0)
        for name, controller in self.controllers.items():
            reward, weight_support = beat_reward(self._task, flight, controller.beats())
            self.returns[name] += np.where(mask, reward, 0)
            controller.feel(weight_support * noise, mask)


def _rows(beats: Beats, insect: np.ndarray) -> Beats:
    """The strokes of the insect that flies in each row."""
    return Beats(**{name: value[insect] for name, value in vars(beats).items()})
