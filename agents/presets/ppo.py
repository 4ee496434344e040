"""Proximal policy optimisation: settings, and the presets that use them."""

import math
from typing import TYPE_CHECKING, Any, ClassVar

from agents.presets.limits import require_an_update, require_counts
from agents.presets.preset import Preset
from flapenv.aero.checks import HUGEST, record, require_name, require_scalar, shown

if TYPE_CHECKING:
    from stable_baselines3 import PPO
    from stable_baselines3.common.vec_env import VecEnv

ACTIVATIONS = {"relu": "ReLU", "silu": "SiLU", "tanh": "Tanh"}
"""By their names in torch."""


@record
class PPOSettings:
    """Proximal policy optimisation; where an episode is one wingbeat, `gamma` and `gae_lambda` have nothing to act on.

    Attributes:
        wingbeats: training budget, one wingbeat a row.
        rows: of the batch that is flown at once.
        steps: wingbeats of every row between two updates.
        minibatch: rows of a gradient step.
        epochs: passes over the rows, cut short where the policy has moved by `target_kl`.
        learning_rate: at the start. It falls by `learning_rate_ratio` over the budget, evenly on a log scale as the
            noise does, because a step that suits one noise is too long for a smaller one; and towards zero with
            `learning_rate_power` of the budget that is left.
        learning_rate_ratio: of last to first learning rate, before the power; 1 leaves it to the power.
        learning_rate_power: 1 is linear, more spends longer on small steps.
        clip_range: of the probability ratio.
        target_kl: the update stops at 1.5 times this divergence. It keeps early leaps from landing where the
            frequency is clipped and the reward is flat.
        gradient_norm: longer gradients are cut to it; None cuts nothing. The actor's gradient grows as the noise falls:
            cut together with the critic's, it stops the critic.
        width: neurons of each hidden layer of actor and critic.
        layers: hidden layers of each.
        activation: "relu", "silu" or "tanh". ReLU tells wings of nearly the same features apart much sooner; smooth
            ones interpolate better between many wings.
        log_std: log standard deviation of the actions at the start, in units of the cube.
        noise_floor: log standard deviation that the noise cannot fall below, at the start.
        last_noise_floor: the same at the end; it falls linearly in between.
        floor_until: fraction of the budget at which the last floor is reached.
        gamma: discount factor.
        gae_lambda: of the generalised advantage.
        reward_scale: rewards are multiplied by it before anything is learned from them.
        first_mean: action that the policy's mean begins at, in the box; None for its middle.
        threads: of torch; networks this small are fastest on one.
    """

    algorithm: ClassVar[str] = "PPO"

    wingbeats: int = 3_500_000
    rows: int = 2_048
    steps: int = 1
    minibatch: int = 512
    epochs: int = 8
    learning_rate: float = 5e-3
    learning_rate_ratio: float = 0.005
    learning_rate_power: float = 1.0
    clip_range: float = 0.2
    target_kl: float = 0.2
    gradient_norm: float | None = None
    width: int = 64
    layers: int = 2
    activation: str = "relu"
    log_std: float = -0.5
    noise_floor: float = -3.5
    last_noise_floor: float = -8.5
    floor_until: float = 0.9
    gamma: float = 1.0
    gae_lambda: float = 1.0
    reward_scale: float = 1.0
    first_mean: tuple[float, ...] | None = None
    threads: int = 1

    def __post_init__(self) -> None:
        """Check every field."""
        require_counts(self, "wingbeats", "rows", "steps", "minibatch", "epochs", "width", "layers", "threads")
        require_an_update(self.wingbeats, self.rows * self.steps, "rows x steps")
        if min(self.minibatch, self.rows * self.steps) < 2:
            raise ValueError(f"minibatch = {self.minibatch} of rows = {self.rows} is not allowed; allowed: 2 and more")
        for name in ("learning_rate", "learning_rate_power", "clip_range", "target_kl", "reward_scale"):
            require_scalar(name, getattr(self, name), 0.0, HUGEST, open_low=True)
        require_scalar("learning_rate_ratio", self.learning_rate_ratio, 0.0, 1.0, open_low=True)
        require_name("activation", self.activation, ACTIVATIONS)
        if self.gradient_norm is not None:
            require_scalar("gradient_norm", self.gradient_norm, 0.0, open_low=True)
        for name in ("log_std", "noise_floor", "last_noise_floor"):
            require_scalar(name, getattr(self, name), -20.0, 0.0)
        require_scalar("floor_until", self.floor_until, 0.0, 1.0, open_low=True)
        for name in ("gamma", "gae_lambda"):
            require_scalar(name, getattr(self, name), 0.0, 1.0)
        if self.first_mean is not None:
            if not isinstance(self.first_mean, list | tuple):
                raise TypeError(
                    f"first_mean = {shown(self.first_mean)} is not allowed; allowed: a list of numbers, or none"
                )
            for number, value in enumerate(self.first_mean):
                require_scalar(f"first_mean[{number}]", value, -1.0, 1.0)
            object.__setattr__(self, "first_mean", tuple(float(value) for value in self.first_mean))

    def learning_rate_at(self, left: float) -> float:
        """Learning rate of the update after which the fraction `left` of the budget is still to go."""
        before = min(
            1.0, max(left, 0.0) + self.rows * self.steps / self.wingbeats
        )  # even the last update learns a little
        fall = self.learning_rate_ratio ** (1 - before) * before**self.learning_rate_power
        return float(self.learning_rate * fall)

    def noise_floor_at(self, left: float) -> float:
        """Floor of the log standard deviation with the fraction `left` of the budget still to go."""
        done = min(1.0, (1 - left) / self.floor_until)
        return self.noise_floor + (self.last_noise_floor - self.noise_floor) * done

    def build(self, env: "VecEnv", seed: int) -> "PPO":
        """The learner with random weights."""
        from stable_baselines3 import PPO
        from torch import nn

        from agents.policy import HoverPolicy

        return PPO(
            HoverPolicy,
            env,
            learning_rate=self.learning_rate_at,
            n_steps=self.steps,
            batch_size=min(self.minibatch, self.rows * self.steps),
            n_epochs=self.epochs,
            gamma=self.gamma,
            gae_lambda=self.gae_lambda,
            clip_range=self.clip_range,
            target_kl=self.target_kl,
            max_grad_norm=math.inf if self.gradient_norm is None else self.gradient_norm,
            policy_kwargs={
                "net_arch": [self.width] * self.layers,
                "activation_fn": getattr(nn, ACTIVATIONS[self.activation]),
                "log_std_init": self.log_std,
                "first_mean": self.first_mean,
            },
            seed=seed,
            device="cpu",
        )

    def anneal(self, model: Any, left: float) -> None:
        """Set the noise floor."""
        model.policy.noise_floor = self.noise_floor_at(left)


