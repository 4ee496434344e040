"""What Tune is told of runs, and what becomes of Tune's own mistakes; without Ray."""

import errno
from pathlib import Path
from typing import Any

import pytest
from finished_runs import finish
from ray.exceptions import RayError
from ray.tune.search import Searcher

from agents.run_folder import RESULTS
from agents.sweep import queue
from agents.sweep.plan import SweepPlan
from agents.sweep.queue import RunQueue, run_all_trials
from agents.sweep.runs import SweepRun
from agents.sweep.sources import Failure, Listed
from agents.sweep.watch import Watch

RUNS = SweepPlan(presets=["hover-ppo"], seeds=2).grid()


@pytest.fixture
def ended() -> list[tuple[SweepRun, Failure | None]]:
    return []


@pytest.fixture
def runs(tmp_path: Path, ended: list[Any], monkeypatch: pytest.MonkeyPatch) -> RunQueue:
    monkeypatch.setattr(queue, "SEEN", 0.0)
    return RunQueue(Listed(RUNS), tmp_path, lambda *told: ended.append(told))


def test_a_run_counts_by_what_its_folder_holds(runs: RunQueue, ended: list[Any], tmp_path: Path) -> None:
    told = [runs.suggest("a"), runs.suggest("b")]
    assert [Path(one["folder"]) for one in told] == [tmp_path / run.name for run in RUNS]
    assert runs.suggest("c") == Searcher.FINISHED
    finish(RUNS[0], tmp_path)
    runs.on_trial_complete("a", {"mean": 0.01, "failed": None, "final": False})
    runs.on_trial_complete("b", {"mean": 0.01, "failed": None, "final": False})
    runs.on_trial_complete("x")
    [(_, well), (_, missing)] = ended
    assert well is None
    assert missing.why == f"it ended without a result; see {tmp_path / RUNS[1].name}"
    assert not missing.final


def test_results_that_cannot_be_read_are_that_run_s_failure(runs: RunQueue, ended: list[Any], tmp_path: Path) -> None:
    runs.suggest("a")
    finish(RUNS[0], tmp_path)
    (tmp_path / RUNS[0].name / RESULTS).write_text('{"interrupted": false}')
    runs.on_trial_complete("a", {"mean": 0.01, "failed": None, "final": False})
    [(run, failure)] = ended
    assert run is RUNS[0]
    assert "results.json is not a run's: KeyError" in failure.why


@pytest.mark.parametrize(
    ("mistake", "kind", "said"),
    [
        (RayError("no\nnode"), ConnectionError, r"Ray has failed: no\\nnode; finished runs are kept, and the same"),
        (ConnectionError("dead"), ConnectionError, "Ray has failed: dead; finished runs are kept"),
        (OSError(errno.ENOSPC, "No space left"), OSError, r"cannot be written \(.*No space left\); finished runs are"),
    ],
)
def test_what_stops_tune_is_one_line_that_says_how_to_go_on(
    mistake: Exception, kind: Any, said: str, runs: RunQueue, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    class Tuner:
        def __init__(self, *_: Any, **__: Any) -> None: ...

        def fit(self) -> None:
            raise mistake

    watch = Watch(lambda: None)
    monkeypatch.setattr(queue, "watched", lambda ray: watch)
    monkeypatch.setattr(queue.tune, "Tuner", Tuner)
    with pytest.raises(kind, match=said):
        run_all_trials(runs, tmp_path, [], 1)
    assert watch._over.is_set()
