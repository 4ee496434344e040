"""What every environment of the family must do, scalar and vector, in every autoreset mode."""

import copy
import json
import pickle
from typing import Any

import gymnasium as gym
import numpy as np
import pytest
from gymnasium.envs.registration import EnvSpec
from gymnasium.error import ResetNeeded
from gymnasium.utils.env_checker import check_env
from gymnasium.vector import AutoresetMode, SyncVectorEnv, VectorEnv

from flapenv.envs import ENV_IDS

MODES = [mode.name for mode in AutoresetMode]
ROWS = 5
ONE_BEAT: dict[str, dict[str, Any]] = {"flapenv/Heave-v0": {"beats": 1}, "flapenv/HoverAdapt-v0": {"beats": 1}}
"""Arguments with which an episode ends after one beat, where it does not anyway."""
JUST_BEGUN = {
    "flapenv/Hover-v0": lambda seen: seen[..., -1] == 1,  # the whole episode is left
    "flapenv/HoverAdapt-v0": lambda seen: seen[..., -1] == 1,
    "flapenv/Waveform-v0": lambda seen: seen[..., -1] == 1,
    "flapenv/Heave-v0": lambda seen: seen[..., 2] == 0,  # no weight support felt yet
}
"""Whether observations are the first of an episode."""


@pytest.fixture(params=ENV_IDS)
def env_id(request: pytest.FixtureRequest) -> str:
    return request.param


def make(env_id: str, mode: str = "NEXT_STEP", rows: int = ROWS, **arguments: Any) -> VectorEnv:
    return gym.make_vec(env_id, num_envs=rows, autoreset_mode=mode, **arguments)


def make_one_beat(env_id: str, mode: str) -> VectorEnv:
    """An environment all of whose rows end with every step."""
    return make(env_id, mode, **ONE_BEAT.get(env_id, {}))


def reset_ended(env: VectorEnv, ended: np.ndarray) -> np.ndarray:
    """Reset the rows that have ended, if any; the observations after it."""
    return env.reset(options={"reset_mask": ended})[0] if ended.any() else np.zeros(0)


def assert_infos_equal(one: dict[str, Any], other: dict[str, Any]) -> None:
    """The same keys, masks and values where the mask says there is one."""
    assert one.keys() == other.keys()
    for key, value in one.items():
        if isinstance(value, dict):
            assert_infos_equal(value, other[key])
        elif key.startswith("_"):
            np.testing.assert_array_equal(value, other[key])
        else:
            mask = one[f"_{key}"]
            for a, b in zip(value[mask], other[key][mask], strict=True):
                if isinstance(a, str):
                    assert a == b
                else:
                    np.testing.assert_allclose(a, b, rtol=2e-5, atol=1e-5)


def test_gymnasiums_checker_passes_without_a_warning(env_id: str) -> None:
    check_env(gym.make(env_id, render_mode="rgb_array").unwrapped)
    check_env(gym.make(env_id).unwrapped)


@pytest.mark.parametrize("mode", MODES)
def test_spaces_types_and_metadata(env_id: str, mode: str) -> None:
    env = make(env_id, mode)
    assert env.metadata["autoreset_mode"] is AutoresetMode[mode]
    assert env.action_space.shape == (ROWS, *env.single_action_space.shape)
    observations, infos = env.reset(seed=3)
    assert observations in env.observation_space
    assert observations.dtype == np.float32
    env.action_space.seed(3)
    for _ in range(4):
        observations, rewards, terminations, truncations, infos = env.step(env.action_space.sample())
        assert observations in env.observation_space
        assert rewards.dtype == np.float64
        assert terminations.dtype == truncations.dtype == bool
        assert rewards.shape == terminations.shape == truncations.shape == (ROWS,)
        assert np.isfinite(rewards).all()
        for key, value in infos.items():
            if not key.startswith("_") and not isinstance(value, dict):
                assert len(value) == ROWS
                assert infos[f"_{key}"].dtype == bool
        if mode == "DISABLED":
            reset_ended(env, terminations | truncations)
    env.close()


def test_metadata_of_one_environment_leaves_the_class_and_the_others_alone(env_id: str) -> None:
    first, second = make(env_id, "SAME_STEP"), make(env_id, "DISABLED")
    assert first.metadata["autoreset_mode"] is AutoresetMode.SAME_STEP
    assert second.metadata["autoreset_mode"] is AutoresetMode.DISABLED
    assert "autoreset_mode" not in type(first.unwrapped).metadata


