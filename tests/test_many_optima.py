"""Optima of many wings at once against the search for each alone."""

import dataclasses
import math

import numpy as np
import pytest

from flapenv import HoverProblem, evaluate, load_insect, optimum
from flapenv.aero.parameters import STROKE_PARAMETERS
from flapenv.insects import pick
from flapenv.many_optima import many_optima
from flapenv.problem import PROBLEMS
from flapenv.wing_pool import wing_pool

pytestmark = pytest.mark.filterwarnings("ignore:.*outside the range of the lifting-line:UserWarning")  # pools reach 2.6
COUNT = 8
POOL = wing_pool(COUNT, seed=7, min_weight_support=1.05)


@pytest.mark.parametrize("name", ["free-frequency", "fixed-frequency", "profile-drag"])
def test_many_wings_at_once_are_what_each_is_alone_to_1e_6(name: str) -> None:
    together = many_optima(POOL, name)
    assert not np.any(together.solved_alone)
    assert np.all(together.feasible)
    for i in range(COUNT):
        alone = optimum(pick(POOL, i), name)
        assert together.specific_power[i] == pytest.approx(alone.specific_power, rel=1e-6)
        assert together.weight_support[i] == pytest.approx(alone.weight_support, abs=1e-7)
        assert together.max_weight_support[i] == pytest.approx(alone.max_weight_support, rel=1e-6)
        assert together.lower_bound[i] == pytest.approx(alone.lower_bound, rel=1e-12)
        assert together.multiplier[i] == pytest.approx(alone.multiplier, rel=1e-3)


@pytest.mark.parametrize("name", ["free-frequency", "fixed-frequency", "profile-drag"])
def test_the_strokes_are_in_the_box_and_do_what_is_said_of_them(name: str) -> None:
    problem = PROBLEMS[name]
    together = many_optima(POOL, problem)
    ours = evaluate(POOL, together.stroke, **vars(problem.model))
    np.testing.assert_allclose(ours.specific_power, together.specific_power, rtol=1e-8)
    np.testing.assert_allclose(ours.weight_support, together.weight_support, rtol=1e-8)
    for parameter in STROKE_PARAMETERS:
        low, high = problem.box.bounds(parameter, POOL.reference)
        value = getattr(together.stroke, parameter)
        slack = 1e-12 * np.maximum(np.abs(high), 1)
        assert np.all((value >= low - slack) & (value <= high + slack)), parameter


