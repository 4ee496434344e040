"""What a benchmark's pictures draw is what the runs came to: each number where it belongs."""

from collections.abc import Sequence
from typing import TYPE_CHECKING

import numpy as np
import pytest

from agents.benchmark.data import BenchmarkData, CurvePoint, InsectRow, RunRow
from agents.benchmark.pictures import draw_curves, draw_final, draw_others, draw_profile
from agents.benchmark.statistics import interquartile_mean, last_known
from flapenv.drawing import BLUE, ORANGE

if TYPE_CHECKING:
    from matplotlib.figure import Figure
    from matplotlib.lines import Line2D

LEARNERS = ["hover-ppo", "hover-sac"]
MEANS = {"hover-ppo": (0.001, 0.002, 0.004), "hover-sac": (0.03, 0.05, 0.08)}
WORSTS = {"hover-ppo": (0.011, 0.022, 0.044), "hover-sac": (0.33, 0.55, 0.88)}
PACE = 1, 10, 100
"""How many times as long each seed's beats take."""
GAPS = {"hover-ppo": (0.001, 0.004, 0.02), "hover-sac": (0.03, 0.2, 0.7)}


@pytest.fixture(scope="module")
def data() -> BenchmarkData:
    """Three seeds of two presets, each of its own pace."""
    runs, insects, curves = [], [], []
    for preset in LEARNERS:
        for seed, (mean, worst) in enumerate(zip(MEANS[preset], WORSTS[preset], strict=True)):
            known = {"preset": preset, "seed": seed}
            runs.append(
                RunRow(
                    **known, environment="e", distance="d", mean=mean, worst=worst, wingbeats=4000, seconds=4 * seed + 4
                )
            )
            insects.append(InsectRow(**known, insect="hawkmoth", gap=GAPS[preset][seed]))
            for number in (1, 2, 3, 4):
                so_far = {"wingbeats": 1000 * PACE[seed] * number, "seconds": float(7 * PACE[seed] * number)}
                curves.append(CurvePoint(**known, **so_far, mean=mean * (5 - number), worst=worst * (5 - number)))
    return BenchmarkData(runs=runs, insects=insects, curves=curves)


def lines_labelled(figure: "Figure", axes: int = 0) -> dict[str, "Line2D"]:
    return {str(line.get_label()): line for line in figure.axes[axes].lines}


def marked(figure: "Figure", marker: str) -> Sequence["Line2D"]:
    return [line for line in figure.axes[0].lines if line.get_marker() == marker]


def test_the_final_picture_marks_the_mean_gap_of_every_seed_and_their_interquartile_mean(data: BenchmarkData) -> None:
    figure = draw_final(data, LEARNERS)
    for preset, dots, middle in zip(LEARNERS, marked(figure, "o"), marked(figure, "|"), strict=True):
        np.testing.assert_allclose(dots.get_xdata(), 100 * np.array(MEANS[preset]))
        assert middle.get_xdata()[0] == pytest.approx(100 * interquartile_mean(np.array(MEANS[preset])))


def test_learning_curves_put_every_seed_at_its_own_wingbeats_and_seconds(data: BenchmarkData) -> None:
    figure = draw_curves(data, LEARNERS)
    for axes, unit in enumerate((1000.0, 7.0)):
        lines = lines_labelled(figure, axes)
        for preset, name in zip(LEARNERS, ("PPO", "SAC"), strict=True):
            grid = lines[name].get_xdata()
            assert (grid[0], grid[-1]) == pytest.approx((unit * PACE[-1], 4 * unit * PACE[-1]))
            steps = np.arange(1, 5)
            seeds = [
                last_known(unit * pace * steps, 100 * mean * (5.0 - steps), grid)
                for pace, mean in zip(PACE, MEANS[preset], strict=True)
            ]
            drawn = lines[name].get_ydata()
            inside = slice(1, -1)  # at the ends rounding decides which step is the last
            np.testing.assert_allclose(drawn[inside], interquartile_mean(np.array(seeds), axis=0)[inside])


def test_the_profile_of_a_learner_rises_at_its_own_gaps(data: BenchmarkData) -> None:
    lines = lines_labelled(draw_profile(data, LEARNERS))
    for preset, name in zip(LEARNERS, ("PPO", "SAC"), strict=True):
        thresholds, shares = lines[name].get_data()
        for below, gap in enumerate(sorted(GAPS[preset])):
            assert shares[np.searchsorted(thresholds, 100 * gap) - 1] == pytest.approx(below / 3)
        assert shares[-1] == 1


def test_other_tasks_show_the_mean_as_the_mean_and_the_worst_as_the_worst(data: BenchmarkData) -> None:
    figure = draw_others(data, LEARNERS)
    for axes, preset in zip(figure.axes, LEARNERS, strict=True):
        lines = {str(line.get_label()): line for line in axes.lines}
        for name, values, colour in (("mean", MEANS, BLUE), ("worst", WORSTS, ORANGE)):
            np.testing.assert_array_equal(lines[name].get_xdata(), [0, 1, 2])
            np.testing.assert_allclose(lines[name].get_ydata(), 100 * np.array(values[preset]))
            assert lines[name].get_color() == colour
        dashed = next(line for line in axes.lines if line.get_linestyle() == "--")
        assert dashed.get_ydata()[0] == pytest.approx(100 * interquartile_mean(np.array(MEANS[preset])))
