"""Gymnasium's wrappers around the environments, scalar and vector, in the autoreset modes that each supports."""

from collections.abc import Callable
from typing import Any

import gymnasium as gym
import numpy as np
import pytest
from gymnasium import wrappers
from gymnasium.vector import AutoresetMode, VectorEnv
from gymnasium.wrappers import vector

from flapenv.envs import ENV_IDS

MODES = [mode.name for mode in AutoresetMode]
ROWS = 4
STEPS = 6


@pytest.fixture(params=ENV_IDS)
def env_id(request: pytest.FixtureRequest) -> str:
    return request.param


def make(env_id: str, mode: str, **arguments: Any) -> VectorEnv:
    return gym.make_vec(env_id, num_envs=ROWS, autoreset_mode=mode, **arguments)


def steps(env: VectorEnv, change: Callable[[np.ndarray], np.ndarray] | None = None) -> list[tuple[Any, ...]]:
    """What the first reset and some steps give; ended rows are reset where nobody else does it."""
    rng = np.random.default_rng(0)
    seen: list[tuple[Any, ...]] = [env.reset(seed=3)]
    for _ in range(STEPS):
        own = rng.uniform(-1, 1, env.action_space.shape).astype(np.float32)
        seen.append(env.step(own if change is None else change(own)))
        ended = np.asarray(seen[-1][2]) | np.asarray(seen[-1][3])
        if env.metadata["autoreset_mode"] is AutoresetMode.DISABLED and ended.any():
            env.reset(options={"reset_mask": ended})
    return seen


@pytest.mark.parametrize("mode", MODES)
def test_record_episode_statistics_adds_up_each_episode(env_id: str, mode: str) -> None:
    env = vector.RecordEpisodeStatistics(make(env_id, mode))
    returns, lengths = np.zeros(ROWS), np.zeros(ROWS, dtype=int)
    ended = np.zeros(ROWS, dtype=bool)
    env.reset(seed=1)
    env.action_space.seed(1)
    told, known = 0, np.zeros(ROWS, dtype=bool)
    while not known.all():
        waited = ended & (mode == "NEXT_STEP")
        _, rewards, terminations, truncations, infos = env.step(env.action_space.sample())
        returns = np.where(waited, 0, returns + rewards)
        lengths = np.where(waited, 0, lengths + 1)
        ended = terminations | truncations
        assert ("episode" in infos) == ended.any()
        if ended.any():
            np.testing.assert_array_equal(infos["_episode"], ended)
            # Gymnasium 1.1 knows NEXT_STEP alone and drops the first beat of every later episode
            sure = ended if mode == "NEXT_STEP" else ended & ~known
            np.testing.assert_allclose(infos["episode"]["r"][sure], returns[sure], rtol=1e-6)
            np.testing.assert_array_equal(infos["episode"]["l"][sure], lengths[sure])
            known |= ended
            told += int(ended.sum())
            if mode != "NEXT_STEP":
                returns[ended], lengths[ended] = 0, 0
            if mode == "DISABLED":
                env.reset(options={"reset_mask": ended})
    assert len(env.return_queue) == told


@pytest.mark.parametrize("mode", MODES)
def test_dict_info_to_list_gives_every_row_what_it_has(env_id: str, mode: str) -> None:
    plain, listed = steps(make(env_id, mode)), steps(vector.DictInfoToList(make(env_id, mode)))
    for before, after in zip(plain, listed, strict=True):
        infos, rows = before[-1], after[-1]
        assert len(rows) == ROWS
        for key in (key for key in infos if not key.startswith("_")):
            for row, has in zip(rows, infos[f"_{key}"], strict=True):
                assert (key in row) == has


@pytest.mark.parametrize("mode", MODES)
def test_wrappers_of_actions_change_actions_only(env_id: str, mode: str) -> None:
    plain = steps(make(env_id, mode))
    low, high = (np.full(make(env_id, mode).single_action_space.shape, end, np.float32) for end in (0.0, 10.0))
    same = (
        steps(vector.RescaleAction(make(env_id, mode), low, high), lambda own: 5 + 5 * own),
        steps(vector.ClipAction(make(env_id, mode))),
        steps(vector.TransformAction(make(env_id, mode), lambda actions: -actions), lambda actions: -actions),
    )
    for run in same:
        for before, after in zip(plain, run, strict=True):
            for one, other in zip(before[:-1], after[:-1], strict=True):
                np.testing.assert_allclose(one, other, rtol=2e-4, atol=2e-4)  # 5 + 5 a is rounded in single precision


