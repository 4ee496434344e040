"""What is HoverAdapt's own: hidden conditions, felt beats, the horizon and the references in the infos."""

import dataclasses
from typing import Any

import gymnasium as gym
import numpy as np
import pytest

from flapenv import HoverModel, Insect, Stroke, Wing, evaluate, load_insect
from flapenv.adapt import Condition, flown, tuning
from flapenv.adapt.conditions import NOMINAL
from flapenv.adapt.references import COORDINATES
from flapenv.adapt.task import BEATS, CHANGE
from flapenv.adapt.tuning import NAMES, shipped
from flapenv.envs import HoverAdaptEnv, HoverAdaptVectorEnv
from flapenv.performance import yardstick
from flapenv.wing_pool import wing_pool

ID = "flapenv/HoverAdapt-v0"
ROBOT = Insect(
    name="robot",
    mass=1e-4,
    wing=Wing(length=0.015, mean_chord=0.004, r1_hat=0.5),
    stroke=Stroke(frequency=120.0, flap_amplitude=1.0, pitch_amplitude=1.0),
)
MIDDLE = np.zeros(5, dtype=np.float32)


def fly(env: HoverAdaptEnv, action: np.ndarray = MIDDLE) -> list[dict[str, Any]]:
    """Infos of an episode of one action, begun already."""
    infos = []
    while True:
        _, _, terminated, truncated, info = env.step(action)
        assert not truncated
        infos.append(info)
        if terminated:
            return infos


def stroke_of(info: dict[str, Any]) -> Stroke:
    return Stroke(**{name.split("/")[1]: value for name, value in info.items() if name.startswith("stroke/")})


def condition_of(info: dict[str, Any]) -> Condition:
    return Condition(**{name.split("/")[1]: value for name, value in info.items() if name.startswith("condition/")})


def test_an_episode_has_twenty_beats_and_the_same_keys_on_each() -> None:
    env = gym.make(ID)
    env.reset(seed=1)
    infos = fly(env)
    assert len(infos) == BEATS
    assert [info["beat"] for info in infos] == list(range(1, BEATS + 1))
    keys = set(HoverAdaptVectorEnv.info_keys)
    assert all(set(info) == keys for info in infos)
    assert env.spec.max_episode_steps is None
    assert len({stroke_of(info) for info in infos}) == 1


def test_the_condition_changes_once_within_its_beats() -> None:
    env = gym.make(ID)
    changes = []
    for seed in range(40):
        env.reset(seed=seed)
        conditions = [condition_of(info) for info in fly(env)]
        beats = [beat for beat in range(1, BEATS) if conditions[beat] != conditions[beat - 1]]
        assert len(beats) == 1
        changes += beats
    assert CHANGE[0] <= min(changes) <= CHANGE[0] + 2
    assert CHANGE[1] - 2 <= max(changes) <= CHANGE[1]


@pytest.mark.filterwarnings("ignore:.*aspect ratio:UserWarning")
def test_loads_are_those_of_the_cut_wing_in_the_actual_air_and_the_reward_is_free_of_noise() -> None:
    env = HoverAdaptEnv(insect="honeybee", dtype="float64")
    env.reset(seed=5)
    action = np.array([0.8, -0.9, 0.5, 0.6, 0.1], dtype=np.float32)
    for info in fly(env, action)[:: BEATS - 1]:
        changed, air = flown(load_insect("honeybee"), condition_of(info), HoverModel())
        found = evaluate(changed, stroke_of(info), **vars(air))
        assert info["weight_support"] == pytest.approx(found.weight_support, rel=2e-6)
        assert info["specific_power"] == pytest.approx(found.specific_power, rel=2e-6)
        assert info["lift_deficit"] == max(0.0, 1 - info["weight_support"])
        flight = env.batch.task.flight(
            np.zeros(1, dtype=np.intp),
            Condition(**{name: np.array([value]) for name, value in vars(condition_of(info)).items()}),
        )
        assert info["reward/power"] == pytest.approx(-found.specific_power / flight.reference_power[0], rel=1e-5)


