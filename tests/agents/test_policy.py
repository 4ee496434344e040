"""The policy's mean stays near the box, and its noise has a floor and is each wing's own."""

import numpy as np
import pytest
import torch
from gymnasium import spaces

from agents.policy import MEAN_REACH, HoverPolicy

SPACES = (spaces.Box(-5, 5, (6,), np.float32), spaces.Box(-1, 1, (3,), np.float32))


@pytest.fixture
def policy() -> HoverPolicy:
    torch.manual_seed(0)
    return HoverPolicy(*SPACES, lambda _: 1e-3, log_std_init=-0.5, net_arch=[16, 16])


def distribution(policy: HoverPolicy, observations: torch.Tensor) -> torch.distributions.Normal:
    return policy.get_distribution(observations).distribution


def test_the_mean_is_bounded_a_little_past_the_box(policy: HoverPolicy) -> None:
    with torch.no_grad():
        policy.action_net[0].bias += 100.0
    mean = distribution(policy, torch.zeros(4, 6)).mean
    assert torch.allclose(mean, torch.full_like(mean, MEAN_REACH))
    actions, _ = policy.predict(np.zeros((4, 6), dtype=np.float32), deterministic=True)
    assert (actions == 1).all()


def test_the_noise_begins_as_set_and_learns_to_differ_between_observations(policy: HoverPolicy) -> None:
    observations = torch.randn(8, 6)
    assert torch.allclose(distribution(policy, observations).stddev, torch.tensor(np.exp(-0.5), dtype=torch.float32))
    loss = (distribution(policy, observations).stddev * torch.linspace(-1, 1, 8)[:, None]).sum()
    for _ in range(20):
        policy.optimizer.zero_grad()
        loss = (distribution(policy, observations).stddev * torch.linspace(-1, 1, 8)[:, None]).sum()
        loss.backward()
        policy.optimizer.step()
    assert distribution(policy, observations).stddev.std() > 1e-4


def test_the_noise_cannot_fall_below_its_floor(policy: HoverPolicy) -> None:
    with torch.no_grad():
        policy.noise_net.bias -= 30.0
    policy.noise_floor = -4.0
    stddev = distribution(policy, torch.randn(5, 6)).stddev
    assert torch.allclose(stddev, torch.full_like(stddev, np.exp(-4.0)))


def test_everything_that_is_trained_is_in_the_optimiser_once(policy: HoverPolicy) -> None:
    held = [id(parameter) for group in policy.optimizer.param_groups for parameter in group["params"]]
    trained = [id(parameter) for parameter in policy.parameters() if parameter.requires_grad]
    assert sorted(held) == sorted(trained)
    assert id(policy.noise_net.weight) in held


def test_the_mean_begins_where_it_is_told_to() -> None:
    first = (0.4, 1.0, -1.0)
    policy = HoverPolicy(*SPACES, lambda _: 1e-3, first_mean=first, net_arch=[16, 16])
    observations = np.random.default_rng(0).normal(size=(64, 6)).astype(np.float32)
    actions, _ = policy.predict(observations, deterministic=True)
    np.testing.assert_allclose(actions, np.tile(first, (64, 1)), atol=0.05)


@pytest.mark.parametrize("wrong", [(0.4, 1.0), (0.4, 1.0, 1.2), (0.0, 0.0, float("nan"))])
def test_a_first_mean_outside_the_cube_is_refused(wrong: tuple[float, ...]) -> None:
    with pytest.raises(ValueError, match="first_mean"):
        HoverPolicy(*SPACES, lambda _: 1e-3, first_mean=wrong)
