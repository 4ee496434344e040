"""Wingbeats a second of free waveforms, in one run with the pasted baseline: `python -m benchmarks.waveform`."""

from collections.abc import Callable

import gymnasium as gym
import numpy as np

from benchmarks.speed import ROWS, baseline, rate
from flapenv.case import hover_case, stack_cases
from flapenv.envs import WaveformVectorEnv
from flapenv.insects import INSECTS, load_insect
from flapenv.problem import HoverProblem
from flapenv.tables import text_table
from flapenv.waveform.performance import waveform_performance


def waveform_cases() -> list[tuple[str, Callable[[], object], int]]:
    """What is measured: a name, the work and how many wingbeats it is."""
    batch = WaveformVectorEnv(ROWS, autoreset_mode="SAME_STEP")
    batch.reset(seed=0)
    rng = np.random.default_rng(0)
    points = rng.uniform(-1, 1, batch.action_space.shape).astype(np.float32)
    rows = rng.integers(len(INSECTS), size=ROWS)
    model = HoverProblem().model
    case = stack_cases([hover_case(load_insect(name), model) for name in INSECTS]).rows(rows, np.float32)
    waveforms, _ = batch.coordinates.decode(points, case.reference)
    single = gym.make("flapenv/Waveform-v0")
    action = points[0]

    def beat_single() -> None:
        single.reset()
        single.step(action)

    return [
        (
            f"free waveforms, {ROWS} rows, 8 knots, float32, 1e-5",
            lambda: waveform_performance(case, model, waveforms),
            ROWS,
        ),
        (f"Waveform vector env, {ROWS} rows, step with infos", lambda: batch.step(points), ROWS),
        ("Waveform gym.make env, reset and step", beat_single, 1),
    ]


def main() -> None:
    """Measure and print."""
    reference = rate(baseline, 1)
    rows = [("case", "wingbeats/s", "x baseline"), ("baseline: 50 x 500 in NumPy, pasted", f"{reference:,.0f}", "1.0")]
    for name, work, wingbeats in waveform_cases():
        value = rate(work, wingbeats)
        rows.append((name, f"{value:,.0f}", f"{value / reference:,.1f}"))
    print(text_table(rows))


if __name__ == "__main__":
    main()
