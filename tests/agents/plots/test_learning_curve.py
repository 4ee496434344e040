"""The interactive learning curve."""

import numpy as np

from agents.curve_picture import LEAST_GAP
from agents.plots.learning_curve import learning_curve

ROWS = [
    {"wingbeats": 0.0, "mean_gap": 0.5, "worst_gap": 1.5},
    {"wingbeats": 2e6, "mean_gap": 0.001, "worst_gap": 0.02},
    {"wingbeats": 4e6, "mean_gap": -0.01, "worst_gap": float("nan")},
]


def test_lines_are_the_rows_in_percent_over_millions_of_wingbeats() -> None:
    lines = {trace.name: trace for trace in learning_curve(ROWS, "gap to the optimum").data}
    worst, mean = lines["worst"], lines["mean"]
    np.testing.assert_allclose(mean.x, [0, 2, 4])
    np.testing.assert_allclose(mean.customdata, [50, 0.1, -1])
    np.testing.assert_allclose(worst.y[:2], [150, 2])


def test_what_a_logarithm_cannot_show_lies_on_the_lowest_line_and_keeps_its_number() -> None:
    lines = {trace.name: trace for trace in learning_curve(ROWS, "gap to the optimum").data}
    worst, mean = lines["worst"], lines["mean"]
    assert mean.y[2] == LEAST_GAP
    assert np.isnan(worst.y[2])


def test_a_single_point_can_be_seen_and_the_axis_says_what_it_is() -> None:
    figure = learning_curve(ROWS[:1], "distance to LQG")
    assert figure.data[0].mode == "markers"
    assert figure.layout.yaxis.title.text == "distance to LQG [%]"


def test_one_percent_is_a_line_with_a_name_over_all_of_the_run() -> None:
    (line,) = (trace for trace in learning_curve(ROWS, "gap to the optimum").data if trace.name == "1 %")
    np.testing.assert_allclose([line.x, line.y], [[0, 4], [1, 1]])
