"""Heave-v0 as a task: LQG flown as a policy is level with LQG."""

import json
from collections.abc import Callable
from typing import Any

import numpy as np
import pytest

from agents import lqg as front_module
from agents.heave_flights import fly
from agents.lqg import fly_every
from agents.lqg_controller import Lqg, OneEach, lqg
from agents.tasks import heave, heave_picture
from agents.tasks.heave import HeaveTask
from agents.tasks.held_out import HELD_OUT_SEED

EPISODES = 32
RATIOS = (20.0, 2.0, 0.2)
TRIM = [0.4, 1, 1, 1, 0]


class Flying:
    """A controller as a policy; an episode begins where the last action seen is the one that hovers."""

    def __init__(self, controller: Lqg | OneEach) -> None:
        self.controller = controller

    def predict(self, observation: np.ndarray, *, deterministic: bool) -> tuple[np.ndarray, Any]:
        if np.all(observation[:, 2] == 0):
            self.controller.start()
        return self.controller(observation), None


@pytest.fixture(autouse=True)
def few_flights(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(heave, "EPISODES", EPISODES)
    monkeypatch.setattr(heave, "RATIOS", RATIOS)
    heave.lqg_flights.cache_clear()


def test_the_best_lqg_is_level_with_the_best_lqg() -> None:
    verdict = HeaveTask(insects="hawkmoth").judge(Flying(lqg("hawkmoth", 0.2)))
    entry = verdict.results["insects"]["hawkmoth"]
    assert verdict.mean == verdict.worst == pytest.approx(0, abs=1e-9)
    assert entry["power_over_front_at_equal_height"] == pytest.approx(0, abs=1e-9)
    assert entry["return"] == entry["return/lqg"] > -2
    assert entry["lost"] == 0
    json.dumps(verdict.results, allow_nan=False)


def test_the_cost_of_a_beat_is_the_return_over_the_beats() -> None:
    verdict = HeaveTask(insects="hawkmoth").judge(Flying(lqg("hawkmoth", 20.0)))
    entry = verdict.results["insects"]["hawkmoth"]
    assert verdict.mean == pytest.approx((entry["return/lqg"] - entry["return"]) / 200)
    assert 0 < entry["cost_above_lqg_interval_95"] < verdict.mean
    assert entry["rms_height"] > entry["rms_height/lqg"]


def test_holding_the_trim_is_lost(constant: Callable) -> None:
    verdict = HeaveTask(insects=["hawkmoth", "cranefly"]).judge(constant(TRIM))
    assert verdict.worst > verdict.mean > 1
    assert all(entry["lost"] > 0 for entry in verdict.results["insects"].values())
    assert len(verdict.text.splitlines()) == 4


def test_a_glance_flies_every_insect_beside_its_own_lqg(constant: Callable) -> None:
    names = ["hawkmoth", "cranefly"]
    task = HeaveTask(insects=names)
    own = OneEach([lqg(name, heave.GLANCED_RATIO) for name in names], heave.GLANCES)
    assert task.glance(Flying(own)) == (0, 0)
    mean, worst = task.glance(constant(TRIM))
    assert worst > mean > 1


def test_held_out_gusts_are_not_those_of_a_seed_that_is_trained_on() -> None:
    seen = [fly(lqg("hawkmoth", 1.0), insect="hawkmoth", episodes=4, seed=seed).returns for seed in (0, HELD_OUT_SEED)]
    assert not np.any(seen[0] == seen[1])


def test_its_arguments_come_back_from_json_and_its_environment_trains() -> None:
    task = HeaveTask(insects=["hawkmoth", "cranefly"])
    again = HeaveTask(**json.loads(json.dumps(task.to_dict())))
    assert again == task
    env = again.vector_env(3)
    env.reset(seed=0)
    *_, infos = env.step(np.tile(TRIM, (3, 1)))
    assert infos == {}
    assert env.beats == heave.BEATS


def test_the_picture_puts_the_policy_on_the_front(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(heave_picture, "RATIOS", RATIOS)
    monkeypatch.setattr(heave_picture, "EPISODES", EPISODES)
    controller = lqg("hawkmoth", 0.2)
    figure = HeaveTask(insects="hawkmoth").draw(Flying(controller))
    left, height, gust, amplitude = figure.axes
    flown = fly_every(lqg, front_module.as_insect("hawkmoth"), ratios=(0.2,), episodes=EPISODES, seed=HELD_OUT_SEED)[0]
    star = next(line for line in left.lines if str(line.get_label()).startswith("policy"))
    assert star.get_xdata()[0] == pytest.approx(flown.rms_height)
    for axes in (height, amplitude):
        best, policy = (line.get_ydata() for line in axes.lines)
        np.testing.assert_allclose(best, policy)
    assert len(gust.lines) == 1
