"""Settings of CrossQ, and its presets."""

from sb3_contrib import CrossQ
from stable_baselines3.common.vec_env import VecEnv

from agents.presets.off_policy import MaximumEntropySettings
from flapenv.aero.checks import record, require_count, require_scalar


@record
class CrossQSettings(MaximumEntropySettings):
    """CrossQ: batch renormalisation in place of target networks.

    Attributes:
        policy_delay: gradient steps of the critic for one of the actor.
        norm_warmup: gradient steps before running statistics replace those of the batch.
        norm_momentum: of the running statistics.
    """

    policy_delay: int = 2
    norm_warmup: int = 2_000
    norm_momentum: float = 0.01

    def __post_init__(self) -> None:
        """Check every field."""
        super().__post_init__()
        require_count("policy_delay", self.policy_delay)
        require_count("norm_warmup", self.norm_warmup, low=0)
        require_scalar("norm_momentum", self.norm_momentum, 0.0, 1.0, open_low=True)

    def build(self, env: VecEnv, seed: int) -> CrossQ:
        """The model with random weights on `env`."""
        return CrossQ(
            "MlpPolicy",
            env,
            ent_coef=self.entropy,
            policy_delay=self.policy_delay,
            **self.arguments(seed, renorm_warmup_steps=self.norm_warmup, batch_norm_momentum=self.norm_momentum),
        )


PRESETS: dict[str, CrossQSettings] = {"hover-crossq": CrossQSettings()}
