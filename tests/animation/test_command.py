"""`python -m flapenv.animation`."""

import subprocess
import sys
from pathlib import Path

import pytest
from drawn_beats import BEST, HAWKMOTH, read_gif

import flapenv.animation.__main__ as command


def test_the_command_writes_the_picture(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.chdir(tmp_path)
    words = ["fruitfly", "--stroke", "both", "--frames", "2", "--width", "320", "--out", "fly.gif"]
    command.main(words)
    assert read_gif(tmp_path / "fly.gif").shape == (2, 360, 320, 3)
    assert capsys.readouterr().out.startswith("wrote fly.gif (")
    seen = {}
    monkeypatch.setattr(command, "animate", lambda *given, **_: seen.update(given=given) or tmp_path / "fly.gif")
    command.main(["hawkmoth", "--stroke", "optimal"])
    assert seen["given"][:2] == (BEST, HAWKMOTH)
    command.main([])
    assert seen["given"][:2] == (HAWKMOTH.stroke, HAWKMOTH)


@pytest.mark.parametrize("words", [["hawkmot"], ["--frames", "1"], ["--out", "a.png"], ["--problem", "inertial", "x"]])
def test_the_command_says_what_is_wrong_in_one_line(words: list[str], capsys: pytest.CaptureFixture[str]) -> None:
    with pytest.raises(SystemExit) as stopped:
        command.main(words)
    assert stopped.value.code == 2
    assert "allowed: " in capsys.readouterr().err


def test_the_module_runs_without_a_warning() -> None:
    words = [sys.executable, "-W", "error", "-m", "flapenv.animation", "--help"]
    assert "--stroke" in subprocess.run(words, capture_output=True, text=True, check=True).stdout
