"""What is Waveform's own: actions, infos, references, the exact penalty, problems and insects."""

import dataclasses
import json
import math
from typing import Any

import gymnasium as gym
import numpy as np
import pytest
from gymnasium.envs.registration import EnvSpec

from flapenv import INSECTS, load_insect, simulate
from flapenv.envs import WaveformEnv, WaveformVectorEnv
from flapenv.waveform.coordinates import Waveform

INFO_KEYS = {
    "insect",
    "weight_support",
    "specific_power",
    "lift_deficit",
    "reward/power",
    "reward/lift",
    "stroke/frequency",
    "stroke/flap_amplitude",
    "stroke/speed_coefficients",
    "stroke/pitch_coefficients",
    "peak/flap_acceleration",
    "peak/pitch_rate",
    "clipped",
    "bound_gap",
    "optimality_gap",
}


def best_action(env: WaveformVectorEnv, number: int = 0) -> np.ndarray:
    best = env.objective.known[number]
    assert best is not None
    return env.coordinates.encode(best.waveform, env.insects[number].reference)


def test_one_wingbeat_is_one_episode_and_terminates() -> None:
    env = gym.make("flapenv/Waveform-v0")
    observation, info = env.reset(seed=1)
    assert info.keys() == {"insect"}
    assert observation.shape == (6,)
    assert env.action_space.shape == (18,)
    _, reward, terminated, truncated, info = env.step(env.action_space.sample())
    assert (terminated, truncated) == (True, False)
    assert info.keys() == INFO_KEYS
    assert reward == pytest.approx(max(-20, info["reward/power"] + info["reward/lift"]))
    assert len(info["stroke/speed_coefficients"]) == len(info["stroke/pitch_coefficients"]) == 8
    assert env.step.__doc__ or env.unwrapped.__doc__.startswith("One step is one wingbeat")


@pytest.mark.parametrize("problem", ["free-frequency", "fixed-frequency", "profile-drag"])
def test_the_shipped_waveform_is_an_action_without_a_gap(problem: str) -> None:
    env = WaveformVectorEnv(8, problem=problem, autoreset_mode="DISABLED", dtype="float64")
    env.reset(seed=0, options={"insect": list(INSECTS)})
    actions = np.stack([best_action(env, number) for number in range(8)])
    observations, rewards, _, _, info = env.step(actions)
    assert observations in env.observation_space
    assert info["weight_support"] == pytest.approx(1, abs=1e-5)
    assert info["optimality_gap"] == pytest.approx(0, abs=2e-5)
    assert (info["bound_gap"] > 0.05).all()
    powers = [best.specific_power / bound for best, bound in zip(env.objective.known, env.objective.bound, strict=True)]
    assert rewards == pytest.approx(-np.array(powers), abs=1e-4)


def test_numbers_in_the_info_are_those_of_the_blade_element() -> None:
    env = WaveformEnv(insect="honeybee", dtype="float64")
    env.reset(seed=0)
    rng = np.random.default_rng(4)
    for _ in range(5):
        env.reset()
        *_, info = env.step(rng.uniform(-1, 1, 18))
        waveform = Waveform(*(info[f"stroke/{name}"] for name in Waveform._fields))
        motion, insect = waveform.motion(), load_insect("honeybee")
        history = simulate(insect, motion, strips=4, steps=8000, spacing="gauss")
        assert history.mean_lift / (insect.mass * 9.81) == pytest.approx(info["weight_support"], abs=1e-4)
        assert history.mean_power() / insect.mass == pytest.approx(info["specific_power"], rel=1e-5)
        omega = 2 * math.pi * motion.frequency
        kinematics = history.kinematics
        assert np.max(np.abs(kinematics.flap_acceleration)) / omega**2 == pytest.approx(
            info["peak/flap_acceleration"], rel=1e-3
        )
        assert np.max(np.abs(kinematics.pitch_rate)) / omega == pytest.approx(info["peak/pitch_rate"], rel=1e-3)


def test_a_sinusoids_peaks_are_its_amplitudes() -> None:
    env = WaveformEnv(insect="honeybee", knots=32, dtype="float64")
    env.reset(seed=0)
    arc = np.sin(math.pi * (np.arange(32) + 0.5) / 32)
    action = env.batch.coordinates.encode(Waveform(200.0, 1.2, arc, 0.9 * arc), load_insect("honeybee").reference)
    *_, info = env.step(action)
    assert info["peak/flap_acceleration"] == pytest.approx(1.2, rel=0.01)
    assert info["peak/pitch_rate"] == pytest.approx(0.9, rel=0.01)
    assert info["stroke/frequency"] == pytest.approx(200)


