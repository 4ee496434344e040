"""The Stable-Baselines3 adapter equals DummyVecEnv, array for array."""

from typing import Any

import gymnasium as gym
import numpy as np
import pytest
from gymnasium.vector import AutoresetMode, SyncVectorEnv
from stable_baselines3.common.vec_env import DummyVecEnv

from agents.vec_env import GymnasiumVecEnv

ROWS = 4
IDS = ("flapenv/Hover-v0", "Pendulum-v1", "CartPole-v1", "MountainCarContinuous-v0")


def make(name: str) -> gym.Env:
    return gym.make(name, max_episode_steps=7) if "flapenv" not in name else gym.make(name)


def looped(name: str) -> SyncVectorEnv:
    return SyncVectorEnv([lambda: make(name)] * ROWS, autoreset_mode=AutoresetMode.SAME_STEP)


def assert_same(one: Any, other: Any) -> None:
    if isinstance(one, dict):
        assert one.keys() == other.keys()
        for key in one:
            assert_same(one[key], other[key])
    elif isinstance(one, str) or one is None:
        assert one == other
    else:
        assert np.asarray(one).dtype == np.asarray(other).dtype
        np.testing.assert_array_equal(one, other)


@pytest.mark.parametrize("name", IDS)
def test_over_a_loop_of_environments_it_equals_dummy_vec_env(name: str) -> None:
    ours, theirs = GymnasiumVecEnv(looped(name)), DummyVecEnv([lambda: make(name)] * ROWS)
    assert ours.observation_space == theirs.observation_space
    assert ours.action_space == theirs.action_space
    assert ours.seed(3) == theirs.seed(3)
    assert_same(ours.reset(), theirs.reset())
    theirs.action_space.seed(3)
    for _ in range(20):
        actions = np.stack([theirs.action_space.sample() for _ in range(ROWS)])
        got, expected = ours.step(actions), theirs.step(actions)
        for a, b in zip(got[:3], expected[:3], strict=True):
            assert_same(a, b)
        for a, b in zip(got[3], expected[3], strict=True):
            assert_same(a, b)
        for a, b in zip(ours.reset_infos, theirs.reset_infos, strict=True):
            assert_same(a, b)


class Ends(gym.Env):
    """Ends on its first step as asked: terminated, truncated or both."""

    observation_space = gym.spaces.Box(-1, 1, (1,), np.float32)
    action_space = gym.spaces.Box(-1, 1, (1,), np.float32)

    def __init__(self, terminated: bool, truncated: bool) -> None:
        self.ends = terminated, truncated

    def reset(self, *, seed: int | None = None, options: dict[str, Any] | None = None) -> tuple[np.ndarray, dict]:
        super().reset(seed=seed)
        return np.zeros(1, dtype=np.float32), {}

    def step(self, action: np.ndarray) -> tuple[np.ndarray, float, bool, bool, dict]:
        return np.ones(1, dtype=np.float32), 0.0, *self.ends, {}


def test_an_episode_that_is_both_terminated_and_truncated_counts_as_terminated() -> None:
    cases = [(True, False), (False, True), (True, True)]
    makers = [lambda ends=ends: Ends(*ends) for ends in cases]
    ours = GymnasiumVecEnv(SyncVectorEnv(makers, autoreset_mode=AutoresetMode.SAME_STEP))
    ours.reset()
    *_, infos = ours.step(np.zeros((3, 1), dtype=np.float32))
    assert [info["TimeLimit.truncated"] for info in infos] == [False, True, False]


def native(rows: int = ROWS) -> GymnasiumVecEnv:
    return GymnasiumVecEnv(gym.make_vec("flapenv/Hover-v0", num_envs=rows, autoreset_mode="SAME_STEP"))


def test_over_the_native_batch_every_row_has_its_own_info_and_last_observation() -> None:
    env = native()
    env.seed(1)
    first = env.reset()
    observations, rewards, dones, infos = env.step(np.zeros((ROWS, 6), dtype=np.float32))
    assert rewards.dtype == np.float32
    assert dones.all()
    assert len({id(info) for info in infos}) == ROWS
    for row, info in enumerate(infos):
        assert info["TimeLimit.truncated"] is False
        np.testing.assert_array_equal(info["terminal_observation"][:3], first[row, :3])
        assert info["terminal_observation"][-1] == 0
        assert info["weight_support"] == pytest.approx(1 + info["terminal_observation"][3], rel=1e-5)
    assert (observations[:, -1] == 1).all()


def test_a_seed_serves_one_reset_and_options_reach_every_row() -> None:
    env = native(64)
    env.seed(5)
    first, second = env.reset(), env.reset()
    env.seed(5)
    np.testing.assert_array_equal(env.reset(), first)
    assert np.any(second != first)
    env.set_options({"insect": "hawkmoth"})
    env.reset()
    assert {info["insect"] for info in env.reset_infos} == {"hawkmoth"}
    env.reset()
    assert {info["insect"] for info in env.reset_infos} != {"hawkmoth"}
    env.set_options([{"insect": "hawkmoth"}] + [{}] * 63)
    with pytest.raises(ValueError, match="options differ between rows"):
        env.reset()


def test_attributes_and_methods_are_the_batchs_for_every_row_asked_for() -> None:
    env = native()
    assert env.get_attr("num_envs") == [ROWS] * ROWS
    assert env.get_attr("num_envs", indices=[1, 2]) == [ROWS] * 2
    assert env.env_is_wrapped(gym.Wrapper) == [False] * ROWS
    assert env.env_is_wrapped(gym.Wrapper, indices=0) == [False]
    env.set_attr("label", "x")
    assert env.get_attr("label", 0) == ["x"]
    with pytest.raises(ValueError, match="rows share their attributes"):
        env.set_attr("label", "y", indices=[0])
    assert env.env_method("close", indices=[0]) == [None]
    assert env.get_images() == [None] * ROWS


def test_other_autoreset_modes_are_refused() -> None:
    with pytest.raises(ValueError, match=r"allowed: AutoresetMode\.SAME_STEP"):
        GymnasiumVecEnv(gym.make_vec("flapenv/Hover-v0", num_envs=2))
