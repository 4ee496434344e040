"""The equal-budget competition, from the command line too."""

import json
import math
import re
from pathlib import Path

import pytest

import train as command
from agents.budget import Trace
from agents.competition import (
    CompetitionConfig,
    checkpoints,
    compete,
    competition_table,
    median_to_solve,
    quartiles,
)
from agents.presets import PPOSettings, Preset
from agents.training import TrainingConfig, train

TINY = Preset(
    task="hover",
    arguments={"insects": ["hawkmoth"]},
    settings=PPOSettings(wingbeats=4096, rows=512, minibatch=128, epochs=1),
)


def test_quartiles_and_wingbeats_to_solve_are_read_off_the_traces() -> None:
    traces = [Trace(wingbeats=[10, 100], seconds=[0.1, 1.0], gaps=[1.0, 0.0001 * i]) for i in (0, 5, 20)]
    assert quartiles(traces, 50) == (1.0, 1.0, 1.0)
    assert quartiles(traces, 100) == (0.0005, 0.0005, 0.002)
    assert quartiles(traces, 0.5, of="seconds") == (1.0, 1.0, 1.0)
    assert quartiles(traces, 5)[1] == math.inf
    assert median_to_solve(traces) == (100, 1.0)
    assert median_to_solve(traces, 0.0001) == (math.inf, math.inf)
    assert checkpoints(CompetitionConfig(wingbeats=2000)) == [10, 100, 1000, 2000]


def test_the_command_compares_a_policy_with_optimisers_and_keeps_everything(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    train(TrainingConfig(preset=TINY), tmp_path / "run", progress=False)
    arguments = ["compare", "--insects", "hawkmoth", "--seeds", "2", "--wingbeats", "300", "--quiet"]
    out = tmp_path / "out"
    assert command.main([*arguments, "--policy", str(tmp_path / "run"), "--out", str(out)]) == 0
    printed = capsys.readouterr().out
    for said in ("corner", "SLSQP", "policy run:", "one wingbeat a wing", "corner gets there in", "gap of run [%]"):
        assert said in printed
    assert re.search(r"wingbeats to 0.1 % +hawkmoth\n-+\ncorner +2\n", printed)
    kept = json.loads((out / "results.json").read_text(encoding="utf-8"))
    assert set(kept["traces"]) == set(CompetitionConfig().competitors)
    assert len(kept["traces"]["SLSQP"]) == 2
    assert (out / "competition.png").stat().st_size > 20_000
    assert (out / "table.txt").read_text(encoding="utf-8").strip() in printed


def test_random_wings_and_who_cannot_hover_are_told_apart() -> None:
    config = CompetitionConfig(
        problem="fixed-frequency",
        insects=["fruitfly", "cranefly"],
        wings=2,
        competitors=["random search"],
        wingbeats=128,
        seeds=1,
    )
    result = compete(config, progress=False)
    assert result.left_out == ("fruitfly",)
    assert [insect.name for insect in result.insects] == ["cranefly", "test-0-0", "test-0-1"]
    assert "left out, cannot hover in this box or lack a wing mass: fruitfly" in competition_table(result)


@pytest.mark.parametrize(
    ("arguments", "said"),
    [
        (["--insects"], r"leave nothing to compare on"),
        (["--wingbeats", "0"], "wingbeats = 0"),
        (["--seeds", "0"], "seeds = 0"),
        (["--competitors", "SLSPQ"], "did you mean 'SLSQP'"),
        (["--problem", "free"], "problem = 'free' is unknown"),
        (["--insects", "fruitfly", "--problem", "fixed-frequency"], "none can hover in fixed-frequency"),
        (["--policy", "nowhere"], "policy = 'nowhere' is unknown"),
    ],
)
def test_bad_input_ends_with_one_line(arguments: list[str], said: str, capsys: pytest.CaptureFixture[str]) -> None:
    assert command.main(["compare", "--quiet", *arguments]) == 2
    error = capsys.readouterr().err
    assert said in error
    assert error.count("\n") == 1


def test_a_policy_of_another_problem_is_refused(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    train(TrainingConfig(preset=TINY), tmp_path / "run", progress=False)
    arguments = ["compare", "--quiet", "--insects", "hawkmoth", "--problem", "profile-drag"]
    assert command.main([*arguments, "--policy", str(tmp_path / "run")]) == 2
    assert "was trained for free-frequency; allowed: profile-drag" in capsys.readouterr().err


def test_wings_without_a_mass_are_left_out_of_the_problem_that_needs_one() -> None:
    config = CompetitionConfig(
        problem="inertial", insects=["fruitfly", "cranefly"], competitors=["random search"], wingbeats=64, seeds=1
    )
    result = compete(config, progress=False)
    assert result.left_out == ("cranefly",)


def test_a_taken_folder_is_refused_before_anything_is_searched(
    tmp_path: Path, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    (tmp_path / "results.json").write_text("{}")
    monkeypatch.setattr("agents.competition.compete", lambda *_, **__: pytest.fail("searched"))
    assert command.main(["compare", "--quiet", "--out", str(tmp_path)]) == 2
    assert "holds results.json already" in capsys.readouterr().err


def test_ctrl_c_keeps_the_searches_that_have_ended(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    import agents.competition as competition

    original, calls = competition.run, []

    def stop_at_third(*arguments: object) -> object:
        calls.append(1)
        if len(calls) == 3:
            raise KeyboardInterrupt
        return original(*arguments)

    monkeypatch.setattr("agents.competition.run", stop_at_third)
    arguments = ["compare", "--quiet", "--insects", "hawkmoth", "--seeds", "2", "--wingbeats", "100"]
    assert command.main([*arguments, "--out", str(tmp_path / "kept")]) == 0
    kept = json.loads((tmp_path / "kept" / "results.json").read_text(encoding="utf-8"))
    assert [len(traces) for traces in kept["traces"].values()] == [2, 0, 0, 0, 0, 0]
