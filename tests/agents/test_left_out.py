"""Species left out in turn, with a stand-in for the training."""

import json
from pathlib import Path

import pytest

from agents import left_out

STAND_IN = """
import json, pathlib, sys
asked = dict(zip(sys.argv[1::2], sys.argv[2::2]))
name, out = asked["--leave-out"], pathlib.Path(asked["--out"])
if name == "cranefly":
    sys.exit("no wings like it")
own = {"gap_percent": 0.5 * int(asked["--seed"])}
own |= {"weight_support": 1.0, "specific_power": 2.0, "optimum_specific_power": 1.9}
told = {"preset": asked["--preset"], "seed": int(asked["--seed"])}
wings = {"test": {"mean_gap_percent": 0.4, "p95_gap_percent": 1.2}}
(out / "results.json").write_text(json.dumps({**told, "insects": {name: own}, "wings": wings}))
"""


@pytest.fixture
def trainer(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    script = tmp_path / "stand_in.py"
    script.write_text(STAND_IN, encoding="utf-8")
    monkeypatch.setattr(left_out, "TRAIN", script)
    return tmp_path / "runs"


def test_every_species_is_trained_without_once_and_told(trainer: Path, capsys: pytest.CaptureFixture[str]) -> None:
    asked = ["--root", str(trainer), "--insects", "fruitfly", "hawkmoth"]
    assert left_out.main([*asked, "--seed", "2"]) == 0
    printed = capsys.readouterr().out
    assert "mean 1.00 %, worst 1.00 %" in printed
    assert (trainer / "table.txt").read_text(encoding="utf-8") == printed
    assert json.loads((trainer / "hawkmoth" / "results.json").read_text(encoding="utf-8"))["insects"]["hawkmoth"]
    before = (trainer / "hawkmoth" / "results.json").stat().st_mtime_ns
    assert left_out.main([*asked, "--seed", "2"]) == 0
    assert (trainer / "hawkmoth" / "results.json").stat().st_mtime_ns == before  # kept
    capsys.readouterr()
    assert left_out.main([*asked, "--seed", "4"]) == 2
    assert "made with preset random-wings-ppo, seed 2" in capsys.readouterr().err


def test_a_failed_run_is_told_and_the_others_are_kept(trainer: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert left_out.main(["--root", str(trainer), "--insects", "cranefly", "ladybird"]) == 1
    assert "without cranefly: no wings like it" in capsys.readouterr().err
    assert (trainer / "ladybird" / "results.json").exists()
    assert not (trainer / "cranefly").exists()


@pytest.mark.parametrize(
    ("arguments", "said"),
    [
        (["--insects", "moth"], "--insects = 'moth' is unknown"),
        (["--preset", "hover-ppo"], "--preset = 'hover-ppo' is unknown"),
        (["--jobs", "0"], "--jobs = 0"),
        (["--seed", "-1"], "--seed = -1"),
    ],
)
def test_bad_input_is_one_line(arguments: list[str], said: str, capsys: pytest.CaptureFixture[str]) -> None:
    assert left_out.main(arguments) == 2
    err = capsys.readouterr().err
    assert said in err
    assert len(err.strip().splitlines()) == 1
