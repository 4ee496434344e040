"""The scalar environment of every member of the family: its batch of one behind Gymnasium's `Env`."""

from typing import Any

import gymnasium as gym
import numpy as np
from gymnasium.vector import AutoresetMode

from flapenv.envs.arguments import arguments_of, checked_actions, refuse_unknown, require_options, require_seed
from flapenv.envs.batch import BatchEnv, Info
from flapenv.envs.state import EnvState

BATCH_ONLY = ("num_envs", "autoreset_mode")
"""Arguments of a batch that a single environment has no use for."""


class SingleEnv(gym.Env[np.ndarray, np.ndarray]):
    """A batch of one as a `gymnasium.Env`; a member sets `batch_class` and describes itself in its docstring."""

    batch_class: type[BatchEnv]
    metadata: dict[str, Any] = dict(BatchEnv.metadata)

    def __init__(self, *, render_mode: str | None = None, **arguments: Any) -> None:
        """Make a batch of one.

        Args:
            render_mode: "rgb_array" or None.
            **arguments: of the batched environment, but for num_envs and autoreset_mode.

        Raises:
            TypeError: for an unknown argument or one of another kind.
            ValueError: for an unknown name or a value outside its range.
        """
        own = [name for name in arguments_of(self.batch_class) if name not in BATCH_ONLY]
        unknown = {name: value for name, value in arguments.items() if name not in own}
        refuse_unknown(unknown, self.batch_class, hidden=BATCH_ONLY)
        make: Any = self.batch_class  # each member has arguments of its own
        self.batch: BatchEnv = make(1, autoreset_mode=AutoresetMode.DISABLED, render_mode=render_mode, **arguments)
        self.render_mode = self.batch.render_mode
        self.reward_space = self.batch.reward_space
        self.observation_space = self.batch.single_observation_space
        self.action_space = self.batch.single_action_space

    def reset(self, *, seed: int | None = None, options: dict[str, Any] | None = None) -> tuple[np.ndarray, Info]:
        """Begin an episode; `options` as the batch takes them.

        Raises:
            TypeError: for a seed or options of another type.
            ValueError: for an unknown option.
        """
        seed = require_seed(seed)
        prepared = self.batch.prepare(require_options(options, self.batch.reset_options))
        super().reset(seed=seed)
        self.batch.np_random = self.np_random
        observations, info = self.batch.start(prepared)
        return observations[0], self._plain(info)

    def step(self, action: np.ndarray) -> tuple[np.ndarray, Any, bool, bool, Info]:
        """One wingbeat; infos are plain Python values, None where a value does not exist.

        The reward is a float, or an array where the environment was made for a vector.

        Args:
            action: shape (n,), finite.

        Raises:
            TypeError: for an action that is not numbers.
            ValueError: for an action of another shape, or with NaN or inf.
            gymnasium.error.ResetNeeded: before a reset, and after the end of an episode.
        """
        action = checked_actions("action", action, self.action_space.shape)
        observations, rewards, terminations, truncations, info = self.batch.advance(action[None])
        reward = float(rewards[0]) if self.reward_space is None else rewards[0]
        return observations[0], reward, bool(terminations[0]), bool(truncations[0]), self._plain(info)

    def render(self) -> np.ndarray | None:
        """The last wingbeat as a picture (height, width, 3) of uint8; None without a render mode."""
        frames: Any = self.batch.render()
        return None if frames is None else frames[0]

    def state(self) -> EnvState:
        """All that the next steps and pictures depend on, copied, as `BatchEnv.state`."""
        self.batch._np_random, self.batch._np_random_seed = self._np_random, self._np_random_seed
        return self.batch.state()

    def restore(self, state: EnvState) -> None:
        """Go on from a state of an environment made with the same arguments; all else as `BatchEnv.restore`."""
        self.batch.restore(state)
        self._np_random, self._np_random_seed = self.batch._np_random, self.batch._np_random_seed

    def _plain(self, info: Info) -> Info:
        """The wanted infos of a batch of one as plain Python values; None where the row has no value."""
        row: Info = {}
        for key, value in info.items():
            if key[0] != "_" and key not in self.batch.unwanted:
                element, present = value[0], info.get(f"_{key}")
                row[key] = element.tolist() if isinstance(element, np.generic | np.ndarray) else element
                if present is not None and not present[0]:
                    row[key] = None
        return row
