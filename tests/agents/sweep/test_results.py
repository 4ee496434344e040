"""Tables and files of what a sweep found."""

import csv
import dataclasses
import json
from pathlib import Path

import numpy as np
import pytest

from agents.benchmark.statistics import interquartile_mean, interval
from agents.sweep.plan import SweepPlan
from agents.sweep.results import best_command, summary_of, sweep_table, trials_table, write_results
from agents.sweep.runs import RunResult
from agents.sweep.search_space import Choices, Range
from agents.sweep.study import Trial

RUNS = SweepPlan(presets=["hover-ppo"], seeds=6).grid()
SEARCH = SweepPlan(
    presets=["hover-ppo"],
    seeds=2,
    wingbeats=5_000,
    search={"learning_rate": Range(low=1e-4, high=1e-2, log=True), "activation": Choices(values=["relu", "tanh"])},
    trials=3,
)


def results(*means: float | None) -> list[RunResult]:
    return [
        RunResult(
            run=run,
            mean=mean,
            worst=None if mean is None else 3 * mean,
            wingbeats=1_000,
            seconds=2.0,
            distance="gap to the optimum",
        )
        for run, mean in zip(RUNS, means, strict=False)
    ]


def test_a_line_of_the_table_says_mean_worst_and_interval_over_the_seeds() -> None:
    means = [0.01, 0.02, 0.03, 0.05]
    found = summary_of("hover-ppo", results(*means), 6)
    assert found["finished"] == 4
    assert found["mean"] == pytest.approx(0.0275)
    assert found["interquartile_mean"] == float(interquartile_mean(np.array(means)))
    assert tuple(found["interval"]) == interval(np.array(means))
    assert found["worst"] == pytest.approx(0.15)
    table = sweep_table([found])
    assert "4/6" in table
    for cell in ("2.75", "2.5", "15", "1,000", "IQM", "95 % interval"):
        assert cell in table


def test_seconds_and_wingbeats_of_a_line_are_medians() -> None:
    runs = [
        dataclasses.replace(one, seconds=seconds, wingbeats=wingbeats)
        for one, seconds, wingbeats in zip(results(0.1, 0.1, 0.1), (1.0, 2.0, 90.0), (70, 10, 20), strict=True)
    ]
    found = summary_of("hover-ppo", runs, 3)
    assert (found["seconds"], found["wingbeats"]) == (2.0, 20.0)


def test_a_group_without_results_has_dashes_and_runs_without_a_distance_are_left_out_of_the_means() -> None:
    nothing = summary_of("hover-ppo", [], 6)
    assert nothing["mean"] is None
    assert "0/6" in sweep_table([nothing])
    some = summary_of("hover-ppo", results(None, 0.02), 6)
    assert some["finished"] == 2
    assert some["mean"] == 0.02
    assert some["interval"] is None


def test_the_best_trial_is_first_and_its_command_is_complete() -> None:
    trials = [
        Trial(number=0, chosen={"learning_rate": 0.001, "activation": "tanh"}, value=0.5),
        Trial(number=1, chosen={"learning_rate": 0.002, "activation": "relu"}, value=None),
        Trial(number=2, chosen={"learning_rate": 0.003, "activation": "tanh"}, value=0.25),
    ]
    lines = trials_table(SEARCH, trials).splitlines()
    assert lines[0].split() == ["trial", "learning_rate", "activation", "mean", "[%]"]
    assert [line.split()[0] for line in lines[2:]] == ["trial0002", "trial0000", "trial0001"]
    assert lines[-1].split()[-1] == "-"
    told = "--wingbeats 5000 --set learning_rate=0.003 --set activation=tanh"
    assert best_command(SEARCH, trials) == f"python train.py --preset hover-ppo --seed 0 {told}"
    assert best_command(SEARCH, trials[1:2]) is None


def test_the_files_hold_every_run_whole(tmp_path: Path) -> None:
    write_results(tmp_path, "the table", results(0.1 + 0.2, None), {"groups": []})
    assert (tmp_path / "table.txt").read_text() == "the table\n"
    rows = list(csv.DictReader((tmp_path / "sweep_runs.csv").read_text().splitlines()))
    assert [row["folder"] for row in rows] == ["hover-ppo-seed0", "hover-ppo-seed1"]
    assert float(rows[0]["mean"]) == 0.1 + 0.2
    assert rows[1]["mean"] == ""
    assert rows[0]["command"] == "python train.py --preset hover-ppo --seed 0"
    assert json.loads((tmp_path / "sweep_results.json").read_text()) == {"groups": []}
    assert {path.name for path in tmp_path.iterdir()} == {"table.txt", "sweep_runs.csv", "sweep_results.json"}
