"""Training end to end, from the command line too."""

import csv
import json
import os
import signal
import subprocess
import sys
import time
from pathlib import Path

import pytest
from stable_baselines3 import PPO

from agents.presets import PPOPreset
from agents.training import TrainingConfig, draw_pictures, make_model, summary, train
from flapenv import INSECTS, Insect, Stroke, Wing, evaluate
from flapenv.aero.planform import HALF_ELLIPSE

ROOT = Path(__file__).parents[2]
TINY = PPOPreset(wingbeats=4096, rows=512, minibatch=128, epochs=1)


def command(*arguments: str, cwd: Path = ROOT) -> subprocess.Popen[str]:
    return subprocess.Popen(
        [sys.executable, str(ROOT / "train.py"), *arguments],
        cwd=cwd,
        stdout=subprocess.PIPE,
        stderr=subprocess.PIPE,
        text=True,
        env={**os.environ, "PYTHONPATH": str(ROOT)},
    )


def test_a_run_writes_everything_needed_to_repeat_and_judge_it(tmp_path: Path) -> None:
    config = TrainingConfig(preset=TINY, seed=3)
    result = train(config, tmp_path, progress=False)
    draw_pictures(config, result)
    names = {path.name for path in tmp_path.iterdir()}
    pictures = {"learning_curve.png", "strokes.png"}
    assert names == {"config.json", "results.json", "policy.zip", "curve.csv", "tensorboard"} | pictures
    assert any((tmp_path / "tensorboard").glob("events.out.tfevents.*"))

    config = json.loads((tmp_path / "config.json").read_text(encoding="utf-8"))
    assert config["seed"] == 3
    assert PPOPreset(**config["preset"]) == TINY
    assert {"torch", "gymnasium", "flapenv"} <= set(config["versions"])
    fields = {key: config[key] for key in ("insects", "problem", "preset", "seed")}
    assert TrainingConfig(**fields) == TrainingConfig(preset=TINY, seed=3)

    results = json.loads((tmp_path / "results.json").read_text(encoding="utf-8"))
    assert tuple(results["insects"]) == INSECTS
    assert results["wingbeats"] == 4096
    assert results["interrupted"] is False
    for name, entry in results["insects"].items():
        ours = evaluate(name, Stroke(**entry["stroke"]))
        assert entry["weight_support"] == pytest.approx(ours.weight_support, rel=1e-12)
        assert entry["specific_power"] == pytest.approx(ours.specific_power, rel=1e-12)
    assert results["mean_gap_percent"] == pytest.approx(
        sum(entry["gap_percent"] for entry in results["insects"].values()) / 8
    )
    with (tmp_path / "curve.csv").open(encoding="utf-8") as file:
        rows = list(csv.DictReader(file))
    assert int(rows[-1]["wingbeats"]) == 4096
    assert float(rows[-1]["mean_gap"]) * 100 == pytest.approx(results["mean_gap_percent"], rel=1e-4)
    assert "4,096 wingbeats" in summary(result)


def test_the_same_seed_learns_the_same_and_the_saved_policy_is_the_last(tmp_path: Path) -> None:
    config = TrainingConfig(preset=TINY, seed=1)
    one, two = (train(config, tmp_path / name, progress=False) for name in "ab")
    other = train(TrainingConfig(preset=TINY, seed=2), tmp_path / "c", progress=False)
    assert [a.stroke for a in one.insects] == [b.stroke for b in two.insects]
    assert [a.stroke for a in one.insects] != [b.stroke for b in other.insects]

    from agents.comparison import Comparison

    loaded = PPO.load(tmp_path / "a" / "policy.zip", device="cpu")
    strokes = [result.stroke for result in Comparison(config.insects, config.problem).results(loaded)]
    assert strokes == [result.stroke for result in one.insects]


@pytest.mark.filterwarnings("ignore:.*no stroke of the box:UserWarning")
def test_an_infeasible_insect_is_trained_and_reported(tmp_path: Path) -> None:
    problem = {"box": {"frequency_ratio": (0.3, 0.45)}}
    config = TrainingConfig(insects=["ladybird", "hoverfly"], problem=problem, preset=TINY)
    text = summary(train(config, tmp_path, progress=False))
    assert "ladybird is INFEASIBLE" in text
    results = json.loads((tmp_path / "results.json").read_text(encoding="utf-8"))
    assert results["infeasible"] == ["ladybird"]
    assert results["insects"]["ladybird"]["feasible"] is False
    assert results["insects"]["ladybird"]["gap_percent"] is None


def test_ctrl_c_saves_what_was_learned_and_prints_the_comparison(tmp_path: Path) -> None:
    process = command("--out", str(tmp_path / "run"), "--quiet")
    curve = tmp_path / "run" / "curve.csv"
    for _ in range(600):
        if curve.exists() and len(curve.read_text(encoding="utf-8").splitlines()) > 3:
            break
        time.sleep(0.1)
    process.send_signal(signal.SIGINT)
    out, err = process.communicate(timeout=60)
    assert process.returncode == 130
    assert "keeping what was learned" in err
    assert "hawkmoth" in out
    results = json.loads((tmp_path / "run" / "results.json").read_text(encoding="utf-8"))
    assert results["interrupted"] is True
    assert 0 < results["wingbeats"] < PPOPreset().wingbeats
    assert (tmp_path / "run" / "policy.zip").exists()


