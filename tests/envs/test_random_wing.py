"""Hover-v0 on a pool of random wings, its vector reward, and infos on demand."""

from typing import Any

import gymnasium as gym
import numpy as np
import pytest

from flapenv import HoverProblem, evaluate, load_insect
from flapenv.envs import HoverEnv, HoverVectorEnv
from flapenv.insects import Insect
from flapenv.many_optima import many_optima
from flapenv.wing_pool import wing_pool

ROWS = 256


def pool_env(**arguments: Any) -> HoverVectorEnv:
    return HoverVectorEnv(ROWS, insect="random-wing", pool_size=64, autoreset_mode="DISABLED", **arguments)


@pytest.mark.filterwarnings("ignore:.*aspect ratio:UserWarning")
def test_a_random_wing_is_scored_as_its_insect_alone() -> None:
    env = pool_env(dtype="float64", gap_to="optimum")
    env.reset(seed=1)
    actions = np.random.default_rng(0).uniform(-1, 1, env.action_space.shape).astype(np.float32)
    info = env.step(actions)[-1]
    row = 17
    number = int(info["insect"][row].split("-")[-1])
    insect = env.flyers[number]
    assert isinstance(insect, Insect)
    stroke = {name.removeprefix("stroke/"): float(v[row]) for name, v in info.items() if name.startswith("stroke/")}
    alone = evaluate(insect, type(insect.stroke)(**stroke))
    assert info["weight_support"][row] == pytest.approx(alone.weight_support, rel=1e-5)
    assert info["specific_power"][row] == pytest.approx(alone.specific_power, rel=1e-5)


def test_the_optimum_of_every_wing_has_no_gap_and_no_action_solves_them_all() -> None:
    env = pool_env(gap_to="optimum")
    env.reset(seed=2)
    pool = wing_pool(64)
    best = many_optima(pool)
    own = {name: getattr(best.stroke, name) for name in ("frequency", "flap_amplitude", "pitch_amplitude")}
    own |= {name: getattr(best.stroke, name) for name in ("flap_shape", "pitch_shape", "pitch_phase")}
    points = env.coordinates.encode(own, pool.reference)
    number = np.array([int(name.split("-")[-1]) for name in env.reset(seed=3)[1]["insect"]])
    info = env.step(points[number].astype(np.float32))[-1]
    np.testing.assert_allclose(info["optimality_gap"], 0, atol=2e-5)
    assert np.ptp(points[:, 0]) > 0.5
    env.reset(seed=3)
    constant = env.step(np.repeat(points[:1], ROWS, axis=0).astype(np.float32))[-1]["optimality_gap"]
    assert np.median(np.abs(constant)) > 0.1


def test_gaps_to_the_optimum_are_there_only_where_asked_for_and_the_reward_is_the_same() -> None:
    actions = np.zeros((ROWS, 6), dtype=np.float32)
    results = []
    for gap_to in ("bound", "optimum"):
        env = pool_env(gap_to=gap_to)
        env.reset(seed=4)
        _, reward, *_, info = env.step(actions)
        assert info["_bound_gap"].all()
        assert info["_optimality_gap"].all() == (gap_to == "optimum")
        results.append(reward)
    np.testing.assert_array_equal(*results)


def test_splits_seeds_and_left_out_species_make_other_pools() -> None:
    def features(**arguments: Any) -> np.ndarray:
        return pool_env(**arguments).reset(seed=5)[0][:, :3]

    base = features()
    for change in ({"pool_split": "test"}, {"pool_seed": 1}, {"pool_split": "outside"}):
        assert np.any(features(**change) != base)
    outside = features(pool_split="outside")[:, 0] + 4
    assert np.all((outside < 2.6) | (outside > 5.6))
    bee = load_insect("honeybee").wing
    seen = HoverVectorEnv(2, insect="random-wing", pool_size=2048, leave_out="honeybee")
    near = np.abs(np.asarray(seen.objective.cases.aspect_ratio) - bee.aspect_ratio) < 0.3
    near &= np.abs(seen.flyers.r1_hat - bee.r1_hat) < 0.015
    assert not near.any()


def test_with_the_frequency_fixed_every_wing_can_hover() -> None:
    env = HoverVectorEnv(4, insect="random-wing", pool_size=32, problem="fixed-frequency")
    assert env.flyers.references.feasible.all()
    assert np.all(np.isfinite(env.flyers.references.multiplier))


@pytest.mark.parametrize(
    ("arguments", "kind", "said"),
    [
        ({"insect": "hawkmoth", "pool_size": 7}, ValueError, "pool_size = 7 belongs to insect = 'random-wing'"),
        ({"insect": "all", "gap_to": "optimum"}, ValueError, "gap_to = 'optimum' belongs to"),
        ({"insect": "random-wing", "include_infeasible": True}, ValueError, "include_infeasible = True belongs to"),
        ({"insect": "random-wing", "pool_size": 0}, ValueError, "pool_size = 0 "),
        ({"insect": "random-wing", "pool_seed": 0.5}, TypeError, "pool_seed = 0.5 "),
        ({"insect": "random-wing", "pool_split": "trian"}, ValueError, "pool_split = 'trian' .*did you mean 'train'"),
        ({"insect": "random-wing", "gap_to": "cfd", "pool_size": 8}, ValueError, "gap_to = 'cfd'"),
        ({"insect": "random-wing", "leave_out": "moth"}, ValueError, "leave_out = 'moth' .*did you mean 'hawkmoth'"),
        ({"insect": "random-wing", "problem": "inertial", "pool_size": 8}, ValueError, "proves no bound"),
        ({"insect": "random-wing", "leave_out": wing_pool(4)}, TypeError, "leave_out has array fields"),
        (
            {"insect": "hawkmoth", "problem": {"box": {"frequency": (1, 1e14)}}},
            ValueError,
            "frequency = 1e[+]14 .*float32",
        ),
        ({"reward": "triple"}, ValueError, "reward = 'triple'"),
        ({"infos": "some"}, ValueError, "infos = 'some'"),
        ({"infos": ["weight_suport"]}, ValueError, "infos key = 'weight_suport' .*did you mean 'weight_support'"),
        ({"infos": 3}, TypeError, "infos = 3"),
        ({"threads": 0}, ValueError, "threads = 0"),
        ({"threads": True}, TypeError, "threads = True"),
    ],
)
def test_bad_arguments_are_named(arguments: dict[str, Any], kind: type[Exception], said: str) -> None:
    with pytest.raises(kind, match=said):
        HoverEnv(**arguments)


