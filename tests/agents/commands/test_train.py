"""The command line that trains."""

import dataclasses
import json
import os
import signal
import subprocess
import sys
import time
from pathlib import Path

import pytest

import train
from agents.commands.train import config_of, parser, what_counts
from agents.presets import DEFAULT_PRESET, PRESETS
from flapenv import HoverProblem, WingFile, read_wing, write_wing

ROOT = Path(__file__).parents[3]
ROBOT = ROOT / "docs" / "examples" / "robot.json"


def command(*arguments: str, cwd: Path = ROOT) -> subprocess.Popen[str]:
    return subprocess.Popen(
        [sys.executable, str(ROOT / "train.py"), *arguments],
        cwd=cwd,
        stdout=subprocess.PIPE,
        stderr=subprocess.PIPE,
        text=True,
        env={**os.environ, "PYTHONPATH": str(ROOT)},
    )


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
    assert 0 < results["wingbeats"] < PRESETS[DEFAULT_PRESET].settings.wingbeats
    assert (tmp_path / "run" / "policy.safetensors").exists()


def test_ctrl_c_while_everything_is_being_loaded_is_one_line(tmp_path: Path) -> None:
    for delay in (0.3, 0.8):
        process = command("--out", str(tmp_path / str(delay)), "--quiet")
        time.sleep(delay)
        process.send_signal(signal.SIGINT)
        _, err = process.communicate(timeout=60)
        assert process.returncode in (130, -signal.SIGINT)  # the latter before Python runs a line of ours
        assert "Traceback" not in err or process.returncode != 130


def test_a_command_that_does_not_exist_is_named(capsys: pytest.CaptureFixture[str]) -> None:
    assert train.main(["evalute", "hover"]) == 2
    assert "did you mean 'evaluate'?" in capsys.readouterr().err


@pytest.mark.parametrize("arguments", [("--seed", "a"), ("--wingbeats", "1e6"), ("--out", ""), ("--sed", "1")])
def test_what_the_parser_refuses_is_one_line_too(
    arguments: tuple[str, ...], capsys: pytest.CaptureFixture[str]
) -> None:
    with pytest.raises(SystemExit) as end:
        train.main(list(arguments))
    assert end.value.code == 2
    assert len(capsys.readouterr().err.strip().splitlines()) == 1


