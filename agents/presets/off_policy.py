"""What the learners with a replay buffer share: budget, networks, and what falls while they learn."""

from abc import ABC, abstractmethod
from typing import TYPE_CHECKING, Any, ClassVar

from agents.presets.limits import require_counts
from flapenv.aero.checks import HUGEST, record, require_count, require_scalar

if TYPE_CHECKING:
    from stable_baselines3.common.off_policy_algorithm import OffPolicyAlgorithm
    from stable_baselines3.common.vec_env import VecEnv

LEAST_LEFT = 0.003
"""The learning rate stops falling when this fraction of the budget is left."""


def fallen(first: float, last: float, left: float, until: float) -> float:
    """Geometrically from `first` to `last`, which is reached when the fraction `until` of the budget is spent."""
    done = min(1.0, (1.0 - max(left, 0.0)) / until)
    return float(first * (last / first) ** done)


@record
class OffPolicySettings(ABC):
    """Settings of a learner that fits a critic to a replay buffer and climbs it.

    Where an episode is one wingbeat the critic regresses the reward itself: nothing is bootstrapped, a discount factor
    has nothing to act on, and one critic is enough, for nothing overestimates.

    Attributes:
        wingbeats: training budget, one wingbeat a row.
        rows: wingbeats flown at a time.
        learning_starts: wingbeats of random actions before the first gradient step.
        batch: wingbeats of a gradient step.
        buffer: wingbeats kept, the latest.
        gradient_steps: after every `rows` wingbeats.
        learning_rate: of actor and critic at the start.
        learning_rate_power: it falls with this power of the budget that is left; 1 is linear.
        width: neurons of each of the actor's two hidden layers.
        critic_width: the same of each critic.
        critics: how many; two or more guard against overestimation where values are bootstrapped.
        gamma: discount factor, for tasks of many wingbeats.
        threads: of torch; networks this small are fastest on one.
    """

    algorithm: ClassVar[str]

    wingbeats: int = 300_000
    rows: int = 64
    learning_starts: int = 2_000
    batch: int = 256
    buffer: int = 100_000
    gradient_steps: int = 4
    learning_rate: float = 2e-3
    learning_rate_power: float = 1.0
    width: int = 64
    critic_width: int = 128
    critics: int = 1
    gamma: float = 0.0
    threads: int = 1

    def __post_init__(self) -> None:
        """Check every field.

        Raises:
            TypeError: for a field of another kind.
            ValueError: for a value outside its range, for a buffer that cannot hold one batch of rows, and for a
                budget that is spent before anything is learned.
        """
        require_counts(self, "wingbeats", "rows", "batch", "buffer", "gradient_steps", "width", "critic_width")
        require_counts(self, "critics", "threads")
        require_count("learning_starts", self.learning_starts, low=0)
        for name in ("learning_rate", "learning_rate_power"):
            require_scalar(name, getattr(self, name), 0.0, HUGEST, open_low=True)
        require_scalar("gamma", self.gamma, 0.0, 1.0)
        if self.buffer < self.rows:
            raise ValueError(f"buffer = {self.buffer} is not allowed; allowed: at least rows = {self.rows}")
        if self.wingbeats <= self.learning_starts:
            raise ValueError(
                f"wingbeats = {self.wingbeats} is not allowed; allowed: more than learning_starts = "
                f"{self.learning_starts}"
            )

    @abstractmethod
    def build(self, env: "VecEnv", seed: int) -> "OffPolicyAlgorithm":
        """The model with random weights on `env`."""

    @abstractmethod
    def anneal(self, model: Any, left: float) -> None:
        """Set on `model` what falls, with the fraction `left` of the budget still to go."""

    def learning_rate_at(self, left: float) -> float:
        """Learning rate with the fraction `left` of the budget still to go."""
        return float(self.learning_rate * min(1.0, max(left, LEAST_LEFT)) ** self.learning_rate_power)

    def arguments(self, seed: int, **policy: Any) -> dict[str, Any]:
        """Arguments that the models share.

        Args:
            seed: of networks, noise and draws.
            **policy: more arguments of the policy, over those shared.
        """
        return {
            "learning_rate": self.learning_rate_at,
            "buffer_size": self.buffer,
            "learning_starts": self.learning_starts,
            "batch_size": self.batch,
            "gamma": self.gamma,
            "train_freq": 1,
            "gradient_steps": self.gradient_steps,
            "policy_kwargs": {
                "net_arch": {"pi": [self.width] * 2, "qf": [self.critic_width] * 2},
                "n_critics": self.critics,
                "optimizer_kwargs": {"fused": True},  # one kernel for all weights
                **policy,
            },
            "seed": seed,
            "device": "cpu",
        }


@record
class MaximumEntropySettings(OffPolicySettings):
    """Settings of a learner whose actions are paid for their entropy, at a price that falls.

    At the kink of the penalty the policy stands off by about its noise, and off a face of the box by the price over the
    reward's slope there, so the price must end low. And it must start high: a wing that flaps narrow and fast, where
    the frequency is clipped and the reward is flat, has no way back once its noise has died. A price that is learned
    for a fixed entropy ("auto") keeps the noise instead.

    Attributes:
        entropy: price of the entropy at the start, in units of the reward a nat.
        last_entropy: at the end; it falls geometrically.
        entropy_until: fraction of the budget at which the last price is reached.
    """

    entropy: float = 1.0
    last_entropy: float = 1e-4
    entropy_until: float = 0.9

    def __post_init__(self) -> None:
        """Check every field."""
        super().__post_init__()
        for name in ("entropy", "last_entropy"):
            require_scalar(name, getattr(self, name), 0.0, HUGEST, open_low=True)
        require_scalar("entropy_until", self.entropy_until, 0.0, 1.0, open_low=True)

    def entropy_at(self, left: float) -> float:
        """Price of the entropy with the fraction `left` of the budget still to go."""
        return fallen(self.entropy, self.last_entropy, left, self.entropy_until)

    def anneal(self, model: Any, left: float) -> None:
        """Set the price."""
        model.ent_coef_tensor.fill_(self.entropy_at(left))
