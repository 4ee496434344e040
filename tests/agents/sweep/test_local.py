"""Sweeps on one machine, for real: stopped, killed, gone on with, and equal to the same runs alone."""

import json
import signal
from pathlib import Path

import pytest
from sweeps_alone import TINY, begin, finished, require_same_as_alone, tiny_plan, until

from agents.sweep.storage import JOURNAL, RAY

pytestmark = pytest.mark.slow


def test_a_sweep_that_was_stopped_and_killed_ends_like_the_same_runs_alone(tmp_path: Path) -> None:
    storage = tmp_path / "sweep"
    asked = ["--presets", "hover-ppo", "--seeds", "4", "--wingbeats", "16384", *TINY, "--storage", str(storage)]
    first = begin(*asked, "--jobs", "2")
    until(lambda: finished(storage) >= 1, first)
    first.send_signal(signal.SIGINT)
    out, err = first.communicate(timeout=60)
    assert first.returncode == 130, err
    assert "Traceback" not in err
    assert "the same command goes on" in err
    assert "hover-ppo" in out
    there = finished(storage)
    second = begin(*asked, "--jobs", "2")
    until(lambda: finished(storage) > there or finished(storage) == 4, second)
    second.kill()
    second.communicate()
    third = begin("--resume", str(storage), "--jobs", "2")
    out, err = third.communicate(timeout=120)
    assert third.returncode == 0, err
    assert not err
    assert "4/4" in out
    assert not (storage / RAY).exists()
    for run in tiny_plan(seeds=4, wingbeats=16384).grid():
        require_same_as_alone(run, storage, tmp_path / "alone")


def test_a_search_that_was_killed_finds_what_it_would_have_found(tmp_path: Path) -> None:
    asked = ["--presets", "hover-ppo", "--seeds", "1", "--wingbeats", "4096", *TINY, "--jobs", "2"]
    asked += ["--search", "learning_rate=1e-3:3e-2:log", "--search", "activation=relu,tanh", "--trials", "4"]
    asked += ["--batch", "2"]
    killed = begin(*asked, "--storage", str(tmp_path / "killed"))
    until(lambda: finished(tmp_path / "killed") >= 1, killed)
    killed.kill()
    killed.communicate()
    lines = (tmp_path / "killed" / JOURNAL).read_text(encoding="utf-8").splitlines()
    assert all(isinstance(json.loads(line), dict) for line in lines)
    processes = {name: begin(*asked, "--storage", str(tmp_path / name)) for name in ("killed", "undisturbed")}
    printed = {}
    for name, process in processes.items():
        out, err = process.communicate(timeout=200)
        assert process.returncode == 0, err
        printed[name] = out.replace(name, "NAME")
    assert printed["killed"] == printed["undisturbed"]
    assert "best settings:\n  python train.py --preset hover-ppo --seed 0 --insects hawkmoth fruitfly" in out
    content = json.loads((tmp_path / "killed" / "sweep_results.json").read_text(encoding="utf-8"))
    assert content == json.loads((tmp_path / "undisturbed" / "sweep_results.json").read_text(encoding="utf-8"))
    assert len({trial["mean"] for trial in content["trials"]}) == 4
    assert f" {min(100 * trial['mean'] for trial in content['trials']):.3g}" in out.splitlines()[2]


def test_a_run_that_diverges_is_named_and_the_others_go_on(tmp_path: Path) -> None:
    (tmp_path / "taken").mkdir()
    space = ["--search", "learning_rate=0.01,1e30", "--trials", "3", "--batch", "3", "--seeds", "1"]
    asked = ["--presets", "hover-ppo", "--wingbeats", "4096", *TINY, *space, "--storage", str(tmp_path / "sweep")]
    process = begin(*asked, "--jobs", "2")
    out, err = process.communicate(timeout=120)
    assert process.returncode == 1, err
    assert "-seed0 failed: training diverged: " in err
    assert "Traceback" not in err
    assert "best settings:\n  python train.py" in out
    assert "learning_rate=0.01" in out
