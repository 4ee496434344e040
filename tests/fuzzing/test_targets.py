"""Every target takes what Hypothesis draws: a finite answer, or an error of the project's own in one line."""

import json
import math
import warnings
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from gymnasium.error import ResetNeeded
from hypothesis import given, settings
from hypothesis import strategies as st

from flapenv import Stroke, load_insect
from fuzzing import files, seeds
from fuzzing.draw import Draw
from fuzzing.targets import SPREAD, TARGETS, target_of
from fuzzing.verdict import LONGEST, FindingError, judge, refused, require_finite

FEW = {
    "checkpoint": 20,
    "page-answers": 20,
    "strokes-judged": 10,
    "insects-hover": 4,
    "problems-hover": 8,
    "search-journal": 20,
}
"""Inputs of targets that take long; of the others there are `MANY`."""
MANY = 60
BUILT = (
    "policy",
    "checkpoint",
    "settings",
    "insect",
    "problem",
    "page-answers",
    "actions-hover",
    "search-journal",
)
READERS = (
    "strokes-json",
    "strokes-csv",
    "wing-json",
    "planform-csv",
    "config-json",
    "sweep-json",
    "space-json",
    "run-results",
)


@pytest.mark.parametrize("name", TARGETS)
def test_no_input_breaks_the_rule(name: str) -> None:
    target = TARGETS[name]

    @settings(max_examples=FEW.get(name, MANY))
    @given(data=st.binary(max_size=120))
    def judged(data: bytes) -> None:
        judge(target.call, data)

    judged()
    for data in SPREAD[: FEW.get(name, MANY) // 4]:
        judge(target.call, data)


@pytest.mark.parametrize("name", READERS)
def test_every_file_that_the_fuzzer_begins_with_is_valid(name: str) -> None:
    assert [judge(TARGETS[name].call, data) for data in TARGETS[name].corpus] == ["accepted"] * len(
        list(TARGETS[name].corpus)
    )


@pytest.mark.parametrize("name", BUILT)
def test_what_is_hardly_changed_is_often_accepted(name: str) -> None:
    told = [judge(TARGETS[name].call, data) for data in SPREAD]
    assert told.count("accepted") > 1


def test_all_targets_together_reach_each_of_them(monkeypatch: pytest.MonkeyPatch) -> None:
    reached = set()
    for name, target in TARGETS.items():
        monkeypatch.setitem(vars(target), "call", lambda data, name=name: reached.add(name))
    together = target_of("together")
    for data in together.corpus:
        judge(together.call, data)
    assert reached == set(TARGETS)


def raised(kind: type[Exception], text: str) -> Any:
    def target(data: bytes) -> None:
        raise kind(text)

    return target


def ours(data: bytes) -> None:
    Stroke(frequency=-1.0, flap_amplitude=1.0, pitch_amplitude=1.0)


def overflowing(data: bytes) -> None:
    np.float32(1e38) * np.float32(10)


def theirs(data: bytes) -> None:
    json.loads("{")


@pytest.mark.parametrize(
    ("target", "why"),
    [
        (raised(KeyError, "allowed: nothing"), "a KeyError"),
        (raised(RecursionError, "allowed: nothing"), "a RecursionError"),
        (raised(MemoryError, "allowed: nothing"), "a MemoryError"),
        (raised(ValueError, "allowed: nothing"), "of another library"),
        (theirs, "a JSONDecodeError"),
        (overflowing, "a RuntimeWarning"),
        (lambda data: float("nan"), "value = nan is not finite"),
        (lambda data: {"a": [1.0, (2, np.array([0.0, math.inf]))]}, "not finite"),
    ],
)
def test_what_breaks_the_rule_is_found(target: Any, why: str) -> None:
    with pytest.raises(FindingError, match=why):
        judge(target, b"")


def test_our_own_errors_and_warnings_do_not_break_the_rule() -> None:
    assert judge(ours, b"") == "refused"
    assert judge(lambda data: warnings.warn("a wing that hardly flies", stacklevel=1), b"") == "accepted"
    assert judge(raised(ResetNeeded, "call reset"), b"") == "refused"


@pytest.mark.parametrize(
    ("text", "why"),
    [
        ("a = 1; allowed: 2", None),
        ("a = 1\nallowed: 2", "more than one line"),
        ("a = \x1b[2J; allowed: 2", "more than one line"),
        ("a" * LONGEST + "allowed", "letters"),
        ("a = 1 is wrong", "does not say what is allowed"),
    ],
)
def test_an_error_is_one_line_of_limited_length_that_says_what_is_allowed(text: str, why: str | None) -> None:
    def here() -> str | None:
        try:
            load_insect("moth")
        except ValueError as mistake:
            mistake.args = (text,)
            return refused(mistake)
        raise AssertionError

    found = here()
    assert found is None if why is None else why in str(found)


def test_a_record_with_a_number_that_is_not_finite_is_found() -> None:
    require_finite(seeds.as_own(load_insect("hawkmoth")))
    stroke = load_insect("hawkmoth").stroke
    object.__setattr__(stroke := Stroke(**vars(stroke)), "frequency", math.nan)
    with pytest.raises(FindingError, match="frequency"):
        require_finite([stroke])


@given(data=st.binary(max_size=40))
def test_any_bytes_are_choices_and_no_bytes_are_the_first_ones(data: bytes) -> None:
    draw = Draw(data)
    for _ in range(20):
        draw.thing()
        draw.number()
        draw.text()
    assert draw.rest() == b"" or len(data) > 20
    assert Draw(b"").one_of("abc") == "a"
    assert Draw(b"").number(3.0) == 3.0


def test_files_of_the_fuzzer_lie_in_a_folder_of_its_own() -> None:
    assert files.folder().is_dir()
    assert Path.cwd() not in files.folder().parents
