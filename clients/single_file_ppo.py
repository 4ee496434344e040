"""Proximal policy optimisation in one file, over the vector environment that `gymnasium.make_vec` gives for an id.

`python clients/single_file_ppo.py --help` lists the fields of `Args`, which are the whole command line. Nothing here
knows about wings: any id with a Box of observations and a Box of actions will do.
"""

import argparse
import dataclasses
import math
import time
from typing import NamedTuple

import gymnasium as gym
import numpy as np
import torch
from gymnasium.vector import AutoresetMode, VectorEnv
from torch import Tensor, nn

AUTORESET_MODES = (AutoresetMode.SAME_STEP.name, AutoresetMode.NEXT_STEP.name)


@dataclasses.dataclass(frozen=True, kw_only=True)
class Args:
    """The command line."""

    env_id: str = "flapenv:flapenv/Hover-v0"
    """id of the environment, after the module that registers it"""
    seed: int = 0
    """of the environment, the network and the minibatches"""
    steps: int = 250_000
    """training budget, rows of the vector environment"""
    num_envs: int = 128
    """rows that step at once"""
    rollout: int = 16
    """steps between two updates"""
    minibatch: int = 512
    """rows of a gradient step"""
    epochs: int = 8
    """passes over the rows of an update"""
    learning_rate: float = 3e-3
    """at the start; falls linearly to zero"""
    gamma: float = 0.99
    """discount; without effect where an episode is one step"""
    gae_lambda: float = 0.95
    """of the advantage estimate; without effect where an episode is one step"""
    clip: float = 0.2
    """of the probability ratio"""
    target_kl: float = 0.2
    """an update ends early beyond this divergence"""
    max_grad_norm: float = 0.5
    """gradients are scaled down to it"""
    log_std: float = -0.7
    """log standard deviation of the actions at the start"""
    width: int = 64
    """neurons of each of two hidden layers"""
    autoreset_mode: str = "SAME_STEP"
    """SAME_STEP, or NEXT_STEP, where the row after an episode's end is a reset and not learned from"""
    eval_episodes: int = 512
    """noise-free episodes before and after training"""

    def __post_init__(self) -> None:
        """Check what a typing error would spoil silently."""
        if self.autoreset_mode not in AUTORESET_MODES:
            raise ValueError(f"autoreset_mode = {self.autoreset_mode!r} is not allowed; allowed: {AUTORESET_MODES}")
        if self.steps < self.num_envs * self.rollout:
            least = self.num_envs * self.rollout
            raise ValueError(f"steps = {self.steps} are not allowed; allowed: >= {least}, one update")


class Agent(nn.Module):
    """Actor and critic, two networks of two hidden layers, and a noise that is the same everywhere."""

    def __init__(self, observations: int, actions: int, args: Args) -> None:
        """Small last layer of the actor, so that it begins in the middle of the box."""
        super().__init__()
        self.actor = network(observations, args.width, actions, gain=0.01)
        self.critic = network(observations, args.width, 1, gain=1.0)
        self.log_std = nn.Parameter(torch.full((actions,), args.log_std))

    def policy(self, seen: Tensor) -> torch.distributions.Normal:
        """Distribution of the actions, (rows, actions)."""
        mean = self.actor(seen)
        return torch.distributions.Normal(mean, self.log_std.exp().expand_as(mean))

    def value(self, seen: Tensor) -> Tensor:
        """Return to be expected, (rows,)."""
        return self.critic(seen).squeeze(-1)


class Rollout(NamedTuple):
    """Steps of all rows between two updates, each (steps, rows, ...)."""

    seen: Tensor
    actions: Tensor
    log_prob: Tensor
    rewards: Tensor
    next_seen: Tensor
    """what the step led to: where the episode ended, its last observation and not the next one's first"""
    terminated: Tensor
    done: Tensor
    learned: Tensor
    """false where the step was a reset and the action was ignored"""


def network(inputs: int, width: int, outputs: int, *, gain: float) -> nn.Sequential:
    """Two hidden layers of tanh, orthogonal weights."""
    layers: list[nn.Module] = []
    for size_in, size_out, scale in (
        (inputs, width, math.sqrt(2)),
        (width, width, math.sqrt(2)),
        (width, outputs, gain),
    ):
        layer = nn.Linear(size_in, size_out)
        nn.init.orthogonal_(layer.weight, scale)
        nn.init.zeros_(layer.bias)
        layers += [layer, nn.Tanh()]
    return nn.Sequential(*layers[:-1])


class Collector:
    """Steps a vector environment and keeps where it stands between two rollouts."""

    def __init__(self, envs: VectorEnv, seed: int) -> None:
        """Reset every row."""
        self.envs = envs
        self.same_step = envs.metadata["autoreset_mode"] is AutoresetMode.SAME_STEP
        self.seen = tensor(envs.reset(seed=seed)[0])
        self.to_reset = np.zeros(envs.num_envs, dtype=bool)  # of NEXT_STEP: rows whose next step is a reset

    @torch.no_grad()
    def collect(self, agent: Agent, steps: int) -> Rollout:
        """`steps` steps in every row."""
        kept = []
        for _ in range(steps):
            policy = agent.policy(self.seen)
            actions = policy.sample()
            observations, rewards, terminated, truncated, infos = self.envs.step(actions.numpy())
            done = terminated | truncated
            next_seen = np.array(observations, dtype=np.float32)
            if self.same_step and done.any():
                next_seen[done] = np.stack(list(infos["final_obs"][done]))
            learned = ~self.to_reset
            kept.append(
                (
                    self.seen,
                    actions,
                    policy.log_prob(actions).sum(-1),
                    *map(tensor, (rewards, next_seen)),
                    *map(torch.from_numpy, (terminated, done, learned)),
                )
            )
            self.seen = tensor(observations)
            if not self.same_step:
                self.to_reset = done
        return Rollout(*(torch.stack(column) for column in zip(*kept, strict=True)))


