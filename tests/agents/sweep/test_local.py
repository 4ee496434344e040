"""Sweeps on one machine, for real: stopped, killed, gone on with, and equal to the same runs alone."""

import json
import signal
import subprocess
from collections.abc import Callable
from pathlib import Path

import pytest
from sweeps_alone import TINY, finished, require_same_as_alone, tiny_plan, until

from agents.sweep.storage import JOURNAL, RAY

pytestmark = pytest.mark.slow
Begin = Callable[..., subprocess.Popen[str]]


def test_a_sweep_that_was_stopped_and_killed_ends_like_the_same_runs_alone(begin: Begin, tmp_path: Path) -> None:
    storage = tmp_path / "sweep"
    asked = ["--presets", "hover-ppo", "--seeds", "3", "--wingbeats", "16384", *TINY, "--storage", str(storage)]
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
    until(lambda: finished(storage) > there or finished(storage) == 3, second)
    second.kill()
    second.communicate()
    third = begin("--resume", str(storage), "--jobs", "2")
    out, err = third.communicate(timeout=120)
    assert third.returncode == 0, err
    assert not err
    assert "3/3" in out
    assert not (storage / RAY).exists()
    for run in tiny_plan(seeds=3, wingbeats=16384).grid():
        require_same_as_alone(run, storage, tmp_path / "alone")


def test_a_search_that_was_killed_finds_what_it_would_have_found_and_names_what_diverged(
    begin: Begin, tmp_path: Path
) -> None:
    asked = ["--presets", "hover-ppo", "--seeds", "1", "--wingbeats", "4096", *TINY, "--jobs", "2"]
    asked += ["--search", "learning_rate=0.003,0.01,1000", "--search", "width=16:64", "--trials", "4"]
    asked += ["--batch", "2", "--seed", "9"]  # with which the second batch has one that diverges
    storages = [tmp_path / "one", tmp_path / "two"]
    processes = [begin(*asked, "--storage", str(storage)) for storage in storages]
    until(lambda: finished(storages[0]) >= 1, processes[0])
    processes[0].kill()
    processes[0].communicate()
    lines = (storages[0] / JOURNAL).read_text(encoding="utf-8").splitlines()
    assert all(isinstance(json.loads(line), dict) for line in lines)
    processes[0] = begin("--resume", str(storages[0]), "--jobs", "2")
    printed = []
    for process, storage in zip(processes, storages, strict=True):
        out, err = process.communicate(timeout=200)
        assert process.returncode == 1, err
        assert "-seed0 failed: training diverged: " in err
        assert "Traceback" not in err
        printed.append(out.replace(str(storage), "STORAGE"))
    assert printed[0] == printed[1]
    assert "best settings:\n  python train.py --preset hover-ppo --seed 0 --insects hawkmoth fruitfly" in printed[0]
    first, second = (json.loads((one / "sweep_results.json").read_text(encoding="utf-8")) for one in storages)
    assert first == second
    means = [trial["mean"] for trial in first["trials"]]
    assert means.count(None) == 1
    assert f" {100 * min(mean for mean in means if mean is not None):.3g}" in printed[0].splitlines()[2]
