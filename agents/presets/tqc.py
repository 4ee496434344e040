"""Settings of TQC, and its presets."""

from typing import TYPE_CHECKING, ClassVar

from agents.presets.off_policy import MaximumEntropySettings
from agents.presets.preset import Preset
from flapenv.aero.checks import record, require_count

if TYPE_CHECKING:
    from sb3_contrib import TQC
    from stable_baselines3.common.vec_env import VecEnv


@record
class TQCSettings(MaximumEntropySettings):
    """Truncated quantile critics. The reward of one wingbeat is certain, so few quantiles do and none is dropped.

    The other fields are those of `MaximumEntropySettings`.

    Attributes:
        wingbeats: training budget, one wingbeat a row.
        quantiles: of each critic.
        dropped: largest quantiles of each critic that do not count, against overestimation.
    """

    algorithm: ClassVar[str] = "TQC"

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

    def build(self, env: "VecEnv", seed: int) -> "TQC":
        """The model with random weights on `env`."""
        from sb3_contrib import TQC

        return TQC(
            "MlpPolicy",
            env,
            ent_coef=self.entropy,
            top_quantiles_to_drop_per_net=self.dropped,
            **self.arguments(seed, n_quantiles=self.quantiles),
        )


PRESETS = {"hover-tqc": Preset(task="hover", settings=TQCSettings())}
