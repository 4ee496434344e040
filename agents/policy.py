"""A Gaussian policy whose mean stays near the box and whose noise is its own for every wing."""

from collections.abc import Callable, Sequence
from typing import Any

import torch
from gymnasium import spaces
from stable_baselines3.common.distributions import DiagGaussianDistribution, Distribution
from stable_baselines3.common.policies import ActorCriticPolicy
from stable_baselines3.common.type_aliases import Schedule
from torch import nn

from agents.actor import MEAN_REACH

LEAST_FLOOR = -20.0
"""A floor of the log standard deviation that binds nothing."""


class Reach(nn.Module):
    """x -> 1.1 tanh x."""

    def forward(self, latent: torch.Tensor) -> torch.Tensor:
        """The mean of the actions, a little past the box at most."""
        return MEAN_REACH * torch.tanh(latent)


class HoverPolicy(ActorCriticPolicy):
    """An MLP actor-critic for the exact-penalty objective, where a plain Gaussian gets stuck in two ways.

    A mean that wanders out of the box sees no gradient and never returns: here it is bounded. One noise for all wings
    dies with the first wing that is hovering, while another is still under weight: here the noise depends on the
    observation, and `noise_floor` (log standard deviation, lowered by the trainer) keeps it from dying too early.
    """

    def __init__(
        self,
        observation_space: spaces.Space,
        action_space: spaces.Box,
        lr_schedule: Schedule,
        first_mean: Sequence[float] | None = None,
        **arguments: Any,
    ) -> None:
        """Build the networks.

        Args:
            observation_space: as `ActorCriticPolicy`'s, like the rest.
            action_space: the cube.
            lr_schedule: learning rate by the share of the training that is left.
            first_mean: mean action before training, one number an axis, each within the cube; its middle where None.
            **arguments: of `ActorCriticPolicy`.

        Raises:
            ValueError: for a first mean of another length or outside the cube.
        """
        self.noise_floor = LEAST_FLOOR
        self.first_mean = None if first_mean is None else _checked_mean(first_mean, action_space)
        super().__init__(observation_space, action_space, lr_schedule, **arguments)

    def _build(self, lr_schedule: Schedule) -> None:
        super()._build(lr_schedule)
        self.log_std.requires_grad_(False)
        self.noise_net = nn.Linear(self.mlp_extractor.latent_dim_pi, self.log_std.shape[0])
        nn.init.zeros_(self.noise_net.weight)
        nn.init.constant_(self.noise_net.bias, self.log_std_init)
        if self.first_mean is not None:
            assert isinstance(self.action_net, nn.Linear)
            with torch.no_grad():
                self.action_net.bias.copy_(torch.atanh(torch.tensor(self.first_mean) / MEAN_REACH))
        self.action_net = nn.Sequential(self.action_net, Reach())
        trained = [parameter for parameter in self.parameters() if parameter.requires_grad]
        make_optimizer: Callable[..., torch.optim.Optimizer] = self.optimizer_class
        self.optimizer = make_optimizer(trained, lr=lr_schedule(1), **self.optimizer_kwargs)

    def mean_action(self, observations: torch.Tensor) -> torch.Tensor:
        """The mean of the policy, shape (rows, n), not clipped to the box; keeps its gradient."""
        mean: torch.Tensor = self.action_net(self.mlp_extractor.forward_actor(torch.flatten(observations, 1)))
        return mean

    def _get_action_dist_from_latent(self, latent_pi: torch.Tensor) -> Distribution:
        assert isinstance(self.action_dist, DiagGaussianDistribution)
        noise = torch.clamp(self.noise_net(latent_pi), self.noise_floor, 0.0)
        return self.action_dist.proba_distribution(self.action_net(latent_pi), noise)


def _checked_mean(first_mean: Sequence[float], action_space: spaces.Box) -> tuple[float, ...]:
    """The mean as plain numbers, of the actions' length and within the cube."""
    checked = tuple(float(value) for value in first_mean)
    if (len(checked),) != action_space.shape or not all(-1 <= value <= 1 for value in checked):
        raise ValueError(f"first_mean = {checked} is not allowed; allowed: {action_space.shape} numbers from -1 to 1")
    return checked
