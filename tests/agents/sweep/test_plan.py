"""The plan of a sweep: which runs it makes, how it is kept, and what it refuses."""

import json
import shlex
from typing import Any

import pytest

import train
from agents.commands.train import config_of, parser
from agents.presets import PRESETS
from agents.sweep.plan import SweepPlan
from agents.sweep.search_space import Choices, Range
from agents.sweep.trials import packed, unpacked

SEARCH = {"learning_rate": Range(low=1e-4, high=1e-2, log=True), "activation": Choices(values=["relu", "tanh"])}


def test_a_plan_is_seeds_times_presets_times_problems_with_seeds_outside() -> None:
    plan = SweepPlan(presets=["hover-ppo", "hover-sac"], problems=["A", "profile-drag"], seeds=2)
    names = [run.name for run in plan.grid()]
    assert len(set(names)) == 8
    assert names[:5] == [
        "hover-ppo-free-frequency-seed0",
        "hover-ppo-profile-drag-seed0",
        "hover-sac-free-frequency-seed0",
        "hover-sac-profile-drag-seed0",
        "hover-ppo-free-frequency-seed1",
    ]
    assert plan.grid()[1].group == "hover-ppo-profile-drag"
    assert plan.grid()[1].described()["task"]["problem"]["name"] == "profile-drag"


def test_letters_are_those_of_the_named_problems() -> None:
    plan = SweepPlan(presets=["hover-ppo"], problems=["A", "B", "C", "D"], insects=["hawkmoth"], seeds=1)
    assert plan.problems == ("free-frequency", "fixed-frequency", "profile-drag", "inertial")


def test_without_more_a_run_is_the_preset_under_its_own_name() -> None:
    [run] = SweepPlan(presets=["hover-ppo"], seeds=1).grid()
    assert run.name == "hover-ppo-seed0"
    assert run.config.preset == PRESETS["hover-ppo"]
    assert run.config.command == "python train.py --preset hover-ppo --seed 0"


@pytest.mark.parametrize(
    "fields",
    [
        {"problems": ["C"], "insects": ["hawkmoth", "fruitfly"], "wingbeats": 5_000, "settings": {"rows": 16}},
        {"settings": {"gradient_norm": None, "activation": "tanh", "learning_rate": 0.1 + 0.2}},
        {"search": SEARCH, "trials": 3, "problems": ["B"]},
    ],
)
def test_the_command_of_a_run_trains_the_same_alone(fields: dict[str, Any]) -> None:
    plan = SweepPlan(presets=["hover-ppo"], seeds=2, **fields)
    chosen = {"learning_rate": 0.1 / 3, "activation": "tanh"}
    runs = plan.runs_of_trial(7, chosen) if plan.search else plan.grid()
    words = shlex.split(runs[1].config.command)
    assert words[:2] == ["python", "train.py"]
    config = config_of(parser().parse_args(words[2:]), "")
    assert config.to_dict() == runs[1].config.to_dict()
    assert config.seed == 1


def test_a_config_goes_to_a_worker_and_back_as_text() -> None:
    [run] = SweepPlan(presets=["hover-sac"], problems=["C"], insects=["hawkmoth"], seeds=1, settings={"rows": 8}).grid()
    there = unpacked(packed(run.config))
    assert json.dumps(there.to_dict()) == json.dumps(run.config.to_dict())
    assert (there.name, there.seed, there.command) == (run.config.name, 0, run.config.command)


@pytest.mark.parametrize("fields", [{}, {"problems": ["A"], "settings": {"rows": 16}}, {"search": SEARCH, "trials": 3}])
def test_a_plan_comes_back_from_its_file(fields: dict[str, Any]) -> None:
    plan = SweepPlan(presets=["hover-ppo"], seeds=2, **fields)
    assert SweepPlan.from_dict(json.loads(json.dumps(plan.to_dict())), "sweep.json") == plan


def test_a_trial_has_a_run_for_every_seed() -> None:
    plan = SweepPlan(presets=["hover-ppo"], seeds=3, search=SEARCH, trials=5)
    runs = plan.runs_of_trial(2, {"learning_rate": 0.001, "activation": "tanh"})
    assert [run.name for run in runs] == ["trial0002-seed0", "trial0002-seed1", "trial0002-seed2"]
    assert {run.group for run in runs} == {"trial0002"}
    assert {run.config.preset.settings.learning_rate for run in runs} == {0.001}


