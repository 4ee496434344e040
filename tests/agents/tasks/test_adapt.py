"""HoverAdapt-v0 as a task: references flown as policies score what the task says of the references."""

import json
from collections.abc import Callable
from typing import Any

import numpy as np
import pytest

from agents.tasks import adapt
from agents.tasks.adapt import HoverAdaptTask
from flapenv.adapt.references import LadderClimber
from flapenv.adapt.task import AdaptTask
from flapenv.adapt.tuning import action_of, shipped
from flapenv.insects import Insect, load_insect

DRAWS = 64


@pytest.fixture(autouse=True)
def few_draws(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(adapt, "DRAWS", DRAWS)


class Ladder:
    """The ladder controller of one insect, flown from what a policy sees."""

    def __init__(self, insect: Insect) -> None:
        tuned = shipped(insect)
        assert tuned is not None
        self.task = AdaptTask((insect,))
        self.places = tuned.ladder_height, tuned.ladder_gain, tuned.ladder_margin

    def predict(self, observation: np.ndarray, *, deterministic: bool) -> tuple[np.ndarray, Any]:
        rows = len(observation)
        if np.all(observation[:, -1] == 1):
            self.climber = LadderClimber(self.task, np.zeros(rows, dtype=np.intp), *self.places)
            self.climber.feel(np.ones(rows), np.zeros(rows, dtype=bool))
        else:
            self.climber.feel(1.0 + observation[:, 3], np.ones(rows, dtype=bool))
        beats = self.climber.beats()
        amplitude, lift = np.broadcast_to(beats.amplitude, rows), np.broadcast_to(beats.lift, rows)
        return np.array([action_of(self.task, *one) for one in zip(amplitude, lift, strict=True)]), None


def test_the_fixed_strokes_action_scores_what_the_fixed_stroke_does(constant: Callable) -> None:
    tuned = shipped(load_insect("hawkmoth"))
    assert tuned is not None
    verdict = HoverAdaptTask(insects="hawkmoth").judge(constant(tuned.fixed_action))
    entry = verdict.results["insects"]["hawkmoth"]
    assert entry["return/policy"] == pytest.approx(entry["return/fixed_stroke"], abs=1e-3)
    assert abs(entry["over/fixed_stroke"]["mean"]) < 1e-3
    assert entry["over/fixed_stroke"]["interval_95"] < 1e-3
    assert entry["over/lift_ladder"]["mean"] < -entry["over/lift_ladder"]["interval_95"]
    best = entry["return/full_knowledge"]
    assert verdict.mean == verdict.worst == pytest.approx((best - entry["return/policy"]) / abs(best))


def test_a_policy_that_climbs_the_ladder_scores_as_the_ladder() -> None:
    insect = load_insect("hawkmoth")
    entry = HoverAdaptTask(insects=insect).judge(Ladder(insect)).results["insects"]["hawkmoth"]
    assert entry["over/lift_ladder"]["mean"] == pytest.approx(0, abs=2e-3)
    assert entry["over/lift_ladder"]["interval_95"] < 2e-3
    assert entry["over/felt_lift"]["mean"] > 2


def test_the_glance_is_the_verdict_on_fewer_draws(constant: Callable, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(adapt, "DRAWS", adapt.GLANCES)
    task, policy = HoverAdaptTask(insects=["hawkmoth", "cranefly"]), constant([0.5, 0.2, 0.3, 0.4, 0.0])
    verdict = task.judge(policy)
    assert task.glance(policy) == task.glance(policy) == pytest.approx((verdict.mean, verdict.worst), rel=1e-4)
    shares = [entry["lost"] for entry in verdict.results["insects"].values()]
    assert verdict.mean == pytest.approx(np.mean(shares))
    assert verdict.worst == max(shares)


def test_an_insect_of_ones_own_has_full_knowledge_alone_beside_it(constant: Callable) -> None:
    own = Insect(**load_insect("hawkmoth").to_dict() | {"name": "mine"})
    verdict = HoverAdaptTask(insects=["honeybee", own]).judge(constant(np.zeros(5)))
    entry = verdict.results["insects"]["mine"]
    assert entry["return/full_knowledge"] > entry["return/policy"]
    assert entry["return/lift_ladder"] is None
    assert entry["over/lift_ladder"] is None
    assert np.isfinite(verdict.mean)
    json.dumps(verdict.results, allow_nan=False)
    line = next(line for line in verdict.text.splitlines() if line.startswith("mine"))
    assert line.split()[2:5] == ["-", "-", "-"]


def test_its_arguments_come_back_from_json_and_its_environment_trains(constant: Callable) -> None:
    task = HoverAdaptTask(insects=["hawkmoth", "cranefly"])
    again = HoverAdaptTask(**json.loads(json.dumps(task.to_dict())))
    assert again == task
    env = again.vector_env(3)
    env.reset(seed=0)
    *_, infos = env.step(np.zeros((3, 5)))
    assert infos == {}
    assert {insect.name for insect in env.insects} == {"hawkmoth", "cranefly"}
    with pytest.raises(ValueError, match="wasp"):
        HoverAdaptTask(insects="wasp")


def test_the_picture_shows_every_reference(constant: Callable) -> None:
    figure = HoverAdaptTask(insects=["hawkmoth", "cranefly"]).draw(constant(np.zeros(5)))
    lift, one, mean = figure.axes
    assert len(lift.lines) == 3  # hovering, the policy's, the change
    assert len(one.lines) == len(mean.lines) + 1 == 6
    assert [line.get_label() for line in mean.lines][-1] == "policy"
