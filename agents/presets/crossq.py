"""Settings of CrossQ, and its presets."""

from typing import TYPE_CHECKING, Any, ClassVar

from agents.presets.off_policy import LEAST_LEFT, MaximumEntropySettings
from agents.presets.preset import Preset
from flapenv.aero.checks import record, require_count, require_scalar

if TYPE_CHECKING:
    from sb3_contrib import CrossQ
    from stable_baselines3.common.vec_env import VecEnv


@record
class CrossQSettings(MaximumEntropySettings):
    """CrossQ: batch renormalisation in place of target networks.

    The other fields are those of `MaximumEntropySettings`.

    The running statistics follow every batch, and their noise moves the strokes of all wings at once: at a constant
    momentum by more than a percent of the gap. So the momentum falls with the square of the budget that is left. A
    buffer of recent wingbeats keeps the statistics from changing when they have become slow.

    Attributes:
        wingbeats: training budget, one wingbeat a row.
        buffer: wingbeats kept, the latest.
        learning_rate_power: the learning rate falls with this power of the budget that is left.
        policy_delay: gradient steps of the critic for one of the actor.
        norm_warmup: gradient steps of a network before its running statistics replace those of the batch.
        norm_momentum: of the running statistics at the start.
    """

    algorithm: ClassVar[str] = "CrossQ"

    wingbeats: int = 240_000
    buffer: int = 30_000
    learning_rate_power: float = 2.0
    policy_delay: int = 2
    norm_warmup: int = 2_000
    norm_momentum: float = 0.01

    def __post_init__(self) -> None:
        """Check every field."""
        super().__post_init__()
        require_count("policy_delay", self.policy_delay)
        require_count("norm_warmup", self.norm_warmup, low=0)
        require_scalar("norm_momentum", self.norm_momentum, 0.0, 1.0, open_low=True)

    def norm_momentum_at(self, left: float) -> float:
        """Momentum of the running statistics with the fraction `left` of the budget still to go."""
        return float(self.norm_momentum * max(left, LEAST_LEFT) ** 2)

    def anneal(self, model: Any, left: float) -> None:
        """Set the price of entropy and the momentum."""
        from sb3_contrib.common.torch_layers import BatchRenorm

        super().anneal(model, left)
        for layer in model.policy.modules():
            if isinstance(layer, BatchRenorm):
                layer.momentum = self.norm_momentum_at(left)

    def build(self, env: "VecEnv", seed: int) -> "CrossQ":
        """The model with random weights on `env`."""
        from sb3_contrib import CrossQ

        return CrossQ(
            "MlpPolicy",
            env,
            ent_coef=self.entropy,
            policy_delay=self.policy_delay,
            **self.arguments(seed, renorm_warmup_steps=self.norm_warmup, batch_norm_momentum=self.norm_momentum),
        )


PRESETS = {"hover-crossq": Preset(task="hover", settings=CrossQSettings())}
