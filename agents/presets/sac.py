"""Settings of SAC, and its presets."""

from typing import TYPE_CHECKING, ClassVar

from agents.presets.off_policy import MaximumEntropySettings
from agents.presets.preset import Preset
from flapenv.aero.checks import record

if TYPE_CHECKING:
    from stable_baselines3 import SAC
    from stable_baselines3.common.vec_env import VecEnv


@record
class SACSettings(MaximumEntropySettings):
    """Soft actor-critic; the fields are those of `MaximumEntropySettings`."""

    algorithm: ClassVar[str] = "SAC"

    def build(self, env: "VecEnv", seed: int) -> "SAC":
        """The model with random weights on `env`."""
        from stable_baselines3 import SAC

        return SAC("MlpPolicy", env, ent_coef=self.entropy, **self.arguments(seed))


PRESETS = {
    "hover-sac": Preset(task="hover", settings=SACSettings()),
    "hover-sac-50k": Preset(
        task="hover",
        settings=SACSettings(wingbeats=50_000, rows=8, gradient_steps=3, buffer=20_000, learning_starts=1_000),
    ),
}
