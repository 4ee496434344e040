"""Judging policies from the command line."""

import json
import os
import pickle
from pathlib import Path
from typing import Any

import pytest

import train as command
from agents.presets import GradientSettings, Preset
from agents.training import TrainingConfig, train

TINY = GradientSettings(wingbeats=9_000, rows=32)


@pytest.fixture(scope="module")
def hover(tmp_path_factory: pytest.TempPathFactory) -> Path:
    folder = tmp_path_factory.mktemp("hover") / "run"
    train(TrainingConfig(preset=Preset(task="hover", settings=TINY), seed=4), folder, progress=False, report=False)
    return folder


@pytest.fixture(scope="module")
def wings(tmp_path_factory: pytest.TempPathFactory) -> Path:
    folder = tmp_path_factory.mktemp("wings") / "run"
    with pytest.MonkeyPatch.context() as patched:
        patched.setattr("agents.tasks.random_wings.TEST_WINGS", 200)
        preset = Preset(task="random-wings", arguments={"pool_size": 512}, settings=TINY)
        train(TrainingConfig(preset=preset), folder, progress=False, report=False)
    return folder


def evaluated(capsys: pytest.CaptureFixture[str], *arguments: Any) -> tuple[int, str, str]:
    code = command.main(["evaluate", *map(str, arguments)])
    return code, *capsys.readouterr()


def test_what_is_evaluated_is_what_the_run_ended_with(
    hover: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    code, out, _ = evaluated(capsys, hover, "--out", tmp_path)
    assert code == 0
    assert "9,024 wingbeats, seed 4" in out
    card = json.loads((hover / "policy.json").read_text(encoding="utf-8"))
    assert json.loads((tmp_path / "run" / "results.json").read_text(encoding="utf-8"))["sha256"] == card["sha256"]
    assert str(hover.parent) not in (tmp_path / "run" / "report.html").read_text(encoding="utf-8")
    ended, again = (json.loads((f / "results.json").read_text(encoding="utf-8")) for f in (hover, tmp_path / "run"))
    assert again["verdict"]["mean"] == pytest.approx(ended["verdict"]["mean"], rel=1e-4)
    assert (tmp_path / "run" / "learned.png").stat().st_size > 20_000


@pytest.mark.parametrize("subject", [".", "../run/", "policy.safetensors"])
def test_a_run_is_called_by_its_own_name_however_one_points_at_it(
    subject: str, hover: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.chdir(hover)
    assert evaluated(capsys, subject, "--insects", "hawkmoth", "--out", tmp_path / "kept")[0] == 0
    assert [path.name for path in (tmp_path / "kept").iterdir()] == ["run"]


def test_noise_other_models_and_other_insects_are_told(hover: Path, capsys: pytest.CaptureFixture[str]) -> None:
    _, calm, _ = evaluated(capsys, hover, "--insects", "hawkmoth")
    assert "fruitfly" not in calm
    code, shaken, _ = evaluated(capsys, hover, "--insects", "hawkmoth", "--noise", "0.02", "--robustness")
    assert code == 0
    assert "with noise" in shaken
    assert "berman-wang" in shaken
    lines = [next(line for line in text.splitlines() if line.startswith("hawkmoth")) for text in (calm, shaken)]
    assert lines[0] != lines[1]


def test_a_policy_for_every_wing_flies_named_insects_and_tells_its_costs(
    wings: Path, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr("agents.tasks.random_wings.TEST_WINGS", 200)
    monkeypatch.setattr("agents.evaluation.wing_costs.WINGS", 200)
    monkeypatch.setattr("agents.evaluation.wing_costs.SEARCHED", 2)
    code, out, _ = evaluated(capsys, wings, "--insects", "ladybird")
    assert code == 0
    assert "ladybird" in out
    assert "hawkmoth" not in out
    code, out, _ = evaluated(capsys, wings, "--costs")
    assert code == 0
    for word in ("outside", "batched optimum", "multi-start SLSQP", "rms error", "such searches"):
        assert word in out


def test_bad_input_is_one_line_and_nothing_is_unpickled(
    hover: Path, wings: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    class Bomb:
        def __reduce__(self) -> Any:
            return os.mkdir, (str(tmp_path / "boom"),)

    (tmp_path / "bomb.zip").write_bytes(pickle.dumps(Bomb()))
    (tmp_path / "bomb.safetensors").write_bytes(pickle.dumps(Bomb()))
    (tmp_path / "bomb.json").write_text((hover / "policy.json").read_text(encoding="utf-8"), encoding="utf-8")
    for arguments, said in (
        ((tmp_path / "bomb.zip",), "pickles"),
        ((tmp_path / "bomb.safetensors",), "sha256"),
        (("hoverr",), "is unknown"),
        ((tmp_path / "nowhere" / "run",), "does not exist"),
        ((hover, "--insects", "moth"), "'moth' is unknown"),
        ((hover, "--problem", "free"), "'free' is unknown"),
        ((hover, "--insects", "hawkmoth", "--problem", "fixed-frequency"), "do not fit"),
        ((hover, "--costs"), "allowed: random wings"),
        ((hover, "--wing", tmp_path / "none.json"), "none.json"),
        ((hover, "--noise", "-1"), "share = -1"),
        ((wings, "--robustness"), "allowed: policies of named insects"),
    ):
        code, _, err = evaluated(capsys, *arguments)
        assert code == 2, arguments
        assert said in err
        assert err.removesuffix("\n").isprintable(), err
    assert not (tmp_path / "boom").exists()
