"""One policy for every wing: how it is judged."""

import json
from typing import Any

import numpy as np
import pytest

from agents.tasks import RandomWingsTask
from agents.tasks.random_wings import wings_table
from agents.tasks.wing_flights import WingPool
from flapenv import HoverProblem
from flapenv.coordinates import StrokeCoordinates
from flapenv.envs.insect_choice import choose_pool


class Optimal:
    """Beats every wing of a pool at its optimum, its tip speed `faster` than that."""

    def __init__(self, pool: WingPool, faster: float = 0.0) -> None:
        stroke = {name: np.asarray(value) for name, value in vars(pool.best.stroke).items()}
        stroke["frequency"] = stroke["frequency"] * (1 + faster)
        reference = pool.env.flyers.cases.reference
        self.actions = StrokeCoordinates(HoverProblem().box).encode(stroke, reference).astype(np.float32)

    def predict(self, observation: np.ndarray, *, deterministic: bool) -> tuple[np.ndarray, Any]:
        assert deterministic
        return self.actions[: len(observation)], None


@pytest.fixture(scope="module")
def pool() -> WingPool:
    return WingPool(500, split="test", problem=HoverProblem(), seed=0)


def test_the_optimum_has_no_gap_on_any_wing(pool: WingPool) -> None:
    flights = pool.fly(Optimal(pool))
    assert len(flights.gaps) == 500
    assert np.max(np.abs(flights.gaps)) < 1e-4
    assert flights.rms_frequency_error < 1e-5


def test_a_frequency_too_high_costs_three_times_its_error_and_too_low_seventeen(pool: WingPool) -> None:
    """P* ∝ f³; Λ ∝ f², its lack charged ten-fold."""
    for faster, slope in ((1e-3, 3.0), (-1e-3, -17.0)):
        flights = pool.fly(Optimal(pool, faster))
        assert flights.mean == pytest.approx(slope * faster, rel=0.02)
        assert flights.rms_frequency_error == pytest.approx(1e-3, rel=0.02)
        assert np.sign(np.mean(flights.weight_support) - 1) == np.sign(faster)


def test_the_test_wings_are_not_those_that_are_trained_on() -> None:
    train, test = (
        choose_pool(HoverProblem(), size=64, seed=0, split=split, leave_out=None) for split in ("train", "test")
    )
    assert not np.intersect1d(train.wing.length, test.wing.length).size
    task = RandomWingsTask(pool_size=64)
    assert np.array_equal(task.vector_env(4).flyers.r1_hat, train.wing.r1_hat)


@pytest.mark.filterwarnings("ignore:.*outside the range of the lifting-line:UserWarning")
def test_another_pool_of_wings_is_what_is_trained_on_where_another_is_asked_for() -> None:
    pools = [
        choose_pool(HoverProblem(), size=64, seed=seed, split="train", leave_out=None).wing.r1_hat for seed in (0, 3)
    ]
    trained = RandomWingsTask(pool_size=64, pool_seed=3).vector_env(4).flyers
    assert np.array_equal(trained.r1_hat, pools[1])
    assert not np.array_equal(trained.r1_hat, pools[0])
    assert np.array_equal(RandomWingsTask(pool_seed=3).pool("train", 64).env.flyers.r1_hat, pools[1])


def test_a_species_that_is_left_out_is_what_is_judged_and_its_like_is_not_trained_on() -> None:
    task = RandomWingsTask(pool_size=2048, leave_out="honeybee")
    flyers, wing = task.vector_env(4).flyers, task.leave_out.wing
    near = np.abs(flyers.cases.aspect_ratio - wing.aspect_ratio) < 0.3
    assert not np.any(near & (np.abs(flyers.r1_hat - wing.r1_hat) < 0.015))
    assert list(task.insects.names) == ["honeybee"]
    assert task.to_dict()["leave_out"] == "honeybee"


def test_the_verdict_is_plain_numbers_and_tells_all_three_sets(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("agents.tasks.random_wings.TEST_WINGS", 300)
    task = RandomWingsTask(pool_size=64)

    class Middle:
        def predict(self, observation: np.ndarray, *, deterministic: bool) -> tuple[np.ndarray, Any]:
            return np.zeros((len(observation), 6), dtype=np.float32), None

    verdict = task.judge(Middle())
    assert json.loads(json.dumps(verdict.results, allow_nan=False))["wings"]["outside"]["wings"] == 300
    assert verdict.mean is not None
    assert verdict.worst is not None
    assert verdict.mean < verdict.worst
    assert set(verdict.results["insects"]) >= {"hawkmoth", "ladybird"}
    for word in ("test", "outside", "hawkmoth", "rms error"):
        assert word in verdict.text
    flown = {"test": task.pool("test", 300).fly(Middle())}
    assert f"{100 * verdict.mean:.3f}" in wings_table(flown)
    size = task.draw(Middle()).get_size_inches()
    assert size[0] > size[1]
    mean, most = task.glance(Middle())
    assert 0.5 * verdict.mean < mean < 2 * verdict.mean
    assert mean < most


@pytest.mark.parametrize(
    ("fields", "kind", "said"),
    [
        ({"pool_size": 0}, ValueError, "pool_size = 0"),
        ({"problem": "free"}, ValueError, "problem = 'free'"),
        ({"leave_out": "moth"}, ValueError, "'moth' is unknown"),
        ({"pools": 3}, TypeError, "did you mean 'pool_s"),
    ],
)
def test_bad_arguments_are_named(fields: dict[str, Any], kind: type[Exception], said: str) -> None:
    with pytest.raises(kind, match=said):
        RandomWingsTask(**fields)
