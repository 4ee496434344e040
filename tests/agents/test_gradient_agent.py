"""The agent that follows the reward's gradient, and the gradient itself."""

import numpy as np
import pytest
import torch
from gymnasium.error import ResetNeeded

from agents.presets import GradientSettings, Preset
from agents.training import make_model
from flapenv.envs import HoverVectorEnv
from flapenv.model import COEFFICIENTS


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


@pytest.mark.filterwarnings("ignore:.*outside the range of the polhamus")
@pytest.mark.parametrize("coefficients", COEFFICIENTS)
def test_every_law_of_forces_has_a_slope(coefficients: str) -> None:
    insect = "hawkmoth"  # one of those with constants of Berman and Wang
    env = HoverVectorEnv(8, insect=insect, problem={"model": {"coefficients": coefficients}}, dtype="float64")
    env.reset(seed=0)
    actions = torch.tensor(np.random.default_rng(1).uniform(-0.9, 0.9, (8, 6)), requires_grad=True)
    (slope,) = torch.autograd.grad(env.differentiable_reward(actions).sum(), actions)
    ahead, behind = (env.differentiable_reward(actions.detach() + step) for step in (1e-6, -1e-6))
    np.testing.assert_allclose(slope.sum(axis=1), (ahead - behind) / 2e-6, rtol=1e-3, atol=1e-5)


@pytest.mark.parametrize(
    ("actions", "kind", "said"),
    [
        (torch.zeros(4, 7), ValueError, "shape"),
        (torch.zeros(1, 6), ValueError, "shape"),
        (torch.full((4, 6), float("nan")), ValueError, "actions"),
        (torch.zeros(4, 6, dtype=torch.float16), TypeError, "float16"),
        (torch.zeros(4, 6, dtype=torch.int64), TypeError, "int64"),
        (np.zeros((4, 6)), TypeError, "ndarray"),
    ],
)
def test_bad_actions_are_named(actions: object, kind: type[Exception], said: str) -> None:
    env = HoverVectorEnv(4)
    env.reset(seed=0)
    with pytest.raises(kind, match=said):
        env.differentiable_reward(actions)


def test_rows_that_have_ended_or_not_begun_are_not_paid() -> None:
    env = HoverVectorEnv(4, autoreset_mode="DISABLED")
    with pytest.raises(ResetNeeded):
        env.differentiable_reward(torch.zeros(4, 6))
    env.reset(seed=0)
    env.step(np.zeros((4, 6), dtype=np.float32))
    with pytest.raises(ResetNeeded):
        env.differentiable_reward(torch.zeros(4, 6))


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
    assert model.num_timesteps == pytest.approx(15_000, abs=3 * 32)
    assert len(seen) == model.num_timesteps // (3 * 32)
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
