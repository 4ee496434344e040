"""The pages of docs/how-to run, but for what needs another virtual environment."""

import os
import subprocess
import sys
from pathlib import Path

import pytest
from running_pages import DOCS, FENCE, run_python, run_shell

from agents.tasks import Verdict

HOW_TO = DOCS / "how-to"


def test_the_learners_of_ones_own_learn(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)
    names = run_python(HOW_TO / "own-learner.md")
    verdict = names["verdict"]
    assert isinstance(verdict, Verdict)
    assert verdict.worst is not None
    assert verdict.worst < 0.001
    (printed,) = run_shell(HOW_TO / "own-learner.md").values()
    assert "hover-gradient" in printed


def test_the_sweep_is_a_script_that_trains_in_two_processes(tmp_path: Path) -> None:
    page = (HOW_TO / "many-runs.md").read_text(encoding="utf-8")
    (script,) = [block for language, block in FENCE.findall(page) if language == "python"]
    (tmp_path / "sweep.py").write_text(script, encoding="utf-8")
    environment = {**os.environ, "PYTHONPATH": str(DOCS.parent)}
    command = [sys.executable, "-W", "error", "sweep.py"]
    done = subprocess.run(command, cwd=tmp_path, env=environment, capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stderr
    assert done.stdout.startswith("4 runs, gap")
    assert len(list(tmp_path.glob("runs/sweep/*/results.json"))) == 4
