"""An environment made afresh goes on from a saved state as the one that it was taken from, bit for bit."""

import copy
import dataclasses
import json
from collections.abc import Callable, Iterator
from typing import Any

import gymnasium as gym
import numpy as np
import pytest
from gymnasium.envs.registration import EnvSpec
from gymnasium.vector import AutoresetMode
from hypothesis import given, settings
from hypothesis import strategies as st

from flapenv.envs import ENV_IDS, EnvState
from flapenv.envs.batch import BatchEnv
from flapenv.envs.single import SingleEnv

MODES = [mode.name for mode in AutoresetMode]
ROWS, BEATS = 3, 6
LONG = ("flapenv/Heave-v0", "flapenv/HoverAdapt-v0")
ARGUMENTS: dict[str, dict[str, Any]] = {name: {"beats": BEATS} for name in LONG}
"""Shorter episodes, so that several end."""
VARIANTS: dict[str, tuple[dict[str, Any], ...]] = {
    "flapenv/Hover-v0": (
        {"reward": "vector", "dtype": "float64"},
        {"insect": "random-wing", "pool_size": 16},
        {"problem": "profile-drag", "insect": "hawkmoth"},
    ),
    "flapenv/HoverAdapt-v0": ({"references": False, "dtype": "float64"}, {"beats": 20}),
}
"""Further arguments that change what is kept or how a beat is computed."""
CASES = [(env_id, {}) for env_id in ENV_IDS] + [(env_id, own) for env_id, all_ in VARIANTS.items() for own in all_]
NOT_KEPT = {"_now", "_now_cast", "_results", "_sines", "_bounds"}
"""Made again before they are read: the present conditions of HoverAdapt at the beat that they change, the plain numbers
of Hover's last beat, and the bounds of coordinates in a type that was asked for."""
Env = BatchEnv | SingleEnv


def make(env_id: str, mode: str, **arguments: Any) -> Env:
    """An environment of a mode, or the scalar one for "scalar"."""
    arguments = ARGUMENTS.get(env_id, {}) | arguments
    if mode == "scalar":
        env: Any = gym.make(env_id, **arguments).unwrapped
    else:
        env = gym.make_vec(env_id, num_envs=ROWS, autoreset_mode=mode, **arguments)
    assert isinstance(env, BatchEnv | SingleEnv)
    return env


def drawn_action(env: Env, rng: np.random.Generator) -> np.ndarray:
    """A hovering insect's neighbourhood and beyond, as lost rows of Heave would come too soon."""
    return (rng.uniform(-1.1, 1.1, env.action_space.shape)).astype(np.float32)


def played(env: Env, rng: np.random.Generator, steps: int) -> list[Any]:
    """All that a number of steps gives, with resets where the environment does not reset itself."""
    seen: list[Any] = []
    for _ in range(steps):
        observation, reward, terminated, truncated, info = env.step(drawn_action(env, rng))
        seen.append((observation, reward, terminated, truncated, info))
        ended = np.logical_or(terminated, truncated)
        if not ended.any():
            continue
        if isinstance(env, SingleEnv):
            seen.append(env.reset())
        elif env.autoreset_mode is AutoresetMode.DISABLED:
            seen.append(env.reset(options={"reset_mask": ended}))
    return seen


def through_bytes(state: EnvState) -> EnvState:
    """A state as it comes back from a file: arrays as bytes, the rest as JSON."""
    kinds = {name: (one.dtype.str, one.shape, one.tobytes()) for name, one in state.arrays.items()}
    assert all(np.dtype(dtype).kind in "biuf" for dtype, _, _ in kinds.values())
    arrays = {name: np.frombuffer(own, dtype).reshape(shape) for name, (dtype, shape, own) in kinds.items()}
    return EnvState(arrays=arrays, random=json.loads(json.dumps(state.random)))


def assert_same(one: Any, other: Any, where: str = "") -> None:
    """Equal to the bit, of the same types, whatever they consist of."""
    assert type(one) is type(other), where
    if isinstance(one, dict):
        assert list(one) == list(other), where
        for key in one:
            assert_same(one[key], other[key], f"{where}.{key}")
    elif isinstance(one, list | tuple):
        assert len(one) == len(other), where
        for index, pair in enumerate(zip(one, other, strict=True)):
            assert_same(*pair, f"{where}[{index}]")
    elif isinstance(one, np.ndarray):
        assert one.dtype == other.dtype, where
        np.testing.assert_array_equal(one, other, err_msg=where)
    elif isinstance(one, np.random.Generator):
        assert one.bit_generator.state == other.bit_generator.state, where
    else:
        assert one == other or (one != one and other != other), where