@pytest.mark.parametrize("mode", MODES)
def test_wrappers_of_rewards_change_rewards_only(env_id: str, mode: str) -> None:
    plain = steps(make(env_id, mode))
    doubled = steps(vector.TransformReward(make(env_id, mode), lambda rewards: 2 * rewards))
    clipped = steps(vector.ClipReward(make(env_id, mode), -0.5, 0.5))
    for before, twice, cut in zip(plain[1:], doubled[1:], clipped[1:], strict=True):
        np.testing.assert_array_equal(before[0], twice[0])
        np.testing.assert_array_equal(2 * before[1], twice[1])
        np.testing.assert_array_equal(np.clip(before[1], -0.5, 0.5), cut[1])


@pytest.mark.parametrize("mode", MODES)
def test_normalised_rewards_are_finite_and_of_one_sign_with_the_plain_ones(env_id: str, mode: str) -> None:
    plain, scaled = steps(make(env_id, mode)), steps(vector.NormalizeReward(make(env_id, mode)))
    for before, after in zip(plain[1:], scaled[1:], strict=True):
        assert np.isfinite(after[1]).all()
        np.testing.assert_array_equal(np.sign(before[1]), np.sign(after[1]))


WRAPPERS_OF_OBSERVATIONS = {
    "normalise": vector.NormalizeObservation,
    "flatten": vector.FlattenObservation,
    "reshape": lambda env: vector.ReshapeObservation(env, (1, *env.single_observation_space.shape)),
    "rescale": lambda env: vector.RescaleObservation(
        env, *(np.full(env.single_observation_space.shape, end, np.float32) for end in (-1, 1))
    ),
    "half": lambda env: vector.TransformObservation(env, lambda seen: seen / 2),
}
SUPPORTED = {
    name: ("NEXT_STEP",) if name == "normalise" else ("NEXT_STEP", "DISABLED") for name in WRAPPERS_OF_OBSERVATIONS
}


@pytest.mark.parametrize("name", WRAPPERS_OF_OBSERVATIONS)
@pytest.mark.parametrize("mode", MODES)
def test_wrappers_of_observations_keep_rewards_or_refuse_the_mode_themselves(env_id: str, mode: str, name: str) -> None:
    wrap = WRAPPERS_OF_OBSERVATIONS[name]
    if mode not in SUPPORTED[name]:  # Gymnasium's own refusal, a bare assertion in its older releases
        with pytest.raises((ValueError, AssertionError)):
            wrap(make(env_id, mode))
        return
    for before, after in zip(steps(make(env_id, mode)), steps(wrap(make(env_id, mode))), strict=True):
        assert after[0].size == before[0].size
        assert np.isfinite(after[0]).all()
        if len(before) == 5:
            np.testing.assert_array_equal(before[1], after[1])


def test_the_scalar_wrappers_change_what_they_are_for(env_id: str) -> None:
    plain = gym.make(env_id)
    low, high = (np.full(plain.action_space.shape, end, np.float32) for end in (0.0, 10.0))
    wrapped = {
        "rescaled": wrappers.RescaleAction(gym.make(env_id), low, high),
        "clipped": wrappers.ClipAction(gym.make(env_id)),
        "flat": wrappers.FlattenObservation(gym.make(env_id)),
        "timed": wrappers.TimeAwareObservation(wrappers.TimeLimit(gym.make(env_id), 10)),
        "counted": wrappers.RecordEpisodeStatistics(gym.make(env_id)),
        "autoreset": wrappers.Autoreset(gym.make(env_id)),
        "stacked": wrappers.FrameStackObservation(gym.make(env_id), 2),
    }
    action = plain.action_space.sample()
    first = plain.reset(seed=1)[0]
    expected = plain.step(action)
    for name, env in wrapped.items():
        seen, _ = env.reset(seed=1)
        assert env.observation_space.contains(seen), name
        result = env.step(5 + 5 * action if name == "rescaled" else action)
        assert result[1] == pytest.approx(expected[1], rel=1e-4), name
        assert result[2] == expected[2], name
        if name == "timed":
            assert seen[:-1] == pytest.approx(first)
            assert seen[-1] != result[0][-1]
        if name == "counted" and expected[2]:
            assert result[-1]["episode"]["r"] == pytest.approx(expected[1])


def test_a_time_limit_truncates_an_episode_that_goes_on() -> None:
    for env_id in ENV_IDS:
        env = wrappers.TimeLimit(gym.make(env_id), 2)
        env.reset(seed=1)
        ends = [env.step(np.zeros(env.action_space.shape, np.float32))[2:4]]
        if not ends[0][0]:
            ends.append(env.step(np.zeros(env.action_space.shape, np.float32))[2:4])
            assert ends[1] == (False, True)


def test_render_collection_keeps_a_picture_for_the_reset_and_one_for_each_step(env_id: str) -> None:
    env = wrappers.RenderCollection(gym.make(env_id, render_mode="rgb_array"))
    env.reset(seed=1)
    env.step(env.action_space.sample())
    frames = env.render()
    assert len(frames) == 2
    assert all(frame.dtype == np.uint8 and frame.shape == frames[0].shape for frame in frames)
