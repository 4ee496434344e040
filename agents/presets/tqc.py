"""Settings of TQC, and its presets."""

from sb3_contrib import TQC
from stable_baselines3.common.vec_env import VecEnv

from agents.presets.off_policy import MaximumEntropySettings
from flapenv.aero.checks import record, require_count


@record
class TQCSettings(MaximumEntropySettings):
    """Truncated quantile critics. The reward of one wingbeat is certain, so few quantiles do and none is dropped.

    The other fields are those of `MaximumEntropySettings`.

    Attributes:
        wingbeats: training budget, one wingbeat a row.
        quantiles: of each critic.
        dropped: largest quantiles of each critic that do not count, against overestimation.
    """

    wingbeats: int = 400_000
    quantiles: int = 5
    dropped: int = 0

    def __post_init__(self) -> None:
        """Check every field."""
        super().__post_init__()
        require_count("quantiles", self.quantiles)
        if require_count("dropped", self.dropped, low=0) >= self.quantiles:
            raise ValueError(
                f"dropped = {self.dropped} is not allowed; allowed: fewer than quantiles = {self.quantiles}"
            )

    def build(self, env: VecEnv, seed: int) -> TQC:
        """The model with random weights on `env`."""
        return TQC(
            "MlpPolicy",
            env,
            ent_coef=self.entropy,
            top_quantiles_to_drop_per_net=self.dropped,
            **self.arguments(seed, n_quantiles=self.quantiles),
        )


PRESETS: dict[str, TQCSettings] = {"hover-tqc": TQCSettings()}
