"""An agent that sees the reward's gradient: the yardstick of what a policy of the same class can reach.

The others learn from rewards alone. This one is handed d(reward)/d(action) by the differentiable model and follows it
through the mean of its policy, without noise, without a critic.
"""

from typing import Any, ClassVar

import numpy as np
import torch
from gymnasium import spaces
from stable_baselines3.common.base_class import BaseAlgorithm
from stable_baselines3.common.policies import ActorCriticPolicy, BasePolicy
from stable_baselines3.common.type_aliases import MaybeCallback, Schedule
from stable_baselines3.common.vec_env import VecEnv

from agents.competition.budget import GRADIENT_COST
from agents.policy import HoverPolicy


class GradientAgent(BaseAlgorithm):
    """Stable-Baselines3's interface around gradient ascent on the mean reward of the rows of a batch.

    The environment must offer `differentiable_reward(actions)`, as `flapenv.envs.HoverVectorEnv` does. A row that is
    evaluated with its gradient counts `GRADIENT_COST` wingbeats; the step that draws the next wings is that evaluation
    once more and is not counted again.
    """

    policy: HoverPolicy
    policy_aliases: ClassVar[dict[str, type[BasePolicy]]] = {"HoverPolicy": HoverPolicy}

    def __init__(
        self,
        policy: str | type[ActorCriticPolicy],
        env: VecEnv,
        learning_rate: float | Schedule,
        *,
        policy_kwargs: dict[str, Any] | None = None,
        seed: int | None = None,
        device: str = "cpu",
        _init_setup_model: bool = True,
    ) -> None:
        """Build the policy.

        Args:
            policy: an actor-critic class; only its actor's mean is trained.
            env: over a batch that offers `differentiable_reward`.
            learning_rate: of Adam; a number or a schedule of the budget's fraction that is left.
            policy_kwargs: of the policy.
            seed: of networks and draws.
            device: of torch.
        """
        super().__init__(
            policy,
            env,
            learning_rate,
            policy_kwargs=policy_kwargs,
            seed=seed,
            device=device,
            support_multi_env=True,
            supported_action_spaces=(spaces.Box,),
        )
        if _init_setup_model:
            self._setup_model()

    def _setup_model(self) -> None:
        self._setup_lr_schedule()
        self.set_random_seed(self.seed)
        made = self.policy_class(
            self.observation_space, self.action_space, lr_schedule=self.lr_schedule, **self.policy_kwargs
        )
        assert isinstance(made, HoverPolicy)
        self.policy = made.to(self.device)

    def _get_torch_save_params(self) -> tuple[list[str], list[str]]:
        """What Stable-Baselines3's files and checkpoints keep: the networks and what Adam remembers."""
        return ["policy", "policy.optimizer"], []

    def learn(
        self,
        total_timesteps: int,
        callback: MaybeCallback = None,
        log_interval: int = 1,
        tb_log_name: str = "gradient",
        reset_num_timesteps: bool = True,
        progress_bar: bool = False,
    ) -> "GradientAgent":
        """Follow the gradient until the budget is spent; arguments as Stable-Baselines3's."""
        total_timesteps, callback = self._setup_learn(
            total_timesteps, callback, reset_num_timesteps, tb_log_name, progress_bar
        )
        callback.on_training_start(locals(), globals())
        assert self.env is not None
        while self.num_timesteps < total_timesteps:
            callback.on_rollout_start()
            self._update_current_progress_remaining(self.num_timesteps, total_timesteps)
            actions = self._climb(self.env)
            observations, rewards, _, _ = self.env.step(actions)
            self._last_obs = np.asarray(observations)
            self.num_timesteps += GRADIENT_COST * self.env.num_envs
            callback.update_locals({"rewards": rewards})
            if not callback.on_step():
                break
            callback.on_rollout_end()
            self._n_updates += 1
            if self._n_updates % log_interval == 0:
                self.logger.dump(self.num_timesteps)
        callback.on_training_end()
        return self

    def _climb(self, env: VecEnv) -> np.ndarray:
        """One step of Adam on the rows as they are; the actions that were evaluated."""
        optimizer = self.policy.optimizer
        self._update_learning_rate(optimizer)
        mean = self.policy.mean_action(torch.as_tensor(self._last_obs, device=self.device))
        reward = env.env_method("differentiable_reward", mean, indices=0)[0]
        loss = -reward.mean()
        optimizer.zero_grad()
        torch.autograd.backward(loss)
        optimizer.step()
        return np.asarray(mean.detach().clamp(-1, 1).cpu().numpy())