def test_single_precision_agrees_with_double() -> None:
    results = []
    for dtype in ("float32", "float64"):
        env = WaveformVectorEnv(2000, autoreset_mode="DISABLED", dtype=dtype)
        env.reset(seed=0)
        actions = np.random.default_rng(0).uniform(-1, 1, (2000, 18)).astype(np.float32)
        results.append(env.step(actions)[4])
    single, double = results
    for key in ("weight_support", "specific_power", "peak/flap_acceleration", "peak/pitch_rate"):
        assert single[key].dtype == np.float32
        assert single[key] == pytest.approx(double[key], rel=3e-5, abs=3e-5)


@pytest.mark.parametrize("problem", ["free-frequency", "fixed-frequency"])
def test_nothing_near_the_best_waveform_is_paid_better(problem: str) -> None:
    env = WaveformVectorEnv(4000, insect="bumblebee", problem=problem, autoreset_mode="DISABLED", dtype="float64")
    action, rng = best_action(env), np.random.default_rng(1)
    best = env.objective.known[0].specific_power / env.objective.bound[0]
    for size in (1e-3, 1e-2, 0.1):
        env.reset(seed=0)
        _, rewards, *_ = env.step(np.clip(action + size * rng.normal(size=(4000, len(action))), -1, 1))
        assert np.max(rewards) < -best + 2e-5


def test_the_penalty_is_twice_the_multiplier_of_the_best_waveform_and_at_least_three() -> None:
    env = WaveformVectorEnv(1)
    for best, bound, penalty in zip(env.objective.known, env.objective.bound, env.objective.lift_penalty, strict=True):
        assert penalty == pytest.approx(max(3, 2 * 1.5 * best.specific_power / bound))
    between = WaveformVectorEnv(1, knots=11)
    assert between.objective.known == (None,) * 8
    assert between.objective.lift_penalty == pytest.approx(env.objective.lift_penalty)
    assert WaveformVectorEnv(1, problem={"lift_penalty": 4.0}).objective.lift_penalty == pytest.approx(4)
    with pytest.warns(UserWarning, match=r"lift_penalty = 0.5 is below the multiplier 1\.65 of hawkmoth"):
        WaveformVectorEnv(1, insect="hawkmoth", problem={"lift_penalty": 0.5})
    wide = {"box": {"pitch_amplitude": (0.5, 1.2)}}
    assert WaveformVectorEnv(1, problem=wide).objective.lift_penalty == pytest.approx(10)


def test_without_a_known_best_waveform_there_is_a_bound_gap_only() -> None:
    env = WaveformEnv(knots=11)
    env.reset(seed=0)
    *_, info = env.step(np.full(24, 0.5, dtype=np.float32))
    assert info["optimality_gap"] is None
    assert math.isfinite(info["bound_gap"])
    assert len(info["stroke/pitch_coefficients"]) == 11


def test_every_insect_can_hover_in_b_and_what_cannot_anywhere_is_said() -> None:
    env = WaveformVectorEnv(1, problem="fixed-frequency")
    assert len(env.insects) == 8
    assert np.min(env.objective.largest_weight_support) > 2
    assert env.single_observation_space.shape == (7,)
    assert env.single_action_space.shape == (16,)
    slow = {"box": {"frequency_ratio": (0.3, 0.4)}}
    with pytest.warns(
        UserWarning, match=r"no waveform carries the weight of .*ladybird \(largest 0\.\d+\).*: left out"
    ):
        env = WaveformVectorEnv(1, problem=slow, knots=4)
    assert "ladybird" not in {one.name for one in env.insects}
    with pytest.warns(UserWarning, match="kept; the aim is their largest weight support"):
        env = WaveformVectorEnv(1, problem=slow, knots=4, include_infeasible=True)
    assert len(env.insects) == 8


def test_a_frequency_or_an_amplitude_that_is_fixed_has_no_axis() -> None:
    for box, axes in (
        ({"frequency_ratio": 1.0}, ("flap_amplitude", "speed_0")),
        ({"flap_amplitude": 1.0}, ("frequency", "speed_0")),
        ({"flap_amplitude": 1.0, "frequency": 200.0}, ("speed_0", "speed_1")),
    ):
        env = WaveformVectorEnv(3, insect="honeybee", problem={"box": box}, knots=4, autoreset_mode="DISABLED")
        assert env.coordinates.axis_names[:2] == axes
        env.reset(seed=0)
        assert np.isfinite(env.step(env.action_space.sample())[1]).all()