def test_a_vector_reward_holds_power_and_deficit_and_the_cost_is_the_deficit() -> None:
    arguments: dict[str, Any] = {"insect": "hawkmoth", "autoreset_mode": "SAME_STEP"}
    scalar, vector = HoverVectorEnv(64, **arguments), HoverVectorEnv(64, reward="vector", **arguments)
    actions = np.random.default_rng(1).uniform(-1, 1, (64, 6)).astype(np.float32)
    scalar.reset(seed=1)
    vector.reset(seed=1)
    one, both = scalar.step(actions)[1], vector.step(actions)
    assert vector.reward_space is not None
    assert both[1].shape == (64, 2)
    assert np.all((both[1] >= vector.reward_space.low) & (both[1] <= 0))
    final = both[-1]["final_info"]
    np.testing.assert_array_equal(final["cost"], final["lift_deficit"])
    np.testing.assert_allclose(both[1][:, 1], -final["cost"], rtol=1e-6)
    penalty = vector.objective.lift_penalty[0]
    np.testing.assert_allclose(np.maximum(both[1] @ (1, penalty), -20), one, rtol=1e-5)


def test_a_vector_reward_comes_from_the_scalar_environment_too_and_a_reset_row_has_none() -> None:
    env = gym.make("flapenv/Hover-v0", reward="vector", disable_env_checker=True)
    env.reset(seed=1)
    reward: Any = env.step(np.zeros(6, dtype=np.float32))[1]
    assert reward.shape == (2,)
    batch = HoverVectorEnv(3, reward="vector")
    batch.reset(seed=0)
    batch.step(np.zeros((3, 6), dtype=np.float32))
    np.testing.assert_array_equal(batch.step(np.zeros((3, 6), dtype=np.float32))[1], np.zeros((3, 2)))


@pytest.mark.parametrize("mode", ["NEXT_STEP", "SAME_STEP", "DISABLED"])
def test_only_the_infos_asked_for_are_given(mode: str) -> None:
    wanted = ["weight_support", "optimality_gap"]
    for infos, keys in (("none", set()), (wanted, set(wanted))):
        env = HoverVectorEnv(4, infos=infos, autoreset_mode=mode)
        seen = env.reset(seed=0)[1]
        step = env.step(np.zeros((4, 6), dtype=np.float32))[-1]
        own = step.get("final_info", step)
        assert {key for key in (*seen, *own) if not key.startswith(("_", "final"))} == keys
    single = HoverEnv(infos=wanted)
    single.reset(seed=0)
    assert set(single.step(np.zeros(6, dtype=np.float32))[-1]) == set(wanted)


def test_threads_and_parts_change_nothing() -> None:
    rows = 40_000
    actions = np.random.default_rng(2).uniform(-1, 1, (rows, 6)).astype(np.float32)
    rewards = []
    for threads in (1, 2):
        env = HoverVectorEnv(rows, threads=threads, infos="none", autoreset_mode="SAME_STEP")
        env.reset(seed=6)
        rewards.append(env.step(actions)[1])
    np.testing.assert_allclose(*rewards, rtol=1e-6)


def test_a_problem_of_ones_own_takes_random_wings_too() -> None:
    env = HoverVectorEnv(4, insect="random-wing", pool_size=16, problem=HoverProblem(box={"pitch_shape": (0.1, 3.0)}))
    env.reset(seed=0)
    assert np.isfinite(env.step(env.action_space.sample())[1]).all()


def test_bounds_that_differ_from_wing_to_wing_are_seen() -> None:
    hertz = HoverVectorEnv(2, insect=["hawkmoth", "bumblebee"], problem=HoverProblem(box={"frequency": (20, 200)}))
    seen = hertz.reset(seed=0, options={"insect": ["hawkmoth", "bumblebee"]})[0]
    assert seen.shape == (2, 8)
    own = np.array([26.3, 155.0])
    np.testing.assert_allclose(seen[:, 3:5], np.log([20, 200] / own[:, None]), rtol=1e-5)
    both = HoverVectorEnv(1, insect="hawkmoth", problem=HoverProblem(box={"flap_amplitude_ratio": (0.9, 1.1)}))
    own = load_insect("hawkmoth").stroke.flap_amplitude * np.array([0.9, 1.1])
    np.testing.assert_allclose(both.reset()[0][0, 3:5], (np.degrees(own) - 67.5) / 22.5, rtol=1e-5)