def test_training_that_destroys_itself_says_so_and_keeps_no_policy(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    asked = ["--insects", "hawkmoth", "--wingbeats", "4096", "--set", "learning_rate=1e10", "--quiet"]
    assert train.main([*asked, "--out", str(tmp_path / "run")]) == 1
    assert "training diverged" in capsys.readouterr().err
    assert not (tmp_path / "run" / "policy.safetensors").exists()


def test_a_mistake_on_the_command_line_ends_the_program_with_code_2(tmp_path: Path) -> None:
    process = command("--preset", "hover-pp", "--out", str(tmp_path / "run"))
    _, err = process.communicate(timeout=60)
    assert process.returncode == 2
    assert len(err.strip().splitlines()) == 1


CONFIG = {"task": {"name": "hover"}, "algorithm": "PPO", "settings": {"wingbeats": 512, "rows": 512}}


@pytest.mark.parametrize(
    ("arguments", "said"),
    [
        (("--insects", "moth"), "insect = 'moth' is unknown; allowed: fruitfly"),
        (("--problem", "free"), "problem = 'free' is unknown"),
        (("--wingbeats", "0"), "wingbeats = 0"),
        (("--seed", "-1"), "seed = -1"),
        (("--seed", str(2**32)), "seed = 4294967296 "),
        (("--insects", "hawkmoth", "hawkmoth"), "2 called 'hawkmoth'"),
        (("--preset", "hover-pp"), "did you mean 'hover-ppo'?"),
        (("--algorithm", "gradent"), "did you mean 'gradient'?"),
        (("--algorithm", "recurrentppo"), "--algorithm = 'recurrentppo' is unknown; allowed: ppo, sac"),
        (("--algorithm", "ppo", "--preset", "hover-ppo"), "--preset and --algorithm ask for two recipes"),
        (("--set", "row=3"), "did you mean 'rows'?"),
        (("--set", "rows=many"), "rows = 'many' is not"),
        (("--set", "rows"), "--set rows is not allowed; allowed: NAME=VALUE"),
        (
            ("--preset", "random-wings-gradient", "--insects", "hawkmoth"),
            "has no argument 'insects'",
        ),
        (("--config", "nowhere.json"), "nowhere.json"),
        (("--wing", "nowhere.json"), "nowhere.json does not exist; allowed: a wing file"),
        (("--wing", str(ROBOT), "--insects", "hawkmoth"), "--insects and --wing both say what flies"),
        (("--wing", str(ROBOT), "--preset", "random-wings-ppo"), "--wing is not told of task 'random-wings'"),
        (("--wing", str(ROBOT), "--wing", str(ROBOT)), "2 called 'invented-robot'"),
        (("--preset", ""), "preset = '' is unknown"),
        (("--wingbeats", "1"), "allowed: at least one update, rows x steps = 2048"),
        (("--algorithm", "sac", "--wingbeats", "1000"), "more than learning_starts = 2000"),
        (("--set", "minibatch=1"), "minibatch = 1"),
        (("--set", "threads=100000"), "threads = 100000"),
        (("--set", "layers=1000000"), "layers = 1000000"),
        (("--set", "rows=99999999999999999999"), "rows = 99999999999999999999"),
        (("--set", "first_mean=3"), "first_mean = 3"),
        (("--set", f"rows={'[' * 100_000}"), "rows = "),
        (("--problem", "inertial"), "needs wing masses, which honeybee"),
    ],
)
def test_bad_input_is_one_line_and_exit_code_2(
    arguments: tuple[str, ...], said: str, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    assert train.main([*arguments, "--out", str(tmp_path / "run")]) == 2
    err = capsys.readouterr().err
    assert said in err
    assert len(err.strip().splitlines()) == 1
    assert not (tmp_path / "run").exists()


@pytest.mark.parametrize(
    ("content", "said"),
    [
        ("{", "is not JSON"),
        ("[]", "holds no object"),
        ("", "is empty"),
        ('{"task": 1, "task": 2}', "the key 'task' stands twice"),
        (json.dumps({"tasks": {}, **CONFIG}), "did you mean 'task'?"),
        (json.dumps({"task": {}}), "lacks algorithm, settings"),
        (json.dumps({**CONFIG, "settings": {"wingbeat": 512}}), "did you mean 'wingbeats'?"),
        (json.dumps({**CONFIG, "task": {"name": "hoover"}}), "did you mean 'hover'?"),
        (json.dumps({**CONFIG, "task": {"name": "hover", "insect": ["hawkmoth"]}}), "did you mean 'insects'?"),
        (json.dumps({**CONFIG, "algorithm": "PP0"}), "did you mean 'PPO'?"),
        (json.dumps({**CONFIG, "preset": 3}), "name = 3"),
        (json.dumps({**CONFIG, "preset": "../escaped"}), "name = '../escaped'"),
        (json.dumps({**CONFIG, "seed": "a"}), "seed = 'a'"),
        (json.dumps({**CONFIG, "settings": None}), "settings = None"),
        (json.dumps({**CONFIG, "settings": {"rows": True}}), "rows = True"),
        (json.dumps({**CONFIG, "settings": {"learning_rate": float("nan")}}), "learning_rate"),
        (json.dumps({**CONFIG, "task": {"name": "hover", "insects": {}}}), "Insect needs name"),
        (json.dumps({**CONFIG, "environment": 5}), "environment = 5"),
        (json.dumps({**CONFIG, "task": {"name": "hover", "problem": {"name": "\ud800"}}}), "surrogates"),
        ("[" * 100_000, "is not JSON that can be read"),
    ],
)
def test_a_config_file_with_a_mistake_is_one_line(
    content: str, said: str, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    (tmp_path / "config.json").write_text(content, encoding="utf-8")
    assert train.main(["--config", str(tmp_path / "config.json"), "--out", str(tmp_path / "run")]) == 2
    err = capsys.readouterr().err
    assert said in err
    assert len(err.strip().splitlines()) == 1


def test_a_run_is_repeated_from_its_config(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    small = ["--insects", "hawkmoth", "--wingbeats", "1024", "--set", "rows=512", "--set", "epochs=1", "--quiet"]
    assert train.main([*small, "--seed", "5", "--out", str(tmp_path / "a")]) == 0
    again = ["--config", str(tmp_path / "a" / "config.json"), "--out", str(tmp_path / "b"), "--quiet"]
    assert train.main(again) == 0
    one, two = (json.loads((tmp_path / name / "results.json").read_text(encoding="utf-8")) for name in "ab")
    assert one["insects"] == two["insects"]
    assert one["settings"]["rows"] == 512
    assert "hawkmoth" in capsys.readouterr().out


def test_a_wing_of_ones_own_is_trained_within_its_limits_and_repeated_from_the_config(tmp_path: Path) -> None:
    small = ["--wingbeats", "1024", "--set", "rows=512", "--set", "epochs=1", "--quiet"]
    assert train.main(["--wing", str(ROBOT), *small, "--out", str(tmp_path / "a")]) == 0
    again = ["--config", str(tmp_path / "a" / "config.json"), "--out", str(tmp_path / "b"), "--quiet"]
    assert train.main(again) == 0
    one, two = (json.loads((tmp_path / name / "results.json").read_text(encoding="utf-8")) for name in "ab")
    wing = read_wing(ROBOT)
    assert list(one["insects"]) == [wing.insect.name]
    assert one["insects"] == two["insects"]
    assert one["problem"] == two["problem"] == json.loads(json.dumps(wing.problem(HoverProblem()).to_dict()))
    low, high = wing.limits["frequency"]
    assert low <= one["insects"][wing.insect.name]["stroke"]["frequency"] <= high


def test_wings_of_other_limits_cannot_share_a_policy(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    wing = read_wing(ROBOT)
    other = dataclasses.replace(wing.insect, name="other")
    for name, limits in (("wide", {**wing.limits, "frequency": (10, 200)}), ("same", wing.limits)):
        write_wing(tmp_path / f"{name}.json", WingFile(insect=other, limits=limits))
    arguments = ["--wing", str(ROBOT), "--wing", str(tmp_path / "wide.json"), "--out", str(tmp_path / "run")]
    assert train.main(arguments) == 2
    assert f"wide.json has other limits than {ROBOT}; allowed: equal ones" in capsys.readouterr().err
    options = parser().parse_args(["--wing", str(ROBOT), "--wing", str(tmp_path / "same.json")])
    task = config_of(options, "").preset.make_task()
    assert [one.name for one in task.insects] == ["invented-robot", "other"]


def test_help_teaches_and_the_list_names_every_preset() -> None:
    out, _ = command("--help").communicate(timeout=60)
    commands = ("evaluate", "optimum", "benchmark", "compare")
    for word in ("examples:", "--seed", "--out", "--wing", "results.json", "Ctrl-C", "hawkmoth", *commands):
        assert word in out
    out, _ = command("--list").communicate(timeout=60)
    for name in PRESETS:
        assert name in out


def test_the_card_tells_the_command_without_where_it_is_kept(tmp_path: Path) -> None:
    asked = ["--seed", "3", "--out", str(tmp_path), "--quiet", f"--out={tmp_path}", "--insects", "hawkmoth"]
    assert what_counts([*asked, "--config", str(tmp_path / "c.json")]) == [
        *("--seed", "3", "--insects", "hawkmoth"),
        *("--config", "c.json"),
    ]
    wings = ["--wing", str(tmp_path / "a.json"), f"--wing={tmp_path / 'b.json'}"]
    assert what_counts(wings) == ["--wing", "a.json", "--wing=b.json"]
