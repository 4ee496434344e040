"""The fuzzers' verdict on environments: one that gives NaN, or what is outside of its space, is found."""

from types import SimpleNamespace
from typing import Any

import gymnasium as gym
import numpy as np
import pytest

from fuzzing import environments
from fuzzing.environments import NAMES, require_given
from fuzzing.verdict import FindingError, judge

INSIDE = np.array([[0.5, -0.5]], np.float32)


class Fake(SimpleNamespace):
    """A batch of one that gives what it is told."""

    num_envs = 1
    observation_space = gym.spaces.Box(-1.0, 1.0, (1, 2), np.float32)
    action_space = gym.spaces.Box(-1.0, 1.0, (1, 2), np.float32)
    single_action_space = gym.spaces.Box(-1.0, 1.0, (2,), np.float32)
    seen, reward, info = INSIDE, 1.0, 2.0

    def reset(self, **_: Any) -> Any:
        return INSIDE, {}

    def step(self, _: Any) -> Any:
        flags = np.array([False])
        info = {"gap": np.array([self.info]), "_gap": np.array([True])}
        return self.seen, np.array([self.reward]), flags, flags, info


WRONG = (
    ({"seen": np.array([[np.nan, 0.0]], np.float32)}, "not finite"),
    ({"seen": np.array([[1.5, 0.0]], np.float32)}, "outside of"),
    ({"seen": INSIDE.astype(np.float64)}, "outside of"),
    ({"seen": INSIDE[0]}, "outside of"),
    ({"reward": np.inf}, "not finite"),
    ({"info": np.nan}, r"info\['gap'\]"),
)


def test_what_is_right_is_accepted() -> None:
    require_given(Fake().step(None), Fake(), (1,))


@pytest.mark.parametrize(("told", "why"), WRONG)
def test_what_no_environment_may_give_is_found(told: dict[str, Any], why: str) -> None:
    env = Fake(**told)
    with pytest.raises(FindingError, match=why):
        require_given(env.step(None), env, (1,))


@pytest.mark.parametrize(("told", "why"), WRONG)
def test_every_kind_of_target_looks_at_what_comes_out(
    told: dict[str, Any], why: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(environments, "vector", lambda *_: Fake(**told))
    monkeypatch.setattr(environments, "_batch_class", lambda name: lambda **_: Fake(**told))
    name = NAMES["hover"]
    for target in (environments.arguments(name), environments.insects_flown(name)):
        with pytest.raises(FindingError, match=why):
            judge(target, bytes(40))
    for target in (environments.actions(name), environments.reset_options(name)):
        with pytest.raises(FindingError, match=why):
            judge(target, bytes([1]) + bytes(40))


def test_infos_of_rows_that_have_none_do_not_count() -> None:
    env = Fake()
    seen, *numbers, _ = env.step(None)
    require_given((seen, *numbers, {"gap": np.array([np.nan]), "_gap": np.array([False])}), env, (1,))
