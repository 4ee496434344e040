"""Wingbeats a second of learning, and where the time of PPO goes: `python -m benchmarks.learning`.

From the environment up to the whole learner, every line holds what the lines above it hold and a little more.
"""

import time
from collections.abc import Callable

import torch
from stable_baselines3 import PPO
from stable_baselines3.common.logger import Logger

from agents.callbacks import Annealing
from agents.presets import DEFAULT_PRESET, PRESETS, Preset
from agents.training import make_model
from benchmarks.speed import rate
from flapenv.tables import text_table

SHARE = 0.1
"""Of the preset's budget that is learned through from its beginning to its end."""


class Stopwatch:
    """Adds up the seconds that calls of a function take, those inside of each other once."""

    def __init__(self) -> None:
        """Nothing has been called."""
        self.seconds: dict[str, float] = {}
        self._inside: list[str] = []

    def watch(self, name: str, owner: object, method: str) -> None:
        """Count calls of `owner.method` under `name`, and not under what called it."""
        plain: Callable[..., object] = getattr(owner, method)

        def timed(*arguments: object, **options: object) -> object:
            started = time.perf_counter()
            self._inside.append(name)
            try:
                return plain(*arguments, **options)
            finally:
                self._inside.pop()
                took = time.perf_counter() - started
                self.seconds[name] = self.seconds.get(name, 0.0) + took
                if self._inside:
                    caller = self._inside[-1]
                    self.seconds[caller] = self.seconds.get(caller, 0.0) - took

        setattr(owner, method, timed)


def learner(preset: Preset) -> PPO:
    """PPO as it is trained."""
    model = make_model(preset, preset.make_task(), 0)
    assert isinstance(model, PPO)
    model.set_logger(Logger(folder=None, output_formats=[]))
    return model


def learn(model: PPO, preset: Preset) -> float:
    """Wingbeats a second of a whole run of the preset."""
    started = time.perf_counter()
    model.learn(preset.settings.wingbeats, callback=Annealing(preset.settings))
    return model.num_timesteps / (time.perf_counter() - started)


def speed_table(preset: Preset) -> str:
    """Rates of the environment, the adapter, the collection and the whole learner."""
    settings, task = preset.settings, preset.make_task()
    rows, wingbeats = settings.rows, settings.rows * settings.steps
    env = task.vector_env(rows)
    env.reset(seed=0)
    actions = env.action_space.sample()
    model = learner(preset)
    adapter = model.get_env()
    assert adapter is not None
    _, callback = model._setup_learn(10**9)  # what `learn` does before its first rollout
    callback.on_training_start({}, {})

    def collect() -> None:
        model.collect_rollouts(adapter, callback, model.rollout_buffer, n_rollout_steps=settings.steps)

    cases = (
        ("the environment's step", rate(lambda: env.step(actions), rows)),
        ("through the adapter", rate(lambda: adapter.step(actions), rows)),
        ("collection: the policy, the adapter, the buffer", rate(collect, wingbeats)),
        ("PPO: collection and updates", learn(learner(preset), preset)),
    )
    head = (f"{task.environment}, {rows:,} rows, one thread", "wingbeats/s")
    return text_table([head, *((name, f"{value:,.0f}") for name, value in cases)])


def profile_table(preset: Preset) -> str:
    """Where the seconds of PPO go, from collection to the optimiser."""
    model = learner(preset)
    watch, policy = Stopwatch(), model.policy
    adapter = model.get_env()
    assert adapter is not None
    watch.watch("environment and adapter", adapter, "step")
    watch.watch("policy when flying", policy, "forward")
    watch.watch("policy and critic when learning", policy, "evaluate_actions")
    watch.watch("backward", torch.Tensor, "backward")
    watch.watch("Adam", policy.optimizer, "step")
    watch.watch("clipping of gradients", torch.nn.utils, "clip_grad_norm_")
    watch.watch("minibatches", model.rollout_buffer, "_get_samples")
    watch.watch("rest of the update: losses", model, "train")
    watch.watch("rest of the collection", model, "collect_rollouts")
    learn(model, preset)
    whole = sum(watch.seconds.values())
    rows = [("PPO, share of the time", "%")]
    order = sorted(watch.seconds.items(), key=lambda one: -one[1])
    return text_table(rows + [(name, f"{100 * took / whole:.0f}") for name, took in order])


def main() -> None:
    """Print both tables for the default preset."""
    torch.set_num_threads(1)
    full = PRESETS[DEFAULT_PRESET]
    preset = full.changed({}, {"wingbeats": round(SHARE * full.settings.wingbeats)})
    print(f"{speed_table(preset)}\n\n{profile_table(preset)}")


if __name__ == "__main__":
    main()
