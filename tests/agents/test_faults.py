"""What can go wrong around a run does so for real: it is told in one line, and nothing that exists is harmed."""

import hashlib
import json
import os
import subprocess
import sys
import time
from pathlib import Path
from typing import Any

import pytest

import train
from agents.checkpoint import STATE, read_checkpoint
from agents.run_folder import CHECKPOINT
from flapenv.whole_file import json_text

pytestmark = pytest.mark.slow

TOP = Path(__file__).parents[2]
SHORT = ("--preset", "hover-ppo", "--wingbeats", "30000", "--set", "rows=128", "--set", "minibatch=128")
QUIETLY = ("--quiet", "--no-report")
OFTEN = ("--checkpoint-seconds", "0.05")
MOST = 120.0
"""Seconds to wait for what must come."""
JUMPING = """
import itertools, time
jumps = itertools.cycle((0.0, 3e8, -3e8, 9e8))
now, now_ns = time.time, time.time_ns
time.time = lambda: now() + next(jumps)
time.time_ns = lambda: now_ns() + int(1e9 * next(jumps))
"""
"""A clock that is set forth and back by ten years and more between two looks at it."""


def start(*words: str, **environment: str) -> subprocess.Popen[str]:
    command = [sys.executable, str(TOP / "train.py"), *words, *QUIETLY]
    threads = {**os.environ, "OMP_NUM_THREADS": "1", **environment}
    return subprocess.Popen(command, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True, env=threads)


def end(process: subprocess.Popen[str]) -> tuple[int, str]:
    """Exit code and complaint."""
    _, errors = process.communicate(timeout=MOST)
    return process.returncode, errors


def wait_for(path: Path) -> None:
    began = time.monotonic()
    while not path.exists():
        assert time.monotonic() - began < MOST
        time.sleep(0.005)


def tree(folder: Path) -> dict[Path, bytes]:
    return {path: path.read_bytes() for path in folder.rglob("*") if path.is_file() and path.name != ".lock"}


