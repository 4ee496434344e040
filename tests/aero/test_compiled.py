"""The compiled averages against NumPy's."""

import concurrent.futures
import importlib.util
from typing import Any

import numpy as np
import pytest

from flapenv import HoverProblem, load_insect
from flapenv.aero.accelerators import plate_kernel
from flapenv.aero.compiled import LANES, hyperbolic_tangent, sine
from flapenv.aero.wingbeat import speed_averages, time_rule
from flapenv.envs import HoverEnv, HoverVectorEnv
from flapenv.objective import HoverObjective

KERNEL = plate_kernel("numba")


def strokes(rng: np.random.Generator, count: int) -> list[np.ndarray]:
    """Cφ, θmax, Cθ and δ over the default box and well beyond."""
    columns = rng.uniform(0, 0.999, count), rng.uniform(0.2, 1.4, count), rng.uniform(0.01, 20, count)
    return [column.astype(np.float32) for column in (*columns, rng.uniform(0.5, 2.6, count))]


def test_sine_and_tangent_are_good_to_single_precision() -> None:
    angles = np.linspace(1e-6, np.pi / 2, 2001).astype(np.float32)
    ours = np.array([sine(angle) for angle in angles])
    np.testing.assert_allclose(ours, np.sin(angles.astype(float)), rtol=3e-7)
    values = np.geomspace(1e-6, 1e4, 2001).astype(np.float32)
    ours = np.array([hyperbolic_tangent(value) for value in values])
    np.testing.assert_allclose(ours, np.tanh(values.astype(float)), rtol=5e-7)
    assert hyperbolic_tangent(np.float32(0)) == sine(np.float32(0)) == 0


@pytest.mark.parametrize("count", [1, LANES - 1, LANES, LANES + 1, 5000])
def test_averages_equal_those_of_double_precision(rng: np.random.Generator, count: int) -> None:
    values = strokes(rng, count)
    rule = time_rule(0.999, 20.0, tolerance=1e-9)
    exact = speed_averages(*(value.astype(float) for value in values), rule=rule)
    ours = speed_averages(*values, rule=rule, kernel=KERNEL)
    assert ours[0].dtype == ours[1].dtype == np.float32
    np.testing.assert_allclose(ours[0], exact[0], rtol=5e-6, atol=2e-6)
    np.testing.assert_allclose(ours[1], exact[1], rtol=1e-5)


def test_limits_are_finite() -> None:
    grid = np.array(np.meshgrid([0, 1], [0, np.pi / 2], [0, 1e6], [0, np.pi / 2, np.pi, -2])).reshape(4, -1)
    lift, power = speed_averages(*grid.astype(np.float32), rule=time_rule(1.0, 1e6, tolerance=1e-5), kernel=KERNEL)
    plain = speed_averages(*grid, rule=time_rule(1.0, 1e6, tolerance=1e-5))
    np.testing.assert_allclose(lift, plain[0], atol=2e-5)
    np.testing.assert_allclose(power, plain[1], atol=2e-5)


def test_threads_compute_at_once(rng: np.random.Generator) -> None:
    batches, rule = [strokes(rng, 3000) for _ in range(6)], time_rule(0.9, 5.0, tolerance=1e-5)
    alone = [speed_averages(*batch, rule=rule, kernel=KERNEL) for batch in batches]
    with concurrent.futures.ThreadPoolExecutor(3) as pool:
        together = list(pool.map(lambda batch: speed_averages(*batch, rule=rule, kernel=KERNEL), batches))
    np.testing.assert_array_equal(together, alone)


@pytest.mark.parametrize("problem", ["free-frequency", "fixed-frequency"])
@pytest.mark.filterwarnings("ignore:no stroke of the box:UserWarning")
def test_the_environment_rewards_the_same_with_either(problem: str) -> None:
    rewards = []
    for accelerator in ("numpy", "numba"):
        env = HoverVectorEnv(512, problem=problem, accelerator=accelerator, autoreset_mode="SAME_STEP")
        assert (env.objective.kernel is KERNEL) == (accelerator == "numba")
        env.reset(seed=1)
        env.action_space.seed(1)
        rewards.append(env.step(env.action_space.sample())[1])
    np.testing.assert_allclose(*rewards, rtol=3e-5, atol=1e-5)
    assert np.any(rewards[0] != rewards[1])  # by another path


@pytest.mark.parametrize("arguments", [{}, {"action_scaling": "plain"}, {"insect": "random-wing", "pool_size": 8}])
def test_the_scalar_environment_gives_the_same_compiled(arguments: dict[str, Any]) -> None:
    plain, compiled = HoverEnv(**arguments), HoverEnv(accelerator="numba", **arguments)
    actions = np.random.default_rng(0).uniform(-1.2, 1.2, (40, 6)).astype(np.float32)
    for seed, action in enumerate(actions):
        ours, theirs = (env.reset(seed=seed) for env in (compiled, plain))
        np.testing.assert_array_equal(ours[0], theirs[0])
        ours, theirs = (env.step(action) for env in (compiled, plain))
        np.testing.assert_allclose(ours[0], theirs[0], rtol=1e-6, atol=1e-6)
        assert ours[1] == pytest.approx(theirs[1], rel=1e-12)
        for key, value in ours[4].items():
            assert value == (pytest.approx(theirs[4][key], rel=1e-9) if type(value) is float else theirs[4][key]), key


@pytest.mark.parametrize(
    ("arguments", "said"),
    [
        ({"accelerator": "cuda"}, "accelerator = 'cuda' is unknown; allowed: numpy, numba"),
        ({"accelerator": "numba", "dtype": "float64"}, "single precision; allowed: dtype 'float32'"),
        ({"accelerator": "numba", "problem": "profile-drag"}, "allowed for problem 'profile-drag': 'numpy'"),
        ({"accelerator": "numba", "problem": {"model": {"coefficients": "robofly"}}}, "allowed for problem 'custom'"),
    ],
)
def test_what_it_cannot_do_is_refused(arguments: dict[str, Any], said: str) -> None:
    with pytest.raises(ValueError, match=said):
        HoverEnv(**arguments)


def test_without_numba_the_error_names_the_extra(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(importlib.util, "find_spec", lambda name: None)
    plate_kernel.cache_clear()
    with pytest.raises(ImportError, match=r"pip install 'flapenv\[fast\]'"):
        HoverObjective([load_insect("hawkmoth")], HoverProblem(), np.float32, accelerator="numba")
    monkeypatch.undo()
    plate_kernel.cache_clear()
