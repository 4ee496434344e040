"""docs/tutorial.md does what it says, to the digit where the digits are the physics'."""

from pathlib import Path

import pytest
from running_pages import DOCS, require_quoted, run_python, run_shell

from agents.training import TrainingResult

PAGE = DOCS / "tutorial.md"


def test_the_tutorial_runs_from_the_first_block_to_the_last(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)
    names = run_python(PAGE)
    result = names["result"]
    assert isinstance(result, TrainingResult)
    assert result.verdict.mean is not None
    assert result.verdict.mean < 0.01, "it promises five hundredths of a per cent"
    assert (tmp_path / "runs" / "tutorial" / "report.html").is_file()
    assert (tmp_path / "hawkmoth.gif").stat().st_size > 10_000
    printed = run_shell(PAGE)
    assert "random-wings" in printed["python train.py evaluate --list"]
    require_quoted(PAGE, "\n".join([result.verdict.text, *printed.values()]))