@pytest.fixture(scope="module")
def alone(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """The run that nothing happens to."""
    folder = tmp_path_factory.mktemp("alone")
    code, errors = end(start(*SHORT, "--out", str(folder)))
    assert (code, errors) == (0, "")
    return folder


@pytest.fixture(scope="module")
def cut(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A run that was killed at a checkpoint."""
    folder = tmp_path_factory.mktemp("cut")
    process = start(*SHORT, *OFTEN, "--out", str(folder))
    wait_for(folder / CHECKPOINT / STATE)
    process.kill()
    process.communicate()
    assert read_checkpoint(folder / CHECKPOINT) is not None
    return folder


def refused(capsys: pytest.CaptureFixture[str], *words: str) -> str:
    """What the command says, in one line, where it refuses what it is asked for."""
    assert train.main([*words, *QUIETLY]) == 2
    return one_line(capsys.readouterr().err)


def one_line(errors: str) -> str:
    [line] = errors.splitlines()
    assert line.startswith("train.py: ")
    return line


def test_a_full_disk_and_one_that_cannot_be_written_are_told_and_the_run_goes_on_when_there_is_room(
    alone: Path, tmp_path: Path
) -> None:
    command = ["unshare", "--map-root-user", "--mount", sys.executable, str(TOP / "tests" / "small_disk.py")]
    environment = {**os.environ, "OMP_NUM_THREADS": "1"}
    done = subprocess.run(
        [*command, str(tmp_path), *SHORT],
        stdout=subprocess.PIPE,
        env=environment,
        text=True,
        check=True,
        timeout=5 * MOST,
    )
    assert done.returncode == 0
    found: dict[str, Any] = json.loads(done.stdout)
    for name in ("full", "full again"):
        assert found[name]["code"] == 2
        line = one_line(found[name]["errors"])
        assert "No space left on device" in line
        assert "allowed: a disk with room" in line
    assert f"--resume {tmp_path / 'run'} goes on from the last checkpoint" in found["full"]["errors"]
    assert found["harmed"] == []
    assert any("arrays" in name for name in found["left"])
    assert not any("partial" in name for name in found["left"])
    assert found["room"] == {"code": 0, "errors": ""}
    assert found["learned"] == (alone / "policy.safetensors").read_bytes().hex()
    for name in ("unwritable", "unwritable again"):
        assert found[name]["code"] == 2
        assert "cannot be written" in one_line(found[name]["errors"])
    assert found["changed"] is False


def test_two_runs_into_one_folder_are_one(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    first = start(*SHORT, "--wingbeats", "30000000", *OFTEN, "--out", str(tmp_path))
    wait_for(tmp_path / CHECKPOINT / STATE)
    assert f"{tmp_path} is in use by process {first.pid}" in refused(capsys, "--resume", str(tmp_path))
    assert "holds config.json" in refused(capsys, *SHORT, "--out", str(tmp_path))
    assert first.poll() is None
    first.kill()
    first.communicate()
    assert read_checkpoint(tmp_path / CHECKPOINT) is not None


def test_two_runs_that_begin_at_once_do_not_mix(tmp_path: Path) -> None:
    both = [end(one) for one in [start(*SHORT, "--out", str(tmp_path)) for _ in range(2)]]
    assert sorted(code for code, _ in both) == [0, 2]
    [told] = [errors for code, errors in both if code == 2]
    assert "in use by process" in told or "already; allowed: a folder without a run" in told
    assert json.loads((tmp_path / "results.json").read_text(encoding="utf-8"))["wingbeats"] >= 30000


def test_a_clock_that_jumps_changes_nothing(alone: Path, tmp_path: Path) -> None:
    (tmp_path / "sitecustomize.py").write_text(JUMPING)
    out = tmp_path / "run"
    process = start(*SHORT, *OFTEN, "--out", str(out), PYTHONPATH=str(tmp_path))
    wait_for(out / CHECKPOINT / STATE)
    assert end(process) == (0, "")
    assert (out / "policy.safetensors").read_bytes() == (alone / "policy.safetensors").read_bytes()
    jumped, calm = (json.loads((one / "results.json").read_text(encoding="utf-8")) for one in (out, alone))
    assert 0 < jumped.pop("seconds") < MOST
    assert calm.pop("seconds") > 0
    assert jumped == calm


def test_a_checkpoint_that_is_not_this_runs_is_told_and_left(
    cut: Path, alone: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    state, config = cut / CHECKPOINT / STATE, cut / "config.json"
    [arrays] = (cut / CHECKPOINT).glob("arrays-*")
    whole = {path: path.read_bytes() for path in (state, config, arrays)}

    def signed(**changed: Any) -> bytes:
        content = json.loads(whole[state])
        content.pop("sha256")
        content |= changed
        return json_text({**content, "sha256": hashlib.sha256(json_text(content).encode()).hexdigest()}).encode()

    learner = json.loads(whole[state])["learner"]
    other_rows = {**learner, "spaces": {**learner["spaces"], "observations": [[7], "float32"]}}
    other_config = whole[config].replace(b"flapenv/Hover-v0", b"flapenv/Hover-v1")
    for path, content, said in (
        (arrays, whole[arrays][:-1], "not the"),
        (arrays, whole[arrays][:-1] + b"!", "was changed since it was written"),
        (state, whole[state][:-40], "is not JSON that can be read"),
        (state, whole[state].replace(b"num_timesteps", b"num_timestepz"), "its sha256 is not its own"),
        (state, signed(environment="flapenv/Hover-v1"), "environment = 'flapenv/Hover-v1' is not allowed"),
        (state, signed(learner=other_rows), "spaces = "),
        (config, other_config, "environment = 'flapenv/Hover-v1'; allowed: 'flapenv/Hover-v0'"),
        (config, whole[config][:-30], "is not JSON that can be read"),
    ):
        path.write_bytes(content)
        before = tree(cut)
        assert said in refused(capsys, "--resume", str(cut)), said
        assert tree(cut) == before
        path.write_bytes(whole[path])
    assert end(start("--resume", str(cut))) == (0, "")
    assert (cut / "policy.safetensors").read_bytes() == (alone / "policy.safetensors").read_bytes()


@pytest.mark.parametrize(
    ("words", "said"),
    [
        (("--resume", "nowhere"), "nowhere/config.json does not exist"),
        (("--resume", "nowhere", "--seed", "0"), "--resume and --seed ask for two runs"),
        (("--resume", "nowhere", "--set", "rows=8"), "--resume and --set ask for two runs"),
        (("--resume", "nowhere", "--out", "here"), "--resume and --out ask for two runs"),
        (("--checkpoint-seconds", "-1", "--wingbeats", "4096"), "checkpoint_seconds = -1"),
        (("--checkpoint-seconds", "nan", "--wingbeats", "4096"), "checkpoint_seconds = nan"),
    ],
)
def test_options_that_cannot_be_are_told(
    words: tuple[str, ...],
    said: str,
    tmp_path: Path,
    monkeypatch: pytest.MonkeyPatch,
    capsys: pytest.CaptureFixture[str],
) -> None:
    monkeypatch.chdir(tmp_path)
    assert said in refused(capsys, *words)
    assert not list(tmp_path.iterdir())
