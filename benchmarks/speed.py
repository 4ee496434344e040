"""Wingbeats a second of every way to evaluate one, in one run and as ratios: `make bench`.

Each case runs for a fixed time after a warm-up, the best of three repetitions. The baseline
is pasted in here so that no other code of the project can make it look better: the paper's 50 strips by 500 steps in
vectorised NumPy, one wingbeat at a time. `make bench` sets one thread.
"""

import os
import platform
import resource
import subprocess
import sys
import time
from collections.abc import Callable
from typing import Any

import gymnasium as gym
import numpy as np

from flapenv import HoverProblem, Stroke, Wing, evaluate, load_insect
from flapenv.aero.accelerators import Accelerator, plate_kernel
from flapenv.aero.induced import k_ind
from flapenv.aero.parameters import StrokeReference
from flapenv.case import hover_case
from flapenv.coordinates import StrokeCoordinates
from flapenv.objective import QUADRATURE_TOLERANCE
from flapenv.performance import hover_averages
from flapenv.simulation import evaluate_by_blade_element
from flapenv.tables import text_table

SECONDS, REPETITIONS = 0.7, 3
ROWS, MANY, MILLION = 4096, 100_000, 1_000_000
HOVERING = (0.4, 1, 1, 1, 0)
"""The action of Heave-v0 that holds height in still air."""


def baseline() -> None:
    """One wingbeat by strips and steps, written out."""
    t = np.linspace(0, 1, 500, endpoint=False)[:, None]
    r = ((np.arange(50) + 0.5) / 50)[None]
    c = r**0.8 * (1 - r) ** 0.5
    v = np.cos(2 * np.pi * t) * r
    al = 0.5 + 0.1 * np.tanh(5 * np.cos(2 * np.pi * t))
    cl = np.sin(2 * al)
    cd = np.sin(al) ** 2
    (v * v * cl * c).mean()
    (np.abs(v) ** 3 * cd * c).mean()


def rate(work: Callable[[], object], wingbeats: int) -> float:
    """Wingbeats a second, the best repetition."""
    work()
    best = 0.0
    for _ in range(REPETITIONS):
        calls, start = 0, time.perf_counter()
        while (elapsed := time.perf_counter() - start) < SECONDS:
            work()
            calls += 1
        best = max(best, calls * wingbeats / elapsed)
    return best


def fast_path(rows: int, accelerator: Accelerator = "numpy") -> tuple[Callable[[int], Any], float]:
    """The averages of random strokes of the default box in single precision, as a function of the threads.

    Returns:
        The work, and its largest relative error against double precision with far more nodes.
    """
    hawkmoth, problem = load_insect("hawkmoth"), HoverProblem()
    points = np.random.default_rng(0).uniform(-1, 1, (rows, 6)).astype(np.float32)
    values: dict[str, Any]
    values, _ = StrokeCoordinates(problem.box).decode(points, StrokeReference(26.3, 1.0))
    case = hover_case(hawkmoth, problem.model)
    single, rule = case.rows(np.newaxis, np.float32), problem.box.time_rule(tolerance=QUADRATURE_TOLERANCE)

    kernel = plate_kernel(accelerator)

    def work(threads: int) -> Any:
        return hover_averages(single, problem.model, **values, rule=rule, threads=threads, kernel=kernel)

    some: dict[str, Any] = {name: value[:ROWS].astype(float) for name, value in values.items()}
    exact = hover_averages(case, problem.model, **some, rule=rule.refined(4))
    error = max(float(np.max(np.abs(ours[:ROWS] / own - 1))) for ours, own in zip(work(1), exact, strict=True))
    return work, error


def stepping(name: str, rows: int = ROWS, actions: Any = None, **arguments: Any) -> Callable[[], object]:
    """Steps of a vector environment with given actions, or a random one for each row."""
    batch = gym.make_vec(name, num_envs=rows, autoreset_mode="SAME_STEP", **arguments)
    batch.reset(seed=0)
    batch.action_space.seed(0)
    actions = batch.action_space.sample() if actions is None else np.tile(np.float32(actions), (rows, 1))
    return lambda: batch.step(actions)


def resetting_and_stepping(**arguments: Any) -> Callable[[], object]:
    """An episode of the scalar Hover-v0."""
    env = gym.make("flapenv/Hover-v0", **arguments)
    action = np.random.default_rng(0).uniform(-1, 1, 6).astype(np.float32)

    def episode() -> None:
        env.reset()
        env.step(action)

    return episode