@pytest.mark.parametrize(
    ("fields", "said"),
    [
        ({"presets": ["hover-pqo"]}, "presets = 'hover-pqo' is unknown; .*did you mean 'hover-ppo'"),
        ({"presets": []}, "presets = .* is not allowed; allowed: a list of at least one name"),
        ({"presets": "hover-ppo"}, "presets = 'hover-ppo' is not allowed; allowed: a list"),
        ({"presets": ["hover-ppo", "hover-ppo"]}, "presets name hover-ppo more than once"),
        ({"problems": ["E"]}, "problems = 'E' is unknown; allowed: free-frequency"),
        ({"problems": ["A", "free-frequency"]}, "problems name free-frequency more than once"),
        (
            {"presets": ["hover-ppo", "adapt-ppo"], "problems": ["A"]},
            "preset 'adapt-ppo': task 'adapt' has no argument",
        ),
        ({"insects": ["hawkmot"]}, "insect = 'hawkmot' is unknown.*did you mean 'hawkmoth'"),
        ({"seeds": 0}, "seeds = 0 is not allowed; allowed: whole numbers from 1"),
        ({"seeds": 10**9}, "seeds = 1000000000 is not allowed"),
        ({"wingbeats": 0}, "wingbeats = 0 is not allowed"),
        ({"wingbeats": 9, "settings": {"wingbeats": 9}}, "wingbeats are told twice"),
        ({"settings": {"row": 9}}, "preset 'hover-ppo': PPO has no setting 'row'.*did you mean 'rows'"),
        ({"settings": {"rows": 0}}, "preset 'hover-ppo': rows = 0"),
        ({"trials": 3}, "trials are of a search"),
        ({"search": SEARCH}, "a search needs a number of trials"),
        ({"search": SEARCH, "trials": 0}, "trials = 0 is not allowed"),
        ({"search": SEARCH, "trials": 2, "batch": 0}, "batch = 0 is not allowed"),
        ({"search": SEARCH, "trials": 2, "presets": ["hover-ppo", "hover-sac"]}, "of a search; allowed: one"),
        ({"search": SEARCH, "trials": 2, "problems": ["A", "B"]}, "problems = .* of a search; allowed: one"),
        ({"search": SEARCH, "trials": 2, "settings": {"activation": "tanh"}}, "activation is both set and searched"),
        ({"search": {"lr": Range(low=1, high=2)}, "trials": 2}, "PPO has no setting 'lr'.*allowed: wingbeats, rows"),
    ],
)
def test_a_plan_that_cannot_be_is_refused_before_anything_runs(fields: dict[str, Any], said: str) -> None:
    with pytest.raises((ValueError, TypeError), match=said):
        SweepPlan(**{"presets": ["hover-ppo"], **fields})


@pytest.mark.parametrize("content", [{"presets": ["hover-ppo"], "seed": 3}, {"presets": ["hover-ppo"], "search": []}])
def test_a_file_with_a_mistake_is_named(content: dict[str, Any]) -> None:
    with pytest.raises(TypeError, match=r"sweep\.json: "):
        SweepPlan.from_dict(content, "sweep.json")


def test_train_knows_the_command() -> None:
    assert train.COMMANDS["sweep"] == "agents.sweep.command"


@pytest.mark.parametrize(
    "told",
    [
        {"problems": [{"a": 1}]},
        {"insects": [["hawkmoth"]]},
        {"presets": [None]},
        {"settings": [None] * 3000},
        {"search": "x" * 3000},
        {"presets": {"\n": "x" * 3000}},
        {"insects": ["\x1b[2J", "\x1b[2J"]},
        {"insects": ["x" * 3000] * 2},
    ],
)
def test_what_a_changed_file_may_hold_is_refused_in_one_short_line(told: dict[str, Any]) -> None:
    with pytest.raises((TypeError, ValueError), match="allowed") as caught:
        SweepPlan.from_dict({"presets": ["hover-ppo"], **told}, "sweep.json")
    assert str(caught.value).startswith("sweep.json: ")
    assert str(caught.value).isprintable()
    assert len(str(caught.value)) < 500
