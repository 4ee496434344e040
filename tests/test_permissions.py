"""Nobody but its owner can change what is written, and nobody can run it, even where the umask forbids nothing."""

import json
import os
import stat
import subprocess
import sys
from collections.abc import Sequence
from pathlib import Path

import pytest

import train

ROOT = Path(__file__).parents[1]
NOBODY_ELSES = stat.S_IWGRP | stat.S_IWOTH
RUNS = stat.S_IXUSR | stat.S_IXGRP | stat.S_IXOTH
UNDER_NO_MASK = "import os, sys, train; os.umask(0); sys.exit(train.main(sys.argv[1:]))"
TINY = ("--insects", "hawkmoth", "--set", "rows=16", "--set", "minibatch=16", "--set", "epochs=1", "--quiet")
COMMANDS: dict[str, tuple[tuple[str, ...], tuple[str, ...]]] = {
    "train": (
        ("--wingbeats", "64", *TINY, "--out", "out/run"),
        ("config.json", "results.json", "policy.safetensors", "policy.json", "policy.zip", "report.html", "curve.csv"),
    ),
    "evaluate": (("evaluate", "hawkmoth", "--out", "out"), ("results.json", "learned.png", "report.html")),
    "optimum": (("optimum", "hawkmoth", "--out", "optima.csv"), ("optima.csv",)),
}
"""What is typed, and some of the files that it writes."""


def open_to_others(folder: Path) -> list[str]:
    """Files and folders that somebody else can change, and files that can be run."""
    found = []
    for path in folder.rglob("*"):
        mode = path.lstat().st_mode
        if mode & NOBODY_ELSES or (mode & RUNS and not path.is_dir()):
            found.append(f"{path.relative_to(folder)}: {stat.filemode(mode)}")
    return found


def run(words: Sequence[str], folder: Path) -> None:
    environment = {**os.environ, "PYTHONPATH": str(ROOT), "OMP_NUM_THREADS": "1"}
    subprocess.run([sys.executable, *words], cwd=folder, env=environment, check=True, capture_output=True, timeout=300)


@pytest.mark.parametrize(
    "name", [pytest.param(name, marks=pytest.mark.slow) if name == "train" else name for name in COMMANDS]
)
def test_a_command_writes_nothing_that_others_could_change_or_run(name: str, tmp_path: Path) -> None:
    words, written = COMMANDS[name]
    run(["-c", UNDER_NO_MASK, *words], tmp_path)
    assert set(written) <= {path.name for path in tmp_path.rglob("*")}
    assert open_to_others(tmp_path) == []


def test_what_the_library_writes_by_itself_is_not_for_others_either(tmp_path: Path) -> None:
    code = "import os; os.umask(0); from flapenv.files.__main__ import main; main(['--out', 'schemas'])"
    (tmp_path / "schemas").mkdir(mode=0o755)
    run(["-c", code], tmp_path)
    assert len(list((tmp_path / "schemas").iterdir())) == 2
    assert open_to_others(tmp_path) == []


def test_the_commands_keep_a_stricter_mask(capsys: pytest.CaptureFixture[str]) -> None:
    before = os.umask(0o077)
    try:
        assert train.main(["--list"]) == 0
        assert os.umask(0o077) == 0o077
    finally:
        os.umask(before)
    assert "hover-ppo" in capsys.readouterr().out


@pytest.mark.parametrize(("mode", "is_open"), [(0o644, False), (0o600, False), (0o666, True), (0o755, True)])
def test_a_file_that_is_open_to_others_is_found(mode: int, is_open: bool, tmp_path: Path) -> None:
    path = tmp_path / "some.json"
    path.write_text(json.dumps({}))
    path.chmod(mode)
    assert bool(open_to_others(tmp_path)) == is_open
