"""Every task says when episodes begin, so that a policy with memory brings nothing along from others."""

from collections.abc import Callable
from typing import Any

import numpy as np
import pytest

from agents.predictor import Predictor
from agents.tasks import HoverTask
from agents.tasks.adapt import HoverAdaptTask
from agents.tasks.heave import HeaveTask
from agents.tasks.waveform import WaveformTask
from agents.tasks.wing_flights import WingPool
from flapenv.problem import HoverProblem


class Counting:
    """Knows how many of its episodes' beats it has flown; does the same in all of them."""

    def __init__(self, size: int) -> None:
        self.size, self.starts, self.beats = size, 0, 0

    def start(self) -> None:
        self.starts, self.beats = self.starts + 1, 0

    def predict(self, observation: np.ndarray, *, deterministic: bool) -> tuple[np.ndarray, Any]:
        assert deterministic
        assert self.starts > 0
        self.beats += 1
        return np.zeros((len(observation), self.size), dtype=np.float32), None


def fly_wings(policy: Predictor) -> None:
    WingPool(4, split="test", problem=HoverProblem(), seed=0).fly(policy)


@pytest.mark.parametrize(
    ("fly", "size", "beats"),
    [
        (lambda policy: HoverTask(insects=["hawkmoth"]).glance(policy), 6, 1),
        (fly_wings, 6, 1),
        (lambda policy: WaveformTask(insects="hawkmoth").glance(policy), 18, 1),
        (lambda policy: HoverAdaptTask(insects="hawkmoth").glance(policy), 5, 20),
        (lambda policy: HeaveTask(insects="hawkmoth").glance(policy), 5, 200),
    ],
    ids=["hover", "random-wings", "waveform", "adapt", "heave"],
)
def test_a_policy_is_told_that_episodes_begin(fly: Callable[[Predictor], Any], size: int, beats: int) -> None:
    policy = Counting(size)
    for times in (1, 2):
        fly(policy)
        assert policy.starts == times
        assert 0 < policy.beats <= beats
