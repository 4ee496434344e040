"""The comparison of a policy with optimum and CFD."""

from typing import Any

import numpy as np
import pytest

from agents.evaluation.assessment_table import assessment_table
from agents.evaluation.comparison import Comparison, mean_gap
from flapenv import INSECTS, HoverProblem, evaluate, load_insect, optimum
from flapenv.coordinates import StrokeCoordinates


class Fixed:
    """A policy that knows the actions, one row an insect."""

    def __init__(self, actions: np.ndarray) -> None:
        self.actions = actions.astype(np.float32)

    def predict(self, observation: np.ndarray, *, deterministic: bool) -> tuple[np.ndarray, Any]:
        assert deterministic
        assert len(observation) == len(self.actions)
        return self.actions, None


def optimal_actions(problem: HoverProblem) -> np.ndarray:
    coordinates = StrokeCoordinates(problem.box)
    return np.stack(
        [coordinates.encode(vars(optimum(name, problem).stroke), load_insect(name).reference) for name in INSECTS]
    )


def test_the_optimal_actions_have_no_gap_and_the_table_shows_every_reference() -> None:
    comparison = Comparison([load_insect(name) for name in INSECTS], HoverProblem())
    policy = Fixed(optimal_actions(HoverProblem()))
    results = comparison.results(policy)
    assert np.max(np.abs(comparison.gaps(policy))) < 1e-4
    assert mean_gap(results) == pytest.approx(0, abs=1e-5)
    for result in results:
        entry = result.to_dict()
        assert entry["feasible"] is True
        assert entry["optimum_specific_power"] == optimum(result.insect).specific_power
        assert entry["own_stroke_specific_power"] == evaluate(result.insect).specific_power
        assert entry["cfd_specific_power"] == result.insect.cfd.specific_power
        assert set(entry["stroke"]) == set(vars(result.stroke))
    table = assessment_table(results)
    for name in INSECTS:
        assert name in table
    assert "worst 0.0" in table


def test_a_stroke_that_drops_the_insect_is_charged_for_it() -> None:
    comparison = Comparison([load_insect("hawkmoth")], HoverProblem())
    action = optimal_actions(HoverProblem())[INSECTS.index("hawkmoth")] - np.array([0.05, 0, 0, 0, 0, 0])
    (result,) = comparison.results(Fixed(action[None]))
    missing = 1 - result.weight_support
    assert missing > 0.05
    saved = result.specific_power / result.best.specific_power - 1
    assert result.gap == pytest.approx(saved + 10 * missing)


@pytest.mark.filterwarnings("ignore:.*no stroke of the box:UserWarning")
def test_an_infeasible_insect_is_named_and_left_out_of_the_mean() -> None:
    problem = HoverProblem(box={"frequency_ratio": (0.3, 0.45)})
    insects = [load_insect(name) for name in ("ladybird", "hoverfly")]
    results = Comparison(insects, problem).results(Fixed(np.zeros((2, 6))))
    assert [result.gap is None for result in results] == [True, False]
    entry = results[0].to_dict()
    assert entry["gap_percent"] is None
    assert entry["optimum_specific_power"] is None
    assert entry["lift_shortfall"] > 0
    assert mean_gap(results) == results[1].gap
    assert mean_gap(results[:1]) is None
    assert "ladybird is INFEASIBLE: no stroke of the box supports more than 0." in assessment_table(results)
