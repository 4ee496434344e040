"""What environments have in common whose episode is one wingbeat: draws, what is felt, what is seen."""

from collections.abc import Mapping
from typing import Any

import numpy as np
from gymnasium import spaces
from gymnasium.vector import AutoresetMode

from flapenv.aero.parameters import StrokeReference
from flapenv.case import HoverCase
from flapenv.envs.arguments import InfoChoice
from flapenv.envs.batch import BatchEnv, Info
from flapenv.envs.insect_choice import prepared_insects
from flapenv.envs.state import Limits
from flapenv.envs.wing_features import OBSERVATION_LIMIT, seen, wing_features
from flapenv.problem import HoverProblem

NOT_YET = -1
FIRST_FELT = (0.0, 0.0, 1.0)
"""Last Λ - 1, last log P*/P*_felt and fraction of the episode left, at the start."""
SMALLEST_POWER = 1e-30
"""Stands in for no power at all where its logarithm is felt [W/kg]."""


class OneBeatEnv(BatchEnv):
    """A batch whose rows each draw an insect, beat once, and are done.

    Rows are independent but for the one generator that draws their insects, in row order, whatever the others do.
    """

    reset_options = ("insect",)
    kept = (*BatchEnv.kept, "_insect", "_felt", "_beaten")

    def __init__(
        self,
        num_envs: int,
        *,
        cases: HoverCase,
        names: np.ndarray,
        r1_hat: np.ndarray,
        problem: HoverProblem,
        dtype: np.dtype,
        actions: int,
        autoreset_mode: AutoresetMode | str,
        render_mode: str | None,
        infos: InfoChoice,
        reward_space: spaces.Box | None = None,
    ) -> None:
        """Lay out what is seen of every insect and set up the spaces.

        Args:
            num_envs: rows.
            cases: the insects' numbers, array fields.
            names: what infos call them.
            r1_hat: r̂₁ of their wings [-].
            problem: the box and the model.
            dtype: of the computation.
            actions: how many numbers an action has.
            autoreset_mode: as `BatchEnv`.
            render_mode: as `BatchEnv`.
            infos: as `BatchEnv`.
            reward_space: as `BatchEnv`.
        """
        features, felt_power = wing_features(cases, r1_hat, problem)
        start = np.tile(np.array(FIRST_FELT, dtype=np.float32), (len(names), 1))
        self._first_seen = np.concatenate([features, start], axis=1)
        self._names, self._felt_power = names, felt_power.astype(dtype)
        self._reference = StrokeReference(*(np.asarray(own, dtype=dtype) for own in cases.reference))
        size = self._first_seen.shape[1]
        super().__init__(
            num_envs,
            single_observation_space=spaces.Box(-OBSERVATION_LIMIT, OBSERVATION_LIMIT, (size,), np.float32),
            single_action_space=spaces.Box(-1.0, 1.0, (actions,), np.float32),
            autoreset_mode=autoreset_mode,
            render_mode=render_mode,
            infos=infos,
            reward_space=reward_space,
        )
        self._insect = np.zeros(num_envs, dtype=np.intp)
        self._felt = np.zeros((num_envs, 3), dtype=np.float32)
        self._beaten = np.full(num_envs, NOT_YET, dtype=np.intp)  # the insect of each row's last wingbeat

    def prepare(self, options: dict[str, Any]) -> dict[str, Any]:
        """The option "insect" as row numbers."""
        return prepared_insects(options, list(self._names), self.num_envs)

    def _begin(self, mask: np.ndarray, options: dict[str, Any]) -> Info:
        drawn = self.np_random.integers(len(self._names), size=self.num_envs)
        self._insect = np.where(mask, options.get("insect", drawn), self._insect)
        self._felt[mask] = FIRST_FELT
        return {"insect": self._names[self._insect]}

    def _limits(self, arrays: Mapping[str, np.ndarray]) -> dict[str, Limits]:
        last = len(self._names) - 1
        return {"insect": (0, last), "beaten": (NOT_YET, last)}

    def _own(self, rows: Any) -> StrokeReference:
        """The own strokes of the insects at `rows`."""
        return StrokeReference(*(own[rows] for own in self._reference))

    def _feel(self, weight_support: np.ndarray, specific_power: np.ndarray, mask: np.ndarray) -> None:
        """What the wingbeat of the rows of a mask felt like."""
        power = np.maximum(specific_power, SMALLEST_POWER)
        rows = slice(None) if mask.all() else mask
        self._felt[rows, 0] = seen(weight_support - 1)[rows]
        self._felt[rows, 1] = seen(np.log(power / self._felt_power[self._insect]))[rows]
        self._felt[rows, 2] = 0.0
        self._beaten = np.where(mask, self._insect, self._beaten)

    def _observe(self) -> np.ndarray:
        seen = self._first_seen[self._insect]
        seen[:, -3:] = self._felt
        return seen

    def _has_beaten(self, row: int) -> bool:
        """Whether there is a last wingbeat to be drawn; at an episode's beginning the own stroke is.

        With SAME_STEP autoreset the next episode has begun already when the last beat is to be seen.
        """
        just_begun = self._felt[row, 2] == 1 and self.autoreset_mode is not AutoresetMode.SAME_STEP
        return not just_begun and self._beaten[row] != NOT_YET