def parts(value: Any, where: str, seen: set[int]) -> Iterator[tuple[str, Any]]:
    """Every array, number, text and generator that an object consists of, with the way to it."""
    if isinstance(value, np.ndarray | np.random.Generator | int | float | str | type(None)):
        yield where, value
        return
    if id(value) in seen or isinstance(value, gym.Space | EnvSpec | type) or callable(value):
        return
    seen.add(id(value))
    if isinstance(value, dict):
        children = {str(key): own for key, own in value.items()}
    elif isinstance(value, list | tuple):
        children = {str(index): own for index, own in enumerate(value)}
    else:
        children = getattr(value, "__dict__", {})
    for name, own in children.items():
        if name not in NOT_KEPT:
            yield from parts(own, f"{where}.{name}", seen)


def all_parts(env: Env) -> dict[str, Any]:
    """Copies of all that an environment consists of."""
    return {where: copy.deepcopy(value) for where, value in sorted(parts(env, "env", set()), key=lambda part: part[0])}


each_case = pytest.mark.parametrize(("env_id", "arguments"), CASES, ids=[f"{name} {own or ''}" for name, own in CASES])


@each_case
@pytest.mark.parametrize("mode", [*MODES, "scalar"])
@settings(max_examples=4, deadline=None)
@given(seed=st.integers(0, 2**31), steps=st.integers(0, 2 * BEATS + 1))
def test_a_fresh_environment_goes_on_bit_for_bit(
    env_id: str, arguments: dict[str, Any], mode: str, seed: int, steps: int
) -> None:
    env, fresh = make(env_id, mode, **arguments), make(env_id, mode, **arguments)
    env.reset(seed=seed)
    played(env, np.random.default_rng(seed), steps)
    state = through_bytes(env.state())
    before = all_parts(env)
    fresh.restore(state)
    after = all_parts(fresh)
    assert_same(before, after)
    rngs = np.random.default_rng(seed + 1), np.random.default_rng(seed + 1)
    one, other = (played(own, rng, 3 * BEATS) for own, rng in zip((env, fresh), rngs, strict=True))
    assert_same(one, other)
    assert env.np_random_seed == fresh.np_random_seed
    assert_same(env.reset(), fresh.reset())  # goes on in the same series of episodes
    assert_same(env.reset(seed=seed), fresh.reset(seed=seed))


@pytest.mark.parametrize("mode", [*MODES, "scalar"])
@pytest.mark.parametrize("env_id", ENV_IDS)
@pytest.mark.parametrize("steps", [0, 1, 3])
def test_what_is_seen_and_drawn_is_the_same(env_id: str, mode: str, steps: int) -> None:
    env, fresh = (make(env_id, mode, render_mode="rgb_array") for _ in range(2))
    env.reset(seed=5)
    played(env, np.random.default_rng(5), steps)
    fresh.restore(env.state())
    batches = [own.batch if isinstance(own, SingleEnv) else own for own in (env, fresh)]
    assert_same(*(own._observe() for own in batches))
    assert_same(env.render(), fresh.render())


@each_case
@pytest.mark.parametrize("mode", ["SAME_STEP", "scalar"])
def test_a_state_of_before_the_first_reset_is_one_too(env_id: str, arguments: dict[str, Any], mode: str) -> None:
    env, used = make(env_id, mode, **arguments), make(env_id, mode, **arguments)
    used.reset(seed=2)
    played(used, np.random.default_rng(0), 2)
    used.restore(env.state())
    with pytest.raises(gym.error.ResetNeeded, match="call reset"):
        used.step(drawn_action(used, np.random.default_rng(0)))
    assert_same(env.reset(seed=3), used.reset(seed=3))


@pytest.mark.parametrize("env_id", ENV_IDS)
def test_a_generator_of_ones_own_is_kept_before_the_first_reset(env_id: str) -> None:
    env, fresh = make(env_id, "scalar"), make(env_id, "scalar")
    env.np_random = np.random.default_rng(8)
    fresh.restore(env.state())
    assert_same(env.reset(), fresh.reset())


