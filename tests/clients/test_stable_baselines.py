"""Stable-Baselines3 on the scalar environments: its checker, and its learners by id."""

import gymnasium as gym
import numpy as np
import pytest
from stable_baselines3 import PPO, SAC
from stable_baselines3.common.base_class import BaseAlgorithm
from stable_baselines3.common.env_checker import check_env
from stable_baselines3.common.evaluation import evaluate_policy

from flapenv.envs import ENV_IDS

SHORT = {PPO: {"n_steps": 64, "batch_size": 32, "n_epochs": 2}, SAC: {"learning_starts": 16, "batch_size": 16}}


@pytest.mark.parametrize("env_id", ENV_IDS)
def test_its_checker_passes_without_a_warning(env_id: str) -> None:
    check_env(gym.make(env_id, render_mode="rgb_array"))


@pytest.mark.parametrize("env_id", ENV_IDS)
@pytest.mark.parametrize("learner", SHORT, ids=lambda learner: learner.__name__)
def test_it_makes_an_environment_by_its_id_and_learns_without_a_warning(
    env_id: str, learner: type[BaseAlgorithm]
) -> None:
    model = learner("MlpPolicy", env_id, seed=0, device="cpu", **SHORT[learner])
    before = [parameter.detach().clone() for parameter in model.policy.parameters()]
    model.learn(64)
    assert model.num_timesteps == 64
    after = list(model.policy.parameters())
    assert all(parameter.isfinite().all() for parameter in after)
    assert any((one != other).any() for one, other in zip(before, after, strict=True))


def test_what_it_trained_it_can_evaluate_save_and_load(tmp_path: object) -> None:
    model = PPO("MlpPolicy", "flapenv/Hover-v0", seed=0, device="cpu", **SHORT[PPO])
    model.learn(64)
    model.save(f"{tmp_path}/policy")
    again = PPO.load(f"{tmp_path}/policy", env=model.get_env(), device="cpu")
    observation = gym.make("flapenv/Hover-v0").reset(seed=1)[0]
    np.testing.assert_array_equal(*(m.predict(observation, deterministic=True)[0] for m in (model, again)))
    mean, spread = evaluate_policy(again, again.get_env(), n_eval_episodes=16)
    assert np.isfinite([mean, spread]).all()
