"""Two insects judged together are two insects: each beside its own references, on draws that training never meets."""

from collections.abc import Callable
from typing import Any

import numpy as np
import pytest

from agents.lqg_controller import Lqg, lqg
from agents.tasks import adapt, heave
from agents.tasks.adapt import HoverAdaptTask
from agents.tasks.heave import HeaveTask
from agents.tasks.held_out import HELD_OUT_SEED
from flapenv.envs.hover_adapt import HoverAdaptVectorEnv

PAIR = ["hawkmoth", "cranefly"]
ACTIONS = [0.6, 0.2, 0.3, 0.4, 0.0], [-0.4, 0.1, -0.2, 0.3, 0.5]
EPISODES, GLANCES = 6, 4


@pytest.fixture(autouse=True)
def few_episodes(monkeypatch: pytest.MonkeyPatch) -> None:
    """As many as take a moment."""
    monkeypatch.setattr(adapt, "DRAWS", EPISODES)
    monkeypatch.setattr(adapt, "GLANCES", GLANCES)
    monkeypatch.setattr(heave, "EPISODES", EPISODES)
    monkeypatch.setattr(heave, "GLANCES", GLANCES)
    monkeypatch.setattr(heave, "RATIOS", (2.0, 0.2))
    heave.lqg_flights.cache_clear()


def each_its_own(rows: int) -> np.ndarray:
    """The action of every row, as many of each insect."""
    return np.repeat(np.array(ACTIONS, dtype=np.float32), rows, axis=0)


def hovered(actions: np.ndarray, seed: int) -> dict[str, np.ndarray]:
    """Returns of both insects in HoverAdapt, flown here: of the policy and of full knowledge, shape (2, draws)."""
    names = np.repeat(PAIR, len(actions) // 2)
    env = HoverAdaptVectorEnv(len(actions), insect=PAIR, dtype="float64", autoreset_mode="DISABLED")
    env.reset(seed=seed, options={"insect": list(names)})
    for _ in range(env.beats):
        *_, info = env.step(actions)
    assert list(info["insect"]) == list(names)
    return {key: np.stack([info[key][names == name] for name in PAIR]) for key in ("return", "return/full_knowledge")}


def shares_lost(returns: dict[str, np.ndarray]) -> np.ndarray:
    """What each of both loses to full knowledge, over what that gets."""
    own, best = (np.mean(values, axis=1) for values in returns.values())
    return (best - own) / np.abs(best)


def test_hovering_in_hidden_conditions_is_judged_insect_by_insect_on_held_out_draws(constant: Callable) -> None:
    actions = each_its_own(EPISODES)
    verdict = HoverAdaptTask(insects=PAIR).judge(constant(actions))
    returns = hovered(actions, HELD_OUT_SEED)
    lost = shares_lost(returns)
    entries = verdict.results["insects"]
    for name, own, best, share in zip(PAIR, *returns.values(), lost, strict=True):
        assert entries[name]["return/policy"] == pytest.approx(np.mean(own))
        assert entries[name]["return/full_knowledge"] == pytest.approx(np.mean(best))
        assert entries[name]["lost"] == pytest.approx(share)
    assert (verdict.mean, verdict.worst) == pytest.approx((np.mean(lost), np.max(lost)))
    together = verdict.results["all"]
    assert together["return/policy"] == pytest.approx(np.mean(returns["return"]))
    assert together["return/full_knowledge"] == pytest.approx(np.mean(returns["return/full_knowledge"]))
    assert together["lost"] == verdict.mean
    assert shares_lost(hovered(actions, 0)) != pytest.approx(lost, rel=1e-3)


def test_two_insects_in_hidden_conditions_fare_as_each_of_them_alone(
    constant: Callable, monkeypatch: pytest.MonkeyPatch
) -> None:
    """On draws of their own, so that they are alike as far as means of many are."""
    monkeypatch.setattr(adapt, "DRAWS", 128)
    both = HoverAdaptTask(insects=PAIR).judge(constant(each_its_own(128))).results["insects"]
    alone = [HoverAdaptTask(insects=name).judge(constant(act)).mean for name, act in zip(PAIR, ACTIONS, strict=True)]
    assert [both[name]["lost"] for name in PAIR] == pytest.approx(alone, rel=0.1)
    assert abs(alone[0] - alone[1]) > 0.5 * max(alone)


def test_a_glance_at_hidden_conditions_is_insect_by_insect_on_held_out_draws(constant: Callable) -> None:
    actions = each_its_own(GLANCES)
    lost = shares_lost(hovered(actions, HELD_OUT_SEED))
    glance = HoverAdaptTask(insects=PAIR).glance(constant(actions))
    assert glance == pytest.approx((np.mean(lost), np.max(lost)), rel=1e-4)
    assert shares_lost(hovered(actions, 0)) != pytest.approx(lost, rel=1e-3)


class Holding:
    """LQG of the rows before `until`; the rest hold the action that hovers. An episode begins with each `start`."""

    def __init__(self, controller: Lqg, until: int) -> None:
        self.controller, self.until = controller, until

    def start(self) -> None:
        self.controller.start()

    def predict(self, observation: np.ndarray, *, deterministic: bool) -> tuple[np.ndarray, Any]:
        trim = np.tile([0.4, 1.0, 1.0, 1.0, 0.0], (len(observation) - self.until, 1))
        return np.concatenate([self.controller(observation[: self.until]), trim]), None


def test_holding_height_is_judged_beside_each_insects_own_lqg(constant: Callable) -> None:
    policy = constant([0.45, 0.9, 0.9, 0.9, 0.0])
    both = HeaveTask(insects=PAIR).judge(policy)
    alone = [HeaveTask(insects=name).judge(policy) for name in PAIR]
    for name, one in zip(PAIR, alone, strict=True):
        assert both.results["insects"][name] == one.results["insects"][name]
    assert both.mean == pytest.approx(np.mean([one.mean for one in alone]))
    assert both.worst == max(one.worst for one in alone)
    entries = [both.results["insects"][name] for name in PAIR]
    assert entries[0]["return/lqg"] != entries[1]["return/lqg"]


def test_a_glance_tells_the_insect_that_is_held_from_the_one_that_falls() -> None:
    held = Holding(lqg(PAIR[0], heave.GLANCED_RATIO), GLANCES)
    mean, worst = HeaveTask(insects=PAIR).glance(held)
    assert worst == pytest.approx(2 * mean)  # nothing behind on the first
    assert mean > 1