@pytest.mark.parametrize("mode", [*MODES, "scalar"])
@pytest.mark.parametrize("env_id", ENV_IDS)
def test_going_back_to_a_state_plays_the_same_again(env_id: str, mode: str) -> None:
    env = make(env_id, mode)
    env.reset(seed=1)
    played(env, np.random.default_rng(0), 2)
    state = env.state()
    saved = copy.deepcopy(state)
    first = played(env, np.random.default_rng(4), 2 * BEATS)
    assert_same(dict(state.arrays), dict(saved.arrays))  # neither stepping nor restoring changes it
    env.restore(state)
    assert_same(first, played(env, np.random.default_rng(4), 2 * BEATS))
    assert_same(dict(state.arrays), dict(saved.arrays))


@pytest.mark.parametrize("env_id", ENV_IDS)
def test_taking_a_state_changes_nothing(env_id: str) -> None:
    for mode in (*MODES, "scalar"):
        env, other = make(env_id, mode), make(env_id, mode)
        assert_same(env.reset(seed=1), other.reset(seed=1))
        env.state()
        assert_same(played(env, np.random.default_rng(4), 9), played(other, np.random.default_rng(4), 9))


def with_array(name: str, change: Callable[[np.ndarray], Any]) -> Callable[[EnvState], EnvState]:
    """The state with another array."""
    return lambda state: dataclasses.replace(state, arrays={**state.arrays, name: change(state.arrays[name])})


def with_random(**values: Any) -> Callable[[EnvState], EnvState]:
    """The state with another state of the generator."""
    return lambda state: dataclasses.replace(
        state, random={**(state.random or {}), "generator": {**(state.random or {})["generator"], **values}}
    )


def put(value: Any, place: tuple[int, ...] = (0,)) -> Callable[[np.ndarray], np.ndarray]:
    """An array with another element."""

    def change(array: np.ndarray) -> np.ndarray:
        array[place] = value
        return array

    return change


HOSTILE: list[tuple[str, Callable[[EnvState], Any], str]] = [
    *(
        (env_id, with_array("insect", put(number)), rf"insect\[0\] = {number} .*whole numbers from 0 to 7")
        for env_id in ENV_IDS
        for number in (-1, 8)
    ),
    ("flapenv/Hover-v0", with_array("insect", lambda own: own[:2]), r"insect .*shape \(2,\); .*int64 of shape \(3,\)"),
    ("flapenv/Hover-v0", with_array("insect", lambda own: own.astype(float)), "insect is an array of float64"),
    ("flapenv/Hover-v0", with_array("insect", lambda own: own.tolist()), "insect = .* is not an array"),
    ("flapenv/Hover-v0", with_array("felt", put(np.nan, (1, 2))), r"felt\[1, 2\] = nan .*finite numbers"),
    ("flapenv/Hover-v0", with_array("felt", put(np.inf, (0, 0))), r"felt\[0, 0\] = inf .*finite numbers"),
    ("flapenv/Hover-v0", with_array("beaten", put(-2)), r"beaten\[0\] = -2 .*whole numbers from -1 to 7"),
    ("flapenv/Heave-v0", with_array("beaten", put(8)), r"beaten\[0\] = 8 "),
    ("flapenv/Heave-v0", with_array("paths", put(np.inf, (0, 1))), r"paths\[0, 1\] = inf .*finite numbers"),
    ("flapenv/Heave-v0", with_array("beat_number", put(BEATS)), rf"beat_number\[0\] = {BEATS} .*from 0 to {BEATS - 1}"),
    ("flapenv/HoverAdapt-v0", with_array("flown", put(BEATS)), rf"flown\[0\] = {BEATS} .*from 0 to {BEATS - 1}"),
    ("flapenv/HoverAdapt-v0", with_array("last.insect", put(9)), r"last.insect\[0\] = 9 "),
    ("flapenv/HoverAdapt-v0", with_array("last.beats", put(BEATS + 1)), rf"last.beats\[0\] = {BEATS + 1} "),
    ("flapenv/HoverAdapt-v0", with_array("draws.before.payload", put(3.0)), r"payload\[0\] = 3 .*\[1, 1.25\]"),
    ("flapenv/Hover-v0", lambda state: state.arrays, "state = .*an EnvState"),
    ("flapenv/Hover-v0", lambda state: EnvState(arrays=[], random=state.random), r"arrays = \[\] .*allowed: a dict"),
    (
        "flapenv/Hover-v0",
        lambda state: EnvState(arrays={**state.arrays, "insects": np.zeros(3)}, random=state.random),
        "holds 'insects', which .*did you mean 'insect'",
    ),
    (
        "flapenv/Hover-v0",
        lambda state: EnvState(
            arrays={name: one for name, one in state.arrays.items() if name != "felt"}, random=state.random
        ),
        r"has no 'felt'; allowed: an array of float32 of shape \(3, 3\)",
    ),
    ("flapenv/Hover-v0", lambda state: EnvState(arrays=state.arrays), "random = None .*allowed: a dict"),
    ("flapenv/Hover-v0", lambda state: EnvState(arrays=state.arrays, random=[]), r"random = \[\] .*allowed: a dict"),
    ("flapenv/Hover-v0", lambda state: EnvState(arrays=state.arrays, random={}), "keys .*allowed: seed, generator"),
    (
        "flapenv/Hover-v0",
        lambda state: EnvState(arrays=state.arrays, random={**(state.random or {}), "seed": "1"}),
        "seed = '1' .*a whole number or None",
    ),
    ("flapenv/Hover-v0", with_random(bit_generator="MT19937"), "bit_generator = 'MT19937' .*allowed: PCG64"),
    ("flapenv/Hover-v0", with_random(state={"state": 1}), "generator = .* is not a state of PCG64"),
    ("flapenv/Hover-v0", with_random(state={"state": 1.5, "inc": 1}), "is not a state of PCG64"),
    ("flapenv/Hover-v0", with_random(state={"state": 2**128, "inc": 1}), "is not a state of PCG64"),
    ("flapenv/Hover-v0", with_random(state={"state": -1, "inc": 1}), "is not a state of PCG64"),
    ("flapenv/Hover-v0", with_random(uinteger=2**40), "is not a state of PCG64"),
    ("flapenv/Hover-v0", with_random(uinteger=np.zeros(2)), "is not a state of PCG64"),
    ("flapenv/Hover-v0", with_random(more=1), "is not a state of PCG64"),
]


