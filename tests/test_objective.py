"""The exact penalty: the reward's optimum is the constrained optimum."""

import math
import warnings

import numpy as np
import pytest
from scipy.optimize import differential_evolution

from flapenv import HoverProblem, Insect, load_insect, optimum
from flapenv.coordinates import StrokeCoordinates
from flapenv.objective import HoverObjective


def reward_of(objective: HoverObjective, points: np.ndarray) -> np.ndarray:
    """Rewards of the first insect at points of the cube, shape (n, axes)."""
    coordinates = StrokeCoordinates(objective.problem.box)
    values, _ = coordinates.decode(points, objective.flyers[0].reference)
    return objective.score(np.zeros(len(points), dtype=int), values).reward


@pytest.mark.parametrize("name", ["fruitfly", "hoverfly", "ladybird"])
def test_the_rewards_own_optimum_is_the_constrained_optimum(name: str) -> None:
    insect = load_insect(name)
    objective = HoverObjective([insect], HoverProblem())
    best = optimum(insect)
    found = differential_evolution(
        lambda points: -reward_of(objective, points.T),
        [(-1, 1)] * 6,
        vectorized=True,
        updating="deferred",
        seed=0,
        tol=1e-12,
        atol=1e-12,
        maxiter=600,
        popsize=12,
    )
    assert -found.fun == pytest.approx(-best.specific_power / best.lower_bound, abs=1e-5)
    values, _ = StrokeCoordinates(HoverProblem().box).decode(found.x[None], insect.reference)
    assert values["frequency"][0] == pytest.approx(best.stroke.frequency, rel=1e-3)
    score = objective.score(np.zeros(1, dtype=int), values)
    assert score.weight_support[0] == pytest.approx(1, abs=1e-5)
    assert score.optimality_gap[0] == pytest.approx(0, abs=1e-5)


def test_a_penalty_below_the_multiplier_sells_the_weight_and_is_warned_about() -> None:
    insect = load_insect("hawkmoth")
    with pytest.warns(UserWarning, match="lift_penalty = 0.5 is below the multiplier 1.57 of hawkmoth"):
        weak = HoverObjective([insect], HoverProblem(lift_penalty=0.5))
    strong = HoverObjective([insect], HoverProblem())
    best = StrokeCoordinates(HoverProblem().box).encode(vars(optimum(insect).stroke), insect.reference)
    slower = best - np.array([0.02, 0, 0, 0, 0, 0])
    assert reward_of(weak, slower[None]) > reward_of(weak, best[None])
    assert reward_of(strong, slower[None]) < reward_of(strong, best[None])


def test_penalties_are_twice_the_multiplier_at_least_three_and_ten_where_infeasible() -> None:
    insect = load_insect("ladybird")
    expected = max(3, 2 * 1.5 * 1.0453)
    assert HoverObjective([insect], HoverProblem()).lift_penalty[0] == pytest.approx(expected, rel=1e-3)
    hopeless = HoverProblem(box={"frequency_ratio": (0.1, 0.2)})
    assert HoverObjective([insect], hopeless).lift_penalty[0] == 10
    slack = HoverProblem(box={"frequency_ratio": (6.0, 7.0)})
    assert HoverObjective([insect], slack).lift_penalty[0] == 3
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        assert HoverObjective([insect], HoverProblem(lift_penalty=4)).lift_penalty[0] == 4


def test_a_floor_above_the_best_reward_is_warned_about() -> None:
    with pytest.warns(UserWarning, match=r"reward_floor = -1 is above the reward -1\.05 of the optimum of hawkmoth"):
        HoverObjective([load_insect("hawkmoth")], HoverProblem(reward_floor=-1))


def test_terms_add_up_to_the_reward_above_its_floor(insect: Insect, rng: np.random.Generator) -> None:
    objective = HoverObjective([insect], HoverProblem())
    coordinates = StrokeCoordinates(HoverProblem().box)
    values, _ = coordinates.decode(rng.uniform(-1, 1, (500, 6)), insect.reference)
    score = objective.score(np.zeros(500, dtype=int), values)
    np.testing.assert_allclose(score.reward, np.maximum(-20, score.power_term + score.lift_term))
    assert np.all(score.power_term < 0)
    assert np.all((score.lift_term < 0) == (score.weight_support < 1))
    assert np.min(score.optimality_gap) > 0
    assert np.all(score.bound_gap > score.optimality_gap * 0.99)
    assert score.reward.min() >= -20


def test_a_steep_multiplier_is_charged_double_in_units_of_each_reference() -> None:
    pitch = (math.radians(30), math.radians(85))
    box = {"flap_amplitude": 1.0, "pitch_amplitude": pitch, "pitch_phase": math.pi / 2}
    largest = optimum("hawkmoth", HoverProblem(box={**box, "frequency": 26.3})).max_weight_support
    steep = HoverProblem(box={**box, "frequency": 26.3 * math.sqrt(1.01 / largest)})  # lifts 1 % more than it must
    best = optimum("hawkmoth", steep)
    charge = 2 * best.multiplier / best.specific_power
    assert charge > 10
    objective = HoverObjective([load_insect("hawkmoth")], steep)
    assert best.gap(0.99, best.specific_power) == pytest.approx(0.01 * charge)
    values, _ = StrokeCoordinates(steep.box).decode(np.array([[-0.9, 0.5, 0.5]]), load_insect("hawkmoth").reference)
    score = objective.score(np.zeros(1, dtype=int), values)
    missing = score.lift_deficit[0]
    assert missing > 0
    power = score.specific_power[0]
    assert score.optimality_gap[0] == pytest.approx(power / best.specific_power - 1 + charge * missing)
    bound_charge = max(10, 2 * best.multiplier / best.lower_bound)
    assert score.bound_gap[0] == pytest.approx(power / best.lower_bound - 1 + bound_charge * missing)


def test_an_infeasible_insect_has_no_gap() -> None:
    objective = HoverObjective([load_insect("hawkmoth")], HoverProblem(box={"frequency_ratio": (0.1, 0.2)}))
    values, _ = StrokeCoordinates(objective.problem.box).decode(np.zeros((1, 6)), load_insect("hawkmoth").reference)
    score = objective.score(np.zeros(1, dtype=int), values)
    assert not score.has_gap[0]
    assert math.isfinite(score.reward[0])
