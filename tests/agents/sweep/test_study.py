"""The search: the same settings whatever was killed, and a journal that is read as text."""

import math
from collections.abc import Mapping
from pathlib import Path
from typing import Any

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from agents.sweep.plan import SweepPlan
from agents.sweep.search_space import Choices, Range
from agents.sweep.study import Study, Trial

PLAN = SweepPlan(
    presets=["hover-ppo"],
    seeds=1,
    search={
        "learning_rate": Range(low=1e-4, high=1e-2, log=True),
        "width": Range(low=16, high=64),
        "activation": Choices(values=["relu", "tanh"]),
    },
    trials=14,
    batch=4,
)


def distance(chosen: Mapping[str, Any]) -> float:
    return (math.log10(chosen["learning_rate"]) + 3) ** 2 + chosen["width"] / 64


def searched(journal: Path, killed_after: int = 10**9) -> list[Trial]:
    """A search to its end, which begins anew once, after so many trials were told."""
    told, study = 0, Study(PLAN, journal)
    while not study.over:
        for trial in study.batch():
            if told == killed_after:
                study = Study(PLAN, journal)
                told += 1
                break
            told += 1
            study.tell(trial.number, None if trial.number == 5 else distance(trial.chosen))
    return Study(PLAN, journal).trials()


@pytest.fixture(scope="module")
def undisturbed(tmp_path_factory: pytest.TempPathFactory) -> tuple[list[Trial], bytes]:
    journal = tmp_path_factory.mktemp("search") / "search.jsonl"
    return searched(journal), journal.read_bytes()


def test_a_search_stays_in_its_space_and_nears_the_best(undisturbed: tuple[list[Trial], bytes]) -> None:
    trials, _ = undisturbed
    assert [trial.number for trial in trials] == list(range(14))
    for trial in trials:
        assert 1e-4 <= trial.chosen["learning_rate"] <= 1e-2
        assert isinstance(trial.chosen["width"], int)
        assert 16 <= trial.chosen["width"] <= 64
        assert trial.chosen["activation"] in ("relu", "tanh")
    assert trials[5].value is None
    assert len({trial.chosen["learning_rate"] for trial in trials}) == 14


@pytest.mark.parametrize("killed_after", [0, 1, 3, 4, 6, 11, 13])
def test_a_search_that_was_killed_finds_the_same(
    killed_after: int, undisturbed: tuple[list[Trial], bytes], tmp_path: Path
) -> None:
    assert searched(tmp_path / "search.jsonl", killed_after) == undisturbed[0]


@settings(max_examples=8, deadline=None)
@given(share=st.floats(0.02, 1.0))
def test_a_journal_that_was_cut_off_anywhere_is_gone_on_with(
    share: float, undisturbed: tuple[list[Trial], bytes], tmp_path_factory: pytest.TempPathFactory
) -> None:
    trials, content = undisturbed
    journal = tmp_path_factory.mktemp("cut") / "search.jsonl"
    journal.write_bytes(content[: int(share * len(content))])
    journal.with_name("search.jsonl.lock").symlink_to(journal)  # as a process that was killed leaves it
    assert searched(journal) == trials


def test_another_seed_chooses_others(undisturbed: tuple[list[Trial], bytes], tmp_path: Path) -> None:
    fields = {name: getattr(PLAN, name) for name in ("presets", "seeds", "search", "trials", "batch")}
    other = Study(SweepPlan(**fields, sampler_seed=1), tmp_path / "search.jsonl").batch()
    assert other[0].chosen != undisturbed[0][0].chosen


def test_a_trial_that_was_given_up_is_tried_the_next_time(tmp_path: Path) -> None:
    study = Study(PLAN, tmp_path / "search.jsonl")
    first, second, *rest = study.batch()
    study.give_up(first.number)
    for trial in (second, *rest):
        study.tell(trial.number, 1.0)
    assert [trial.number for trial in study.batch()] == [4, 5, 6, 7]
    again = Study(PLAN, tmp_path / "search.jsonl").batch()
    assert [trial.number for trial in again] == [0, 4, 5, 6, 7]
    assert again[0] == first


@pytest.mark.parametrize(
    "content",
    [b'{"op_code":99}\n', b"{}\n", b"null\n{}\n", b"not JSON\n{}\n", b'\x80\x04K\x01.\n{"a": 1}\n', b'{"op_code":4}\n'],
)
def test_a_journal_of_something_else_is_refused_in_one_line(content: bytes, tmp_path: Path) -> None:
    journal = tmp_path / "search.jsonl"
    journal.write_bytes(content)
    with pytest.raises(ValueError, match=r"search\.jsonl is not a journal as Optuna writes it: .*allowed"):
        Study(PLAN, journal)


@pytest.mark.parametrize("line", [b'{"op_code": \n', b"\xff\xfe\n", b'"\n'])
def test_a_last_line_that_is_no_json_is_told_at_once(line: bytes, tmp_path: Path) -> None:
    journal = tmp_path / "search.jsonl"
    Study(PLAN, journal).batch()
    journal.write_bytes(journal.read_bytes() + line)
    with pytest.raises(ValueError, match=r"search\.jsonl is not a journal as Optuna writes it: .*; allowed: the file"):
        Study(PLAN, journal)