def test_a_frequency_beyond_its_bounds_shows_as_clipped() -> None:
    env = WaveformEnv(insect="hawkmoth")
    actions = np.zeros((3, 18), dtype=np.float32)
    actions[0, :2], actions[1, 5] = (1, -1), 1.5
    for action, expected in zip(actions, (True, True, False), strict=True):
        env.reset(seed=0)
        assert env.step(action)[4]["clipped"] is expected


def test_an_insect_of_ones_own_and_a_dict_of_it_serve() -> None:
    own = dataclasses.replace(load_insect("hawkmoth"), name="loaded", mass=1.9e-3)
    for given in (own, own.to_dict(), [own, "honeybee"]):
        env = WaveformEnv(insect=given)
        env.reset(options={"insect": "loaded"})
        assert env.step(np.full(18, 0.5, dtype=np.float32))[4]["optimality_gap"] > 0


def test_a_picture_shows_the_last_beat_and_after_a_reset_the_new_insects_own_stroke() -> None:
    env = WaveformEnv(insect=["hawkmoth", "fruitfly"], render_mode="rgb_array")
    env.reset(options={"insect": "hawkmoth"})
    env.step(np.full(18, 0.5, dtype=np.float32))
    insect, motion = env.batch._last_beat(0)
    assert (insect.name, motion.knots) == ("hawkmoth", 8)
    drawn = env.render()
    env.reset(options={"insect": "fruitfly"})
    assert env.batch._last_beat(0) == (load_insect("fruitfly"), None)
    assert np.any(drawn != env.render())
    for corner in (-1, 1):
        env.reset()
        env.step(np.full(18, corner, dtype=np.float32))
        assert env.render().shape[2] == 3


def test_specs_with_a_problem_survive_json() -> None:
    spec = gym.make("flapenv/Waveform-v0", problem="fixed-frequency", knots=4).spec
    assert json.loads(spec.to_json())["kwargs"] == {"problem": "fixed-frequency", "knots": 4}
    assert gym.make(EnvSpec.from_json(spec.to_json())).action_space.shape == (8,)


@pytest.mark.parametrize(
    ("arguments", "kind", "said"),
    [
        ({"insect": "moth"}, ValueError, "insect = 'moth' is unknown; allowed: all, fruitfly"),
        ({"insect": []}, ValueError, r"insect = \[\] is not allowed"),
        ({"insect": ["hawkmoth", "hawkmoth"]}, ValueError, "insect holds 2 called 'hawkmoth'"),
        ({"problem": "free"}, ValueError, "problem = 'free' is unknown; allowed: free-frequency"),
        ({"problem": "inertial"}, ValueError, "accounting = 'positive' is not served by free waveforms"),
        ({"problem": {"model": {"coefficients": "polhamus"}}}, ValueError, "coefficients = 'polhamus' are not served"),
        ({"problem": {"box": {"pitch_amplitude": 0.0}}}, ValueError, "upper bound of pitch_amplitude = 0"),
        ({"knots": 3}, ValueError, "knots = 3 is not allowed; allowed: whole numbers from 4"),
        ({"knots": 8.0}, TypeError, "knots = 8.0 is not a whole number"),
        ({"dtype": "float16"}, ValueError, "dtype = 'float16' is unknown; allowed: float32, float64"),
        ({"knot": 8}, TypeError, "knot = 8 is not an argument.*did you mean 'knots'"),
        ({"include_infeasible": 1}, TypeError, "include_infeasible = 1"),
    ],
)
def test_bad_arguments_are_named(arguments: dict[str, Any], kind: type[Exception], said: str) -> None:
    with pytest.raises(kind, match=said):
        gym.make("flapenv/Waveform-v0", **arguments)


def test_bad_reset_options_are_named() -> None:
    env = WaveformVectorEnv(3)
    with pytest.raises(ValueError, match="reset option insect = 'moth' is unknown"):
        env.reset(options={"insect": "moth"})
    with pytest.raises(ValueError, match="reset option insect has 2 names"):
        env.reset(options={"insect": ["hawkmoth", "ladybird"]})
    with pytest.raises(TypeError, match="reset option insect = 3"):
        env.reset(options={"insect": 3})
