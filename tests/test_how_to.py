"""The pages of docs/how-to run, but for what needs another virtual environment."""

import os
import shutil
import subprocess
import sys
from pathlib import Path

import pytest
from running_pages import DOCS, FENCE, require_quoted, run_python, run_shell

import flapenv
from agents.tasks import Verdict

HOW_TO = DOCS / "how-to"


def test_the_learners_of_ones_own_learn(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)
    names = run_python(HOW_TO / "own-learner.md")
    verdict = names["verdict"]
    assert isinstance(verdict, Verdict)
    assert verdict.worst is not None
    assert verdict.worst < 0.001
    require_quoted(HOW_TO / "own-learner.md", verdict.text)
    (printed,) = run_shell(HOW_TO / "own-learner.md").values()
    assert "hover-gradient" in printed


def test_a_wing_of_ones_own_goes_through_everything(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    shutil.copytree(DOCS / "examples", tmp_path / "docs" / "examples")
    monkeypatch.chdir(tmp_path)
    run_python(HOW_TO / "own-wing.md")
    assert (tmp_path / "robot.gif").exists()
    printed = run_shell(HOW_TO / "own-wing.md")
    require_quoted(HOW_TO / "own-wing.md", "\n".join(printed.values()))


def test_what_the_page_of_evaluation_names_is_judged(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)
    run_python(HOW_TO / "evaluate.md")
    printed = run_shell(HOW_TO / "evaluate.md")
    require_quoted(HOW_TO / "evaluate.md", "\n".join(printed.values()))
    assert (tmp_path / "judged" / "hover" / "results.json").exists()


def test_a_table_of_strokes_as_the_page_shows_it_is_read(tmp_path: Path) -> None:
    page = (HOW_TO / "evaluate.md").read_text(encoding="utf-8")
    (table,) = [block for language, block in FENCE.findall(page) if block.startswith("insect,")]
    (tmp_path / "strokes.csv").write_text(table, encoding="utf-8")
    (stroke,) = flapenv.read_strokes(tmp_path / "strokes.csv")
    assert stroke.insect == flapenv.load_insect("hawkmoth")


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
