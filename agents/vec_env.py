"""Stable-Baselines3 over a Gymnasium vector environment: rows go in and out as arrays, nothing is looped but infos."""

from collections.abc import Iterable, Sequence
from typing import Any

import gymnasium as gym
import numpy as np
from gymnasium.vector import AutoresetMode, VectorEnv
from stable_baselines3.common.vec_env import VecEnv
from stable_baselines3.common.vec_env.base_vec_env import VecEnvStepReturn

Rows = None | int | Iterable[int]


class GymnasiumVecEnv(VecEnv):
    """A Gymnasium `VectorEnv` with SAME_STEP autoreset as the `VecEnv` that Stable-Baselines3 takes.

    Over `SyncVectorEnv(..., autoreset_mode="SameStep")` it equals `DummyVecEnv` array for array and info for info.
    Attributes and methods are those of the vector environment, the same for every row.
    """

    def __init__(self, venv: VectorEnv, *, reward_scale: float = 1.0) -> None:
        """Wrap `venv`.

        Args:
            venv: with SAME_STEP autoreset.
            reward_scale: what rewards are multiplied by before a learner sees them.

        Raises:
            ValueError: if its autoreset mode is not SAME_STEP.
        """
        mode = venv.metadata.get("autoreset_mode")
        if mode is not AutoresetMode.SAME_STEP:
            raise ValueError(f"autoreset_mode = {mode} is not allowed; allowed: AutoresetMode.SAME_STEP")
        self.venv, self.reward_scale = venv, reward_scale
        self._actions = np.zeros(0)
        super().__init__(venv.num_envs, venv.single_observation_space, venv.single_action_space)

    def reset(self) -> np.ndarray:
        """Reset every row, with the seed and options set before; both serve once."""
        if any(options != self._options[0] for options in self._options):
            raise ValueError("options differ between rows; allowed: the same options for all rows")
        observations, infos = self.venv.reset(seed=self._seeds[0], options=self._options[0] or None)
        self.reset_infos = _by_row(infos, self.num_envs)
        self._reset_seeds()
        self._reset_options()
        return np.asarray(observations)

    def step_async(self, actions: np.ndarray) -> None:
        """Keep the actions for `step_wait`."""
        self._actions = actions

    def step_wait(self) -> VecEnvStepReturn:
        """Step every row: observations, rewards, dones and one info dict a row."""
        observations, rewards, terminations, truncations, infos = self.venv.step(self._actions)
        dones = terminations | truncations
        final_obs, final_infos = infos.pop("final_obs", None), infos.pop("final_info", {})
        infos.pop("_final_obs", None)
        infos.pop("_final_info", None)
        rows = _by_row(infos, self.num_envs)
        for i, (row, final) in enumerate(zip(rows, _by_row(final_infos, self.num_envs), strict=True)):
            if dones[i]:
                self.reset_infos[i] = row
                rows[i] = final
                rows[i]["terminal_observation"] = final_obs[i]
            rows[i]["TimeLimit.truncated"] = bool(truncations[i] and not terminations[i])
        scaled = np.asarray(self.reward_scale * rewards, dtype=np.float32)
        return np.asarray(observations), scaled, dones, rows

    def close(self) -> None:
        """Close the vector environment."""
        self.venv.close()

    def get_images(self) -> Sequence[np.ndarray | None]:
        """One picture a row."""
        frames = None if self.render_mode is None else self.venv.render()
        return [None] * self.num_envs if frames is None else [np.asarray(frame) for frame in frames]

    def get_attr(self, attr_name: str, indices: Rows = None) -> list[Any]:
        """The vector environment's attribute, once for each row asked for."""
        return [getattr(self.venv, attr_name) for _ in self._get_indices(indices)]

    def set_attr(self, attr_name: str, value: Any, indices: Rows = None) -> None:
        """Set the vector environment's attribute, which all rows share."""
        if len(list(self._get_indices(indices))) != self.num_envs:
            raise ValueError("rows share their attributes; allowed: all rows at once")
        setattr(self.venv, attr_name, value)

    def env_method(self, method_name: str, *method_args: Any, indices: Rows = None, **method_kwargs: Any) -> list[Any]:
        """Call the vector environment's method once; its result for each row asked for."""
        result = getattr(self.venv, method_name)(*method_args, **method_kwargs)
        return [result for _ in self._get_indices(indices)]

    def env_is_wrapped(self, wrapper_class: type[gym.Wrapper], indices: Rows = None) -> list[bool]:
        """A batch has no wrapped rows."""
        return [False for _ in self._get_indices(indices)]


def _by_row(infos: dict[str, Any], num_envs: int) -> list[dict[str, Any]]:
    """Masked arrays of infos as one dict a row, in plain Python values."""
    rows: list[dict[str, Any]] = [{} for _ in range(num_envs)]
    for key, values in infos.items():
        if key.startswith("_"):
            continue
        present = infos[f"_{key}"]
        if isinstance(values, dict):
            columns: list[Any] = _by_row(values, num_envs)
        else:
            columns = values.tolist() if values.ndim == 1 else list(values)
        for row, value, has in zip(rows, columns, present.tolist(), strict=True):
            if has:
                row[key] = value
    return rows
