"""Gradient ascent through the differentiable model: settings, and the presets that use them."""

from typing import TYPE_CHECKING, Any, ClassVar

from agents.presets.limits import require_an_update, require_counts
from agents.presets.preset import Preset
from flapenv.aero.checks import HUGEST, record, require_scalar

if TYPE_CHECKING:
    from stable_baselines3.common.vec_env import VecEnv

    from agents.gradient_agent import GradientAgent


@record
class GradientSettings:
    """Adam on the mean reward of a batch, the policy's mean as the action.

    Attributes:
        wingbeats: training budget; a row with its gradient counts three.
        rows: of the batch of one step of Adam.
        learning_rate: at the start; falls towards zero with `learning_rate_power` of the budget that is left.
        learning_rate_power: 1 is linear, more spends longer on small steps.
        width: neurons of each of the two hidden layers.
        threads: of torch.
    """

    algorithm: ClassVar[str] = "gradient"

    wingbeats: int = 2_000_000
    rows: int = 64
    learning_rate: float = 3e-3
    learning_rate_power: float = 3.0
    width: int = 64
    threads: int = 1

    def __post_init__(self) -> None:
        """Check every field."""
        require_counts(self, "wingbeats", "rows", "width", "threads")
        require_an_update(self.wingbeats, 3 * self.rows, "3 x rows")
        for name in ("learning_rate", "learning_rate_power"):
            require_scalar(name, getattr(self, name), 0.0, HUGEST, open_low=True)

    def learning_rate_at(self, left: float) -> float:
        """Learning rate of the step before which the fraction `left` of the budget is still to go."""
        return float(self.learning_rate * max(left, 0.0) ** self.learning_rate_power)

    def build(self, env: "VecEnv", seed: int) -> "GradientAgent":
        """The agent with random weights."""
        from agents.gradient_agent import GradientAgent
        from agents.policy import HoverPolicy

        return GradientAgent(
            HoverPolicy,
            env,
            self.learning_rate_at,
            policy_kwargs={"net_arch": [self.width, self.width]},
            seed=seed,
        )

    def anneal(self, model: Any, left: float) -> None:
        """Nothing falls but the learning rate."""


PRESETS = {
    "hover-gradient": Preset(task="hover", settings=GradientSettings()),
    "random-wings-gradient": Preset(task="random-wings", settings=GradientSettings(rows=1024, wingbeats=30_000_000)),
}
