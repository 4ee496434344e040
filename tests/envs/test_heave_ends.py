"""flapenv/Heave-v0: how episodes end, and that an early end never pays."""

import gymnasium as gym
import numpy as np
import pytest
from flown_heave import HOVER, LEAST, MOST, STILL, centred, run

from flapenv.envs.heave import HeaveEnv
from flapenv.envs.heave_batch import (
    HEIGHT_LIMIT,
    VELOCITY_LIMIT,
    WORST_BEAT,
    WORST_END,
    HeaveVectorEnv,
)


@pytest.mark.parametrize(("action", "edge"), [(LEAST, -1), (MOST, 1)], ids=["falling", "shooting up"])
def test_leaving_the_band_ends_the_episode_and_charges_every_beat_that_is_left(action: np.ndarray, edge: int) -> None:
    env = HeaveEnv(insect="hawkmoth")
    env.reset(seed=0)
    terminated = False
    while not terminated:
        observation, reward, terminated, truncated, info = env.step(action)
        assert not truncated
    assert edge * info["height_ratio"] == HEIGHT_LIMIT
    assert observation[0] == edge * HEIGHT_LIMIT
    assert info["reward/lost"] == -WORST_BEAT * (200 - info["beat"]) - WORST_END
    assert reward == pytest.approx(info["reward/lost"] + info["reward/height"] + info["reward/power"])


def test_an_early_end_never_pays_against_any_way_to_stay() -> None:
    rng = np.random.default_rng(0)
    env = HeaveVectorEnv(256, beats=40)
    found = run(env, lambda seen: np.sign(rng.uniform(-1, 1, (256, 5))), 40)
    flying = (
        np.cumsum(found["terminated"] | found["truncated"], axis=0) - (found["terminated"] | found["truncated"]) == 0
    )
    within = found["reward"][flying & ~found["terminated"] & ~found["truncated"]]
    assert within.min() >= -WORST_BEAT  # no beat costs more than each beat that a lost row is charged
    assert found["reward"][flying & found["truncated"]].min() >= -WORST_BEAT - WORST_END  # nor the end
    beat, row = np.nonzero(flying & found["terminated"])
    assert len(row) > 100
    assert np.all(found["reward"][beat, row] <= -WORST_BEAT * (39 - beat) - WORST_END)
    # the edge of the band, held to the end with the most wasteful stroke, is still no worse than being lost
    env.reset(seed=0, options={"height": 4.99, "velocity": -0.02})
    *_, info = env.step(np.tile(MOST, (256, 1)))
    assert np.all(info["power_excess"] - info["reward/height"] < WORST_BEAT)


@pytest.mark.parametrize("insect", ["hawkmoth", "honeybee", "cranefly"])
@pytest.mark.parametrize("last", [1, 3, 6, 10])
def test_letting_go_in_the_last_beats_never_pays(insect: str, last: int) -> None:
    ways = np.array(
        [
            (-1, 1, 1, 1, 0),
            (-0.5, 1, 1, 1, 0),
            (0.2, 1, 1, 1, 0),
            (1, 1, 1, 1, 0),
            (-1, -1, -1, -1, -1),
            (-1, 1, 1, 1, 1),
        ],
        dtype=np.float32,
    )
    env = HeaveVectorEnv(len(ways), insect=insect, beats=20, gusts=STILL, autoreset_mode="SAME_STEP", dtype="float64")
    env.reset(seed=0, options={"height": 0.0, "velocity": 0.0})
    hover = np.tile(env.dynamics.trim_actions().astype(np.float32), (len(ways), 1))
    returns, flying, ends = np.zeros(len(ways)), np.ones(len(ways), dtype=bool), np.zeros(len(ways))
    for beat in range(20):
        _, rewards, lost, truncated, info = env.step(hover if beat < 20 - last else ways)
        returns += np.where(flying, rewards, 0)
        if truncated.any():
            ends = np.where(flying & truncated, info["final_info"]["reward/end"], ends)
        flying &= ~(lost | truncated)
    assert np.all(returns < 1e-3)
    if insect == "hawkmoth" and last == 3:
        assert returns[0] - ends[0] > 1  # without the term it would pay


