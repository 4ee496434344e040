"""Learned strokes over the optimal ones."""

import math
import textwrap
from collections.abc import Sequence
from typing import TYPE_CHECKING

import numpy as np

from agents.evaluation.assessment_table import LEARNED
from flapenv.assessment import StrokeAssessment
from flapenv.drawing import BLUE, GREY, ORANGE, require_matplotlib, verbatim

if TYPE_CHECKING:
    from matplotlib.figure import Figure


def draw_strokes(results: Sequence[StrokeAssessment], called: str = LEARNED) -> "Figure":
    """Flapping and pitching angle over the cycle, over those of the optimum, one panel an insect.

    Args:
        results: one an insect.
        called: what the strokes are, in a word.
    """
    require_matplotlib()
    from matplotlib.figure import Figure

    columns = min(4, len(results))
    lines = math.ceil(len(results) / columns)
    figure = Figure(figsize=(3.0 * columns + 0.6, 2.5 * lines + 0.8), dpi=100, layout="constrained")
    grid = figure.subplots(lines, columns, sharex=True, sharey=True, squeeze=False)
    phase = np.linspace(0, 2 * math.pi, 361)
    for axes, result in zip(grid.flat, results, strict=False):
        for stroke, width, dash, alpha in ((result.best.stroke, 4.0, "-", 0.35), (result.stroke, 1.4, "-", 1.0)):
            for angle, colour in ((stroke.flap_angle(phase), BLUE), (stroke.pitch_angle(phase), ORANGE)):
                axes.plot(phase / (2 * math.pi), np.degrees(angle), dash, color=colour, lw=width, alpha=alpha)
        frequencies = f"{result.stroke.frequency:.4g} Hz (optimal {result.best.stroke.frequency:.4g})"
        axes.set_title(f"{verbatim(result.insect.name)}\n{frequencies}", fontsize=9)
        axes.axhline(0, color=GREY, lw=0.5)
        axes.set(xlim=(0, 1), ylim=(-105, 105), yticks=(-90, -45, 0, 45, 90))
    for axes in list(grid.flat)[len(results) :]:
        axes.set_visible(False)
    for axes in grid[-1]:
        axes.set_xlabel("t/T")
    for axes in grid[:, 0]:
        axes.set_ylabel("angle [°]")
    said = f"flapping φ (blue) and pitching θ (orange): {called} thin, optimal broad"
    figure.suptitle(textwrap.fill(said, 38 * columns), fontsize=11)
    return figure
