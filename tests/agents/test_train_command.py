"""The command line that trains."""

import json
import os
import signal
import subprocess
import sys
import time
from pathlib import Path

import pytest

import train
from agents.presets import DEFAULT_PRESET, PRESETS
from agents.train_command import what_counts

ROOT = Path(__file__).parents[2]


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
        (json.dumps({"tasks": {}, **CONFIG}), "did you mean 'task'?"),
        (json.dumps({"task": {}}), "lacks algorithm, settings"),
        (json.dumps({**CONFIG, "settings": {"wingbeat": 512}}), "did you mean 'wingbeats'?"),
        (json.dumps({**CONFIG, "task": {"name": "hoover"}}), "did you mean 'hover'?"),
        (json.dumps({**CONFIG, "task": {"name": "hover", "insect": ["hawkmoth"]}}), "did you mean 'insects'?"),
        (json.dumps({**CONFIG, "algorithm": "PP0"}), "did you mean 'PPO'?"),
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


def test_help_teaches_and_the_list_names_every_preset() -> None:
    out, _ = command("--help").communicate(timeout=60)
    for word in ("examples:", "--seed", "--out", "results.json", "Ctrl-C", "hawkmoth", "evaluate", "benchmark"):
        assert word in out
    out, _ = command("--list").communicate(timeout=60)
    for name in PRESETS:
        assert name in out


def test_the_card_tells_the_command_without_where_it_is_kept(tmp_path: Path) -> None:
    asked = ["--seed", "3", "--out", str(tmp_path), "--quiet", f"--out={tmp_path}", "--insects", "hawkmoth"]
    assert what_counts(asked) == ["--seed", "3", "--insects", "hawkmoth"]
