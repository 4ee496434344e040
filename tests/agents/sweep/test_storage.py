"""The folder of a sweep: one plan, one process at a time, and run folders that say what is finished."""

import json
import os
import re
from pathlib import Path

import pytest
from finished_runs import finish

from agents.folder_lock import locked
from agents.run_folder import RESULTS
from agents.sweep.plan import SweepPlan
from agents.sweep.runs import is_finished, result_of
from agents.sweep.storage import PLAN, RAY, opened, read_plan

TINY = SweepPlan(presets=["hover-ppo"], seeds=2, wingbeats=4_096, settings={"rows": 256})


def test_a_plan_is_kept_and_found_again(tmp_path: Path) -> None:
    storage = tmp_path / "deep" / "sweep"
    with opened(storage, TINY):
        pass
    assert read_plan(storage) == TINY
    with opened(storage, TINY):
        pass


def test_another_plan_into_the_same_storage_is_refused_with_what_differs(tmp_path: Path) -> None:
    with opened(tmp_path / "s", TINY):
        pass
    other = SweepPlan(presets=["hover-ppo"], seeds=3, wingbeats=4_096, settings={"rows": 256})
    before = (tmp_path / "s" / PLAN).read_bytes()
    with pytest.raises(ValueError, match=r"holds another sweep: seeds = 2 there, wanted 3; allowed"):
        opened(tmp_path / "s", other).__enter__()
    assert (tmp_path / "s" / PLAN).read_bytes() == before


def test_settings_that_only_the_other_plan_has_differ_too(tmp_path: Path) -> None:
    with opened(tmp_path / "s", TINY):
        pass
    with pytest.raises(ValueError, match=r"holds another sweep: settings"):
        opened(tmp_path / "s", SweepPlan(presets=["hover-ppo"], seeds=2, wingbeats=4_096)).__enter__()


def test_a_second_sweep_into_the_same_storage_is_refused(tmp_path: Path) -> None:
    with (
        opened(tmp_path / "s", TINY),
        pytest.raises(BlockingIOError, match=f"in use by process {os.getpid()}"),
        opened(tmp_path / "s", TINY),
    ):
        pass
    with opened(tmp_path / "s", TINY), pytest.raises(BlockingIOError), locked(tmp_path / "s"):
        pass


def test_a_storage_that_is_a_file_or_below_one_is_refused(tmp_path: Path) -> None:
    (tmp_path / "file").touch()
    for storage in (tmp_path / "file", tmp_path / "file" / "below"):
        with pytest.raises(NotADirectoryError, match="file is a file; allowed: a folder"):
            opened(storage, TINY).__enter__()


def test_a_folder_of_something_else_is_refused_and_left_as_it_is(tmp_path: Path) -> None:
    (tmp_path / "thesis.txt").write_text("mine")
    with pytest.raises(
        FileExistsError, match=r"holds files but no sweep\.json; allowed: a sweep's folder, or an empty"
    ):
        opened(tmp_path, TINY).__enter__()
    assert [one.name for one in tmp_path.iterdir()] == ["thesis.txt"]


def test_what_ray_left_is_removed_unread(tmp_path: Path) -> None:
    with opened(tmp_path / "s", TINY):
        (tmp_path / "s" / RAY / "old").mkdir(parents=True)
        (tmp_path / "s" / RAY / "old" / "tuner.pkl").write_bytes(b"\x80\x04")
    with opened(tmp_path / "s", TINY):
        assert not (tmp_path / "s" / RAY).exists()


@pytest.mark.parametrize(
    ("content", "said"),
    [
        ("", "it is empty"),
        ("{}", "holds no plan"),
        ('{"plan": []}', "holds no plan"),
        ('{"plan": {"presets": ["hover-ppo"], "seeds": "2"}}', "seeds = '2' is not a whole number"),
        ('{"plan": {"presets": ["hover-ppo"], "sedes": 2}}', "no field 'sedes'.*did you mean 'seeds'"),
        ('{"plan": {"presets": ["hover-ppo"], "trials": 2, "search": {"rows": 1}}}', "rows: 1 is no range"),
    ],
)
def test_a_plan_that_was_tampered_with_is_refused(content: str, said: str, tmp_path: Path) -> None:
    (tmp_path / PLAN).write_text(content)
    with pytest.raises((ValueError, TypeError), match=f"{re.escape(str(tmp_path / PLAN))}.*{said}"):
        read_plan(tmp_path)


def test_a_folder_without_a_plan_cannot_be_resumed(tmp_path: Path) -> None:
    with pytest.raises(FileNotFoundError, match=r"sweep\.json does not exist; allowed: the folder of a sweep"):
        read_plan(tmp_path)


def test_a_run_is_finished_when_its_folder_says_so(tmp_path: Path) -> None:
    first, second = TINY.grid()
    assert not is_finished(first, tmp_path)
    finish(first, tmp_path)
    finish(second, tmp_path, interrupted=True)
    assert is_finished(first, tmp_path)
    assert not is_finished(second, tmp_path)
    assert result_of(first, tmp_path).mean == 0.01
    (tmp_path / first.name / RESULTS).unlink()
    assert not is_finished(first, tmp_path)


def test_a_run_with_other_settings_is_not_taken_for_ours(tmp_path: Path) -> None:
    [other, _] = SweepPlan(presets=["hover-ppo"], seeds=2, wingbeats=4_096, settings={"rows": 128}).grid()
    finish(other, tmp_path)
    with pytest.raises(ValueError, match=r"settings\.rows = 128 there, wanted 256"):
        is_finished(TINY.grid()[0], tmp_path)


def test_results_that_are_no_runs_are_refused(tmp_path: Path) -> None:
    run = TINY.grid()[0]
    finish(run, tmp_path)
    (tmp_path / run.name / RESULTS).write_text('{"verdict": {"mean": "low"}}')
    with pytest.raises(ValueError, match=r"results\.json is not a run's: "):
        result_of(run, tmp_path)


@pytest.mark.parametrize(
    ("name", "value"), [("seconds", "nan"), ("seconds", -1), ("wingbeats", 1.5), ("mean", "nan"), ("worst", [1])]
)
def test_numbers_of_results_that_are_none_are_refused(name: str, value: object, tmp_path: Path) -> None:
    run = TINY.grid()[0]
    finish(run, tmp_path)
    path = tmp_path / run.name / RESULTS
    told = json.loads(path.read_text())
    (told if name in told else told["verdict"])[name] = value
    path.write_text(json.dumps(told))
    with pytest.raises(ValueError, match=rf"results\.json is not a run's: \w+ {name} = .*; allowed"):
        result_of(run, tmp_path)
