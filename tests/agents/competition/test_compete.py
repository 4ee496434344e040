"""The equal-budget competition, from the command line too."""

import json
import math
import re
from pathlib import Path

import numpy as np
import pytest

import train as command
from agents.competition.budget import Trace
from agents.competition.compete import CompetitionConfig, CompetitionResult, PolicyScore, compete, prepare
from agents.competition.keep import save
from agents.competition.table import break_even, checkpoints, competition_table, median_to_solve, quartiles, wing_table
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
    train(TrainingConfig(preset=TINY), tmp_path / "run", progress=False, report=False)
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
    result = compete(prepare(config), progress=False)
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
        (["--insects", "hawkmoth", "hawkmoth"], "insects name hawkmoth more than once"),
        (["--competitors", "SLSQP", "corner", "SLSQP"], "competitors name SLSQP more than once"),
        (["--policy", "run", "--policy", "run"], "policies name run more than once"),
    ],
)
def test_bad_input_ends_with_one_line_and_leaves_no_folder(
    arguments: list[str], said: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.chdir(tmp_path)
    assert command.main(["compare", "--quiet", *arguments]) == 2
    error = capsys.readouterr().err
    assert said in error
    assert error.count("\n") == 1
    assert not list(tmp_path.iterdir())


def test_a_policy_of_another_problem_is_refused(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    train(TrainingConfig(preset=TINY), tmp_path / "run", progress=False, report=False)
    arguments = ["compare", "--quiet", "--insects", "hawkmoth", "--policy", str(tmp_path / "run")]
    arguments += ["--out", str(tmp_path / "out")]
    assert command.main([*arguments, "--problem", "profile-drag"]) == 2
    assert "was trained for free-frequency; allowed: profile-drag" in capsys.readouterr().err
    card = json.loads((tmp_path / "run" / "policy.json").read_text(encoding="utf-8"))
    for task, said in (({"name": "hover"}, "names no problem"), ({"problem": 3}, "run: problem = 3 ")):
        (tmp_path / "run" / "policy.json").write_text(json.dumps({**card, "task": task}), encoding="utf-8")
        assert command.main(arguments) == 2
        error = capsys.readouterr().err
        assert said in error
        assert error.count("\n") == 1
    assert not (tmp_path / "out").exists()


def test_wings_without_a_mass_are_left_out_of_the_problem_that_needs_one() -> None:
    config = CompetitionConfig(
        problem="inertial", insects=["fruitfly", "cranefly"], competitors=["random search"], wingbeats=64, seeds=1
    )
    result = compete(prepare(config), progress=False)
    assert result.left_out == ("cranefly",)


def test_a_taken_folder_is_refused_before_anything_is_searched(
    tmp_path: Path, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    (tmp_path / "results.json").write_text("{}")
    monkeypatch.setattr("agents.competition.compete", lambda *_, **__: pytest.fail("searched"))
    assert command.main(["compare", "--quiet", "--out", str(tmp_path)]) == 2
    assert "holds results.json already" in capsys.readouterr().err


def test_ctrl_c_keeps_the_searches_that_have_ended(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    import agents.competition.compete as competition

    original, calls = competition.run, []

    def stop_at_third(*arguments: object) -> object:
        calls.append(1)
        if len(calls) == 3:
            raise KeyboardInterrupt
        return original(*arguments)

    monkeypatch.setattr("agents.competition.compete.run", stop_at_third)
    arguments = ["compare", "--quiet", "--insects", "hawkmoth", "--seeds", "2", "--wingbeats", "100"]
    assert command.main([*arguments, "--out", str(tmp_path / "kept")]) == 130
    kept = json.loads((tmp_path / "kept" / "results.json").read_text(encoding="utf-8"))
    assert [len(traces) for traces in kept["traces"].values()] == [2, 0, 0, 0, 0, 0]
    assert kept["interrupted"] is True
    assert "stopped early: of the searches that had ended by then" in capsys.readouterr().out


@pytest.mark.filterwarnings("error")
@pytest.mark.parametrize(
    "trace", [Trace(), Trace(wingbeats=[1, 3], seconds=[1e-4, 0.1], gaps=[0.5, 0.1])], ids=["nothing", "a stroke"]
)
def test_searches_and_policies_without_a_number_are_kept_and_drawn(trace: Trace, tmp_path: Path) -> None:
    config = CompetitionConfig(insects=["hawkmoth", "fruitfly"], wingbeats=10, seeds=1)
    result = CompetitionResult(
        config=config,
        insects=tuple(config.insects),
        left_out=(),
        traces={"corner": [Trace(), Trace()], "CMA-ES": [trace, trace]},
        policies=[
            PolicyScore(name="new", wingbeats=100, seconds=None, gaps=np.array([0.5, 0.6])),
            PolicyScore(name="wild", wingbeats=100, seconds=2.0, gaps=np.array([np.inf, np.inf])),
            PolicyScore(name="exact", wingbeats=100, seconds=2.0, gaps=np.zeros(2)),
        ],
    )
    save(result, tmp_path)
    kept = json.loads((tmp_path / "results.json").read_text(encoding="utf-8"))
    assert kept["interrupted"] is False
    assert [policy["seconds"] for policy in kept["policies"]] == [None, 2.0, 2.0]
    assert [policy["gaps"] for policy in kept["policies"]] == [[0.5, 0.6], [None, None], [0.0, 0.0]]
    assert "after 100 wingbeats of training, 51 a wing" in competition_table(result)
    assert wing_table(result).count("\n") == 6
    assert (tmp_path / "competition.png").stat().st_size > 5_000


def test_a_policys_training_never_pays_where_one_wingbeat_gets_as_far() -> None:
    config = CompetitionConfig(insects=["hawkmoth"], wingbeats=10, seeds=1)
    policy = PolicyScore(name="new", wingbeats=100, seconds=None, gaps=np.array([0.5]))
    for wingbeats, said in ((1, "in one wingbeat: training never pays"), (5, "in 5 wingbeats: training pays from 25 ")):
        traces = {"corner": [Trace(wingbeats=[wingbeats], seconds=[0.1], gaps=[0.4])]}
        result = CompetitionResult(
            config=config, insects=tuple(config.insects), left_out=(), traces=traces, policies=[policy]
        )
        (line,) = break_even(result, policy)
        assert said in line