def test_a_condition_can_be_set_and_the_nominal_one_is_hover() -> None:
    env = HoverAdaptEnv(insect="cranefly", dtype="float64")
    env.reset(seed=1, options={"condition": {}})
    infos = fly(env)
    found = evaluate("cranefly", stroke_of(infos[0]))
    assert all(condition_of(info) == NOMINAL for info in infos)
    assert infos[-1]["weight_support"] == pytest.approx(found.weight_support, rel=2e-6)
    assert infos[-1]["specific_power"] == pytest.approx(found.specific_power, rel=2e-6)
    env.reset(options={"condition": {"payload": 1.2}})
    assert all(condition_of(info) == Condition(payload=1.2) for info in fly(env))
    with pytest.raises(ValueError, match="payload = 2 is not allowed"):
        env.reset(options={"condition": {"payload": 2}})
    with pytest.raises(TypeError, match=r"reset option condition = 1\.2"):
        env.reset(options={"condition": 1.2})
    with pytest.raises(TypeError, match=r"reset option condition: payload = .* one number"):
        env.reset(options={"condition": {"payload": np.array([1.0, 1.1])}})
    with pytest.raises(ValueError, match=r"reset option condition: key = 'paylod' .*did you mean 'payload'"):
        env.reset(options={"condition": {"paylod": 1.1}})
    with pytest.raises(ValueError, match="the largest weight support there is 0"):
        env.reset(options={"condition": {"payload": 1.25, "density_ratio": 0.8, "span_lost": 0.15}})


def test_the_observation_is_the_nominal_task_and_the_last_four_beats() -> None:
    env = HoverAdaptEnv(insect="hawkmoth")
    first, _ = env.reset(seed=2)
    nominal = env.batch.task.table.nominal
    reference, felt_power = yardstick(nominal, HoverModel())
    wing = load_insect("hawkmoth").wing
    np.testing.assert_allclose(
        first[:3], (wing.aspect_ratio - 4, (wing.r1_hat - 0.51) / 0.04, np.log(reference[0])), rtol=1e-5
    )
    assert first.shape == (32,)
    assert not first[3:31].any()
    assert first[31] == 1
    actions = np.linspace(-0.9, 0.9, 6 * 5).reshape(6, 5).astype(np.float32)
    infos = [env.step(action)[-1] for action in actions[:-1]]
    seen, _, _, _, info = env.step(actions[-1])
    beats = seen[3:31].reshape(4, 7)
    np.testing.assert_array_equal(beats[:, 2:], actions[:-5:-1])
    for beat, then in zip(beats, [info, *infos[:-4:-1]], strict=True):
        assert beat[0] + 1 == pytest.approx(then["weight_support"], rel=0.1)
        assert beat[1] == pytest.approx(np.log(then["specific_power"] / felt_power[0]), abs=0.1)
    assert seen[31] == pytest.approx(1 - 6 / BEATS)


def test_what_is_felt_is_off_by_two_percent_and_lift_and_power_independently() -> None:
    env = HoverAdaptVectorEnv(4000, insect="bumblebee", dtype="float64")
    env.reset(seed=1)
    seen, _, _, _, info = env.step(np.zeros((4000, 5), dtype=np.float32))
    lift = np.log((seen[:, 3] + 1.0) / info["weight_support"])
    power = seen[:, 4] - np.log(info["specific_power"] / env._felt_power[0])
    assert np.std(lift) == pytest.approx(0.02, rel=0.05)
    assert np.std(power) == pytest.approx(0.02, rel=0.05)
    assert abs(np.corrcoef(lift, power)[0, 1]) < 0.05


def test_returns_are_sums_of_rewards_beside_those_of_the_references() -> None:
    env = HoverAdaptVectorEnv(64, autoreset_mode="SAME_STEP", dtype="float64")
    env.reset(seed=3)
    insects = env.insects
    rows = [insects[number] for number in env._insect]
    actions = np.array([shipped(insect).fixed_action for insect in rows], dtype=np.float32)
    total = np.zeros(64)
    for _ in range(BEATS):
        _, rewards, terminated, _, infos = env.step(actions)
        total += rewards
    assert terminated.all()
    final = infos["final_info"]
    np.testing.assert_allclose(final["return"], total, rtol=1e-12)
    np.testing.assert_allclose(final["return/fixed_stroke"], total, rtol=2e-5)
    assert np.all(final["return/full_knowledge"] > final["return/lift_ladder"])
    assert np.mean(final["return/lift_ladder"]) > np.mean(final["return/felt_lift"]) > np.mean(total)
    _, _, _, _, infos = env.step(actions)
    assert np.all(infos["return"] > -25)  # begun again


