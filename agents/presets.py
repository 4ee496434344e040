"""Settings of the learners: one frozen record each, everything needed to repeat a run."""

from flapenv.aero.checks import record, require_count, require_scalar


@record
class PPOPreset:
    """Proximal policy optimisation for one-wingbeat episodes; a discount factor would have nothing to act on.

    Attributes:
        wingbeats: training budget, one wingbeat a row.
        rows: wingbeats between two updates.
        minibatch: rows of a gradient step.
        epochs: passes over the rows, cut short where the policy has moved by `target_kl`.
        learning_rate: at the start; falls towards zero with `learning_rate_power` of the budget that is left.
        learning_rate_power: 1 is linear, more spends longer on small steps.
        clip_range: of the probability ratio.
        target_kl: the update stops at 1.5 times this divergence. It keeps early leaps from landing where the
            frequency is clipped and the reward is flat.
        width: neurons of each of the two hidden layers of actor and critic.
        log_std: log standard deviation of the actions at the start, in units of the cube.
        noise_floor: log standard deviation that the noise cannot fall below, at the start.
        last_noise_floor: the same at the end; it falls linearly in between.
        floor_until: fraction of the budget at which the last floor is reached.
        threads: of torch; networks this small are fastest on one.
    """

    wingbeats: int = 4_000_000
    rows: int = 2_048
    minibatch: int = 512
    epochs: int = 8
    learning_rate: float = 3e-3
    learning_rate_power: float = 3.0
    clip_range: float = 0.2
    target_kl: float = 0.2
    width: int = 64
    log_std: float = -0.5
    noise_floor: float = -4.0
    last_noise_floor: float = -6.5
    floor_until: float = 0.8
    threads: int = 1

    def __post_init__(self) -> None:
        """Check every field."""
        for name in ("wingbeats", "rows", "minibatch", "epochs", "width", "threads"):
            require_count(name, getattr(self, name))
        for name in ("learning_rate", "learning_rate_power", "clip_range", "target_kl"):
            require_scalar(name, getattr(self, name), 0.0, open_low=True)
        for name in ("log_std", "noise_floor", "last_noise_floor"):
            require_scalar(name, getattr(self, name), -20.0, 0.0)
        require_scalar("floor_until", self.floor_until, 0.0, 1.0, open_low=True)

    def learning_rate_at(self, left: float) -> float:
        """Learning rate of the update after which the fraction `left` of the budget is still to go."""
        before = min(1.0, max(left, 0.0) + self.rows / self.wingbeats)  # even the last update learns a little
        return float(self.learning_rate * before**self.learning_rate_power)

    def noise_floor_at(self, left: float) -> float:
        """Floor of the log standard deviation with the fraction `left` of the budget still to go."""
        done = min(1.0, (1 - left) / self.floor_until)
        return self.noise_floor + (self.last_noise_floor - self.noise_floor) * done
