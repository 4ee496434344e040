"""Settings of SAC, and its presets."""

from stable_baselines3 import SAC
from stable_baselines3.common.vec_env import VecEnv

from agents.presets.off_policy import MaximumEntropySettings
from flapenv.aero.checks import record


@record
class SACSettings(MaximumEntropySettings):
    """Soft actor-critic; the fields are those of `MaximumEntropySettings`."""

    def build(self, env: VecEnv, seed: int) -> SAC:
        """The model with random weights on `env`."""
        return SAC("MlpPolicy", env, ent_coef=self.entropy, **self.arguments(seed))


PRESETS: dict[str, SACSettings] = {
    "hover-sac": SACSettings(),
    "hover-sac-50k": SACSettings(wingbeats=50_000, rows=8, gradient_steps=3, buffer=20_000, learning_starts=1_000),
}
