"""The waveforms of the lift ladder, solved: what `python -m flapenv.adapt --rungs` writes."""

import csv
import math
from pathlib import Path

import numpy as np

from flapenv.adapt.ladder import BOX, RUNGS_FILE
from flapenv.shape_curve import curve, largest_lift, shapes_of

RUNGS = 401
"""Waveforms of the ladder, the corner and the largest lift among them."""
SPREAD_STARTS = 12
"""From which the corner is sought."""


def solve_rungs(count: int = RUNGS) -> np.ndarray:
    """Points of the cube from the corner, the least S/L^1.5, to the largest lift, shape (count, 4).

    Between them the least S with L >= s, s crowded towards both ends, where waveforms change most.

    Args:
        count: of the points.
    """
    shapes = shapes_of(BOX)
    starts = np.random.default_rng(0).uniform(-1, 1, (SPREAD_STARTS, len(shapes.coordinates)))
    corner = shapes.best("free", starts)
    low, high = float(shapes.numbers(corner[None])[0][0]), largest_lift(BOX)[1]
    grid = low + (high - low) * (1 - np.cos(np.linspace(0, math.pi, count)[1:-1])) / 2
    return np.concatenate([corner[None], curve(BOX, "fixed", grid), largest_lift(BOX)[0][None]])


def write_rungs(folder: Path) -> Path:
    """Solve the ladder and write it.

    Args:
        folder: that exists; the package's data folder to ship it.

    Returns:
        The file.
    """
    path = folder / RUNGS_FILE
    with path.open("w", encoding="utf-8", newline="") as file:
        writer = csv.writer(file, lineterminator="\n")
        writer.writerow(shapes_of(BOX).coordinates.names)
        writer.writerows([f"{value:.9f}" for value in point] for point in solve_rungs() + 0.0)
    return path
