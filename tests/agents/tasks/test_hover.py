"""Hover-v0 as a task: where nobody can hover there is no distance to the optimum."""

from collections.abc import Callable

import numpy as np
import pytest

from agents.tasks import HoverTask
from flapenv.problem import HoverProblem

LOW = HoverProblem(box={"frequency_ratio": (0.3, 0.45)})


@pytest.mark.filterwarnings("ignore:.*no stroke of the box:UserWarning")
def test_a_glance_at_insects_of_which_none_can_hover_is_not_a_number_rather_than_perfect(constant: Callable) -> None:
    policy = constant(np.zeros(6))
    assert np.isnan(HoverTask(insects=["ladybird"], problem=LOW).glance(policy)).all()
    some = HoverTask(insects=["ladybird", "hoverfly"], problem=LOW).glance(policy)
    assert some[0] == some[1] > 0  # of the hoverfly alone
