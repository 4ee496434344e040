"""Training end to end."""

import csv
import json
import signal
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from stable_baselines3 import PPO

from agents.policy_file import load_policy
from agents.presets import GradientSettings, PPOSettings, Preset, as_preset
from agents.tasks.hover import HoverTask
from agents.training import DivergedError, TrainingConfig, make_model, summary, train
from agents.vec_env import GymnasiumVecEnv
from flapenv import INSECTS, Insect, Stroke, Wing, evaluate
from flapenv.aero.planform import HALF_ELLIPSE

SETTINGS = PPOSettings(wingbeats=4096, rows=512, minibatch=128, epochs=1)


def tiny(**arguments: Any) -> Preset:
    return Preset(task="hover", arguments=arguments, settings=SETTINGS)


def strokes(folder: Path) -> dict[str, dict[str, float]]:
    results = json.loads((folder / "results.json").read_text(encoding="utf-8"))
    return {name: entry["stroke"] for name, entry in results["insects"].items()}


def test_a_run_writes_everything_needed_to_repeat_and_judge_it(tmp_path: Path) -> None:
    result = train(TrainingConfig(preset=tiny(), seed=3), tmp_path, progress=False)
    names = {path.name for path in tmp_path.iterdir()}
    files = {"config.json", "results.json", "policy.zip", "policy.safetensors", "policy.json", "curve.csv"}
    assert names == files | {"tensorboard", "learning_curve.png", "learned.png", "report.html", ".lock"}
    assert any((tmp_path / "tensorboard").glob("events.out.tfevents.*"))

    config = json.loads((tmp_path / "config.json").read_text(encoding="utf-8"))
    assert config["seed"] == 3
    assert config["preset"] == "hover-ppo"
    assert {"torch", "gymnasium", "flapenv", "sb3-contrib"} <= set(config["versions"])
    again = as_preset({key: config[key] for key in ("task", "algorithm", "settings")})
    assert again.settings == SETTINGS
    assert again.make_task() == HoverTask()

    results = json.loads((tmp_path / "results.json").read_text(encoding="utf-8"))
    assert tuple(results["insects"]) == INSECTS
    assert results["wingbeats"] == 4096
    assert results["interrupted"] is False
    for name, entry in results["insects"].items():
        ours = evaluate(name, Stroke(**entry["stroke"]))
        assert entry["weight_support"] == pytest.approx(ours.weight_support, rel=1e-12)
        assert entry["specific_power"] == pytest.approx(ours.specific_power, rel=1e-12)
    gaps = [entry["gap_percent"] for entry in results["insects"].values()]
    assert results["mean_gap_percent"] == pytest.approx(sum(gaps) / 8)
    assert results["verdict"]["mean"] == pytest.approx(sum(gaps) / 800)
    assert results["verdict"]["worst"] == pytest.approx(max(gaps) / 100)
    with (tmp_path / "curve.csv").open(encoding="utf-8") as file:
        rows = list(csv.DictReader(file))
    assert int(rows[-1]["wingbeats"]) == 4096
    assert float(rows[-1]["mean_gap"]) * 100 == pytest.approx(results["mean_gap_percent"], rel=1e-4)
    assert "4,096 wingbeats" in summary(result)
    assert result.report == tmp_path / "report.html"
    assert summary(result).endswith(f"report: {result.report}")


def test_the_same_seed_learns_the_same_and_what_is_saved_is_the_last_policy(tmp_path: Path) -> None:
    for name, seed in (("a", 1), ("b", 1), ("c", 2)):
        train(TrainingConfig(preset=tiny(), seed=seed), tmp_path / name, progress=False, report=False)
    assert strokes(tmp_path / "a") == strokes(tmp_path / "b")
    assert strokes(tmp_path / "a") != strokes(tmp_path / "c")

    actor, card = load_policy(tmp_path / "a")
    verdict = HoverTask().judge(actor)
    for name, entry in verdict.results["insects"].items():
        assert entry["stroke"] == pytest.approx(strokes(tmp_path / "a")[name], rel=1e-5)
    assert card.seed == 1
    assert card.command == ""  # no command makes this preset
    assert TrainingConfig(seed=1).command == "python train.py --preset hover-ppo --seed 1"
    assert card.result["mean"] == pytest.approx(verdict.mean, rel=1e-3)
    zipped = PPO.load(tmp_path / "a" / "policy.zip", device="cpu")
    assert HoverTask().judge(zipped).mean == pytest.approx(verdict.mean, rel=1e-3)


@pytest.mark.filterwarnings("ignore:.*no stroke of the box:UserWarning")
def test_an_infeasible_insect_is_trained_and_reported(tmp_path: Path) -> None:
    preset = tiny(insects=["ladybird", "hoverfly"], problem={"box": {"frequency_ratio": (0.3, 0.45)}})
    text = summary(train(TrainingConfig(preset=preset), tmp_path, progress=False, report=False))
    assert "ladybird is INFEASIBLE" in text
    results = json.loads((tmp_path / "results.json").read_text(encoding="utf-8"))
    assert results["infeasible"] == ["ladybird"]
    assert results["insects"]["ladybird"]["feasible"] is False
    assert results["insects"]["ladybird"]["gap_percent"] is None


