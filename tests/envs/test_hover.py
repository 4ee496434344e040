"""What is Hover's own: actions, observations, rewards, insects and problems."""

import dataclasses
import json
import math
from typing import Any

import gymnasium as gym
import numpy as np
import pytest
from conftest import yardstick_stroke
from gymnasium.envs.registration import EnvSpec

from flapenv import INSECTS, PROBLEMS, HoverProblem, Insect, Stroke, Wing, evaluate, load_insect, optimum
from flapenv.envs import HoverEnv, HoverVectorEnv

ROBOT = Insect(
    name="robot",
    mass=1e-4,
    wing=Wing(length=0.015, mean_chord=0.004, r1_hat=0.5),
    stroke=Stroke(frequency=120.0, flap_amplitude=1.0, pitch_amplitude=1.0),
)
HOPELESS = {"box": {"frequency_ratio": (0.1, 0.2)}}
INFO_KEYS = {
    "insect",
    "weight_support",
    "specific_power",
    "lift_deficit",
    "cost",
    "reward/power",
    "reward/lift",
    "stroke/frequency",
    "stroke/flap_amplitude",
    "stroke/flap_shape",
    "stroke/pitch_shape",
    "stroke/pitch_amplitude",
    "stroke/pitch_phase",
    "clipped",
    "bound_gap",
    "optimality_gap",
}


def optimal_action(env: HoverEnv, insect: Insect) -> np.ndarray:
    batch = env.batch
    best = optimum(insect, batch.problem).stroke
    return batch.coordinates.encode(vars(best), insect.reference).astype(np.float32)


def test_one_wingbeat_is_one_episode_and_terminates() -> None:
    env = gym.make("flapenv/Hover-v0")
    env.reset(seed=1)
    _, reward, terminated, truncated, info = env.step(env.action_space.sample())
    assert (terminated, truncated) == (True, False)
    assert type(reward) is float
    assert set(info) == INFO_KEYS
    assert {type(value) for key, value in info.items() if key != "insect"} == {float, bool}


def test_the_info_is_what_evaluate_says_of_the_physical_stroke(insect: Insect) -> None:
    env = HoverEnv(insect=insect)
    env.action_space.seed(4)
    for _ in range(5):
        env.reset()
        *_, info = env.step(env.action_space.sample())
        stroke = Stroke(**{key.removeprefix("stroke/"): value for key, value in info.items() if "stroke/" in key})
        ours = evaluate(insect, stroke)
        assert info["weight_support"] == pytest.approx(ours.weight_support, rel=2e-5)
        assert info["specific_power"] == pytest.approx(ours.specific_power, rel=2e-5)


def test_the_best_return_is_minus_1045_at_the_optimal_stroke(insect: Insect) -> None:
    env = HoverEnv(insect=insect, dtype="float64")
    env.reset()
    _, reward, *_, info = env.step(optimal_action(env, insect))
    assert reward == pytest.approx(-1.0453, abs=1e-3)
    assert info["optimality_gap"] == pytest.approx(0, abs=1e-5)
    assert info["bound_gap"] == pytest.approx(0.0453, abs=1e-3)
    assert info["reward/power"] + info["reward/lift"] == pytest.approx(reward)


def test_rewards_are_clipped_below_at_minus_twenty() -> None:
    env = HoverEnv(insect="hoverfly")
    env.reset()
    _, reward, *_, info = env.step(np.array([1, 1, -1, -1, -1, 0], dtype=np.float32))
    assert reward == -20
    assert info["reward/power"] < -20


def test_observations_are_the_wings_shape_and_what_was_felt() -> None:
    env = HoverEnv(insect="cranefly", dtype="float64")
    first, _ = env.reset()
    wing = load_insect("cranefly").wing
    yardstick = yardstick_stroke(45.5)
    reference = evaluate("cranefly", yardstick)
    expected = (wing.aspect_ratio - 4, (wing.r1_hat - 0.51) / 0.04, math.log(reference.weight_support), 0, 0, 1)
    np.testing.assert_allclose(first, expected, rtol=1e-4)
    last, *_, info = env.step(np.zeros(6, dtype=np.float32))
    felt = math.log(info["specific_power"] * math.sin(math.radians(35)) ** 2 / reference.specific_power)
    np.testing.assert_allclose(last, (*expected[:3], info["weight_support"] - 1, felt, 0), rtol=1e-4)


def test_all_draws_every_insect_about_equally_often() -> None:
    env = HoverVectorEnv(8000, autoreset_mode="SAME_STEP")
    _, infos = env.reset(seed=1)
    names, counts = np.unique(infos["insect"].astype(str), return_counts=True)
    assert set(names) == set(INSECTS)
    assert np.all(np.abs(counts - 1000) < 150)


