"""The agent that follows the reward's gradient, and the gradient itself."""

import numpy as np
import pytest
import torch

from agents.gradient_agent import GRADIENT_COST
from agents.presets import GradientSettings, Preset
from agents.training import make_model
from flapenv.envs import HoverVectorEnv


def test_the_differentiable_reward_is_the_reward_and_its_slope_a_finite_difference() -> None:
    env = HoverVectorEnv(64, dtype="float64", autoreset_mode="DISABLED")
    env.reset(seed=0)
    actions = torch.tensor(np.random.default_rng(0).uniform(-0.95, 0.95, (64, 6)), requires_grad=True)
    reward = env.differentiable_reward(actions)
    (slope,) = torch.autograd.grad(reward.sum(), actions)
    step, axis = 1e-6, 2
    ahead, behind = actions.detach().clone(), actions.detach().clone()
    ahead[:, axis] += step
    behind[:, axis] -= step
    difference = (env.differentiable_reward(ahead) - env.differentiable_reward(behind)) / (2 * step)
    np.testing.assert_allclose(slope[:, axis], difference, rtol=1e-4, atol=1e-6)
    paid = env.step(actions.detach().numpy().astype(np.float32))[1]
    above = paid > env.problem.reward_floor
    np.testing.assert_allclose(reward.detach().numpy()[above], paid[above], rtol=1e-5)


def test_beyond_the_box_there_is_no_slope() -> None:
    env = HoverVectorEnv(2)
    env.reset(seed=0)
    actions = torch.full((2, 6), 1.05, requires_grad=True)
    (slope,) = torch.autograd.grad(env.differentiable_reward(actions).sum(), actions)
    assert not slope[:, 2:].any()


def test_every_row_counts_three_wingbeats_and_the_reward_rises() -> None:
    preset = Preset(task="hover", settings=GradientSettings(wingbeats=15_000, rows=32))
    task = preset.make_task()
    model = make_model(preset, task, 0)
    before = task.glance(model)[0]
    seen = []
    model.learn(15_000, callback=lambda inside, _: seen.append(inside["rewards"].mean()) is None)
    assert model.num_timesteps == pytest.approx(15_000, abs=GRADIENT_COST * 32)
    assert len(seen) == model.num_timesteps // (GRADIENT_COST * 32)
    assert task.glance(model)[0] < 0.3 * before
    assert np.mean(seen[-10:]) > np.mean(seen[:10])


@pytest.mark.slow
def test_the_gradient_agent_reaches_the_optimum_of_every_insect() -> None:
    preset = Preset(task="hover", settings=GradientSettings())
    task = preset.make_task()
    model = make_model(preset, task, 1)
    model.learn(preset.settings.wingbeats)
    mean, worst = task.glance(model)
    assert -1e-5 < mean < 2e-4
    assert worst < 1e-3
