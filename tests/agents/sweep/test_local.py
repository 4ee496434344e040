"""Sweeps on one machine, for real: stopped, killed, gone on with, and equal to the same runs alone."""

import json
import os
import re
import secrets
import signal
import subprocess
from collections.abc import Callable
from pathlib import Path

import pytest
from loopback_nodes import children
from sweeps_alone import TINY, finished, require_same_as_alone, tiny_plan, until

from agents.run_folder import CONFIG
from agents.sweep.cluster import require_head
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


LISTENING = "0A"


def addresses(process: int) -> set[str]:
    """Addresses that a process and all that it started listen on, as the system writes them."""
    below = [process]
    for one in below:
        below += children(one)
    inodes = set()
    for one in below:
        for descriptor in Path(f"/proc/{one}/fd").iterdir():
            if descriptor.is_symlink() and (match := re.fullmatch(r"socket:\[(\d+)\]", str(descriptor.readlink()))):
                inodes.add(match[1])
    found = set()
    for table in ("tcp", "tcp6"):
        for line in Path(f"/proc/net/{table}").read_text().splitlines()[1:]:
            words = line.split()
            if words[3] == LISTENING and words[9] in inodes:
                found.add(words[1].rpartition(":")[0])
    return found


def test_a_sweep_is_heard_on_the_loopback_alone_asks_for_a_token_and_ends_when_its_node_is_killed(
    begin: Begin, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    storage = tmp_path / "sweep"
    sweep = begin("--presets", "hover-ppo", "--seeds", "1", *TINY, "--storage", str(storage), "--jobs", "1")
    until(lambda: any(storage.glob(f"*/{CONFIG}")), sweep)
    told = {one: Path(f"/proc/{one}/cmdline").read_text().split("\0") for one in children(sweep.pid)}
    [raylet] = [one for one, words in told.items() if words[0].endswith("/raylet")]
    [head] = [word.partition("=")[2] for word in told[raylet] if word.startswith("--gcs-address=")]
    assert addresses(sweep.pid)
    assert addresses(sweep.pid) <= {"0100007F", "0000000000000000FFFF00000100007F", "00000000000000000000000001000000"}
    monkeypatch.setenv("RAY_AUTH_TOKEN", secrets.token_hex(32))
    with pytest.raises(PermissionError, match="does not accept the token"):
        require_head(head)
    os.kill(raylet, signal.SIGKILL)
    out, err = sweep.communicate(timeout=120)
    assert sweep.returncode == 2
    assert not out
    assert re.fullmatch(r"train\.py sweep: Ray has failed: .*; finished runs are kept, and the same .* goes on\n", err)