def test_a_curve_through_a_grid_serves_more_wings_than_it_has_points(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("flapenv.many_optima.GRID", 12)
    pool = wing_pool(40, seed=8)
    together = many_optima(pool, "profile-drag")
    for i in (0, 13, 39):
        alone = optimum(pick(pool, i), "profile-drag")
        assert together.specific_power[i] == pytest.approx(alone.specific_power, rel=1e-6)


def test_wings_that_want_more_than_their_highest_frequency_stay_on_it() -> None:
    problem = HoverProblem(box={"frequency_ratio": (0.5, 1.1)}, model={"profile_drag": 0.1})
    pool = wing_pool(20, seed=3)
    together = many_optima(pool, problem)
    hurried = np.isclose(together.stroke.frequency, 1.1 * pool.stroke.frequency)
    assert 2 <= np.sum(hurried & together.feasible) < 20
    for i in np.flatnonzero(hurried)[:5]:
        alone = optimum(pick(pool, int(i)), problem)
        assert together.feasible[i] == alone.feasible
        assert together.max_weight_support[i] == pytest.approx(alone.max_weight_support, rel=1e-6)
        if alone.feasible:
            assert together.specific_power[i] == pytest.approx(alone.specific_power, rel=1e-6)
            assert together.multiplier[i] == pytest.approx(alone.multiplier, rel=1e-2)


def test_what_shares_no_curve_is_solved_alone() -> None:
    pool = wing_pool(2, seed=1)
    together = many_optima(pool, HoverProblem(model={"tip_loss": "stroke"}))
    assert np.all(together.solved_alone)
    alone = optimum(pick(pool, 1), HoverProblem(model={"tip_loss": "stroke"}))
    assert together.specific_power[1] == pytest.approx(alone.specific_power, rel=1e-9)


def test_wings_that_cannot_hover_say_so() -> None:
    heavy = dataclasses.replace(POOL, mass=np.asarray(POOL.mass) * 3)
    together = many_optima(heavy, "fixed-frequency")
    assert not np.all(together.feasible)
    assert np.all(np.isinf(together.multiplier[~together.feasible]))
    np.testing.assert_allclose(
        together.weight_support[~together.feasible], together.max_weight_support[~together.feasible], rtol=1e-6
    )


def test_one_insect_is_refused_with_what_is_wanted() -> None:
    with pytest.raises(TypeError, match=r"insects have fields of shape \(\); allowed: one axis"):
        many_optima(load_insect("hawkmoth"))


def test_the_pool_has_the_distribution_it_claims() -> None:
    pool = wing_pool(2000)
    ratio = np.asarray(pool.wing.aspect_ratio)
    assert 2.6 <= ratio.min() < 2.65
    assert 5.55 < ratio.max() <= 5.6
    assert 0.45 <= pool.wing.r1_hat.min() < pool.wing.r1_hat.max() <= 0.57
    loading = pool.mass * 9.81 / (2 * pool.wing.area)
    assert 1.8 <= loading.min() < loading.max() <= 17
    assert 15 < pool.stroke.frequency.min() < pool.stroke.frequency.max() < 1000
    best = many_optima(pool)
    u = best.stroke.frequency / pool.stroke.frequency
    assert 0.53 - 1e-6 < u.min() < 0.55
    assert 1.28 < u.max() < 1.30 + 1e-6
    assert math.isclose(float(np.mean(u)), (0.53 + 1.30) / 2, abs_tol=0.05)


def test_pools_are_endless_sequences_with_independent_splits() -> None:
    np.testing.assert_array_equal(wing_pool(100).mass, wing_pool(1500).mass[:100])
    train, test, outside = (wing_pool(50, split=split) for split in ("train", "test", "outside"))
    assert not np.intersect1d(train.mass, test.mass).size
    ratio = np.asarray(outside.wing.aspect_ratio)
    assert np.all(((ratio >= 2.2) & (ratio <= 2.6)) | ((ratio >= 5.6) & (ratio <= 6.5)))
    assert np.any(ratio < 2.6)
    assert np.any(ratio > 5.6)
    assert wing_pool(50, seed=1).mass[0] != train.mass[0]


def test_a_pool_for_fixed_frequencies_can_hover_with_a_margin() -> None:
    assert many_optima(POOL, "fixed-frequency").max_weight_support.min() >= 1.05


@pytest.mark.parametrize(
    ("arguments", "kind", "said"),
    [
        ({"size": 0}, ValueError, "size = 0"),
        ({"size": 2.5}, TypeError, "size = 2.5"),
        ({"size": 5, "split": "tset"}, ValueError, "split = 'tset' is unknown; .*did you mean 'test'"),
        ({"size": 5, "seed": -1}, ValueError, "seed = -1"),
        ({"size": 5, "min_weight_support": float("nan")}, ValueError, "min_weight_support = nan"),
    ],
)
def test_bad_pools_are_named(arguments: dict[str, object], kind: type[Exception], said: str) -> None:
    with pytest.raises(kind, match=said):
        wing_pool(**arguments)


@pytest.mark.parametrize(
    "fixed", [{"flap_shape": 0.9}, {"flap_shape": 0.9, "pitch_shape": 5.0, "pitch_amplitude": 1.0, "pitch_phase": 1.5}]
)
def test_fixed_waveforms_and_wings_that_want_less_than_their_lowest_frequency_are_served(
    fixed: dict[str, float],
) -> None:
    for ratio in ((0.05, 0.3), (0.5, 1.5), (1.2, 3.0)):
        problem, pool = HoverProblem(box={"frequency_ratio": ratio, **fixed}), wing_pool(3, seed=2)
        together = many_optima(pool, problem)
        for i in range(3):
            alone = optimum(pick(pool, i), problem)
            assert together.feasible[i] == alone.feasible
            assert together.specific_power[i] == pytest.approx(alone.specific_power, rel=1e-6)


def test_lift_that_is_more_than_enough_costs_nothing() -> None:
    box = {"frequency_ratio": 1.3, "flap_amplitude": math.radians(75), "pitch_amplitude": (0.47, 0.85)}
    together = many_optima(wing_pool(3), HoverProblem(box=box))
    for i in range(3):
        alone = optimum(pick(wing_pool(3), i), HoverProblem(box=box))
        assert alone.multiplier == 0
        assert together.multiplier[i] == 0
        assert together.specific_power[i] == pytest.approx(alone.specific_power, rel=1e-6)


def test_one_array_field_makes_many() -> None:
    hawkmoth = load_insect("hawkmoth")
    wide = dataclasses.replace(
        hawkmoth, stroke=dataclasses.replace(hawkmoth.stroke, flap_amplitude=np.array([0.9, 1.2]))
    )
    assert many_optima(wide, "fixed-frequency").feasible.tolist() == [False, True]
    slim = dataclasses.replace(hawkmoth, wing=dataclasses.replace(hawkmoth.wing, r1_hat=np.array([0.46, 0.5, 0.54])))
    assert many_optima(slim).specific_power.shape == (3,)