@pytest.mark.parametrize(("env_id", "change", "message"), HOSTILE, ids=[f"{own[0]} {own[2]}" for own in HOSTILE])
def test_a_hostile_state_is_refused_in_one_line_and_changes_nothing(
    env_id: str, change: Callable[[EnvState], Any], message: str
) -> None:
    env = make(env_id, "SAME_STEP", render_mode="rgb_array")
    env.reset(seed=1)
    played(env, np.random.default_rng(0), 2)
    hostile = change(env.state())
    played(env, np.random.default_rng(0), 1)
    before = all_parts(env)
    with pytest.raises((TypeError, ValueError), match=message) as refused:
        env.restore(hostile)
    assert "\n" not in str(refused.value)
    assert_same(before, all_parts(env))


@pytest.mark.parametrize("env_id", LONG)
def test_a_row_that_has_flown_all_its_beats_has_ended(env_id: str) -> None:
    env = make(env_id, "DISABLED", insect="hawkmoth")
    env.reset(seed=1)
    for _ in range(BEATS):
        env.step(np.zeros(env.action_space.shape, dtype=np.float32))
    state = env.state()
    make(env_id, "DISABLED", insect="hawkmoth").restore(state)
    running = {**state.arrays, "ended": np.zeros(ROWS, dtype=bool)}
    with pytest.raises(ValueError, match=f"= {BEATS} is not allowed; allowed: whole numbers from 0 to {BEATS - 1}"):
        env.restore(EnvState(arrays=running, random=state.random))


@pytest.mark.parametrize("env_id", ENV_IDS)
def test_a_state_of_other_rows_or_another_environment_is_refused(env_id: str) -> None:
    env, one = make(env_id, "SAME_STEP"), make(env_id, "scalar")
    env.reset(seed=1)
    with pytest.raises(ValueError, match=r"shape \(3,\); allowed: .* shape \(1,\), as of an environment made with"):
        one.restore(env.state())
    for other_id in ENV_IDS:
        if other_id != env_id:
            with pytest.raises(ValueError, match=r"does not keep; allowed: |has no "):
                make(other_id, "SAME_STEP").restore(env.state())


def test_a_generator_of_another_kind_is_not_saved() -> None:
    env = make("flapenv/Hover-v0", "SAME_STEP")
    env.np_random = np.random.Generator(np.random.MT19937(1))
    with pytest.raises(ValueError, match="np_random draws from MT19937; allowed: PCG64"):
        env.state()


@pytest.mark.parametrize("mode", ["SAME_STEP", "scalar"])
def test_series_of_gusts_that_nobody_seeded_differ(mode: str) -> None:
    first, second = make("flapenv/Heave-v0", mode).reset(), make("flapenv/Heave-v0", mode).reset()
    assert np.all(first[1]["gust"] != second[1]["gust"])
