"""What a worker does with a run: its mistakes are results, and a folder that is still held is waited for."""

import os
from pathlib import Path
from typing import Any

import pytest

from agents.sweep import trials
from agents.sweep.plan import SweepPlan
from agents.sweep.trials import packed, run_trial
from agents.tasks import Verdict
from agents.training import DivergedError, TrainingResult

RUN = SweepPlan(presets=["hover-ppo"], seeds=1).grid()[0]


def trial(tmp_path: Path) -> dict[str, Any]:
    return {"folder": str(tmp_path / RUN.name), "packed": packed(RUN.config)}


def ended(folder: Path, mean: float) -> TrainingResult:
    verdict = Verdict(mean=mean, worst=mean, text="", results={})
    return TrainingResult(out=folder, verdict=verdict, wingbeats=1, seconds=1.0, interrupted=False)


def test_a_run_goes_on_in_its_folder_and_tells_its_distance(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    seen: list[Any] = []

    def train(config: Any, out: Path, **how: Any) -> TrainingResult:
        seen.append((config.to_dict(), out, how))
        return ended(out, 0.25)

    monkeypatch.setattr("agents.training.train", train)
    assert run_trial(trial(tmp_path)) == {"mean": 0.25, "failed": None, "final": False}
    [(config, out, how)] = seen
    assert config == RUN.config.to_dict()
    assert out == tmp_path / RUN.name
    assert how == {"progress": False, "report": False, "resume": True}


@pytest.mark.parametrize(("before", "after"), [(0o000, 0o022), (0o007, 0o027), (0o077, 0o077)])
def test_others_may_not_change_what_a_run_writes_whatever_its_node_allows(
    before: int, after: int, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    found: list[int] = []

    def train(_: Any, out: Path) -> TrainingResult:
        found.append(os.umask(0o077))
        return ended(out, 0.25)

    monkeypatch.setattr(trials, "go_on", train)
    own = os.umask(before)
    try:
        run_trial(trial(tmp_path))
    finally:
        os.umask(own)
    assert found == [after]


@pytest.mark.parametrize(
    ("mistake", "final", "said"),
    [
        (DivergedError("after 5\nwingbeats"), True, r"after 5\nwingbeats"),
        (OSError("no space left"), False, "no space left"),
        (RuntimeError(), False, "RuntimeError"),
        (MemoryError(), False, "not enough memory"),
    ],
)
def test_a_mistake_of_a_run_is_its_result(
    mistake: Exception, final: bool, said: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    def fail(*_: Any) -> TrainingResult:
        raise mistake

    monkeypatch.setattr(trials, "go_on", fail)
    assert run_trial(trial(tmp_path)) == {"failed": said, "final": final}


def test_a_folder_that_a_lost_worker_holds_is_waited_for(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    tries: list[int] = []

    def held(*_: Any) -> TrainingResult:
        tries.append(1)
        if len(tries) < 3:
            raise BlockingIOError("in use")
        return ended(tmp_path, 0.5)

    monkeypatch.setattr(trials, "go_on", held)
    monkeypatch.setattr(trials, "GLANCE", 0.0)
    assert run_trial(trial(tmp_path))["mean"] == 0.5
    tries.clear()
    monkeypatch.setattr(trials, "PATIENCE", -1.0)
    assert run_trial(trial(tmp_path)) == {"failed": "in use", "final": False}