PRESETS = {
    "hover-ppo": Preset(task="hover", settings=PPOSettings()),
    "hover-ppo-50k": Preset(
        task="hover",
        settings=PPOSettings(
            wingbeats=50_000,
            rows=256,
            minibatch=64,
            epochs=10,
            learning_rate=3e-3,
            learning_rate_ratio=0.05,
            noise_floor=-2.0,
            last_noise_floor=-6.0,
            floor_until=0.9,
        ),
    ),
    "random-wings-ppo": Preset(
        task="random-wings",
        settings=PPOSettings(
            wingbeats=3_000_000,
            learning_rate=3e-3,
            layers=3,
            activation="silu",
            learning_rate_ratio=0.005,
            last_noise_floor=-8.0,
            floor_until=0.9,
        ),
    ),
    "adapt-ppo": Preset(
        task="adapt",
        settings=PPOSettings(
            wingbeats=9_000_000,
            rows=256,
            steps=20,
            minibatch=1_280,
            epochs=5,
            learning_rate=1.5e-3,
            learning_rate_ratio=1.0,
            gradient_norm=0.5,
            activation="tanh",
            log_std=-1.0,
            noise_floor=-4.0,
            last_noise_floor=-6.5,
            floor_until=0.8,
            gamma=0.0,
            gae_lambda=0.0,
        ),
    ),
    "waveform-ppo": Preset(
        task="waveform",
        settings=PPOSettings(
            wingbeats=5_000_000,
            learning_rate=1e-3,
            learning_rate_ratio=1.0,
            learning_rate_power=3.0,
            target_kl=0.03,
            gradient_norm=0.5,
            activation="tanh",
            noise_floor=-4.0,
            last_noise_floor=-6.5,
            floor_until=0.8,
        ),
    ),
    "heave-ppo": Preset(
        task="heave",
        settings=PPOSettings(
            wingbeats=4_000_000,
            rows=256,
            steps=64,
            minibatch=2_048,
            learning_rate=1e-3,
            learning_rate_ratio=1.0,
            gradient_norm=0.5,
            activation="tanh",
            log_std=-2.0,
            noise_floor=-5.0,
            last_noise_floor=-6.5,
            floor_until=0.8,
            gamma=0.97,
            gae_lambda=0.95,
            first_mean=(0.4, 1.0, 1.0, 1.0, 0.0),
        ),
    ),
}