@pytest.mark.parametrize("mode", MODES)
def test_the_same_seed_gives_the_same_episodes_and_another_does_not(env_id: str, mode: str) -> None:
    def run(seed: int) -> list[np.ndarray]:
        env = make(env_id, mode, rows=64)
        seen = [env.reset(seed=seed)[0]]
        rng = np.random.default_rng(0)
        for _ in range(5):
            actions = rng.uniform(-1, 1, env.action_space.shape).astype(np.float32)
            observations, rewards, terminations, truncations, _ = env.step(actions)
            seen += [observations, rewards]
            if mode == "DISABLED":
                seen.append(reset_ended(env, terminations | truncations))
        return seen

    for one, again in zip(run(7), run(7), strict=True):
        np.testing.assert_array_equal(one, again)
    assert any(np.any(one != other) for one, other in zip(run(7), run(8), strict=True))


@pytest.mark.parametrize("mode", ["NEXT_STEP", "SAME_STEP"])
def test_the_batch_of_one_is_the_scalar_environment(env_id: str, mode: str) -> None:
    native = make(env_id, mode, rows=1)
    looped = SyncVectorEnv([lambda: gym.make(env_id)], autoreset_mode=AutoresetMode[mode])
    rng = np.random.default_rng(1)
    ours, theirs = native.reset(seed=11), looped.reset(seed=11)
    np.testing.assert_array_equal(ours[0], theirs[0])
    assert_infos_equal(ours[1], theirs[1])
    for _ in range(6):
        actions = rng.uniform(-1.2, 1.2, native.action_space.shape).astype(np.float32)
        ours, theirs = native.step(actions), looped.step(actions)
        for a, b in zip(ours[:4], theirs[:4], strict=True):
            np.testing.assert_allclose(a, b, rtol=1e-5, atol=2e-6)  # single against double precision
        if "final_obs" in theirs[4]:
            finals = [info.pop("final_obs") for info in (ours[4], theirs[4])]
            np.testing.assert_allclose(*(np.stack(list(final)) for final in finals), rtol=1e-5, atol=2e-6)
            np.testing.assert_array_equal(*(info.pop("_final_obs") for info in (ours[4], theirs[4])))
        assert_infos_equal(ours[4], theirs[4])


@pytest.mark.parametrize("mode", MODES)
def test_a_row_does_not_feel_the_actions_of_the_others(env_id: str, mode: str) -> None:
    def run(others: float) -> list[Any]:
        env, seen = make(env_id, mode), []
        env.reset(seed=5)
        for step in range(5):
            actions = np.full(env.action_space.shape, others, dtype=np.float32)
            actions[2] = 0.1 * step
            observations, rewards, terminations, truncations, _ = env.step(actions)
            seen += [observations[2], rewards[2], terminations[2]]
            if mode == "DISABLED":
                reset_ended(env, terminations | truncations)
        return seen

    for one, other in zip(run(-0.9), run(0.8), strict=True):
        np.testing.assert_array_equal(one, other)


def test_next_step_ignores_the_action_after_an_end_and_pays_nothing(env_id: str) -> None:
    env = make_one_beat(env_id, "NEXT_STEP")
    env.reset(seed=1)
    assert np.logical_or(*env.step(env.action_space.sample())[2:4]).all()
    observations, rewards, terminations, truncations, infos = env.step(env.action_space.sample())
    assert not rewards.any()
    assert not terminations.any()
    assert not truncations.any()
    assert "final_obs" not in infos
    assert JUST_BEGUN[env_id](observations).all()


def test_same_step_gives_the_last_observation_and_info_beside_the_first(env_id: str) -> None:
    env = make(env_id, "SAME_STEP")
    env.reset(seed=1)
    infos: dict[str, Any] = {}
    while "final_obs" not in infos:
        observations, _, terminations, truncations, infos = env.step(env.action_space.sample())
    ended = terminations | truncations
    np.testing.assert_array_equal(infos["_final_obs"], ended)
    np.testing.assert_array_equal(infos["_final_info"], ended)
    assert JUST_BEGUN[env_id](observations[ended]).all()
    assert not JUST_BEGUN[env_id](infos["final_obs"][ended]).any()
    assert "weight_support" in infos["final_info"]
    assert not np.shares_memory(infos["final_obs"], observations)