def test_an_interrupt_before_the_first_wingbeat_still_prints_the_comparison(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    reset = GymnasiumVecEnv.reset

    def interrupt(env: GymnasiumVecEnv) -> np.ndarray:
        signal.raise_signal(signal.SIGINT)
        return reset(env)

    monkeypatch.setattr(GymnasiumVecEnv, "reset", interrupt)
    result = train(TrainingConfig(preset=tiny()), tmp_path, progress=False, report=False)
    assert result.interrupted
    assert result.wingbeats == 0
    assert "hawkmoth" in summary(result)
    assert (tmp_path / "results.json").exists()


def test_a_budget_of_one_update_learns_something_and_writes_one_point(tmp_path: Path) -> None:
    preset = Preset(task="hover", settings=PPOSettings(wingbeats=512, rows=512, minibatch=128, epochs=1))
    weights = make_model(preset, preset.make_task(), 0).policy.state_dict()
    train(TrainingConfig(preset=preset), tmp_path, progress=False, report=False)
    trained = PPO.load(tmp_path / "policy.zip", device="cpu").policy.state_dict()
    assert any((weights[name] != trained[name]).any() for name in weights)
    assert len((tmp_path / "curve.csv").read_text(encoding="utf-8").splitlines()) == 2


@pytest.mark.parametrize(
    ("fields", "kind", "said"),
    [
        ({"preset": 3}, TypeError, "preset = 3"),
        ({"preset": "hover-pp0"}, ValueError, "did you mean 'hover-ppo'"),
        ({"presets": "hover-ppo"}, TypeError, "did you mean 'preset'"),
        ({"seed": -1}, ValueError, "seed = -1"),
        ({"name": 3}, TypeError, "name = 3"),
        ({"name": "a/b"}, ValueError, "name = 'a/b'"),
        ({"command": ["x"]}, TypeError, "command = "),
    ],
)
def test_bad_configurations_are_named(fields: dict[str, object], kind: type[Exception], said: str) -> None:
    with pytest.raises(kind, match=said):
        TrainingConfig(**fields)


def test_what_no_file_can_hold_is_refused_before_anything_is_made(tmp_path: Path) -> None:
    smooth = Insect(
        name="smooth",
        mass=1e-4,
        wing=Wing(length=0.015, mean_chord=0.004, planform=HALF_ELLIPSE),
        stroke=Stroke(frequency=120.0, flap_amplitude=1.0, pitch_amplitude=1.0),
    )
    with pytest.raises(TypeError, match="the planform of smooth is a function, which cannot be written to a file"):
        train(TrainingConfig(preset=tiny(insects=[smooth])), tmp_path / "run", progress=False, report=False)
    assert not (tmp_path / "run").exists()


def test_a_measured_wing_is_trained_on_and_comes_back_from_its_config(tmp_path: Path) -> None:
    measured = Insect(
        name="measured",
        mass=1e-4,
        wing=Wing.from_table([0, 0.004, 0.010, 0.015], [0.003, 0.005, 0.0045, 0.001], mass=4e-7),
        stroke=Stroke(frequency=120.0, flap_amplitude=1.0, pitch_amplitude=1.0),
    )
    train(TrainingConfig(preset=tiny(insects=[measured])), tmp_path, progress=False, report=False)
    config = json.loads((tmp_path / "config.json").read_text(encoding="utf-8"))
    assert HoverTask(insects=config["task"]["insects"]).insects == (measured,)


def test_the_reward_scale_reaches_the_learner_and_nothing_else(tmp_path: Path) -> None:
    halved = Preset(task="hover", settings=PPOSettings(wingbeats=512, rows=512, minibatch=128, reward_scale=0.5))
    env = make_model(halved, halved.make_task(), 0).get_env()
    full = make_model(tiny(), tiny().make_task(), 0).get_env()
    assert env is not None
    assert full is not None
    rewards = []
    for one in (env, full):
        one.seed(0)
        one.reset()
        rewards.append(one.step(np.zeros((512, 6), dtype=np.float32))[1])
    np.testing.assert_allclose(rewards[0], 0.5 * rewards[1], rtol=1e-6)


def test_a_report_that_cannot_be_drawn_does_not_cost_the_run(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    def fails(*_: object) -> None:
        raise RuntimeError("no ink")

    monkeypatch.setattr("agents.report.of_run.report_of_run", fails)
    result = train(TrainingConfig(preset=tiny(insects="hawkmoth")), tmp_path, progress=False)
    assert (tmp_path / "results.json").exists()
    assert result.report is None
    assert "report: " not in summary(result)
    assert "the report could not be drawn: no ink; the run is kept without it" in capsys.readouterr().err


def test_a_gradient_agent_learns_through_the_same_code(tmp_path: Path) -> None:
    settings = GradientSettings(wingbeats=30_000, rows=32)
    result = train(
        TrainingConfig(preset=Preset(task="hover", settings=settings)), tmp_path, progress=False, report=False
    )
    assert result.verdict.mean is not None
    assert result.verdict.mean < 0.5
    assert load_policy(tmp_path)[1].algorithm == "gradient"


@pytest.mark.parametrize(("rate", "said"), [(1e14, "what the policy answers is not finite"), (1e15, "not finite")])
def test_training_whose_policy_answers_no_more_numbers_has_diverged(rate: float, said: str, tmp_path: Path) -> None:
    preset = as_preset("hover-ppo").changed({}, {"wingbeats": 4096, "rows": 256, "learning_rate": rate})
    with pytest.raises(DivergedError, match=said):
        train(TrainingConfig(preset=preset), tmp_path, progress=False, report=False)
    assert not (tmp_path / "policy.safetensors").exists()
