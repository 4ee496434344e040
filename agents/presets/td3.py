"""Settings of TD3, and its presets."""

from typing import TYPE_CHECKING, Any, ClassVar

from agents.presets.off_policy import OffPolicySettings, fallen
from agents.presets.preset import Preset
from flapenv.aero.checks import record, require_count, require_scalar

if TYPE_CHECKING:
    from stable_baselines3 import TD3
    from stable_baselines3.common.vec_env import VecEnv


@record
class TD3Settings(OffPolicySettings):
    """Twin delayed deterministic policy gradient; the other fields are those of `OffPolicySettings`.

    Attributes:
        wingbeats: training budget, one wingbeat a row.
        learning_rate_power: the learning rate falls with this power of the budget that is left. The policy has no noise
            of its own and hovers as exactly as the critic places the kink, which the small last steps decide.
        policy_delay: gradient steps of the critic for one of the actor. A slow actor and much noise at first keep it
            from running into a wrong face of the box, where tanh saturates and it stays, before the critic is right.
        noise: standard deviation of the actions flown at the start, in units of the cube.
        last_noise: at the end; it falls geometrically.
        noise_until: fraction of the budget at which the last noise is reached.
    """

    algorithm: ClassVar[str] = "TD3"

    wingbeats: int = 400_000
    learning_rate_power: float = 2.0
    policy_delay: int = 4
    noise: float = 0.6
    last_noise: float = 0.001
    noise_until: float = 0.95

    def __post_init__(self) -> None:
        """Check every field."""
        super().__post_init__()
        require_count("policy_delay", self.policy_delay)
        for name in ("noise", "last_noise"):
            require_scalar(name, getattr(self, name), 0.0, open_low=True)
        require_scalar("noise_until", self.noise_until, 0.0, 1.0, open_low=True)

    def noise_at(self, left: float) -> float:
        """Standard deviation of the actions flown with the fraction `left` of the budget still to go."""
        return fallen(self.noise, self.last_noise, left, self.noise_until)

    def anneal(self, model: Any, left: float) -> None:
        """Set the noise of every row."""
        from stable_baselines3.common.noise import VectorizedActionNoise

        noise = model.action_noise  # one a row, but where there is one row only
        rows: Any = noise.noises if isinstance(noise, VectorizedActionNoise) else [noise]
        for row in rows:
            row.size = self.noise_at(left)

    def build(self, env: "VecEnv", seed: int) -> "TD3":
        """The model with random weights on `env`."""
        from stable_baselines3 import TD3

        from agents.falling_noise import FallingNoise

        shape = env.action_space.shape
        assert shape is not None
        return TD3(
            "MlpPolicy",
            env,
            policy_delay=self.policy_delay,
            action_noise=FallingNoise(self.noise, shape[0]),
            **self.arguments(seed),
        )


PRESETS = {"hover-td3": Preset(task="hover", settings=TD3Settings())}
