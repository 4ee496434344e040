"""Where the time of a wingbeat goes, and how far it is from the floor: `python -m benchmarks.profile`.

The floor is the arithmetic alone: how often each NumPy function is called for a node of the quadrature, times what that
function takes for one number of an array in the cache, times the nodes. What is above it is calls and memory.
"""

import time
from collections.abc import Callable
from typing import Any

import gymnasium as gym
import numpy as np

from benchmarks.speed import ROWS, fast_path
from flapenv import HoverProblem
from flapenv.aero.accelerators import plate_kernel
from flapenv.aero.parameters import StrokeReference
from flapenv.aero.wingbeat import speed_averages
from flapenv.coordinates import StrokeCoordinates
from flapenv.objective import QUADRATURE_TOLERANCE
from flapenv.tables import text_table

CALLS: dict[str, int] = {"sin": 2, "cos": 1, "tanh": 1, "sqrt": 1, "divide": 1, "multiply": 11, "add": 1, "matmul": 2}
"""Calls of NumPy for a node in `flapenv.aero.plate_averages`."""
NODES_AT_ONCE = 200_000
"""Numbers of a block there."""
REPETITIONS = 30


def seconds(work: Callable[..., object], *arguments: Any, **options: Any) -> float:
    """The best of several calls [s]."""
    work(*arguments, **options)
    best = np.inf
    for _ in range(REPETITIONS):
        start = time.perf_counter()
        work(*arguments, **options)
        best = min(best, time.perf_counter() - start)
    return float(best)


def function_times() -> dict[str, float]:
    """What each function takes for a number of single precision [ns]."""
    rows = NODES_AT_ONCE // 48
    x = np.random.default_rng(0).uniform(0.1, 1.5, (48, rows)).astype(np.float32)
    out, weights = np.empty_like(x), np.ones(48, dtype=np.float32)
    times = {}
    for name in CALLS:
        function: Any = getattr(np, name)
        if name == "matmul":
            times[name] = seconds(function, weights, x)
        elif function.nin == 1:
            times[name] = seconds(function, x, out=out)
        else:
            times[name] = seconds(function, x, x, out=out)
    return {name: 1e9 * value / x.size for name, value in times.items()}


def kernel_table(times: dict[str, float]) -> str:
    """Floor and measurement of the averages, for a wingbeat."""
    rule = HoverProblem().box.time_rule(tolerance=QUADRATURE_TOLERANCE)
    nodes = 2 * rule.nodes
    points = np.random.default_rng(0).uniform(-1, 1, (ROWS, 6)).astype(np.float32)
    stroke: dict[str, Any] = StrokeCoordinates(HoverProblem().box).decode(points, StrokeReference(26.3, 1.0))[0]
    shapes: dict[str, Any] = {
        name: stroke[name] for name in ("flap_shape", "pitch_amplitude", "pitch_shape", "pitch_phase")
    }
    double = np.random.default_rng(0).uniform(0.1, 1.5, NODES_AT_ONCE)
    slow = 1e9 * seconds(np.sin, double, out=np.empty_like(double)) / NODES_AT_ONCE
    floor = sum(CALLS[name] * times[name] for name in CALLS)
    rows = [("what", "ns a node", "ns a wingbeat")]
    rows += [(f"{CALLS[name]} x {name}", f"{CALLS[name] * times[name]:.2f}", "") for name in CALLS]
    rows.append((f"floor: their sum, {nodes} nodes", f"{floor:.2f}", f"{nodes * floor:.0f}"))
    for accelerator in ("numpy", "numba"):
        kernel = plate_kernel(accelerator)
        took = 1e9 * seconds(speed_averages, **shapes, rule=rule, kernel=kernel) / ROWS
        rows.append((f"the averages, {accelerator}", f"{took / nodes:.2f}", f"{took:.0f}"))
    work, _ = fast_path(ROWS)
    rows.append(("the fast path: with C_T, Λ and P*, numpy", "", f"{1e9 * seconds(work, 1) / ROWS:.0f}"))
    rows.append(("for comparison: 1 x sin in double precision", f"{slow:.2f}", ""))
    return text_table(rows)


def step_table() -> str:
    """The parts of a step of Hover-v0, for a wingbeat."""
    rows: list[tuple[str, ...]] = [("a step of Hover-v0, ns a wingbeat", "numpy", "numba")]
    parts: dict[str, list[float]] = {}
    for accelerator in ("numpy", "numba"):
        made: Any = gym.make_vec("flapenv/Hover-v0", num_envs=ROWS, autoreset_mode="SAME_STEP", accelerator=accelerator)
        env: Any = made.unwrapped
        env.reset(seed=0)
        env.action_space.seed(0)
        actions = env.action_space.sample()
        index = np.random.default_rng(0).integers(len(env.flyers), size=ROWS)
        case = env.objective.cases
        reference = StrokeReference(*(np.asarray(own, np.float32)[index] for own in case.reference))
        strokes = env.coordinates.decode(actions, reference)[0]
        bare: Any = gym.make_vec(
            "flapenv/Hover-v0", num_envs=ROWS, autoreset_mode="SAME_STEP", accelerator=accelerator, infos="none"
        )
        bare.reset(seed=0)
        decode = seconds(env.coordinates.decode, actions, reference)
        score = seconds(env.objective.score, index, strokes)
        step, without = seconds(env.step, actions), seconds(bare.step, actions)
        for name, value in (
            ("actions to strokes", decode),
            ("Λ, P*, reward and gaps", score),
            ("checks, draws, observations, autoreset", without - decode - score),
            ("infos and final infos with their masks", step - without),
            ("in all", step),
        ):
            parts.setdefault(name, []).append(1e9 * value / ROWS)
    rows += [(name, *(f"{value:.0f}" for value in values)) for name, values in parts.items()]
    return text_table(rows)


def main() -> None:
    """Measure and print."""
    print(kernel_table(function_times()))
    print()
    print(step_table())


if __name__ == "__main__":
    main()
