"""One wingbeat in plain numbers, and compiled, against the batch."""

from typing import Any

import numpy as np
import pytest
from gymnasium.error import ResetNeeded

from flapenv import HoverProblem, Insect, Stroke, Wing
from flapenv.envs import HoverEnv, HoverVectorEnv
from flapenv.envs.hover_of_one import HoverOfOne

PROBLEMS: list[Any] = [
    {"problem": "free-frequency"},
    {"problem": "fixed-frequency"},
    {"problem": "free-frequency", "action_scaling": "plain"},
    {"problem": "free-frequency", "action_scaling": "log", "reward": "vector"},
    {"problem": HoverProblem(box={"frequency": (20, 300), "pitch_phase": (-6, 6), "flap_shape": (0, 1)})},
    {"problem": HoverProblem(box={"flap_amplitude": 1.2, "pitch_shape": 5.0})},
    {"problem": HoverProblem(model={"induced": False}, lift_penalty=7.0, reward_floor=-5.0)},
    {"problem": HoverProblem(model={"coefficients": "extended-lifting-line"})},
    {"insect": "random-wing", "pool_size": 16, "gap_to": "optimum"},
]


@pytest.mark.parametrize("arguments", PROBLEMS)
@pytest.mark.filterwarnings("ignore:.*(no stroke of the box|aspect ratio|reward's optimum):UserWarning")
def test_it_gives_what_the_batch_gives(arguments: dict[str, Any]) -> None:
    rows = 40
    single = HoverEnv(dtype="float64", **arguments)
    batch = HoverVectorEnv(rows, autoreset_mode="DISABLED", dtype="float64", **arguments)
    names = batch.reset(seed=3)[1]["insect"]
    actions = np.random.default_rng(0).uniform(-1.3, 1.3, batch.action_space.shape).astype(np.float32)
    actions[:8] = np.sign(actions[:8])
    observations, rewards, _, _, infos = batch.step(actions)
    for row in range(rows):
        single.reset(options={"insect": names[row]})
        seen, reward, terminated, truncated, info = single.step(actions[row])
        np.testing.assert_allclose(seen, observations[row], rtol=1e-5, atol=2e-6)
        np.testing.assert_allclose(reward, rewards[row], rtol=1e-9)
        assert (terminated, truncated) == (True, False)
        for key, value in info.items():
            if value is None:
                assert not infos[f"_{key}"][row]
            elif key != "insect":
                assert value == pytest.approx(infos[key][row], rel=1e-9, abs=1e-8), key


@pytest.mark.parametrize("problem", ["profile-drag", "inertial", {"model": {"tip_loss": "stroke"}}])
def test_other_models_go_through_the_batch(problem: Any, monkeypatch: pytest.MonkeyPatch) -> None:
    def never(self: HoverOfOne, action: np.ndarray, number: int) -> list[float]:
        raise AssertionError("asked")

    monkeypatch.setattr(HoverOfOne, "__call__", never)
    env = HoverEnv(insect="hawkmoth", problem=problem)
    env.reset(seed=0)
    assert env.step(env.action_space.sample())[1] < 0
    plain = HoverEnv(insect="hawkmoth")
    plain.reset(seed=0)
    with pytest.raises(AssertionError, match="asked"):
        plain.step(plain.action_space.sample())


def test_episodes_draw_the_same_insects_as_a_batch_of_one() -> None:
    single, batch = HoverEnv(), HoverVectorEnv(1, autoreset_mode="DISABLED")
    ours, theirs = [single.reset(seed=5)[1]["insect"]], [batch.reset(seed=5)[1]["insect"][0]]
    for _ in range(30):
        ours.append(single.reset()[1]["insect"])
        theirs.append(batch.reset()[1]["insect"][0])
    assert ours == theirs
    assert len(set(ours)) > 4


@pytest.mark.parametrize("bad", [np.full(6, np.nan, np.float32), np.full(6, -np.inf), np.zeros(5, np.float32), "up"])
def test_a_bad_action_is_refused_and_the_episode_goes_on(bad: Any) -> None:
    env = HoverEnv(insect="hawkmoth")
    with pytest.raises(ResetNeeded):
        env.step(np.zeros(6, dtype=np.float32))
    env.reset(seed=0)
    with pytest.raises((ValueError, TypeError), match="action"):
        env.step(bad)
    first = env.step(np.zeros(6))  # of another type: cast
    with pytest.raises(ResetNeeded):
        env.step(np.zeros(6, dtype=np.float32))
    env.reset()
    second = env.step(np.zeros(6, dtype=np.float32))
    assert first[1] == second[1]
    first[0][:] = 7  # what was given is the caller's own
    first[4].clear()
    assert env.reset()[0][-1] == 1


@pytest.mark.parametrize("options", [[], "", 0, (), [1]])
def test_options_of_another_kind_are_refused_empty_ones_too(options: Any) -> None:
    env = HoverEnv()
    with pytest.raises(TypeError, match="options"):
        env.reset(options=options)
    with pytest.raises(ValueError, match="shape"):
        env.reset(options={"insect": np.array("fruitfly")})


def test_large_and_opposite_actions_are_not_mistaken_for_finite_ones() -> None:
    env = HoverEnv(insect="hawkmoth")
    env.reset(seed=0)
    action = np.array([np.inf, -np.inf, 0, 0, 0, 0], dtype=np.float32)
    with pytest.raises(ValueError, match="finite"):
        env.step(action)
    huge = np.full(6, 3e38, dtype=np.float32)
    assert env.step(huge)[4]["clipped"] is True


def test_an_insect_of_ones_own_without_a_table_is_known_too() -> None:
    robot = Insect(
        name="robot",
        mass=1e-4,
        wing=Wing(length=0.015, mean_chord=0.004, r1_hat=0.5),
        stroke=Stroke(frequency=120.0, flap_amplitude=1.0, pitch_amplitude=0.9),
    )
    single, batch = HoverEnv(insect=robot), HoverVectorEnv(1, insect=robot)
    single.reset(seed=0)
    batch.reset(seed=0)
    action = np.full(6, 0.3, dtype=np.float32)
    assert single.step(action)[1] == pytest.approx(batch.step(action[None])[1][0], rel=2e-6)
