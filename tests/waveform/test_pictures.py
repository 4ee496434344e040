"""Pictures and tables of free waveforms."""

import sys
from pathlib import Path

import numpy as np
import pytest

from flapenv import load_insect
from flapenv.waveform import __main__ as command
from flapenv.waveform.pictures import best_motion, draw_away_from_the_triangle, draw_towards_the_triangle, draw_waveform
from flapenv.waveform.report import knots_table


def test_the_sheet_shows_sections_angles_speed_and_power() -> None:
    motion = best_motion("bumblebee", "fixed-frequency", 8)
    figure = draw_waveform(load_insect("bumblebee"), motion)
    assert [axes.get_ylabel() for axes in figure.axes] == ["", "angle [°]", "φ̇ / mean |φ̇|", "power / mass [W/kg]"]
    assert "weight support 1.000, 29.4" in figure.get_suptitle()
    assert np.max(np.abs(figure.axes[2].lines[0].get_ydata())) > 3


def test_the_pictures_of_both_problems_show_every_number_of_knots() -> None:
    towards, away = draw_towards_the_triangle(), draw_away_from_the_triangle()
    assert [len(axes.lines) for axes in towards.axes] == [5, 5, 5]
    assert all(len(axes.lines) >= 4 for axes in away.axes)


def test_a_waveform_that_is_not_shipped_is_named() -> None:
    with pytest.raises(LookupError, match="no waveform of 5 knots is shipped for bumblebee in fixed-frequency"):
        best_motion("bumblebee", "fixed-frequency", 5)


def test_the_command_prints_the_tables_of_the_page(
    monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str], tmp_path: Path
) -> None:
    monkeypatch.setattr(sys, "argv", ["python -m flapenv.waveform", "--out", str(tmp_path / "images")])
    command.main()
    printed = capsys.readouterr().out
    page = (Path(command.__file__).parents[2] / "docs" / "waveform.md").read_text(encoding="utf-8")
    for block in printed.split("wrote")[0].strip().split("\n\n"):
        assert "\n".join(f"    {line}" for line in block.splitlines()) in page
    assert knots_table() in printed
    assert len(list((tmp_path / "images").glob("*.png"))) == 3