def test_an_interrupt_before_the_first_wingbeat_still_prints_the_comparison(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr("agents.vec_env.GymnasiumVecEnv.reset", lambda _: signal.raise_signal(signal.SIGINT))
    config = TrainingConfig(preset=TINY)
    result = train(config, tmp_path, progress=False)
    draw_pictures(config, result)
    assert result.interrupted
    assert result.wingbeats == 0
    assert "hawkmoth" in summary(result)
    assert (tmp_path / "results.json").exists()


def test_ctrl_c_while_everything_is_being_loaded_is_one_line(tmp_path: Path) -> None:
    for delay in (0.3, 0.8):
        process = command("--out", str(tmp_path / str(delay)), "--quiet")
        time.sleep(delay)
        process.send_signal(signal.SIGINT)
        _, err = process.communicate(timeout=60)
        assert process.returncode in (130, -signal.SIGINT)  # the latter before Python runs a line of ours
        assert "Traceback" not in err or process.returncode != 130


def test_a_budget_of_one_update_learns_something_and_writes_one_point(tmp_path: Path) -> None:
    config = TrainingConfig(preset=PPOPreset(wingbeats=512, rows=512, minibatch=128, epochs=1))
    weights = make_model(config).policy.state_dict()
    train(config, tmp_path, progress=False)
    trained = PPO.load(tmp_path / "policy.zip", device="cpu").policy.state_dict()
    assert any((weights[name] != trained[name]).any() for name in weights)
    assert len((tmp_path / "curve.csv").read_text(encoding="utf-8").splitlines()) == 2


@pytest.mark.parametrize(
    ("fields", "kind", "said"),
    [
        ({"preset": 3}, TypeError, "preset = 3"),
        ({"insects": "hawkmoth"}, TypeError, "insects = 'hawkmoth'"),
        ({"insect": "hawkmoth"}, TypeError, "did you mean 'insects'"),
        ({"preset": {"rows": 0}}, ValueError, "rows = 0"),
    ],
)
def test_bad_configurations_are_named(fields: dict[str, object], kind: type[Exception], said: str) -> None:
    with pytest.raises(kind, match=said):
        TrainingConfig(**fields)


@pytest.mark.parametrize(
    ("arguments", "said"),
    [
        (("--insects", "moth"), "insect = 'moth' is unknown; allowed: fruitfly"),
        (("--problem", "free"), "problem = 'free' is unknown"),
        (("--wingbeats", "0"), "wingbeats = 0"),
        (("--seed", "-1"), "seed = -1"),
        (("--seed", str(2**32)), "seed = 4294967296 "),
        (("--insects", "hawkmoth", "hawkmoth"), "2 called 'hawkmoth'"),
    ],
)
def test_bad_input_is_one_line_and_exit_code_2(arguments: tuple[str, ...], said: str, tmp_path: Path) -> None:
    process = command(*arguments, "--out", str(tmp_path / "run"))
    _, err = process.communicate(timeout=60)
    assert process.returncode == 2
    assert said in err
    assert len(err.strip().splitlines()) == 1
    assert not (tmp_path / "run").exists()


def test_help_teaches() -> None:
    out, _ = command("--help").communicate(timeout=60)
    for word in ("examples:", "--seed", "--out", "results.json", "Ctrl-C", "hawkmoth"):
        assert word in out


@pytest.mark.slow
def test_the_default_command_learns_to_hover_at_the_proven_optimum(tmp_path: Path) -> None:
    """The whole default run, and the limits that it is held to."""
    process = command("--out", str(tmp_path / "run"), "--quiet")
    out, _ = process.communicate(timeout=1200)
    assert process.returncode == 0
    assert "gap to the optimum: mean 0." in out
    results = json.loads((tmp_path / "run" / "results.json").read_text(encoding="utf-8"))
    entries = results["insects"].values()
    assert results["mean_gap_percent"] <= 1
    assert max(entry["gap_percent"] for entry in entries) <= 2
    assert min(entry["weight_support"] for entry in entries) >= 0.998


def test_what_no_file_can_hold_is_refused_before_anything_is_made(tmp_path: Path) -> None:
    smooth = Insect(
        name="smooth",
        mass=1e-4,
        wing=Wing(length=0.015, mean_chord=0.004, planform=HALF_ELLIPSE),
        stroke=Stroke(frequency=120.0, flap_amplitude=1.0, pitch_amplitude=1.0),
    )
    with pytest.raises(TypeError, match="the planform of smooth is a function, which cannot be written to a file"):
        train(TrainingConfig(insects=[smooth], preset=TINY), tmp_path / "run", progress=False)
    assert not (tmp_path / "run").exists()


def test_a_measured_wing_is_trained_on_and_comes_back_from_its_config(tmp_path: Path) -> None:
    measured = Insect(
        name="measured",
        mass=1e-4,
        wing=Wing.from_table([0, 0.004, 0.010, 0.015], [0.003, 0.005, 0.0045, 0.001], mass=4e-7),
        stroke=Stroke(frequency=120.0, flap_amplitude=1.0, pitch_amplitude=1.0),
    )
    train(TrainingConfig(insects=[measured], preset=TINY), tmp_path, progress=False)
    config = json.loads((tmp_path / "config.json").read_text(encoding="utf-8"))
    assert TrainingConfig(insects=config["insects"]).insects == (measured,)
