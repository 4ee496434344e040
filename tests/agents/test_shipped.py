"""The policies that come with the repository are what their cards say."""

import pytest

from agents.policy_file import load_policy, shipped_policies
from agents.presets import PRESETS, Preset
from agents.tasks import TASKS, HoverTask, Task
from flapenv import FunctionPlanform, Insect, Stroke, Wing

NAMES = ("hover", "random-wings", "adapt", "waveform", "heave")
LARGEST = 200_000
QUICK = ("hover", "adapt", "waveform")
"""Tasks judged in a second or two."""


def task_of(name: str) -> Task:
    _, card = load_policy(name)
    arguments = {key: value for key, value in card.task.items() if key != "name"}
    return Preset(task=card.task["name"], arguments=arguments, settings=None).make_task()


def test_there_is_one_for_every_task() -> None:
    assert set(shipped_policies()) == set(NAMES) == set(TASKS)


@pytest.mark.parametrize("name", NAMES)
def test_it_is_small_fits_its_environment_and_tells_how_it_was_trained(name: str) -> None:
    path = shipped_policies()[name]
    assert path.stat().st_size + path.with_suffix(".json").stat().st_size <= LARGEST
    _, card = load_policy(name)
    task = task_of(name)
    card.require_fit(task.vector_env(1))
    assert card.environment == task.environment
    assert card.preset in PRESETS
    assert card.command == f"python train.py --preset {card.preset} --seed {card.seed}"
    assert card.wingbeats >= PRESETS[card.preset].settings.wingbeats


@pytest.mark.parametrize("name", QUICK)
def test_it_is_as_far_from_its_reference_as_its_card_says(name: str) -> None:
    actor, card = load_policy(name)
    verdict = task_of(name).judge(actor)
    assert verdict.mean == pytest.approx(card.result["mean"], rel=0.02, abs=1e-5)
    assert verdict.worst == pytest.approx(card.result["worst"], rel=0.02, abs=1e-5)


@pytest.mark.parametrize("name", sorted(set(NAMES) - set(QUICK)))
def test_a_glance_is_near_what_the_card_says(name: str) -> None:
    actor, card = load_policy(name)
    mean, _ = task_of(name).glance(actor)
    assert mean == pytest.approx(card.result["mean"], rel=0.5)


def test_the_policy_for_every_wing_flies_a_wing_of_ones_own() -> None:
    robot = Insect(
        name="robot",
        mass=1.0e-4,
        wing=Wing(length=0.015, mean_chord=0.004, planform=FunctionPlanform(function=lambda r: (r * (1 - r)) ** 0.5)),
        stroke=Stroke(frequency=120.0, flap_amplitude=1.0, pitch_amplitude=0.9),
    )
    actor, _ = load_policy("random-wings")
    verdict = HoverTask(insects=[robot]).judge(actor)
    assert verdict.mean is not None
    assert abs(verdict.mean) < 0.1