def cases() -> list[tuple[str, Callable[[], object], int]]:
    """What is measured: a name, the work and how many wingbeats it is."""
    hawkmoth = load_insect("hawkmoth")
    points = np.random.default_rng(0).uniform(-1, 1, (ROWS, 6))
    strokes = Stroke(**StrokeCoordinates(HoverProblem().box).decode(points, hawkmoth.reference)[0])
    few, error = fast_path(ROWS)
    compiled, own_error = fast_path(ROWS, "numba")
    many, million = fast_path(MANY)[0], fast_path(MILLION)[0]

    return [
        ("baseline: 50 x 500 in NumPy, pasted", baseline, 1),
        ("oracle: blade_element, 50 x 500", lambda: evaluate_by_blade_element(hawkmoth), 1),
        (f"evaluate, {ROWS:,} strokes, float64, 1e-9", lambda: evaluate(hawkmoth, strokes), ROWS),
        (f"fast path, {ROWS:,} rows, float32, error {error:.0e}", lambda: few(1), ROWS),
        (f"fast path, {MANY:,} rows", lambda: many(1), MANY),
        (f"fast path, {MANY:,} rows, two threads", lambda: many(2), MANY),
        (f"fast path, {MILLION:,} rows", lambda: million(1), MILLION),
        (f"fast path, {ROWS:,} rows, numba, error {own_error:.0e}", lambda: compiled(1), ROWS),
        (f"Hover-v0, {ROWS:,} rows, step with infos", stepping("flapenv/Hover-v0"), ROWS),
        (f"Hover-v0, {ROWS:,} rows, step without infos", stepping("flapenv/Hover-v0", infos="none"), ROWS),
        (f"Hover-v0, {ROWS:,} rows, numba", stepping("flapenv/Hover-v0", accelerator="numba"), ROWS),
        (f"HoverAdapt-v0, {ROWS:,} rows, step with infos", stepping("flapenv/HoverAdapt-v0"), ROWS),
        (f"Waveform-v0, {ROWS:,} rows, step with infos", stepping("flapenv/Waveform-v0"), ROWS),
        (f"Heave-v0, {ROWS:,} rows, step with infos", stepping("flapenv/Heave-v0", actions=HOVERING), ROWS),
        ("Hover-v0, gym.make, reset and step", resetting_and_stepping(), 1),
        ("Hover-v0, gym.make, reset and step, numba", resetting_and_stepping(accelerator="numba"), 1),
    ]


def wing_cases() -> list[tuple[str, Callable[[], object], int]]:
    """What is measured in wings, not wingbeats."""
    rng = np.random.default_rng(0)
    many = Wing(length=rng.uniform(2.6, 5.6, ROWS), mean_chord=1.0, r1_hat=rng.uniform(0.45, 0.57, ROWS))
    return [(f"k_ind of {ROWS} random wings", lambda: k_ind(many), ROWS)]


def main() -> None:
    """Measure and print."""
    rates = [(name, rate(work, wingbeats)) for name, work, wingbeats in cases()]
    baseline_rate, oracle_rate = rates[0][1], rates[1][1]
    rows = [("case", "wingbeats/s", "x baseline", "x oracle")]
    rows += [
        (name, f"{value:,.0f}", f"{value / baseline_rate:,.1f}", f"{value / oracle_rate:,.1f}") for name, value in rates
    ]
    print(text_table(rows))
    for name, work, wings in wing_cases():
        print(f"{name}: {wings / rate(work, wings):.2f} s")
    print(f"import flapenv, after gymnasium: {import_seconds():.3f} s")
    print(f"largest memory of this process: {resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 1e3:,.0f} MB")
    print(f"{os.cpu_count()} cores, {platform.machine()}, Python {platform.python_version()}, NumPy {np.__version__}")


def import_seconds() -> float:
    """What importing flapenv adds to importing gymnasium, the best of five fresh processes [s]."""
    code = "import gymnasium, time; t = time.perf_counter(); import flapenv; print(time.perf_counter() - t)"
    runs = [subprocess.run([sys.executable, "-c", code], capture_output=True, check=True) for _ in range(5)]
    return min(float(run.stdout) for run in runs)


if __name__ == "__main__":
    main()
