"""Proximal policy optimisation of a policy with memory: settings, and the preset that uses them."""

from typing import TYPE_CHECKING, Any, ClassVar

from agents.presets.limits import require_an_update, require_counts
from agents.presets.preset import Preset
from flapenv.aero.checks import HUGEST, record, require_scalar

if TYPE_CHECKING:
    from sb3_contrib import RecurrentPPO
    from stable_baselines3.common.vec_env import VecEnv


@record
class RecurrentPPOSettings:
    """Proximal policy optimisation with an LSTM before the actor's layers; the critic has a linear layer in its place.

    Attributes:
        wingbeats: training budget, one wingbeat a row.
        rows: of the batch that is flown at once.
        steps: wingbeats of every row between two updates; whole episodes leave nothing to be remembered across them.
        minibatch: wingbeats of a gradient step.
        epochs: passes over the wingbeats, cut short where the policy has moved by `target_kl`.
        learning_rate: at the start; it falls linearly towards zero with the budget that is left.
        clip_range: of the probability ratio.
        target_kl: the update stops at 1.5 times this divergence.
        gradient_norm: longer gradients are cut to it.
        memory: numbers that the LSTM remembers and gives out.
        width: neurons of each hidden layer of actor and critic, which have tanh between them.
        layers: hidden layers of each.
        log_std: log standard deviation of the actions at the start, in units of the cube; it is learned.
        gamma: discount factor; 0 credits an action with its own wingbeat alone.
        gae_lambda: of the generalised advantage.
        threads: of torch; networks this small are fastest on one.
    """

    algorithm: ClassVar[str] = "RecurrentPPO"

    wingbeats: int = 2_200_000
    rows: int = 256
    steps: int = 20
    minibatch: int = 1_280
    epochs: int = 5
    learning_rate: float = 1.5e-3
    clip_range: float = 0.2
    target_kl: float = 0.2
    gradient_norm: float = 0.5
    memory: int = 64
    width: int = 64
    layers: int = 2
    log_std: float = -1.0
    gamma: float = 0.0
    gae_lambda: float = 0.0
    threads: int = 1

    def __post_init__(self) -> None:
        """Check every field."""
        require_counts(
            self, "wingbeats", "rows", "steps", "minibatch", "epochs", "memory", "width", "layers", "threads"
        )
        require_an_update(self.wingbeats, self.rows * self.steps, "rows x steps")
        for name in ("learning_rate", "clip_range", "target_kl", "gradient_norm"):
            require_scalar(name, getattr(self, name), 0.0, HUGEST, open_low=True)
        require_scalar("log_std", self.log_std, -20.0, 0.0)
        for name in ("gamma", "gae_lambda"):
            require_scalar(name, getattr(self, name), 0.0, 1.0)

    def learning_rate_at(self, left: float) -> float:
        """Learning rate of the update after which the fraction `left` of the budget is still to go."""
        update = self.rows * self.steps / self.wingbeats  # even the last one learns a little
        return float(self.learning_rate * min(1.0, max(left, 0.0) + update))

    def build(self, env: "VecEnv", seed: int) -> "RecurrentPPO":
        """The learner with random weights."""
        from sb3_contrib import RecurrentPPO

        return RecurrentPPO(
            "MlpLstmPolicy",
            env,
            learning_rate=self.learning_rate_at,
            n_steps=self.steps,
            batch_size=min(self.minibatch, self.rows * self.steps),
            n_epochs=self.epochs,
            gamma=self.gamma,
            gae_lambda=self.gae_lambda,
            clip_range=self.clip_range,
            target_kl=self.target_kl,
            max_grad_norm=self.gradient_norm,
            policy_kwargs={
                "net_arch": [self.width] * self.layers,
                "lstm_hidden_size": self.memory,
                "enable_critic_lstm": False,
                "log_std_init": self.log_std,
            },
            seed=seed,
            device="cpu",
        )

    def anneal(self, model: Any, left: float) -> None:
        """Nothing falls but the learning rate."""


PRESETS = {"adapt-recurrentppo": Preset(task="adapt", settings=RecurrentPPOSettings())}
