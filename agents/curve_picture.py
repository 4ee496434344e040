"""The learning curve of a run."""

import csv
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from agents.run_folder import CURVE
from flapenv.drawing import BLUE, GREY, ORANGE, require_matplotlib, verbatim

if TYPE_CHECKING:
    from matplotlib.figure import Figure

LEAST_GAP = 1e-2
"""Smallest distance the logarithmic axis shows [%]."""


def read_curve(out: Path) -> list[dict[str, float]]:
    """The points of a run's learning curve, from its CSV file.

    Args:
        out: folder of the run.

    Raises:
        OSError: if the file cannot be read.
        ValueError: if something in it is not a number.
    """
    with (out / CURVE).open(encoding="utf-8", newline="") as file:
        return [{name: float(value) for name, value in row.items()} for row in csv.DictReader(file)]


def draw_learning_curve(out: Path, distance: str, title: str) -> "Figure":
    """How far the noise-free policy is off, mean and worst, against wingbeats, from the run's CSV file.

    Args:
        out: folder of the run.
        distance: what the numbers are, in words.
        title: of the picture.
    """
    require_matplotlib()
    from matplotlib.figure import Figure

    rows = read_curve(out)
    wingbeats = np.array([row["wingbeats"] for row in rows]) / 1e6
    figure = Figure(figsize=(7.2, 4.2), dpi=110, layout="constrained")
    axes = figure.add_subplot()
    for column, colour, dash, label in (
        ("worst_gap", ORANGE, "--", "worst, of many wings the 95th percentile"),
        ("mean_gap", BLUE, "-", "mean"),
    ):
        gap = 100 * np.array([row[column] for row in rows])
        axes.plot(wingbeats, np.maximum(gap, LEAST_GAP), dash, color=colour, label=label)
    axes.axhline(1, color=GREY, lw=0.8, ls=":")
    axes.set(
        yscale="log",
        xlabel="wingbeats [millions]",
        ylabel=f"{distance} [%]",
        title=verbatim(title),
    )
    axes.legend(frameon=False)
    axes.grid(alpha=0.25)
    return figure