def test_whoever_does_what_the_felt_lift_controller_does_gets_its_return() -> None:
    insect = load_insect("bumblebee")
    tuned = shipped(insect)
    env = HoverAdaptEnv(insect=insect, dtype="float64")
    env.reset(seed=9)
    low, high = np.radians(40), np.radians(90)
    amplitude = low + (high - low) * (tuned.felt_action[0] + 1) / 2
    terminated = False
    while not terminated:
        action = np.array([2 * (amplitude - low) / (high - low) - 1, *tuned.felt_action[1:]])
        seen, _, terminated, _, info = env.step(action)
        wanted = amplitude * (seen[3] + 1.0) ** -tuned.felt_gain * (1 + tuned.felt_margin)
        amplitude = np.clip(wanted, low, high)
    assert info["return"] == pytest.approx(info["return/felt_lift"], rel=1e-4)


def test_the_optimum_of_the_present_condition_has_no_gap_and_its_reward() -> None:
    env = HoverAdaptEnv(insect="ladybird", dtype="float64")
    env.reset(seed=4)
    terminated = False
    while not terminated:
        batch = env.batch
        now = batch._after if batch._flown[0] >= batch._draws.change_beat[0] else batch._before
        ladder = batch.task.ladder
        rung = ladder.rung(now.case, HoverModel(), 1.0001 / ladder.full_lift(now.case, HoverModel()))
        values = {name: float(value[0]) for name, value in ladder.waveform(rung.lift).items()}
        action = COORDINATES.encode(values | {"flap_amplitude": rung.flap_amplitude[0]}, now.case.reference)
        _, reward, terminated, _, info = env.step(np.ravel(action))
        assert info["optimality_gap"] == pytest.approx(0, abs=2e-3)
        assert reward == pytest.approx(now.best_reward[0], abs=3e-3)
    assert info["return"] == pytest.approx(info["return/full_knowledge"], abs=0.03)


def test_an_insect_of_ones_own_has_the_optimum_beside_it_and_more_when_asked(monkeypatch: pytest.MonkeyPatch) -> None:
    env = gym.make(ID, insect=dataclasses.asdict(ROBOT))
    env.reset(seed=1)
    info = fly(env)[-1]
    assert info["insect"] == "robot"
    assert info["return/full_knowledge"] > info["return"]
    assert [info[f"return/{name}"] for name in NAMES[1:]] == [None] * 3
    assert set(info) == set(HoverAdaptVectorEnv.info_keys)

    monkeypatch.setattr(tuning, "SAMPLES", 12)
    monkeypatch.setattr(tuning, "STARTS", 1)
    monkeypatch.setattr(tuning, "EVALUATIONS", 60)
    env = gym.make(ID, insect=[ROBOT, "hawkmoth"], tune_references=True)
    env.reset(seed=1, options={"insect": "robot"})
    info = fly(env)[-1]
    assert all(np.isfinite(info[f"return/{name}"]) for name in NAMES)
    tuning.tuned_for.cache_clear()


def test_without_references_their_keys_stay_and_are_empty() -> None:
    env = HoverAdaptEnv(references=False)
    env.reset(seed=1)
    info = fly(env)[-1]
    assert set(info) == set(HoverAdaptVectorEnv.info_keys)
    assert [info[f"return/{name}"] for name in NAMES[1:]] == [None] * 3
    with_them = HoverAdaptEnv()
    with_them.reset(seed=1)
    assert fly(with_them)[-1]["return"] == info["return"]  # they take nothing from the generator
    few = HoverAdaptEnv(infos=["return"])
    few.reset(seed=1)
    assert fly(few)[-1] == {"return": info["return"]}
    assert few.batch._company.controllers == {}  # nobody asked for them