def test_disabled_asks_for_a_reset_of_the_rows_that_ended(env_id: str) -> None:
    env = make(env_id, "DISABLED")
    env.reset(seed=1)
    while not env.step(env.action_space.sample())[2].any():
        pass
    with pytest.raises(ResetNeeded, match="reset_mask"):
        env.step(env.action_space.sample())


def test_rows_that_were_not_reset_still_ask_for_it(env_id: str) -> None:
    env = make_one_beat(env_id, "DISABLED")
    env.reset(seed=1)
    env.step(env.action_space.sample())
    env.reset(options={"reset_mask": np.array([True, False, True, False, False])})
    with pytest.raises(ResetNeeded, match=r"rows \[1, 3, 4\] have ended"):
        env.step(env.action_space.sample())


def test_a_reset_mask_resets_its_rows_only(env_id: str) -> None:
    env = make(env_id, "DISABLED")
    env.reset(seed=1)
    before = env.step(env.action_space.sample())[0]
    mask = np.array([True, False, True, False, False])
    after, infos = env.reset(options={"reset_mask": mask})
    np.testing.assert_array_equal(after[~mask], before[~mask])
    assert JUST_BEGUN[env_id](after[mask]).all()
    np.testing.assert_array_equal(infos["_insect"], mask)


@pytest.mark.parametrize(
    ("mask", "kind"),
    [
        ([True] * ROWS, TypeError),
        (np.ones(ROWS), TypeError),
        (np.ones(ROWS + 1, dtype=bool), ValueError),
        (np.zeros(ROWS, dtype=bool), ValueError),
    ],
)
def test_a_bad_reset_mask_is_refused(env_id: str, mask: Any, kind: type[Exception]) -> None:
    env = make(env_id, "DISABLED")
    env.reset(seed=1)
    with pytest.raises(kind, match="reset_mask"):
        env.reset(options={"reset_mask": mask})


def test_a_refused_reset_changes_nothing_at_all(env_id: str) -> None:
    def after(refused: bool) -> list[np.ndarray]:
        env = make(env_id)
        env.reset(seed=4)
        if refused:
            for options in (
                {"insect": "nobody"},
                {"insect": ["hawkmoth"]},
                {"reset_mask": np.ones(1, dtype=bool)},
                {"x": 1},
            ):
                with pytest.raises((ValueError, TypeError)):
                    env.reset(seed=9, options=options)
        seen = [env.step(np.zeros(env.action_space.shape, dtype=np.float32))[0] for _ in range(2)]
        return [*seen, env.reset()[0]]

    for one, other in zip(after(refused=True), after(refused=False), strict=True):
        np.testing.assert_array_equal(one, other)


def test_infos_are_plain_values_that_json_takes(env_id: str) -> None:
    env = gym.make(env_id)
    env.reset(seed=0)
    json.dumps(env.step(env.action_space.sample())[-1])


def test_final_infos_share_no_array_with_those_of_the_next_episode(env_id: str) -> None:
    env = make(env_id, "SAME_STEP", **({"beats": 2} if env_id in ONE_BEAT else {}))
    env.reset(seed=0)
    actions = np.zeros(env.action_space.shape, dtype=np.float32)
    env.step(actions)
    env.reset(options={"reset_mask": np.arange(ROWS) < 2})  # these rows are a beat behind the others
    info = env.step(actions)[-1]
    for key, value in info["final_info"].items():
        assert key not in info or not np.shares_memory(value, info[key])


def test_stepping_or_resetting_a_part_before_the_first_reset_is_refused(env_id: str) -> None:
    env = make(env_id)
    with pytest.raises(ResetNeeded):
        env.step(env.action_space.sample())
    with pytest.raises(ResetNeeded):
        env.reset(options={"reset_mask": np.array([True] + [False] * (ROWS - 1))})
    with pytest.raises(ValueError, match="reset option 'sede' = 1 is unknown; allowed: reset_mask"):
        env.reset(options={"sede": 1})
    with pytest.raises(TypeError, match="seed = 'one'"):
        env.reset(seed="one")


