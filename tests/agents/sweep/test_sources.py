"""Which run follows which: all of a list, or batch after batch of a search."""

from pathlib import Path
from typing import Any

import pytest
from finished_runs import finish

from agents.sweep.plan import SweepPlan
from agents.sweep.search_space import Choices, Range
from agents.sweep.sources import Failure, Listed, Searched
from agents.sweep.study import Study

PLAN = SweepPlan(
    presets=["hover-sac"],
    seeds=2,
    search={"learning_rate": Range(low=1e-4, high=1e-2, log=True), "batch": Choices(values=[32, 64])},
    trials=3,
    batch=2,
)


@pytest.fixture
def refused() -> list[tuple[str, str]]:
    return []


def search(storage: Path, refused: list[tuple[str, str]], plan: SweepPlan = PLAN) -> tuple[Searched, Study]:
    study = Study(plan, storage / "search.jsonl")
    return Searched(study, plan.runs_of_trial, storage, lambda *told: refused.append(told)), study


def test_a_list_is_handed_out_in_its_order() -> None:
    runs = SweepPlan(presets=["hover-ppo"], seeds=2).grid()
    source = Listed(runs)
    assert not source.over
    assert [source.following(), source.following(), source.following()] == [*runs, None]
    assert source.over


def test_the_next_batch_waits_for_all_of_the_last(tmp_path: Path, refused: list[tuple[str, str]]) -> None:
    source, study = search(tmp_path, refused)
    runs = [source.following() for _ in range(4)]
    names = [run.name for run in runs if run]
    assert names == ["trial0000-seed0", "trial0000-seed1", "trial0001-seed0", "trial0001-seed1"]
    for number, run in enumerate(runs):
        assert run is not None
        assert source.following() is None
        assert not source.over
        finish(run, tmp_path, mean=0.01 * (number + 1))
        source.ended(run, None)
    assert [trial.value for trial in study.trials()] == [pytest.approx(0.015), pytest.approx(0.035)]
    last = [source.following(), source.following()]
    assert [run.name for run in last if run] == ["trial0002-seed0", "trial0002-seed1"]
    for run in last:
        assert run is not None
        finish(run, tmp_path)
        source.ended(run, None)
    assert source.following() is None
    assert source.over


def test_runs_of_an_earlier_time_are_counted_and_not_made_again(tmp_path: Path, refused: list[tuple[str, str]]) -> None:
    source, _ = search(tmp_path, refused)
    first = source.following()
    assert first is not None
    finish(first, tmp_path)
    again, study = search(tmp_path, refused)  # as after a kill: nobody was told
    names = [run.name for run in iter(again.following, None)]
    assert names == ["trial0000-seed1", "trial0001-seed0", "trial0001-seed1"]
    assert [trial.value for trial in study.trials()] == [None, None]


def test_settings_that_diverge_count_as_tried_and_others_wait_for_the_next_time_with_all_that_follows(
    tmp_path: Path, refused: list[tuple[str, str]]
) -> None:
    source, study = search(tmp_path, refused)
    runs = list(iter(source.following, None))
    failures = [Failure(why="diverged", final=True), None, Failure(why="disk full", final=False), None]
    for run, failure in zip(runs, failures, strict=True):
        if failure is None:
            finish(run, tmp_path)
        source.ended(run, failure)
    assert source.following() is None
    assert source.over  # whatever it chose now it would choose without knowing the second trial
    assert [(trial.ended, trial.failed) for trial in study.trials()] == [
        (True, {"trial0000-seed0": "diverged"}),
        (False, {}),
    ]
    again, study = search(tmp_path, refused)
    [run] = list(iter(again.following, None))
    assert run.name == "trial0001-seed0"
    finish(run, tmp_path)
    again.ended(run, None)
    assert [run.name for run in iter(again.following, None)] == ["trial0002-seed0", "trial0002-seed1"]
    assert study.trials()[0].failed == {"trial0000-seed0": "diverged"}


def test_a_run_whose_folder_is_another_s_is_told_and_the_others_go_on(
    tmp_path: Path, refused: list[tuple[str, str]]
) -> None:
    (tmp_path / "trial0000-seed0").mkdir()
    (tmp_path / "trial0000-seed0" / "thesis.txt").touch()
    source, study = search(tmp_path, refused)
    names = [run.name for run in iter(source.following, None)]
    assert names == ["trial0000-seed1", "trial0001-seed0", "trial0001-seed1"]
    [(name, why)] = refused
    assert name == "trial0000-seed0"
    assert "holds 'thesis.txt' but no config.json; allowed: a run's folder, or an empty one" in why
    assert not any(trial.ended for trial in study.trials())


def test_a_policy_without_a_distance_counts_as_tried(tmp_path: Path, refused: list[tuple[str, str]]) -> None:
    source, study = search(tmp_path, refused)
    for number, run in enumerate(list(iter(source.following, None))):
        finish(run, tmp_path, mean=None if number in (0, 2, 3) else 0.01)  # of the first trial's two seeds, one
        source.ended(run, None)
    assert [trial.value for trial in study.trials()] == [None, None]
    assert next(iter(source.following, None)).name == "trial0002-seed0"


def test_settings_that_do_not_go_together_are_told_and_count_as_tried(
    tmp_path: Path, refused: list[tuple[str, str]]
) -> None:
    space: dict[str, Any] = {"rows": Choices(values=[2_000, 3_000]), "buffer": Choices(values=[100_000, 1_000])}
    plan = SweepPlan(presets=["hover-sac"], seeds=1, search=space, trials=8, batch=8)
    source, study = search(tmp_path, refused, plan)
    runs = list(iter(source.following, None))
    assert 0 < len(refused) < 8
    assert len(runs) + len(refused) == 8
    assert all("buffer = 1000 is not allowed; allowed: at least rows" in why for _, why in refused)
    for run in runs:
        finish(run, tmp_path)
        source.ended(run, None)
    assert source.over
    assert sum(trial.value is None for trial in study.trials()) == len(refused)


def test_a_search_whose_every_trial_is_refused_ends(tmp_path: Path, refused: list[tuple[str, str]]) -> None:
    _, study = search(tmp_path, refused)
    broken = Searched(study, lambda *_: _refuse(), tmp_path, lambda *told: refused.append(told))
    assert broken.following() is None
    assert broken.over
    assert [name for name, _ in refused] == ["trial0000", "trial0001", "trial0002"]


def _refuse() -> Any:
    raise ValueError("these do not go together")
