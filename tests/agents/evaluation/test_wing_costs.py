"""What an answer for a new wing costs where the searches do not get there."""

import json

import numpy as np
import pytest

from agents.evaluation import wing_costs
from flapenv.problem import as_problem


class Still:
    """A policy that always answers the middle of the box."""

    def predict(self, observation: np.ndarray, *, deterministic: bool = True) -> tuple[np.ndarray, None]:
        return np.zeros((len(observation), 6)), None


def test_searches_that_miss_have_no_cost_and_the_table_says_so(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(wing_costs, "WINGS", 20)
    monkeypatch.setattr(wing_costs, "SEARCHED", 2)
    monkeypatch.setattr(wing_costs, "SEARCH_BUDGET", 3)
    costs, text = wing_costs.costs_of(Still(), as_problem("free-frequency"), 1000)
    assert costs[-1] == {"name": "multi-start SLSQP", "wings": 1, "wingbeats": None, "seconds": None}
    json.dumps(costs, allow_nan=False)
    assert "half or more of 2 wings did not get to a gap of 0.1 % in 3 wingbeats" in text
    assert "such searches" not in text
