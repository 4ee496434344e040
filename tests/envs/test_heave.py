"""flapenv/Heave-v0: rewards, gusts and what is seen."""

import dataclasses
from typing import Any

import gymnasium as gym
import numpy as np
import pytest
from flown_heave import HOVER, LEAST, MOST, STILL, centred, run

from flapenv import INSECTS, evaluate, load_insect
from flapenv.aero.stroke import Stroke
from flapenv.envs.heave import HeaveEnv
from flapenv.envs.heave_batch import (
    SUPPORT_UNIT,
    VELOCITY_UNIT,
    HeaveVectorEnv,
)


def test_hovering_in_still_air_costs_nothing_and_stays_for_the_whole_episode() -> None:
    env = HeaveEnv(gusts=STILL, dtype="float64")
    for name in INSECTS:
        env.reset(seed=0, options={"insect": name, "height": 0.0, "velocity": 0.0})
        for beat in range(200):
            _, reward, terminated, truncated, info = env.step(HOVER)
            assert reward == pytest.approx(0, abs=2e-3)
            assert not terminated
            assert truncated == (beat == 199)
        assert abs(info["height_ratio"]) < 2e-2
        assert info["weight_support"] == pytest.approx(1, abs=1e-4)
        assert info["power_excess"] == pytest.approx(0, abs=1e-4)


def test_the_reward_is_power_over_hovering_and_the_square_of_height() -> None:
    env = HeaveEnv(insect="bumblebee")
    env.reset(seed=3)
    for _ in range(10):
        _, reward, _, _, info = env.step(HOVER)
        hover = env.batch.dynamics.trim.specific_power[0]
        assert info["reward/power"] == pytest.approx(-(info["specific_power"] / hover - 1), rel=1e-6)
        assert info["reward/height"] == pytest.approx(-0.5 * info["height_ratio"] ** 2)
        assert info["reward/lost"] == 0
        assert reward == pytest.approx(info["reward/power"] + info["reward/height"])


def test_in_still_air_at_rest_the_beat_is_that_of_evaluate() -> None:
    env = HeaveEnv(insect="fruitfly", gusts=STILL, dtype="float64")
    env.reset(seed=0, options={"height": 0.0, "velocity": 0.0})
    *_, info = env.step(np.array([0.2, 0.1, -0.3, 0.5, 0.4]))
    stroke = Stroke(
        **{name.removeprefix("stroke/"): value for name, value in info.items() if name.startswith("stroke/")}
    )
    found = evaluate("fruitfly", stroke)
    assert info["weight_support"] == pytest.approx(found.weight_support, rel=2e-2)  # the beat moves it a little
    assert info["specific_power"] == pytest.approx(found.specific_power, rel=2e-2)


def test_infos_are_in_si_units_and_in_ratios_with_the_same_keys_at_every_step() -> None:
    env = HeaveEnv(insect="cranefly")
    _, first = env.reset(seed=1)
    keys = None
    for beat in range(5):
        *_, info = env.step(HOVER)
        keys = keys or set(info)
        assert set(info) == keys
        assert info["beat"] == beat + 1
        trim = env.batch.dynamics.trim
        assert info["height"] == pytest.approx(info["height_ratio"] * trim.length[0])
        assert info["velocity"] == pytest.approx(info["velocity_ratio"] * trim.tip_speed[0])
        assert info["gust"] == pytest.approx(info["gust_ratio"] * trim.tip_speed[0])
    assert set(first) < keys


