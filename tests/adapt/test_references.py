"""The references: exact short cuts, tuned optima, shipped numbers, and what the measurements say."""

import dataclasses

import numpy as np
import pytest

from flapenv import load_insect
from flapenv.adapt import AdaptTask
from flapenv.adapt.references import (
    COORDINATES,
    FeltLift,
    FixedStroke,
    LadderClimber,
    Trials,
    beats_of,
    best_returns,
    fixed_returns,
    fly,
)
from flapenv.adapt.report import blind_loss, losses_table, references_table
from flapenv.adapt.task import NOISE
from flapenv.adapt.tuning import NAMES, Tuned, action_of, draws_of, scores, shipped, shipped_rows

INSECT = "dronefly"


@pytest.fixture(scope="module")
def task() -> AdaptTask:
    return AdaptTask((load_insect(INSECT),))


@pytest.fixture(scope="module")
def train(task: AdaptTask) -> Trials:
    return draws_of(task, "train")


@pytest.fixture(scope="module")
def tuned() -> Tuned:
    found = shipped(load_insect(INSECT))
    assert found is not None
    return found


@pytest.mark.parametrize("split", ["train", "test"])
def test_the_shipped_returns_are_what_flying_gives(task: AdaptTask, tuned: Tuned, split: str) -> None:
    row = shipped_rows()[INSECT]
    for name, returns in scores(task, tuned, draws_of(task, split)).items():
        assert np.mean(returns) == pytest.approx(float(row[f"{split}_return/{name}"]), abs=2e-3)
        error = np.std(returns) / np.sqrt(len(returns))
        assert error == pytest.approx(float(row[f"{split}_error/{name}"]), rel=1e-2)


def test_nothing_beats_full_knowledge_on_any_draw(task: AdaptTask, tuned: Tuned, train: Trials) -> None:
    found = scores(task, tuned, train)
    assert tuple(found) == NAMES
    for returns in found.values():
        assert np.all(returns <= found["full_knowledge"] + 1e-9)


def test_adapting_pays_and_the_ladder_pays_most(task: AdaptTask, tuned: Tuned) -> None:
    found = scores(task, tuned, draws_of(task, "test"))
    for worse, better in (
        ("fixed_stroke", "felt_lift"),
        ("felt_lift", "lift_ladder"),
        ("lift_ladder", "full_knowledge"),
    ):
        gain = found[better] - found[worse]
        assert np.mean(gain) > 5 * np.std(gain) / np.sqrt(len(gain))


def test_a_fixed_stroke_flown_beat_by_beat_gives_the_short_cuts_return(task: AdaptTask, train: Trials) -> None:
    beats = beats_of(np.array([0.5, -0.5, 0.3, 0.2, 0.1]))
    np.testing.assert_allclose(fly(task, FixedStroke(beats), train), fixed_returns(task, beats, train), rtol=1e-12)


def test_no_fixed_stroke_of_all_five_parameters_does_better(
    task: AdaptTask, tuned: Tuned, train: Trials, rng: np.random.Generator
) -> None:
    best = np.mean(fixed_returns(task, beats_of(np.array(tuned.fixed_action)), train))
    near = np.clip(tuned.fixed_action + rng.normal(0, 1, (150, 5)) * 10 ** rng.uniform(-3, -0.5, (150, 1)), -1, 1)
    for action in np.concatenate([near, rng.uniform(-1, 1, (100, 5))]):
        assert np.mean(fixed_returns(task, beats_of(action), train)) <= best + 1e-3


def test_gains_and_margins_are_at_their_best(task: AdaptTask, tuned: Tuned, train: Trials) -> None:
    felt, gain, margin = beats_of(np.array(tuned.felt_action)), tuned.felt_gain, tuned.felt_margin
    height = tuned.ladder_height

    def felt_return(gain: float, margin: float) -> float:
        return float(np.mean(fly(task, FeltLift(felt, gain, margin), train)))

    def ladder_return(height: float, gain: float, margin: float) -> float:
        return float(np.mean(fly(task, LadderClimber(task, train.index, height, gain, margin), train)))

    for other in ((0.8 * gain, margin), (1.2 * gain, margin), (gain, margin - 0.01), (gain, margin + 0.01)):
        assert felt_return(*other) < felt_return(gain, margin)
    climb = (height, tuned.ladder_gain, tuned.ladder_margin)
    for change in ((0.97, 1, 0), (1.03, 1, 0), (1, 0.8, 0), (1, 1.2, 0), (1, 1, -0.01), (1, 1, 0.01)):
        other = climb[0] * change[0], climb[1] * change[1], climb[2] + change[2]
        assert ladder_return(*other) < ladder_return(*climb)


def test_without_noise_the_ladder_needs_one_beat_after_every_surprise(
    task: AdaptTask, tuned: Tuned, train: Trials
) -> None:
    quiet = dataclasses.replace(train, noise=np.ones_like(train.noise))
    lost = best_returns(quiet) - fly(task, LadderClimber(task, quiet.index, tuned.ladder_height, 1.0, 0.0), quiet)
    blind = blind_loss(task, tuned.ladder_height, quiet)
    assert np.mean(lost) == pytest.approx(np.mean(blind), rel=0.02)


def test_what_is_felt_is_two_percent_off(train: Trials) -> None:
    logs = np.log(train.noise)
    assert np.std(logs) == pytest.approx(NOISE, rel=0.02)
    assert abs(np.mean(logs)) < 5 * NOISE / np.sqrt(logs.size)


def test_actions_stand_for_the_cheapest_waveform_of_a_lift(task: AdaptTask) -> None:
    action = action_of(task, 1.4, 1.0)
    beats = beats_of(np.array(action))
    assert beats.amplitude == pytest.approx(1.4, rel=1e-5)
    assert beats.lift == pytest.approx(1.0, rel=1e-4)
    assert len(action) == len(COORDINATES)


def test_an_insect_that_only_bears_a_shipped_name_has_no_shipped_references() -> None:
    heavier = dataclasses.replace(load_insect(INSECT), mass=1e-4)
    assert shipped(heavier) is None
    assert shipped(dataclasses.replace(heavier, name="own")) is None


def test_the_report_names_every_insect_and_where_the_ladder_loses() -> None:
    table = references_table()
    for name in shipped_rows():
        assert name in table
    assert "without noise" in losses_table(INSECT)
