"""The page of the environment says what the command prints."""

import subprocess
import sys
from pathlib import Path

import pytest

import flapenv
from flapenv.adapt.drawing import references_figure
from flapenv.adapt.report import report

PAGE = Path(flapenv.__file__).parents[1] / "docs" / "hover_adapt.md"


def test_the_tables_of_the_page_are_those_of_the_command() -> None:
    lines = {line.strip() for line in PAGE.read_text(encoding="utf-8").splitlines()}
    for line in report().splitlines():
        assert line.strip() in lines


def test_the_command_refuses_rungs_without_a_folder() -> None:
    call = [sys.executable, "-m", "flapenv.adapt", "--rungs"]
    found = subprocess.run(call, capture_output=True, text=True, check=False)
    assert found.returncode == 2
    assert "--rungs needs --out" in found.stderr


def test_the_references_of_any_named_insect_can_be_drawn() -> None:
    assert len(references_figure("hoverfly", 3).axes) == 2
    with pytest.raises(ValueError, match="insect = 'moth' is unknown"):
        references_figure("moth")