@pytest.mark.parametrize(
    ("spoil", "kind", "said"),
    [
        (lambda a: a[:, :-1], ValueError, "actions with shape .* is not allowed; allowed"),
        (lambda a: a[:-1], ValueError, "actions with shape"),
        (lambda a: a[0], ValueError, "actions with shape"),
        (lambda a: a + np.where(np.indices(a.shape).all(axis=0), np.nan, 0), ValueError, r"actions\[1, 1\] = nan"),
        (lambda a: np.where(np.arange(a.size).reshape(a.shape) == 0, np.inf, a), ValueError, r"actions\[0, 0\] = inf"),
        (lambda a: a.astype(str), TypeError, "actions"),
        (lambda _: None, TypeError, "actions"),
    ],
)
def test_bad_actions_are_refused_and_leave_the_environment_usable(
    env_id: str, spoil: Any, kind: type[Exception], said: str
) -> None:
    env = make(env_id)
    env.reset(seed=1)
    good = env.action_space.sample()
    with pytest.raises(kind, match=said):
        env.step(spoil(good))
    assert np.isfinite(env.step(good)[1]).all()


def test_huge_actions_of_any_number_type_count_as_the_face_of_the_box(env_id: str) -> None:
    env = make_one_beat(env_id, "SAME_STEP")
    size = env.action_space.shape
    results = []
    for actions in (
        np.ones(size, dtype=np.float32),
        np.full(size, 1e300),
        np.full(size, 10**9),
        np.ones(size).tolist(),
    ):
        env.reset(seed=1)
        *_, infos = env.step(actions)
        results.append((infos["final_info"]["specific_power"], infos["final_info"]["clipped"]))
    for power, _ in results:
        np.testing.assert_array_equal(power, results[0][0])
    assert [bool(clipped.all()) for _, clipped in results] == [False, True, True, False]


@pytest.mark.parametrize("clone", [copy.deepcopy, lambda env: pickle.loads(pickle.dumps(env))])
def test_copies_go_on_as_the_original_does(env_id: str, clone: Any) -> None:
    env = make(env_id, "SAME_STEP").unwrapped
    env.reset(seed=2)
    env.step(env.action_space.sample())
    other, actions = clone(env), env.action_space.sample()
    for a, b in zip(env.step(actions)[:4], other.step(actions)[:4], strict=True):
        np.testing.assert_array_equal(a, b)
    scalar = gym.make(env_id)
    scalar.reset(seed=2)
    twin, action = clone(scalar), scalar.action_space.sample()
    assert scalar.step(action)[1] == twin.step(action)[1]


def test_specs_survive_json(env_id: str) -> None:
    spec = gym.make(env_id, render_mode="rgb_array").spec
    again = gym.make(EnvSpec.from_json(spec.to_json()))
    assert again.reset(seed=1)[0].tolist() == gym.make(env_id).reset(seed=1)[0].tolist()
    assert json.loads(spec.to_json())["entry_point"].startswith("flapenv.envs.")


def test_rendering_shows_one_picture_a_row_and_nothing_without_a_mode(env_id: str) -> None:
    env = make(env_id, "SAME_STEP", rows=2, render_mode="rgb_array")
    env.reset(seed=1)
    before = env.render()
    env.step(env.action_space.sample())
    after = env.render()
    assert len(before) == len(after) == 2
    assert all(frame.dtype == np.uint8 and frame.ndim == 3 and frame.shape[2] == 3 for frame in after)
    assert np.any(before[0] != after[0])
    with pytest.warns(UserWarning, match="render_mode"):
        assert make(env_id).unwrapped.render() is None
    with pytest.raises(ValueError, match="render_mode = 'human' is unknown; allowed: rgb_array"):
        make(env_id, render_mode="human")


@pytest.mark.parametrize(
    ("arguments", "kind", "said"),
    [
        ({"autoreset_mode": "SOMETIMES"}, ValueError, "autoreset_mode = 'SOMETIMES' is unknown; allowed: NEXT_STEP"),
        ({"num_envs": 0}, ValueError, "num_envs = 0"),
        ({"num_envs": 2.5}, TypeError, "num_envs = 2.5"),
    ],
)
def test_bad_arguments_of_a_vector_environment_are_named(
    env_id: str, arguments: dict[str, Any], kind: type[Exception], said: str
) -> None:
    with pytest.raises(kind, match=said):
        gym.make_vec(env_id, **arguments)