def test_the_observation_is_height_velocity_last_lift_last_action_and_the_wing() -> None:
    env = HeaveEnv(insect=["hawkmoth", "honeybee"])
    observation, info = env.reset(seed=2, options={"insect": "hawkmoth", "height": 0.7, "velocity": -0.01})
    assert observation[:3] == pytest.approx([0.7, -0.01 / VELOCITY_UNIT, 0.0])
    assert observation[3:8] == pytest.approx(HOVER, abs=1e-6)
    wing = load_insect("hawkmoth").wing
    assert observation[8:10] == pytest.approx([wing.aspect_ratio - 4, (wing.r1_hat - 0.51) / 0.04])
    action = np.array([0.9, 2.0, -0.5, 0.1, 0.0], dtype=np.float32)
    observation, *_, info = env.step(action)
    assert observation[0] == pytest.approx(info["height_ratio"])
    assert observation[1] == pytest.approx(info["velocity_ratio"] / VELOCITY_UNIT)
    assert observation[2] == pytest.approx((info["weight_support"] - 1) / SUPPORT_UNIT)
    assert observation[3:8] == pytest.approx(np.clip(action, -1, 1))
    assert info["clipped"]
    other, _ = env.reset(options={"insect": "honeybee"})
    assert other[10] != observation[10]


def test_two_policies_of_one_seed_meet_the_same_gusts_whenever_the_others_end() -> None:
    gentle, wild = (HeaveVectorEnv(6, autoreset_mode="SAME_STEP") for _ in range(2))
    held = run(gentle, centred, 60, seed=4)
    actions = np.stack([MOST, LEAST, MOST, LEAST, MOST, HOVER])
    thrown = run(wild, lambda seen: np.vstack([actions[:5], centred(seen)[5:]]), 60, seed=4)
    assert not held["terminated"].any()
    assert thrown["terminated"][:, :5].any(axis=0).all()
    np.testing.assert_array_equal(held["gust_ratio"][:, 5], thrown["gust_ratio"][:, 5])
    for row in range(5):
        first_end = int(np.argmax(thrown["terminated"][:, row]))
        np.testing.assert_array_equal(held["gust_ratio"][:first_end, row], thrown["gust_ratio"][:first_end, row])


def test_every_beat_brings_news_of_the_gust() -> None:
    gusts = run(HeaveVectorEnv(4000), centred, 6)["gust_ratio"]
    news = gusts[1:] - np.exp(-1 / 20) * gusts[:-1]
    for one, other in ((0, 1), (1, 2), (3, 4)):
        assert abs(np.corrcoef(news[one], news[other])[0, 1]) < 0.05
    assert np.std(news, axis=1) == pytest.approx(np.full(5, 0.02 * np.sqrt(1 - np.exp(-0.1))), rel=0.05)


def test_the_first_rows_of_a_larger_batch_fly_the_same_episodes() -> None:
    few, many = (run(HeaveVectorEnv(rows), centred, 30) for rows in (3, 7))
    np.testing.assert_array_equal(few["gust_ratio"], many["gust_ratio"][:, :3])
    np.testing.assert_allclose(few["height_ratio"], many["height_ratio"][:, :3], atol=1e-5)


def test_episodes_of_a_row_differ_and_a_seed_brings_the_first_back() -> None:
    env = HeaveEnv(insect="hawkmoth")
    first, _ = env.reset(seed=9)
    second, _ = env.reset()
    assert np.any(first != second)
    np.testing.assert_array_equal(env.reset(seed=9)[0], first)


def test_starts_and_insects_fill_their_ranges() -> None:
    env = HeaveVectorEnv(4000)
    observations, info = env.reset(seed=0)
    for values, half in ((info["height_ratio"], 1.0), (info["velocity_ratio"], 0.02)):
        assert np.abs(values).max() == pytest.approx(half, rel=0.01)
        assert np.std(values) == pytest.approx(half / np.sqrt(3), rel=0.05)
    assert np.std(info["gust_ratio"]) == pytest.approx(0.02, rel=0.05)
    counts = [np.sum(info["insect"] == name) for name in INSECTS]
    assert min(counts) > 400
    assert env.observation_space.contains(observations)


