"""Presets by name."""

import json
from dataclasses import asdict

import pytest

from agents.benchmark.runner import BENCHMARKED
from agents.presets import ALGORITHMS, DEFAULT_PRESET, PRESETS, PPOSettings, Preset, as_preset, setting_of
from agents.tasks import TASKS


@pytest.mark.parametrize("name", PRESETS)
def test_a_name_tells_task_and_learner_and_the_preset_comes_back_from_its_file(name: str) -> None:
    preset = PRESETS[name]
    assert name.startswith(f"{preset.task}-{preset.settings.algorithm.lower()}")
    told = json.loads(json.dumps(preset.to_dict(), allow_nan=False))
    again = as_preset({key: told[key] for key in ("task", "algorithm", "settings")})
    assert again.settings == preset.settings
    assert again.make_task().to_dict() == preset.make_task().to_dict()


def test_every_learner_and_every_task_has_a_preset_and_the_benchmark_names_exist() -> None:
    assert {preset.settings.algorithm for preset in PRESETS.values()} == set(ALGORITHMS)
    assert {preset.task for preset in PRESETS.values()} == set(TASKS)
    assert set(BENCHMARKED) <= set(PRESETS)
    tried = [PRESETS[name] for name in BENCHMARKED]
    learners = {preset.settings.algorithm for preset in PRESETS.values() if preset.task == "hover"}
    assert {preset.settings.algorithm for preset in tried if preset.task == "hover"} == learners
    assert {preset.task for preset in tried} == set(TASKS)
    assert DEFAULT_PRESET == "hover-ppo"


def test_a_changed_preset_keeps_the_rest() -> None:
    changed = PRESETS["hover-ppo"].changed({"insects": ["hawkmoth"]}, {"rows": 512})
    assert changed.settings == PPOSettings(**{**asdict(PRESETS["hover-ppo"].settings), "rows": 512})
    assert [insect.name for insect in changed.make_task().insects] == ["hawkmoth"]


@pytest.mark.parametrize(
    ("arguments", "settings", "said"),
    [
        ({"insect": ["hawkmoth"]}, {}, "did you mean 'insects'"),
        ({}, {"row": 3}, "did you mean 'rows'"),
        ({}, {"rows": "many"}, "rows = 'many'"),
    ],
)
def test_changes_that_do_not_exist_are_named(
    arguments: dict[str, object], settings: dict[str, object], said: str
) -> None:
    with pytest.raises((TypeError, ValueError), match=said):
        PRESETS["hover-ppo"].changed(arguments, settings)


def test_an_unknown_task_is_named() -> None:
    with pytest.raises(ValueError, match="did you mean 'hover'"):
        Preset(task="hoover", settings=PPOSettings())


@pytest.mark.parametrize(
    ("text", "pair"),
    [
        ("rows=3", ("rows", 3)),
        ("mean=[0, 1]", ("mean", [0, 1])),
        ("activation=relu", ("activation", "relu")),
    ],
)
def test_settings_of_a_command_line_are_read_as_what_they_are(text: str, pair: tuple[str, object]) -> None:
    assert setting_of(text) == pair


@pytest.mark.parametrize("text", ["=\x1b[2J\n", "a=", "a" * 5000])
def test_a_setting_of_another_form_is_told_in_one_short_line(text: str) -> None:
    with pytest.raises(ValueError, match=r"^--set .* is not allowed; allowed: NAME=VALUE$") as caught:
        setting_of(text)
    assert str(caught.value).isprintable()
    assert len(str(caught.value)) < 200


def test_a_setting_of_another_kind_is_told_in_one_short_line() -> None:
    for name in ("rows", "learning_rate", "first_mean", "x" * 5000):
        with pytest.raises((TypeError, ValueError), match="allowed") as caught:
            PRESETS[DEFAULT_PRESET].changed({}, {name: ["\n"] * 5000})
        assert str(caught.value).isprintable()
        assert len(str(caught.value)) < 1000
