"""The learning curve of a run."""

import csv
import math
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from agents.run_folder import CURVE
from flapenv.drawing import BLUE, GREY, ORANGE, require_matplotlib, verbatim

if TYPE_CHECKING:
    from matplotlib.figure import Figure

NEEDED = ("wingbeats", "mean_gap", "worst_gap")
"""Columns without which there is no curve."""
LEAST_GAP = 1e-2
"""Smallest distance the logarithmic axis shows [%]."""


def read_curve(out: Path) -> list[dict[str, float]]:
    """The points of a run's learning curve, from its CSV file.

    Args:
        out: folder of the run.

    Raises:
        OSError: if the file cannot be read.
        ValueError: if it is not UTF-8, lacks a column or a number, or has something else in their place.
    """
    path = out / CURVE
    try:
        with path.open(encoding="utf-8", newline="") as file:
            header, *lines = csv.reader(file)
    except (ValueError, csv.Error) as mistake:
        raise ValueError(f"{path} is not a learning curve ({mistake}); allowed: a table with a header") from mistake
    missing = [name for name in NEEDED if name not in header]
    if missing:
        raise ValueError(f"{path} has no column {', '.join(missing)}; allowed: at least {', '.join(NEEDED)}")
    return [_point(header, line, f"{path}, line {number}") for number, line in enumerate(lines, start=2)]


def _point(header: list[str], cells: list[str], where: str) -> dict[str, float]:
    """A row of the table.

    Raises:
        ValueError: for another number of cells, or one that is no number.
    """
    if len(cells) != len(header):
        raise ValueError(f"{where} has {len(cells)} cells; allowed: {len(header)}, as the header has")
    try:
        point = {name: float(cell) for name, cell in zip(header, cells, strict=True)}
    except ValueError as mistake:
        raise ValueError(f"{where}: {mistake}; allowed: numbers") from mistake
    if not math.isfinite(point["wingbeats"]):
        raise ValueError(f"{where}: wingbeats = {point['wingbeats']}; allowed: a finite number")
    return point


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
