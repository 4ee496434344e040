"""Gymnasium's wrapper that speaks torch; no tensor can hold names, so the infos wanted must be numbers."""

import gymnasium as gym
import numpy as np
import pytest
import torch
from gymnasium.wrappers import NumpyToTorch
from gymnasium.wrappers.vector import NumpyToTorch as VectorNumpyToTorch

from flapenv.envs import ENV_IDS

NUMBERS = ("weight_support", "optimality_gap", "clipped")


@pytest.mark.parametrize("mode", ["NEXT_STEP", "SAME_STEP", "DISABLED"])
def test_a_batch_takes_and_gives_tensors(mode: str) -> None:
    plain, env = (gym.make_vec("flapenv/Hover-v0", num_envs=3, autoreset_mode=mode, infos=NUMBERS) for _ in range(2))
    env = VectorNumpyToTorch(env)
    actions = plain.action_space.sample()
    np.testing.assert_array_equal(env.reset(seed=1)[0].numpy(), plain.reset(seed=1)[0])
    seen, expected = env.step(torch.from_numpy(actions)), plain.step(actions)
    for one, other in zip(seen[:4], expected[:4], strict=True):
        assert torch.equal(one, torch.from_numpy(other))
    infos = [result[-1].get("final_info", result[-1]) for result in (seen, expected)]
    for key in NUMBERS:
        assert torch.equal(infos[0][key], torch.from_numpy(infos[1][key]))


@pytest.mark.parametrize("env_id", ENV_IDS)
def test_a_single_environment_takes_and_gives_tensors(env_id: str) -> None:
    env, plain = NumpyToTorch(gym.make(env_id)), gym.make(env_id)
    action = plain.action_space.sample()
    plain.reset(seed=1)
    env.reset(seed=1)
    seen, expected = env.step(torch.from_numpy(action)), plain.step(action)
    assert torch.equal(seen[0], torch.from_numpy(expected[0]))
    assert seen[1:4] == expected[1:4]