def tensor(values: np.ndarray) -> Tensor:
    """Single precision, on the CPU."""
    return torch.from_numpy(np.array(values, dtype=np.float32))


@torch.no_grad()
def advantages_and_returns(agent: Agent, rollout: Rollout, args: Args) -> tuple[Tensor, Tensor]:
    """Generalised advantage estimates, which stop at an episode's end, and the returns that the critic learns.

    A terminated episode is worth nothing more; a truncated one what the critic makes of its last observation.
    """
    values, beyond = agent.value(rollout.seen), agent.value(rollout.next_seen)
    delta = rollout.rewards + args.gamma * beyond * ~rollout.terminated - values
    advantages = torch.zeros_like(delta)
    later = torch.zeros_like(delta[0])
    for step in reversed(range(len(delta))):
        later = delta[step] + args.gamma * args.gae_lambda * ~rollout.done[step] * later
        advantages[step] = later
    return advantages, advantages + values


def update(agent: Agent, optimizer: torch.optim.Optimizer, rollout: Rollout, args: Args) -> None:
    """Gradient steps on the rows of a rollout that were no resets."""
    advantages, returns = advantages_and_returns(agent, rollout, args)
    mask = rollout.learned
    columns = (rollout.seen, rollout.actions, rollout.log_prob, advantages, returns)
    seen, actions, old_log_prob, advantages, returns = (column[mask] for column in columns)
    for _ in range(args.epochs):
        for rows in torch.randperm(len(seen)).split(args.minibatch):
            own = advantages[rows]
            own = (own - own.mean()) / (own.std(correction=0) + 1e-8)
            log_ratio = agent.policy(seen[rows]).log_prob(actions[rows]).sum(-1) - old_log_prob[rows]
            ratio = log_ratio.exp()
            gain = torch.minimum(own * ratio, own * ratio.clamp(1 - args.clip, 1 + args.clip))
            error = agent.value(seen[rows]) - returns[rows]
            loss = error.square().mean() / 2 - gain.mean()
            optimizer.zero_grad()
            loss.backward()
            nn.utils.clip_grad_norm_(agent.parameters(), args.max_grad_norm)
            optimizer.step()
            if (ratio - 1 - log_ratio).mean().item() > args.target_kl:
                return


@torch.no_grad()
def mean_return(agent: Agent, args: Args) -> float:
    """Mean undiscounted return of noise-free episodes, one a row, all begun by a seed of their own."""
    envs = gym.make_vec(args.env_id, num_envs=args.eval_episodes, autoreset_mode="NEXT_STEP")
    seen = envs.reset(seed=args.seed + 10_000)[0]
    returns, going = np.zeros(args.eval_episodes), np.ones(args.eval_episodes, dtype=bool)
    while going.any():
        seen, rewards, terminated, truncated, _ = envs.step(agent.actor(tensor(seen)).numpy())
        returns += np.where(going, rewards, 0)
        going &= ~(terminated | truncated)
    envs.close()
    return float(returns.mean())


def train(args: Args, *, quiet: bool = False) -> tuple[Agent, float, float]:
    """Train an agent from random weights.

    Returns:
        The agent, and its mean noise-free return before and after.
    """
    torch.manual_seed(args.seed)
    envs = gym.make_vec(args.env_id, num_envs=args.num_envs, autoreset_mode=args.autoreset_mode)
    observation_shape, action_shape = envs.single_observation_space.shape, envs.single_action_space.shape
    if observation_shape is None or action_shape is None or len(observation_shape) != 1 or len(action_shape) != 1:
        raise TypeError(f"env_id = {args.env_id!r} is not allowed; allowed: flat boxes of observations and actions")
    agent = Agent(*observation_shape, *action_shape, args)
    optimizer = torch.optim.Adam(agent.parameters(), lr=args.learning_rate, eps=1e-5)
    before, start = mean_return(agent, args), time.perf_counter()
    collector = Collector(envs, args.seed)
    updates = args.steps // (args.num_envs * args.rollout)
    for number in range(updates):
        optimizer.param_groups[0]["lr"] = args.learning_rate * (1 - number / updates)
        rollout = collector.collect(agent, args.rollout)
        update(agent, optimizer, rollout, args)
        if not quiet and (number + 1) % max(1, updates // 10) == 0:
            done, seconds = (number + 1) * args.num_envs * args.rollout, time.perf_counter() - start
            reward = rollout.rewards[rollout.learned].mean()
            print(f"{done:>10,} rows  {seconds:6.1f} s  mean reward with noise {reward:8.3f}")
    envs.close()
    return agent, before, mean_return(agent, args)


def main() -> None:
    """Train, and print the mean return before and after."""
    parser = argparse.ArgumentParser(description=(__doc__ or "").splitlines()[0])
    for field in dataclasses.fields(Args):
        parser.add_argument(f"--{field.name.replace('_', '-')}", type=type(field.default), default=field.default)
    args = Args(**vars(parser.parse_args()))
    torch.set_num_threads(1)
    _, before, after = train(args)
    print(f"{args.env_id}, seed {args.seed}: mean return of {args.eval_episodes} noise-free episodes")
    print(f"  before {before:.4f}, after {after:.4f}")


if __name__ == "__main__":
    main()