def test_outputs_are_finite_whatever_is_done() -> None:
    rng = np.random.default_rng(1)
    env = HeaveVectorEnv(64, autoreset_mode="SAME_STEP", gusts={"strength": 0.1, "correlation": 1.0})
    env.reset(seed=0)
    for _ in range(60):
        observations, rewards, _, _, info = env.step(rng.choice([-1e30, -1, 0, 1, 1e30], size=(64, 5)))
        assert np.isfinite(observations).all()
        assert np.isfinite(rewards).all()
        for value in info.values():
            assert not isinstance(value, np.ndarray) or value.dtype == object or np.isfinite(value).all()
        assert env.observation_space.contains(observations)


def test_an_insect_of_ones_own_holds_height_too() -> None:
    own = dataclasses.replace(load_insect("dronefly"), name="loaded", mass=1.3 * load_insect("dronefly").mass)
    env = HeaveVectorEnv(8, insect=own)
    found = run(env, centred, 200)
    assert not found["terminated"].any()
    assert found["truncated"][-1].all()


def test_double_precision_flies_the_same_episode() -> None:
    single, double = (run(HeaveVectorEnv(8, dtype=dtype), centred, 50) for dtype in ("float32", "float64"))
    np.testing.assert_allclose(single["height_ratio"], double["height_ratio"], atol=1e-3)


def test_the_picture_shows_the_episode_up_to_its_last_beat() -> None:
    env = HeaveEnv(insect="hawkmoth", render_mode="rgb_array")
    env.reset(seed=0)
    frames = [env.render()]
    for _ in range(2):
        env.step(HOVER)
        frames.append(env.render())
    assert frames[0].shape == frames[2].shape
    assert np.any(frames[1] != frames[2])
    path = env.batch._paths[0]
    assert np.sum(~np.isnan(path)) == 3
    env.reset()
    assert np.any(env.render() != frames[2])


@pytest.mark.parametrize(
    ("options", "kind", "said"),
    [
        ({"insect": "moth"}, ValueError, "reset option insect = 'moth' is unknown"),
        ({"insect": 3}, TypeError, "reset option insect = 3"),
        ({"insect": ["hawkmoth"]}, ValueError, "reset option insect has 1 names"),
        ({"height": 6.0}, ValueError, "reset option height = 6 is not allowed"),
        ({"velocity": np.nan}, ValueError, "reset option velocity = nan"),
        ({"height": [0.0, 1.0, 2.0]}, ValueError, r"reset option height has shape \(3,\)"),
        ({"heigth": 0.0}, ValueError, "did you mean 'height'"),
    ],
)
def test_bad_reset_options_are_named_and_change_nothing(options: dict, kind: type[Exception], said: str) -> None:
    env = HeaveVectorEnv(2)
    env.reset(seed=1)
    before = env.step(np.tile(HOVER, (2, 1)))[0]
    with pytest.raises(kind, match=said):
        env.reset(options=options)
    np.testing.assert_array_equal(env._observe(), before)


@pytest.mark.parametrize(
    ("arguments", "kind", "said"),
    [
        ({"insect": "moth"}, ValueError, "insect = 'moth' is unknown; allowed: all, fruitfly"),
        ({"insect": []}, ValueError, r"insect = \[\]"),
        ({"beats": 0}, ValueError, "beats = 0"),
        ({"beats": 10.5}, TypeError, "beats = 10.5"),
        ({"gusts": {"strenght": 0.1}}, TypeError, "did you mean 'strength'"),
        ({"gusts": 0.1}, TypeError, "gusts = 0.1 are not allowed"),
        ({"gust": {}}, TypeError, "gust = {} is not an argument.*did you mean 'gusts'"),
        ({"dtype": "float16"}, ValueError, "dtype = 'float16' is unknown"),
    ],
)
def test_bad_arguments_are_named(arguments: dict[str, Any], kind: type[Exception], said: str) -> None:
    with pytest.raises(kind, match=said):
        gym.make("flapenv/Heave-v0", **arguments)
