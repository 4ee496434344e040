"""What a sweep concludes from its folders, without Ray: one run's fault is that run's, and no failure is forgotten."""

import contextlib
import json
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pytest
from finished_runs import finish

from agents.run_folder import RESULTS
from agents.sweep import sweep
from agents.sweep.command import sweep_command
from agents.sweep.plan import SweepPlan
from agents.sweep.search_space import Choices
from agents.sweep.sources import Failure, Source
from agents.sweep.storage import RAY
from agents.sweep.sweep import Outcome, Watched, run_sweep

GRID = SweepPlan(presets=["hover-ppo"], seeds=3)
SEARCH = SweepPlan(
    presets=["hover-ppo"], seeds=1, search={"width": Choices(values=[16, 32, 64])}, trials=2, batch=2, sampler_seed=0
)


@pytest.fixture(autouse=True)
def runs_that_end_at_once(monkeypatch: pytest.MonkeyPatch) -> None:
    """Runs without Ray; the one of `trial0000` diverges."""

    @contextlib.contextmanager
    def started(jobs: int) -> Iterator[Any]:
        yield None

    def run(source: Source, watched: Watched, storage: Path, at_once: int | None) -> bool:
        while (one := source.following()) is not None:
            diverged = one.name.startswith("trial0000")
            if not diverged:
                finish(one, storage)
            failure = Failure(why="training\ndiverged", final=True) if diverged else None
            source.ended(one, failure)
            watched.ended(one, failure)
        return True

    monkeypatch.setattr(sweep, "started", started)
    monkeypatch.setattr(sweep, "_run", run)


def swept(plan: SweepPlan, storage: Path) -> Outcome:
    return run_sweep(plan, storage, jobs=1, progress=False)


def test_what_diverged_is_still_told_the_next_time(tmp_path: Path) -> None:
    told = []
    for _ in range(2):
        outcome = swept(SEARCH, tmp_path / "s")
        assert (outcome.finished, outcome.total) == (1, 2)
        assert dict(outcome.failed) == {"trial0000-seed0": r"training\ndiverged"}
        told.append((tmp_path / "s" / "sweep_results.json").read_bytes())
        assert sweep_command(["--resume", str(tmp_path / "s"), "--quiet"]) == 1
    assert told[0] == told[1]


def test_of_a_journal_without_reasons_the_runs_are_named_all_the_same(tmp_path: Path) -> None:
    swept(SEARCH, tmp_path / "s")
    journal = tmp_path / "s" / "search.jsonl"
    lines = [line for line in journal.read_text().splitlines() if "user_attr" not in line]
    journal.write_text("\n".join(lines) + "\n")
    assert dict(swept(SEARCH, tmp_path / "s").failed) == {
        "trial0000-seed0": "its settings diverged or do not go together"
    }


@pytest.mark.parametrize("kind", ["corrupt", "no verdict", "a file", "another's", "other settings"])
def test_one_run_that_cannot_be_read_is_named_and_the_others_go_on(kind: str, tmp_path: Path) -> None:
    assert not swept(SweepPlan(presets=["hover-ppo"], seeds=3), tmp_path / "s").failed
    folder = tmp_path / "s" / "hover-ppo-seed1"
    if kind in ("corrupt", "no verdict"):
        text = "{" if kind == "corrupt" else '{"interrupted": false, "verdict": {"mean": "low"}}'
        (folder / RESULTS).write_text(text)
    elif kind == "other settings":
        config = json.loads((folder / "config.json").read_text())
        (folder / "config.json").write_text(json.dumps({**config, "seed": 7}))
    else:
        for one in folder.iterdir():
            one.unlink()
        if kind == "a file":
            folder.rmdir()
        (folder if kind == "a file" else folder / "thesis.txt").touch()
    for one in (tmp_path / "s" / "hover-ppo-seed2").iterdir():
        one.unlink()
    (tmp_path / "s" / "hover-ppo-seed2").rmdir()
    outcome = swept(GRID, tmp_path / "s")
    assert (outcome.finished, outcome.total) == (2, 3)
    [(name, why)] = outcome.failed.items()
    assert name == "hover-ppo-seed1"
    assert str(folder) in why
    assert sweep_command(["--resume", str(tmp_path / "s"), "--quiet"]) == 1


@pytest.mark.parametrize("kind", ["file", "link"])
def test_what_stands_in_the_place_of_rays_folder_is_refused(kind: str, tmp_path: Path) -> None:
    storage, mine = tmp_path / "s", tmp_path / "mine"
    swept(GRID, storage)
    mine.mkdir()
    (mine / "thesis.txt").touch()
    if kind == "file":
        (storage / RAY).touch()
    else:
        (storage / RAY).symlink_to(mine)
    with pytest.raises(NotADirectoryError, match=r"\.ray is no folder; allowed: a folder"):
        swept(GRID, storage)
    assert (mine / "thesis.txt").exists()


@pytest.mark.parametrize(("name", "said"), [("a\0b", r"a\x00b"), ("x" * 300, "xxx")])
def test_a_storage_that_no_folder_can_have_is_refused_in_one_line(
    name: str, said: str, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    assert sweep_command(["--presets", "hover-ppo", "--storage", str(tmp_path / name)]) == 2
    printed = capsys.readouterr().err
    assert printed.count("\n") == 1
    assert "train.py sweep: --storage " in printed
    assert "; allowed: a folder that can" in printed
    assert said in printed
