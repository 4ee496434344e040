"""Verdicts are reached in double precision, whatever precision a policy was trained in."""

from collections.abc import Callable
from typing import Any

import numpy as np
import pytest

from agents import heave_flights
from agents.evaluation import comparison
from agents.tasks import HoverTask, adapt, heave, waveform, wing_flights
from agents.tasks.adapt import HoverAdaptTask
from agents.tasks.heave import HeaveTask
from agents.tasks.waveform import WaveformTask
from agents.tasks.wing_flights import WingPool
from flapenv.problem import HoverProblem


def judge_wings(policy: Any) -> None:
    WingPool(4, split="test", problem=HoverProblem(), seed=0).fly(policy)


@pytest.mark.parametrize(
    ("module", "environment", "judge", "size"),
    [
        (comparison, "HoverVectorEnv", lambda policy: HoverTask(insects=["hawkmoth"]).judge(policy), 6),
        (wing_flights, "HoverVectorEnv", judge_wings, 6),
        (waveform, "WaveformVectorEnv", lambda policy: WaveformTask(insects="hawkmoth").judge(policy), 18),
        (adapt, "HoverAdaptVectorEnv", lambda policy: HoverAdaptTask(insects="hawkmoth").judge(policy), 5),
        (heave_flights, "HeaveVectorEnv", lambda policy: HeaveTask(insects="hawkmoth").judge(policy), 5),
    ],
    ids=["hover", "random-wings", "waveform", "adapt", "heave"],
)
def test_every_beat_that_is_judged_is_computed_in_double_precision(
    module: Any,
    environment: str,
    judge: Callable[[Any], Any],
    size: int,
    constant: Callable,
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    made = []
    kind = getattr(module, environment)

    def noted(*arguments: Any, **options: Any) -> Any:
        made.append(kind(*arguments, **options))
        return made[-1]

    monkeypatch.setattr(module, environment, noted)
    monkeypatch.setattr(adapt, "DRAWS", 2)
    monkeypatch.setattr(heave, "EPISODES", 2)
    monkeypatch.setattr(heave, "RATIOS", (2.0, 0.2))
    heave.lqg_flights.cache_clear()
    judge(constant(np.zeros(size)))
    heave.lqg_flights.cache_clear()
    assert made
    assert {env.dtype for env in made} == {np.dtype("float64")}
