"""Bad input of `train.py sweep`: one line, exit code 2, and nothing has been started or written."""

import importlib.util
import json
import re
import socket
import subprocess
import sys
import time
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pytest

import train
from agents.sweep import cluster, command
from agents.sweep.cluster import require_head
from agents.sweep.command import sweep_command


@pytest.fixture(autouse=True)
def nothing_starts(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> None:
    def start(*_: Any) -> None:
        raise AssertionError("Ray was started")

    monkeypatch.setattr("agents.sweep.sweep.started", start)
    monkeypatch.setattr("agents.sweep.sweep.reached", start)
    monkeypatch.chdir(tmp_path)


@pytest.fixture
def silent() -> Iterator[str]:
    """An address where something listens that is no head of Ray."""
    with socket.create_server(("127.0.0.1", 0)) as server:
        yield f"127.0.0.1:{server.getsockname()[1]}"


PPO = ["--presets", "hover-ppo"]


@pytest.mark.parametrize(
    ("arguments", "said"),
    [
        ([], "a sweep needs presets; allowed: --presets NAME ..., or --resume DIR"),
        (["--presets", "hover-pqo"], "presets = 'hover-pqo' is unknown; .*did you mean 'hover-ppo'"),
        ([*PPO, "--problems", "Z"], "problems = 'Z' is unknown"),
        (["--presets", "heave-ppo", "--problems", "A"], "preset 'heave-ppo': task 'heave' has no argument 'problem'"),
        ([*PPO, "--insects", "hawkmot"], "did you mean 'hawkmoth'"),
        ([*PPO, "--seeds", "0"], "seeds = 0 is not allowed; allowed: whole numbers from 1"),
        ([*PPO, "--jobs", "0"], "jobs = 0 is not allowed; allowed: whole numbers from 1"),
        ([*PPO, "--wingbeats", "0"], "wingbeats = 0 is not allowed"),
        ([*PPO, "--set", "row=3"], "PPO has no setting 'row'.*did you mean 'rows'"),
        ([*PPO, "--set", "rows"], "--set rows is not allowed; allowed: NAME=VALUE"),
        ([*PPO, "--trials", "3"], "trials are of a search"),
        ([*PPO, "--search", "rows=1:8"], "a search needs a number of trials"),
        ([*PPO, "--search", "rows=8:1", "--trials", "2"], "--search rows=8:1 is not allowed: low = 8"),
        ([*PPO, "--search", "lerning_rate=1:2", "--trials", "2"], "no setting 'lerning_rate'.*did you mean"),
        ([*PPO, "--space", "SPACE", "--search", "rows=1:8", "--trials", "2"], "rows is searched twice"),
        ([*PPO, "--space", "FILE", "--trials", "2"], "--space FILE is not JSON: it is empty"),
        ([*PPO, "--storage", "FILE"], "--storage FILE: FILE is a file; allowed: a folder"),
        ([*PPO, "--storage", "FULL"], r"--storage FULL holds files but no sweep\.json"),
        ([*PPO, "--address", "nonsense"], "--address nonsense is not allowed; allowed: HOST:PORT"),
        ([*PPO, "--address", "127.0.0.1:99999"], "is not allowed; allowed: HOST:PORT"),
        ([*PPO, "--address", "127.0.0.1:1"], "127.0.0.1:1 does not answer .*; allowed: HOST:PORT of a head"),
        ([*PPO, "--storage", "/proc/sweep"], "--storage /proc/sweep cannot be made .*; allowed: a folder that can"),
        ([*PPO, "--seed", "3"], "--seed is of a search; allowed: --search beside it, or --seeds N"),
        (["--resume", "NOWHERE"], r"NOWHERE.sweep\.json does not exist; allowed: the folder of a sweep"),
        (["--resume", "FULL", "--seeds", "2"], "--resume goes without --seeds"),
        (["--resume", "FULL", "--storage", "x"], "--resume goes without --storage"),
    ],
)
def test_bad_input_is_one_line_and_exit_code_2(
    arguments: list[str], said: str, capsys: pytest.CaptureFixture[str]
) -> None:
    Path("FILE").touch()
    Path("FULL").mkdir()
    Path("FULL", "thesis.txt").touch()
    Path("SPACE").write_text(json.dumps({"rows": {"low": 1, "high": 8}}))
    assert sweep_command(arguments) == 2
    printed = capsys.readouterr()
    assert not printed.out
    assert re.fullmatch(f"train.py sweep: .*({said}).*\n", printed.err)
    assert sorted(path.name for path in Path().iterdir()) == ["FILE", "FULL", "SPACE"]
    assert [path.name for path in Path("FULL").iterdir()] == ["thesis.txt"]


def test_what_listens_but_is_no_head_is_refused_in_time(silent: str, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("RAY_AUTH_TOKEN", "mine")
    monkeypatch.setattr(cluster, "GREETING", 2.0)
    started = time.monotonic()
    with pytest.raises(ConnectionError, match=f"--address {silent} answers, but not as the head of a Ray cluster"):
        require_head(silent)
    assert time.monotonic() - started < 20


def test_without_ray_the_extra_is_named(monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]) -> None:
    monkeypatch.setattr(command, "find_spec", lambda name: None if name == "ray" else importlib.util.find_spec(name))
    assert train.main(["sweep", *PPO]) == 2
    assert "No module named 'ray'; install what sweep needs: pip install -e '.[sweep]'" in capsys.readouterr().err
    assert not list(Path().iterdir())


def test_without_optuna_the_extra_is_named() -> None:
    code = "import sys; sys.modules['optuna'] = None; import train; sys.exit(train.main(['sweep']))"
    root = Path(train.__file__).parent
    done = subprocess.run([sys.executable, "-c", code], cwd=root, capture_output=True, text=True, check=False)
    assert done.returncode == 2
    assert "optuna" in done.stderr
    assert "install what sweep needs: pip install -e '.[sweep]'" in done.stderr


def test_the_help_has_an_example_for_each_way(capsys: pytest.CaptureFixture[str]) -> None:
    with pytest.raises(SystemExit):
        sweep_command(["--help"])
    said = capsys.readouterr().out
    for words in (
        "--problems A C",
        "--search learning_rate=1e-3:3e-2:log",
        "--resume runs/search",
        "--address 10.0.0.1",
    ):
        assert words in said
    assert max(map(len, said.splitlines())) <= 120