def test_the_insect_can_be_chosen_at_reset() -> None:
    env = gym.make("flapenv/Hover-v0")
    for name in INSECTS:
        assert env.reset(options={"insect": name})[1]["insect"] == name
    batch = HoverVectorEnv(8)
    assert batch.reset(options={"insect": list(INSECTS)})[1]["insect"].tolist() == list(INSECTS)
    with pytest.raises(ValueError, match="reset option insect = 'moth' is unknown"):
        env.reset(options={"insect": "moth"})
    with pytest.raises(TypeError, match="reset option insect = 3 is not allowed"):
        env.reset(options={"insect": 3})
    with pytest.raises(TypeError, match="options = 5"):
        HoverEnv().reset(options=5)
    with pytest.raises(ValueError, match="reset option insect has 2 names"):
        batch.reset(options={"insect": ["hawkmoth", "fruitfly"]})


def test_an_insect_of_ones_own_works_as_record_and_as_dict_and_in_a_spec() -> None:
    env = gym.make("flapenv/Hover-v0", insect=ROBOT)
    _, info = env.reset(seed=1)
    assert info["insect"] == "robot"
    env.step(env.action_space.sample())
    assert HoverEnv(insect=dataclasses.asdict(ROBOT)).batch.flyers[0] == ROBOT
    spec = EnvSpec.from_json(gym.make("flapenv/Hover-v0", insect=dataclasses.asdict(ROBOT)).spec.to_json())
    assert gym.make(spec).unwrapped.batch.flyers[0] == ROBOT


def test_several_insects_are_drawn_from_and_names_must_differ() -> None:
    env = HoverVectorEnv(200, insect=["hawkmoth", ROBOT])
    _, infos = env.reset(seed=1)
    assert set(infos["insect"]) == {"hawkmoth", "robot"}
    with pytest.raises(ValueError, match="2 called 'hawkmoth'"):
        HoverVectorEnv(insect=["hawkmoth", "hawkmoth"])
    with pytest.raises(ValueError, match=r"insect = \[\]"):
        HoverVectorEnv(insect=[])


def test_problems_come_as_name_record_or_dict_and_fixed_parameters_lose_their_row() -> None:
    fixed = {"box": {"pitch_phase": math.pi / 2, "flap_shape": (0.01, 0.9999)}}
    for problem in (fixed, HoverProblem(**fixed), json.loads(json.dumps(HoverProblem(**fixed).to_dict()))):
        env = gym.make("flapenv/Hover-v0", problem=problem)
        assert env.action_space.shape == (5,)
        assert env.unwrapped.batch.problem == HoverProblem(**fixed)
        env.reset(seed=0)
        assert env.step(env.action_space.sample())[-1]["stroke/pitch_phase"] == pytest.approx(math.pi / 2)
    assert gym.make("flapenv/Hover-v0", problem="free-frequency").action_space.shape == (6,)


def test_double_precision_agrees_with_single() -> None:
    actions = np.random.default_rng(0).uniform(-1, 1, (500, 6)).astype(np.float32)
    rewards = []
    for dtype in ("float32", np.float64):
        env = HoverVectorEnv(500, dtype=dtype)
        env.reset(seed=1)
        rewards.append(env.step(actions)[1])
    np.testing.assert_allclose(*rewards, rtol=3e-5)


def test_plain_scaling_runs_linearly_over_the_box() -> None:
    env = HoverEnv(insect="hawkmoth", action_scaling="plain")
    env.reset()
    *_, info = env.step(np.zeros(6, dtype=np.float32))
    assert info["stroke/frequency"] == pytest.approx(26.3)
    assert info["stroke/flap_shape"] == pytest.approx(0.5)


def test_an_infeasible_insect_is_kept_alone_and_left_out_of_all_with_a_warning() -> None:
    with pytest.warns(UserWarning, match=r"ladybird \(largest 0\..*kept; the aim is their largest weight support"):
        env = HoverEnv(insect="ladybird", problem=HOPELESS)
    env.reset()
    *_, info = env.step(np.zeros(6, dtype=np.float32))
    assert info["optimality_gap"] is None
    assert set(info) == INFO_KEYS

    some = {"box": {"frequency_ratio": (0.3, 0.45)}}
    with pytest.warns(UserWarning, match=r"ladybird \(largest .*: left out"):
        env = HoverEnv(problem=some)
    assert 0 < len(env.batch.flyers) < 8
    with pytest.warns(UserWarning, match="kept"):
        assert len(HoverEnv(problem=some, include_infeasible=True).batch.flyers) == 8
    with pytest.warns(UserWarning, match="left out"), pytest.raises(ValueError, match="leaves no insect"):
        HoverEnv(problem={"box": {"frequency_ratio": (0.01, 0.02)}})


