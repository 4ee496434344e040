"""Search spaces: what a command line and a file may ask for, and what is refused."""

import json
import math
from pathlib import Path

import pytest
from hypothesis import given
from hypothesis import strategies as st

from agents.presets import PRESETS
from agents.sweep.search_space import (
    FORMS,
    Choices,
    Range,
    dimension_of,
    is_whole,
    read_space,
    require_settings,
    space_of,
)

FINITE = st.floats(allow_nan=False, allow_infinity=False)


@given(low=FINITE, high=FINITE, log=st.booleans())
def test_a_range_comes_back_from_the_command_line_and_from_a_file(low: float, high: float, log: bool) -> None:
    if low >= high or (log and low <= 0):
        with pytest.raises(ValueError, match="low = "):
            Range(low=low, high=high, log=log)
        return
    text = f"gamma={low!r}:{high!r}{':log' if log else ''}"
    assert dimension_of(text) == ("gamma", Range(low=low, high=high, log=log))
    kept = json.loads(json.dumps({"gamma": Range(low=low, high=high, log=log).to_json()}))
    assert space_of(kept, "file") == {"gamma": Range(low=low, high=high, log=log)}


@given(
    st.lists(st.one_of(st.integers(), FINITE, st.booleans(), st.none()), min_size=2, max_size=5, unique_by=json.dumps)
)
def test_choices_come_back_from_the_command_line_and_from_a_file(values: list[object]) -> None:
    name, found = dimension_of(f"width={','.join(json.dumps(value) for value in values)}")
    assert name == "width"
    assert isinstance(found, Choices)
    assert [json.dumps(value) for value in found.values] == [json.dumps(value) for value in values]
    assert space_of(json.loads(json.dumps({"width": found.to_json()})), "file") == {"width": found}


@given(st.text())
def test_any_text_is_a_dimension_or_an_error_of_one_line(text: str) -> None:
    said = ""
    try:
        name, _ = dimension_of(text)
    except ValueError as mistake:
        name, said = "", str(mistake)
    assert text.startswith(f"{name}=") if name else said.endswith(f"allowed: {FORMS}")


@pytest.mark.parametrize(
    ("text", "said"),
    [
        ("learning_rate", "no name or no value"),
        ("=1:2", "no name or no value"),
        ("rows=2:1", "low = 2 is not allowed; allowed: below high = 1"),
        ("rows=1:1", "low = 1"),
        ("rows=0:8:log", "logarithmic axis; allowed: above 0"),
        ("rows=1:8:lag", "'lag' follows the ends"),
        ("rows=1:8:log:log", "follows the ends"),
        ("rows=1:nan", "not finite"),
        ("rows=1:inf", "not finite"),
        ("rows=one:two", "'one' is no number"),
        ("rows=1,,2", "a choice is empty"),
        ("rows=1", "two or more"),
        ("rows=1,1", "each once"),
        ("rows=1,Infinity", "finite numbers"),
    ],
)
def test_a_dimension_that_cannot_be_is_refused_with_the_forms_that_can(text: str, said: str) -> None:
    with pytest.raises(ValueError, match=f"--search {text} is not allowed: .*{said}.*allowed: NAME=LOW:HIGH"):
        dimension_of(text)


def test_words_are_choices_and_numbers_with_a_word_too() -> None:
    assert dimension_of("activation=relu,tanh") == ("activation", Choices(values=["relu", "tanh"]))
    assert dimension_of("gradient_norm=null,0.5") == ("gradient_norm", Choices(values=[None, 0.5]))


@pytest.mark.parametrize(
    ("content", "said"),
    [
        ({"rows": 3}, "rows: 3 is no range and no list"),
        ({"rows": {"low": 1, "hgih": 2}}, "rows: key 'hgih' is unknown; allowed: low, high, log; did you mean 'high'"),
        ({"rows": {"low": 1}}, "rows: Range needs high"),
        ({"rows": {"low": "1", "high": 2}}, "rows: low = '1' is not"),
        ({"rows": {"low": True, "high": 2}}, "rows: low = True"),
        ({"rows": {"low": 1, "high": 2, "log": 1}}, "rows: log = 1 is not allowed"),
        ({"rows": [1, [2]]}, r"rows: values hold \[2\]"),
        ({"rows": [1]}, "rows: values = .1. is not allowed; allowed: two or more"),
    ],
)
def test_a_file_with_a_mistake_is_refused_with_the_setting(
    content: dict[str, object], said: str, tmp_path: Path
) -> None:
    path = tmp_path / "space.json"
    path.write_text(json.dumps(content))
    with pytest.raises((ValueError, TypeError), match=f"--space .*space.json: {said}"):
        read_space(path)


def test_a_setting_that_no_learner_has_is_refused_with_the_nearest() -> None:
    with pytest.raises(TypeError, match=r"lerning_rate.*allowed: .*did you mean 'learning_rate'"):
        require_settings({"lerning_rate": Range(low=1, high=2)}, PRESETS["hover-ppo"])


@pytest.mark.parametrize("choice", [Range(low=-1.0, high=1e-2), Choices(values=[1e-3, -1.0])])
def test_an_end_or_a_choice_that_a_learner_refuses_is_refused_before(choice: Range | Choices) -> None:
    with pytest.raises(ValueError, match=r"the search space's learning_rate: learning_rate = -1"):
        require_settings({"learning_rate": choice}, PRESETS["hover-ppo"])


def test_a_range_of_what_is_no_number_is_refused() -> None:
    with pytest.raises((TypeError, ValueError), match="the search space's activation"):
        require_settings({"activation": Range(low=1, high=2)}, PRESETS["hover-ppo"])


def test_a_range_is_of_whole_numbers_where_ends_and_setting_are() -> None:
    assert is_whole(Range(low=1, high=8), 4)
    assert is_whole(Range(low=1, high=8), None)
    assert not is_whole(Range(low=1, high=8), 0.5)
    assert not is_whole(Range(low=1, high=8.5), 4)
    assert math.isclose(Range(low=1, high=8.5).high, 8.5)


@pytest.mark.parametrize("name", ["\x1b[2J", "a\nb", "x" * 3000])
def test_names_that_nobody_would_write_change_no_screen(name: str) -> None:
    for told in (1, {name: 2}):
        with pytest.raises(TypeError, match="allowed") as caught:
            space_of({name: told}, "it")
        assert str(caught.value).isprintable()
        assert len(str(caught.value)) < 500
    with pytest.raises(ValueError, match="allowed") as bad:
        dimension_of(f"{name}=1:{name}")
    assert str(bad.value).isprintable()
    assert len(str(bad.value)) < 500
