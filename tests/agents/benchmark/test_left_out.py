"""Species left out in turn, with a stand-in for the training."""

import json
from pathlib import Path

import pytest

from agents.benchmark import left_out, training_run
from agents.benchmark.training_run import Run
from agents.presets import PRESETS
from agents.training_config import LAST_SEED

STAND_IN = """
import json, pathlib, sys
out = pathlib.Path(sys.argv[sys.argv.index("--resume" if "--resume" in sys.argv else "--out") + 1])
name, described = out.stem, DESCRIBED
if "--resume" not in sys.argv:
    assert sys.argv[sys.argv.index("--leave-out") + 1] == name
if name == "cranefly":
    sys.exit("no wings like it")
described = json.loads(pathlib.Path(described).read_text())[name]
(out / "config.json").write_text(json.dumps(described))
own = {"gap_percent": 0.5 * described["seed"]}
own |= {"weight_support": 1.0, "specific_power": 2.0, "optimum_specific_power": 1.9}
told = {"wingbeats": described["settings"]["wingbeats"] + 7, "interrupted": False}
wings = {"test": {"mean_gap_percent": 0.4, "p95_gap_percent": 1.2}}
(out / "results.json").write_text(json.dumps({**described, **told, "insects": {name: own}, "wings": wings}))
"""
NAMES = ("fruitfly", "hawkmoth", "ladybird")


@pytest.fixture
def trainer(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """A stand-in for train.py that is told what the runs of seed 2 are; the folder of the runs."""
    runs = {run.name: run.described() for run in left_out.runs_without(NAMES, left_out.PRESET, 2)}
    (tmp_path / "described.json").write_text(json.dumps(runs), encoding="utf-8")
    script = tmp_path / "stand_in.py"
    script.write_text(STAND_IN.replace("DESCRIBED", repr(str(tmp_path / "described.json"))), encoding="utf-8")
    monkeypatch.setattr(training_run, "TRAIN", script)
    return tmp_path / "runs"


def made(root: Path) -> list[str]:
    """Two finished runs of seed 2, and the words that asked for them."""
    asked = ["--root", str(root), "--insects", "fruitfly", "hawkmoth", "--seed", "2"]
    assert left_out.main(asked) == 0
    return asked


def change(path: Path, **values: object) -> None:
    path.write_text(json.dumps({**json.loads(path.read_text(encoding="utf-8")), **values}), encoding="utf-8")


def test_every_species_is_trained_without_once_and_told(trainer: Path, capsys: pytest.CaptureFixture[str]) -> None:
    asked = made(trainer)
    printed = capsys.readouterr().out
    assert "mean 1.00 %, worst 1.00 %" in printed
    assert printed.endswith("test wings: the whole test split, those like the species included\n")
    assert (trainer / "table.txt").read_text(encoding="utf-8") == printed
    assert json.loads((trainer / "hawkmoth" / "results.json").read_text(encoding="utf-8"))["insects"]["hawkmoth"]
    before = (trainer / "hawkmoth" / "results.json").stat().st_mtime_ns
    (trainer / "hawkmoth" / "command.json").unlink()  # as runs of earlier versions are
    assert left_out.main(asked) == 0
    assert (trainer / "hawkmoth" / "results.json").stat().st_mtime_ns == before  # kept
    capsys.readouterr()
    assert left_out.main([*asked[:-1], "4"]) == 2
    assert "made with other settings: seed = 2 there, wanted 4" in capsys.readouterr().err


def test_a_run_that_left_out_another_species_is_refused(trainer: Path, capsys: pytest.CaptureFixture[str]) -> None:
    asked = made(trainer)
    (trainer / "hawkmoth").rename(trainer / "ladybird")
    assert left_out.main([*asked, "--insects", "ladybird"]) == 2
    assert "task.leave_out = 'hawkmoth' there, wanted 'ladybird'" in capsys.readouterr().err


def test_interrupted_runs_go_on_or_are_refused(trainer: Path, capsys: pytest.CaptureFixture[str]) -> None:
    asked = made(trainer)
    results = trainer / "hawkmoth" / "results.json"
    change(results, interrupted=True)
    assert left_out.main(asked) == 0
    assert json.loads(results.read_text(encoding="utf-8"))["interrupted"] is False
    change(results, interrupted=True)
    (trainer / "hawkmoth" / "command.json").unlink()
    assert left_out.main(asked) == 2
    assert "hawkmoth is in the way: its run was interrupted" in capsys.readouterr().err


def test_a_failed_run_is_told_and_the_others_are_kept(trainer: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert left_out.main(["--root", str(trainer), "--insects", "cranefly", "ladybird", "--seed", "2"]) == 1
    said = capsys.readouterr().err
    assert "cranefly failed: no wings like it (exit code 1" in said
    assert "failed: cranefly; the same command goes on" in said
    assert (trainer / "ladybird" / "results.json").exists()
    assert not (trainer / "cranefly").exists()


@pytest.mark.parametrize("folder", ["hawkmoth", "hawkmoth.part"])
def test_folders_of_others_are_refused_before_anything_is_trained(
    folder: str, trainer: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    (trainer / folder).mkdir(parents=True)
    (trainer / folder / "thesis.txt").touch()
    assert left_out.main(["--root", str(trainer), "--insects", "fruitfly", "hawkmoth", "--seed", "2"]) == 2
    assert f"{folder} is in the way" in capsys.readouterr().err
    assert (trainer / folder / "thesis.txt").exists()
    assert not (trainer / "fruitfly").exists()


@pytest.mark.parametrize(
    ("content", "said"), [({}, "wingbeats = None"), ({"wingbeats": 10**9}, "without fruitfly: KeyError 'insects'")]
)
def test_results_that_are_not_a_runs_are_named(
    content: dict[str, object], said: str, trainer: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    asked = made(trainer)
    results = trainer / "fruitfly" / "results.json"
    results.write_text(json.dumps(content), encoding="utf-8")
    capsys.readouterr()
    assert left_out.main(asked) == 2
    err = capsys.readouterr().err.splitlines()[-1]
    assert str(results) in err
    assert said in err


def test_a_run_without_a_species_is_described_as_its_config_file_describes_it() -> None:
    (run,) = left_out.runs_without(["hawkmoth"], "random-wings-ppo", 1)
    assert isinstance(run, Run)
    described = PRESETS["random-wings-ppo"].changed({"leave_out": "hawkmoth"}, {}).to_dict()
    assert run.described() == json.loads(json.dumps({"preset": "random-wings-ppo", "seed": 1, **described}))


@pytest.mark.parametrize(
    ("arguments", "said"),
    [
        (["--insects", "moth"], "--insects = 'moth' is unknown"),
        (["--insects", "hawkmoth", "hawkmoth"], "--insects name hawkmoth more than once"),
        (["--preset", "hover-ppo"], "--preset = 'hover-ppo' is unknown"),
        (["--jobs", "0"], "--jobs = 0"),
        (["--seed", "-1"], "--seed = -1"),
        (["--seed", str(LAST_SEED + 1)], f"--seed = {LAST_SEED + 1} is not allowed"),
    ],
)
def test_bad_input_is_one_line(arguments: list[str], said: str, capsys: pytest.CaptureFixture[str]) -> None:
    assert left_out.main(arguments) == 2
    err = capsys.readouterr().err
    assert said in err
    assert len(err.strip().splitlines()) == 1
