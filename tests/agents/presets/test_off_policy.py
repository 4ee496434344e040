"""Learners with a replay buffer: their settings, what falls, and that each learns."""

from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from sb3_contrib.common.torch_layers import BatchRenorm

from agents.callbacks import Annealing
from agents.presets import crossq, sac, td3, tqc
from agents.vec_env import GymnasiumVecEnv
from flapenv.envs import HoverVectorEnv

PRESETS: dict[str, Any] = {**sac.PRESETS, **td3.PRESETS, **tqc.PRESETS, **crossq.PRESETS}
LEARNERS = ("sac", "td3", "tqc", "crossq")


def hover(rows: int) -> GymnasiumVecEnv:
    return GymnasiumVecEnv(HoverVectorEnv(rows, autoreset_mode="SAME_STEP", infos="none"))


def test_every_preset_says_its_task_and_its_learner() -> None:
    for name in PRESETS:
        assert name.split("-")[0] == "hover"
        assert name.split("-")[1] in LEARNERS


def test_the_learning_rate_falls_to_a_remainder_that_still_learns() -> None:
    settings = sac.SACSettings(learning_rate=1e-2, learning_rate_power=2.0)
    rates = [settings.learning_rate_at(left) for left in (1.0, 0.5, 0.1, 0.0, -0.1)]
    assert rates[:3] == pytest.approx([1e-2, 2.5e-3, 1e-4])
    assert 0 < rates[3] == rates[4] < 1e-6


def test_what_falls_falls_geometrically_and_then_stays() -> None:
    settings = sac.SACSettings(entropy=1.0, last_entropy=1e-4, entropy_until=0.8)
    assert [settings.entropy_at(left) for left in (1.0, 0.6, 0.2, 0.0)] == pytest.approx([1, 1e-2, 1e-4, 1e-4])
    noisy = td3.TD3Settings(noise=0.4, last_noise=0.004, noise_until=1.0)
    assert [noisy.noise_at(left) for left in (1.0, 0.5, 0.0, -0.1)] == pytest.approx([0.4, 0.04, 0.004, 0.004])


def test_running_statistics_follow_ever_more_slowly() -> None:
    settings = crossq.CrossQSettings(wingbeats=200, rows=10, learning_starts=10, batch=8, norm_momentum=0.1)
    assert [settings.norm_momentum_at(left) for left in (1.0, 0.5, 0.1)] == pytest.approx([0.1, 0.025, 0.001])
    model = settings.build(hover(settings.rows), seed=0)
    settings.anneal(model, 0.5)
    momenta = [layer.momentum for layer in model.policy.modules() if isinstance(layer, BatchRenorm)]
    assert momenta == pytest.approx([0.025] * 6)  # three layers of the actor, three of its one critic


@pytest.mark.parametrize("name", PRESETS)
def test_each_learns_and_ends_with_what_its_schedule_ends_with(name: str) -> None:
    few = {"wingbeats": 320, "rows": 16, "learning_starts": 64, "batch": 16, "gradient_steps": 2}
    settings = replace(PRESETS[name].settings, **few)
    model = settings.build(hover(settings.rows), seed=0)
    before = [weights.detach().clone() for weights in model.policy.parameters()]
    model.learn(settings.wingbeats, callback=Annealing(settings))
    assert any((old != new).any() for old, new in zip(before, model.policy.parameters(), strict=True))
    left = settings.rows / settings.wingbeats  # set before the last rollout
    if isinstance(settings, td3.TD3Settings):
        assert model.action_noise.noises[0].size == pytest.approx(settings.noise_at(left))
    else:
        assert model.ent_coef_tensor.item() == pytest.approx(settings.entropy_at(left))


@pytest.mark.parametrize("name", PRESETS)
def test_a_saved_policy_flies_as_before(name: str, tmp_path: Path) -> None:
    env = hover(8)
    model = replace(PRESETS[name].settings, rows=8).build(env, seed=0)
    model.save(tmp_path / "policy.zip")
    again = type(model).load(tmp_path / "policy.zip", device="cpu")
    observations = env.reset()
    old, new = (one.predict(observations, deterministic=True)[0] for one in (model, again))
    np.testing.assert_array_equal(old, new)


def test_a_single_row_is_flown_too() -> None:
    settings = td3.TD3Settings(wingbeats=40, rows=1, learning_starts=10, batch=8, gradient_steps=1)
    model = settings.build(hover(1), seed=0)
    model.learn(settings.wingbeats, callback=Annealing(settings))
    assert model.num_timesteps == settings.wingbeats


@pytest.mark.parametrize(
    ("kind", "field", "value", "error"),
    [
        (sac.SACSettings, "wingbeats", 0, ValueError),
        (sac.SACSettings, "rows", 1.5, TypeError),
        (sac.SACSettings, "buffer", 8, ValueError),
        (sac.SACSettings, "wingbeats", 2_000, ValueError),
        (sac.SACSettings, "gamma", 1.5, ValueError),
        (sac.SACSettings, "learning_rate", 0.0, ValueError),
        (sac.SACSettings, "last_entropy", 0.0, ValueError),
        (sac.SACSettings, "entropy_until", 0.0, ValueError),
        (sac.SACSettings, "noise", 0.1, TypeError),
        (td3.TD3Settings, "policy_delay", 0, ValueError),
        (td3.TD3Settings, "last_noise", float("nan"), ValueError),
        (tqc.TQCSettings, "dropped", 5, ValueError),
        (crossq.CrossQSettings, "norm_momentum", 0.0, ValueError),
        (crossq.CrossQSettings, "norm_warmup", -1, ValueError),
    ],
)
def test_bad_settings_are_named(kind: Any, field: str, value: object, error: type[Exception]) -> None:
    with pytest.raises(error, match=field):
        kind(**{field: value})