@pytest.mark.parametrize(
    ("arguments", "kind", "said"),
    [
        ({"insect": "moth"}, ValueError, "insect = 'moth' is unknown; allowed: all, random-wing, fruitfly"),
        ({"insect": 3}, TypeError, "insect = 3"),
        ({"problem": "free"}, ValueError, "problem = 'free' is unknown; allowed: free-frequency"),
        ({"problem": {"boxes": 1}}, TypeError, "did you mean 'box'"),
        ({"dtype": "float16"}, ValueError, "dtype = 'float16' is unknown; allowed: float32, float64"),
        ({"action_scaling": "log2"}, ValueError, "action_scaling = 'log2'"),
        ({"insects": "all"}, TypeError, "insects = 'all' is not an argument.*did you mean 'insect'"),
        ({"include_infeasible": "yes"}, TypeError, "include_infeasible = 'yes'"),
        ({"num_envs": 2}, TypeError, "num_envs = 2 is not an argument of this environment; allowed: insect, problem"),
        (
            {
                "problem": {
                    "box": dict.fromkeys(("frequency", "flap_amplitude", "pitch_amplitude"), 1.0)
                    | {"flap_shape": 0.5, "pitch_shape": 1.0, "pitch_phase": 1.5}
                },
                "insect": "hawkmoth",
            },
            ValueError,
            "box fixes every parameter",
        ),
    ],
)
@pytest.mark.filterwarnings("ignore:.*no stroke of the box:UserWarning")
def test_bad_arguments_are_named(arguments: dict[str, Any], kind: type[Exception], said: str) -> None:
    with pytest.raises(kind, match=said):
        gym.make("flapenv/Hover-v0", **arguments)


def test_an_action_of_wrong_shape_is_refused_by_the_scalar_environment() -> None:
    env = HoverEnv()
    env.reset(seed=0)
    with pytest.raises(ValueError, match=r"action with shape \(5,\) is not allowed; allowed: \(6,\)"):
        env.step(np.zeros(5))
    with pytest.raises(ValueError, match=r"action\[2\] = nan is not allowed"):
        env.step(np.array([0, 0, np.nan, 0, 0, 0]))
    with pytest.raises(TypeError, match="action = None"):
        env.step(None)


def test_every_corner_of_the_box_and_the_optimum_can_be_drawn() -> None:
    env = HoverEnv(insect="hawkmoth", render_mode="rgb_array")
    for corner in (-1, 1):
        env.reset()
        env.step(np.full(6, corner, dtype=np.float32))
        assert env.render().shape[2] == 3


def test_a_picture_shows_the_last_beat_and_after_a_reset_the_new_insects_own_stroke() -> None:
    env = HoverEnv(insect=["hawkmoth", "fruitfly"])
    env.reset(options={"insect": "hawkmoth"})
    env.step(np.ones(6, dtype=np.float32))
    insect, stroke = env.batch._last_beat(0)
    assert insect.name == "hawkmoth"
    assert stroke.flap_amplitude == pytest.approx(math.pi / 2)
    env.reset(options={"insect": "fruitfly"})
    assert env.batch._last_beat(0) == (load_insect("fruitfly"), load_insect("fruitfly").stroke)


@pytest.mark.parametrize("seed", [3, np.int64(3)])
def test_whole_numbers_of_any_kind_are_seeds_and_nothing_else_is(seed: Any) -> None:
    for env in (HoverEnv(), HoverVectorEnv(1)):
        first = env.reset(seed=seed)[0]
        np.testing.assert_array_equal(first, env.reset(seed=3)[0])
        with pytest.raises(TypeError, match="seed = True"):
            env.reset(seed=True)


@pytest.mark.filterwarnings("ignore:no stroke of the box carries the weight:UserWarning")
@pytest.mark.parametrize("problem", PROBLEMS)
def test_every_named_problem_is_an_environment_whose_best_action_has_no_gap(problem: str) -> None:
    insect = "bumblebee"  # feasible in all, with a known wing mass
    env = gym.make_vec("flapenv/Hover-v0", 2, insect=insect, problem=problem, dtype="float64")
    assert env.single_observation_space.shape == ((7,) if problem == "fixed-frequency" else (6,))
    env.reset(seed=0)
    best = optimum(insect, problem)
    action = env.unwrapped.coordinates.encode(vars(best.stroke), load_insect(insect).reference)
    observations, rewards, *_, infos = env.step(np.tile(action, (2, 1)).astype(np.float32))
    assert env.observation_space.contains(observations)
    assert infos["optimality_gap"][0] == pytest.approx(0, abs=2e-5)
    assert rewards[0] == pytest.approx(-best.specific_power / best.reference_power, abs=1e-4)