def test_rows_in_different_beats_go_on_where_they_were() -> None:
    env = HoverAdaptVectorEnv(4, autoreset_mode="DISABLED")
    env.reset(seed=1)
    for _ in range(3):
        env.step(np.zeros((4, 5), dtype=np.float32))
    before = {name: np.array(one.beats().amplitude) for name, one in env._company.controllers.items()}
    observed = env._observe()
    mask = np.array([True, False, False, True])
    after, _ = env.reset(options={"reset_mask": mask})
    np.testing.assert_array_equal(after[~mask], observed[~mask])
    for name in ("felt_lift", "lift_ladder"):
        np.testing.assert_array_equal(env._company.controllers[name].beats().amplitude[~mask], before[name][~mask])
    *_, infos = env.step(np.zeros((4, 5), dtype=np.float32))
    np.testing.assert_array_equal(infos["beat"], [1, 4, 4, 1])
    np.testing.assert_allclose(infos["return/full_knowledge"][~mask], 4 * infos_best(env)[~mask], rtol=1e-6)
    for _ in range(BEATS - 4):
        _, _, terminated, _, infos = env.step(np.zeros((4, 5), dtype=np.float32))
    np.testing.assert_array_equal(terminated, ~mask)


def infos_best(env: HoverAdaptVectorEnv) -> np.ndarray:
    """Reward of the optimum before the change."""
    return env._before.best_reward


def test_double_precision_agrees_with_single() -> None:
    rewards = []
    for dtype in ("float32", "float64"):
        env = HoverAdaptVectorEnv(300, dtype=dtype)
        env.reset(seed=1)
        rewards.append(env.step(np.random.default_rng(0).uniform(-1, 1, (300, 5)).astype(np.float32))[1])
    np.testing.assert_allclose(*rewards, rtol=1e-4)


def test_batches_agree_with_the_scalar_environment_on_what_they_compute() -> None:
    condition = {"payload": 1.1, "span_lost": 0.05}
    batch, single = HoverAdaptVectorEnv(7, insect="hoverfly"), HoverAdaptEnv(insect="hoverfly")
    for env in (batch, single):
        env.reset(seed=1, options={"condition": condition})
    *_, infos = batch.step(np.full((7, 5), 0.3, dtype=np.float32))
    *_, info = single.step(np.full(5, 0.3, dtype=np.float32))
    np.testing.assert_allclose(infos["weight_support"], info["weight_support"], rtol=1e-6)
    np.testing.assert_allclose(infos["return"], info["return"], rtol=1e-6)


@pytest.mark.parametrize(
    ("arguments", "kind", "said"),
    [
        ({"insect": "moth"}, ValueError, "insect = 'moth' is unknown"),
        ({"insect": wing_pool(3)}, TypeError, "insect 'train-0' has array fields"),
        ({"insect": ["hawkmoth", "hawkmoth"]}, ValueError, "2 called 'hawkmoth'"),
        ({"problem": "free-frequency"}, TypeError, "problem = 'free-frequency' is not an argument"),
        ({"references": "yes"}, TypeError, "references = 'yes'"),
        ({"tune_references": 1}, TypeError, "tune_references = 1"),
        ({"beats": 0}, ValueError, "beats = 0"),
        ({"infos": ["power"]}, ValueError, "infos key = 'power' is unknown"),
        ({"dtype": "float16"}, ValueError, "dtype = 'float16' is unknown"),
    ],
)
def test_bad_arguments_are_named(arguments: dict[str, Any], kind: type[Exception], said: str) -> None:
    with pytest.raises(kind, match=said):
        gym.make(ID, **arguments)


def test_an_insect_that_cannot_hover_is_refused() -> None:
    with pytest.raises(ValueError, match="insect 'robot' is not allowed: its largest weight support"):
        HoverAdaptEnv(insect=dataclasses.replace(ROBOT, mass=1e-2))


def test_pictures_keep_their_size_and_show_the_flight_so_far() -> None:
    env = HoverAdaptEnv(insect="fruitfly", render_mode="rgb_array")
    env.reset(seed=1)
    frames = [env.render()]
    for _ in range(2):
        env.step(MIDDLE)
        frames.append(env.render())
    assert len({frame.shape for frame in frames}) == 1
    assert np.any(frames[1] != frames[2])
