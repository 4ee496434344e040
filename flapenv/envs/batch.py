"""What every batched environment of the family shares: autoreset written once, reset masks, infos."""

from abc import abstractmethod
from collections.abc import Mapping
from typing import Any

import gymnasium as gym
import numpy as np
from gymnasium import error, spaces
from gymnasium.vector import AutoresetMode, VectorEnv
from gymnasium.vector.utils import batch_space

from flapenv.aero.checks import require_count, shown
from flapenv.envs.arguments import (
    RENDER_MODES,
    InfoChoice,
    as_autoreset_mode,
    checked_actions,
    require_infos,
    require_options,
    require_render_mode,
    require_seed,
)
from flapenv.envs.state import (
    EnvState,
    Limits,
    as_generator,
    changes,
    checked_arrays,
    kept_arrays,
    random_state,
    require_limits,
)

Info = dict[str, Any]


class BatchEnv(VectorEnv[np.ndarray, np.ndarray, np.ndarray]):
    """A vector environment that computes all of its rows at once.

    A member of the family says how episodes begin (`_begin`), how one wingbeat goes (`_beat`) and what is seen
    (`_observe`); this class turns that into Gymnasium's three autoreset modes:

    - NEXT_STEP: the step after an episode's end ignores that row's action, resets it and returns reward 0.
    - SAME_STEP: the row is reset within its last step; its last observation and info are `final_obs`, `final_info`.
    - DISABLED: rows that ended must be reset with `options={"reset_mask": mask}` before they step again.

    A member names in `kept` all that the next steps depend on (`flapenv.envs.state`), and in `with_nan` the arrays of
    that in which NaN stands for what has not been.
    """

    metadata: dict[str, Any] = {"render_modes": list(RENDER_MODES), "render_fps": 2}
    reset_options: tuple[str, ...] = ()
    info_keys: tuple[str, ...] = ()
    kept: tuple[str, ...] = ("_ended", "_begun")
    with_nan: tuple[str, ...] = ()

    def __init__(
        self,
        num_envs: int,
        *,
        single_observation_space: spaces.Box,
        single_action_space: spaces.Box,
        autoreset_mode: AutoresetMode | str,
        render_mode: str | None,
        infos: InfoChoice = "all",
        reward_space: spaces.Box | None = None,
    ) -> None:
        """Set the spaces and the mode; no episode has begun yet.

        `reward_space` is None for scalar rewards, else a Box of shape (k,), and rewards have shape (num_envs, k).
        """
        self.num_envs = require_count("num_envs", num_envs)
        self.autoreset_mode = as_autoreset_mode(autoreset_mode)
        self.render_mode = require_render_mode(render_mode)
        self.metadata = {
            **type(self).metadata,
            "autoreset_mode": self.autoreset_mode,
        }
        self.single_observation_space, self.single_action_space = single_observation_space, single_action_space
        self.observation_space = batch_space(single_observation_space, num_envs)
        self.action_space = batch_space(single_action_space, num_envs)
        self.infos = require_infos(infos, self.info_keys)
        self.unwanted = frozenset(self.info_keys) - frozenset(self.infos)
        self._everyone = np.ones(num_envs, dtype=bool)
        self._everyone.flags.writeable = False
        self.reward_space = reward_space
        self._ended = np.ones(num_envs, dtype=bool)
        self._begun = False

    @abstractmethod
    def _begin(self, mask: np.ndarray, options: dict[str, Any]) -> Info:
        """Begin an episode in the rows of `mask`, options as `prepare` gives them; the reset info of all rows."""

    @abstractmethod
    def _beat(self, actions: np.ndarray, mask: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray, Info]:
        """One wingbeat in the rows of `mask`: rewards, terminations, truncations and info of all rows, as arrays."""

    @abstractmethod
    def _observe(self) -> np.ndarray:
        """What is seen now, a fresh array."""

    @abstractmethod
    def _picture(self, row: int) -> np.ndarray:
        """The last wingbeat of a row, (height, width, 3) of uint8."""

    def _limits(self, arrays: Mapping[str, np.ndarray]) -> dict[str, Limits]:
        """What whole numbers of a state may be, by their names; the arrays are all there, of the right kind."""
        return {}

    def _restored(self) -> None:
        """Make again what follows from what is kept."""

    def state(self) -> EnvState:
        """All that the next steps and pictures depend on, copied.

        Generators of the spaces, as `action_space.sample` draws from, are not in it.

        Raises:
            ValueError: where `np_random` was replaced by a generator of another kind than Gymnasium's.
        """
        return EnvState(arrays=kept_arrays(self), random=random_state(self._np_random, self._np_random_seed))

    def restore(self, state: EnvState) -> None:
        """Go on from a state as the environment it was taken from went on, bit for bit; no reset is needed before.

        Args:
            state: of an environment made with the same arguments; it is copied. An error leaves all as it was.

        Raises:
            TypeError: for what is not a state.
            ValueError: for a missing or unknown array, one of another type or shape, numbers that are not finite or out
                of range, or another bit generator.
        """
        if not isinstance(state, EnvState):
            raise TypeError(f"state = {shown(state)} is not allowed; allowed: an EnvState")
        arrays = checked_arrays(state.arrays, kept_arrays(self), with_nan=self.with_nan)
        require_limits(arrays, self._limits(arrays))
        generator, seed = as_generator(state.random)
        if generator is None and arrays["begun"]:
            raise ValueError("state: random = None is not allowed where an episode has begun; allowed: a dict")
        wanted = changes(self, arrays)  # all is checked before anything changes
        self._np_random, self._np_random_seed = generator, seed
        for owner, name, value in wanted:
            setattr(owner, name, value)
        self._restored()

    def render(self) -> tuple[np.ndarray, ...] | None:
        """The last wingbeat of every row as pictures (height, width, 3) of uint8; None without a render mode."""
        if self.render_mode is None:
            gym.logger.warn("render() needs render_mode='rgb_array' when the environment is made")
            return None
        return tuple(self._picture(row) for row in range(self.num_envs))

    def reset(self, *, seed: int | None = None, options: dict[str, Any] | None = None) -> tuple[np.ndarray, Info]:
        """Begin new episodes, in all rows or in those of `options["reset_mask"]`.

        Args:
            seed: seeds the one generator all rows draw from.
            options: "reset_mask", an array of bool of shape (num_envs,), and the member's own options.

        Returns:
            Observations (num_envs, n) and infos, where `_key` masks the rows that have `key`.

        Raises:
            TypeError: for a seed, mask or options of another type.
            ValueError: for an unknown option or a mask of another shape or without a True.
        """
        seed, options = require_seed(seed), require_options(options, ("reset_mask", *self.reset_options))
        mask = self._reset_mask(options.pop("reset_mask", None))
        if not self._begun and not mask.all():
            raise error.ResetNeeded("the first reset must be of all rows, without options['reset_mask']")
        options = self.prepare(options)  # all is checked before anything changes
        super().reset(seed=seed)
        info = self._open(mask, options)
        return self._observe(), self._masked(info, mask)

    def prepare(self, options: dict[str, Any]) -> dict[str, Any]:
        """Reset options checked and as `_begin` takes them.

        Raises:
            TypeError: for an option of another type.
            ValueError: for an unknown name, another shape, or a value outside its range.
        """
        return options

    def start(self, options: dict[str, Any]) -> tuple[np.ndarray, Info]:
        """New episodes in all rows, with prepared options: observations and unmasked infos."""
        info = self._open(self._everyone, options)
        return self._observe(), info

    def _open(self, mask: np.ndarray, options: dict[str, Any]) -> Info:
        """New episodes in the rows of a mask, and the flags that go with them."""
        info = self._begin(mask, options)
        self._ended[mask] = False
        self._begun = True
        return info

    def advance(self, actions: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray, np.ndarray, Info]:
        """One wingbeat in every row, with checked actions and no autoreset: as `step`, but for unmasked infos.

        Raises:
            gymnasium.error.ResetNeeded: where a row has not begun or has ended.
        """
        self._require_running()
        rewards, terminations, truncations, info = self._beat(actions, self._everyone)
        self._ended = terminations | truncations
        return self._observe(), rewards.astype(np.float64), terminations, truncations, info

    def _require_running(self) -> None:
        """Refuse to step rows that have not begun, or have ended."""
        if not self._begun:
            raise error.ResetNeeded("call reset() before the first step()")
        if self._ended.any():
            raise error.ResetNeeded(
                f"rows {np.flatnonzero(self._ended)[:8].tolist()} have ended; reset them with "
                "options={'reset_mask': mask}"
            )

    def step(self, actions: Any) -> tuple[np.ndarray, np.ndarray, np.ndarray, np.ndarray, Info]:
        """One wingbeat in every row, with the autoreset of the environment's mode.

        Args:
            actions: shape (num_envs, n), finite; values outside [-1, 1] are clipped and flagged in the infos.

        Returns:
            Observations, rewards, terminations, truncations, all of num_envs rows, and infos.

        Raises:
            TypeError: for actions that are not numbers.
            ValueError: for actions of another shape, or with NaN or inf.
            gymnasium.error.ResetNeeded: before the first reset, or where a row has ended and the mode is DISABLED.
        """
        if not self._begun or self.autoreset_mode is AutoresetMode.DISABLED:
            self._require_running()
        actions = checked_actions("actions", actions, self.action_space.shape)
        if self._ended.any():
            return self._step_and_reset(actions)
        observations, rewards, terminations, truncations, beat_info = self.advance(actions)
        info, finished = self._masked(beat_info, self._everyone), self._ended.copy()
        if self.autoreset_mode is AutoresetMode.SAME_STEP and finished.any():
            final = {
                "final_obs": observations,
                "_final_obs": finished.copy(),
                "final_info": {key: value.copy() for key, value in self._masked(info, finished).items()},
                "_final_info": finished.copy(),
            }
            going_on = {} if finished.all() else self._masked(info, ~finished)
            info = _merged(going_on, self._masked(self._open(finished, {}), finished)) | final
            observations = self._observe()
        return observations, rewards, terminations, truncations, info

    def _step_and_reset(self, actions: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray, np.ndarray, Info]:
        """NEXT_STEP after an episode's end: rows that ended are reset, the others beat."""
        ended = self._ended.copy()
        running = ~ended
        info: Info = {}
        shape = () if self.reward_space is None else self.reward_space.shape or ()
        rewards, none = np.zeros((self.num_envs, *shape)), np.zeros(self.num_envs, dtype=bool)
        terminations, truncations = none, none.copy()
        if running.any():
            own, terminations, truncations, beat_info = self._beat(actions, running)
            rewards[running] = own[running]
            terminations, truncations = terminations & running, truncations & running
            info = self._masked(beat_info, running)
        info = _merged(info, self._masked(self._open(ended, {}), ended))
        self._ended = terminations | truncations
        return self._observe(), rewards, terminations, truncations, info

    def _reset_mask(self, mask: Any) -> np.ndarray:
        """All rows, or the checked mask."""
        if mask is None:
            return np.ones(self.num_envs, dtype=bool)
        if not isinstance(mask, np.ndarray) or mask.dtype != np.bool_:
            kind = mask.dtype if isinstance(mask, np.ndarray) else type(mask).__name__
            raise TypeError(f"reset_mask of type {kind} is not allowed; allowed: a NumPy array of bool")
        if mask.shape != (self.num_envs,) or not mask.any():
            raise ValueError(
                f"reset_mask of shape {mask.shape} with {int(mask.sum())} True is not allowed; allowed: shape "
                f"({self.num_envs},) with at least one True"
            )
        return mask.copy()

    def _masked(self, info: Info, mask: np.ndarray) -> Info:
        """The wanted infos as Gymnasium's vector environments give them: each array beside `_key`, where it counts."""
        masked: Info = {}
        for key, value in info.items():
            if not key.startswith("_") and key not in self.unwanted:
                own = info.get(f"_{key}")
                masked[key] = value
                masked[f"_{key}"] = mask.copy() if own is None else mask & own
        return masked


def _merged(first: Info, second: Info) -> Info:
    """Two masked infos of different rows as one."""
    merged = dict(first)
    for key, value in second.items():
        if key.startswith("_"):
            continue
        mask = second[f"_{key}"]
        if key in first:
            merged[key] = np.where(mask, value, first[key])
            merged[f"_{key}"] = mask | first[f"_{key}"]
        else:
            merged[key], merged[f"_{key}"] = value, mask
    return merged