def test_the_worth_of_motion_makes_hovering_a_stationary_point() -> None:
    env = HeaveVectorEnv(1, insect="hawkmoth", beats=6, gusts=STILL, autoreset_mode="SAME_STEP", dtype="float64")
    hover = env.dynamics.trim_actions()[0]

    def total(change: float) -> float:
        env.reset(seed=0, options={"height": 0.0, "velocity": 0.0})
        result = 0.0
        for beat in range(6):
            result += float(env.step((hover + change * (beat == 3) * np.eye(5)[0])[None])[1][0])
        return result

    slope = (total(0.02) - total(-0.02)) / 0.04
    assert abs(slope) < 0.02  # a unit of the action costs some two beats of power
    assert total(0.2) < 0
    assert total(-0.2) < 0


def test_the_most_wasteful_strokes_stay_below_the_worst_beat() -> None:
    rng = np.random.default_rng(3)
    dynamics = HeaveVectorEnv(1).dynamics
    index = rng.integers(8, size=20_000)
    actions = np.where(rng.random((20_000, 5)) < 0.5, np.sign(rng.uniform(-1, 1, (20_000, 5))), 0.0)
    actions[:100] = MOST
    actions[:100, 4] = -1
    strokes, _ = dynamics.decode(actions, index)
    for airspeed, worst in ((0.0, 8.7), (-0.3, 10.9)):
        power = dynamics.forces(index, strokes, np.full(20_000, airspeed)).specific_power
        excess = np.max(power / dynamics.trim.specific_power[index]) - 1
        assert excess == pytest.approx(worst, abs=0.1)
        assert excess + 0.5 * HEIGHT_LIMIT**2 < WORST_BEAT


def test_being_lost_with_the_last_beat_is_an_end_and_no_truncation() -> None:
    env = HeaveEnv(insect="hawkmoth", beats=1)
    env.reset(seed=0, options={"height": 4.99, "velocity": 0.2})
    _, reward, terminated, truncated, info = env.step(HOVER)
    assert (terminated, truncated) == (True, False)
    assert info["reward/lost"] == -WORST_END
    assert -WORST_END - WORST_BEAT < reward < -WORST_END


def test_too_fast_is_lost_as_well() -> None:
    env = HeaveEnv(insect="cranefly")
    env.reset(seed=0, options={"height": -2.0, "velocity": VELOCITY_LIMIT})
    _, _, terminated, _, info = env.step(MOST)
    assert terminated
    assert info["velocity_ratio"] == VELOCITY_LIMIT
    assert abs(info["height_ratio"]) < HEIGHT_LIMIT


@pytest.mark.parametrize("mode", ["NEXT_STEP", "SAME_STEP", "DISABLED"])
def test_rows_at_different_beats_are_reset_one_by_one(mode: str) -> None:
    env = HeaveVectorEnv(3, insect="hawkmoth", autoreset_mode=mode, gusts=STILL)
    env.reset(seed=0)
    actions = np.stack([HOVER, LEAST, HOVER])
    for _ in range(40):
        before = env._beat_number.copy()
        observations, rewards, terminated, _, info = env.step(actions)
        assert not terminated[[0, 2]].any()
        if terminated[1]:
            break
    assert env._beat_number[0] == before[0] + 1
    if mode == "DISABLED":
        env.reset(options={"reset_mask": np.array([False, True, False])})
    elif mode == "NEXT_STEP":
        observations, rewards, terminated, _, info = env.step(actions)
        assert rewards[1] == 0
        assert not terminated[1]
        assert list(info["_reward/power"]) == [True, False, True]
    else:
        assert info["final_info"]["reward/lost"][1] < -1000
        assert info["final_obs"][1, 0] == -HEIGHT_LIMIT
        assert abs(observations[1, 0]) <= 1
    assert list(env._beat_number == 0) == [False, True, False]
    env.step(actions)
    assert env._beat_number[1] == 1
    assert env._beat_number[0] == env._beat_number[2] > 5


def test_every_row_is_truncated_by_the_environment_itself_after_its_beats() -> None:
    env = gym.make_vec("flapenv/Heave-v0", 3, beats=7, autoreset_mode="SAME_STEP")
    assert gym.spec("flapenv/Heave-v0").max_episode_steps is None
    found = run(env, centred, 21)
    assert list(np.flatnonzero(found["truncated"].all(axis=1))) == [6, 13, 20]
    assert not found["terminated"].any()
