"""Picture of an episode: heights over the beats so far, and the last wingbeat. matplotlib is imported inside."""

from typing import TYPE_CHECKING

import numpy as np

from flapenv.aero.stroke import Stroke
from flapenv.drawing import BLUE, GREY, RED, draw_wing_sections, figure_image, require_matplotlib, stroke_text
from flapenv.insects import Insect

if TYPE_CHECKING:
    from matplotlib.figure import Figure


def draw_heave(insect: Insect, stroke: Stroke, path: np.ndarray, *, beats: int, limit: float) -> "Figure":
    """Heights over the beats of an episode, and wing sections of its last beat.

    Args:
        insect: the insect.
        stroke: of the last beat, scalar fields.
        path: z/R from the start on, shape (n,) [-].
        beats: of a whole episode.
        limit: |z|/R at which an episode is lost.

    Raises:
        ImportError: without matplotlib.
    """
    require_matplotlib()
    from matplotlib.figure import Figure

    figure = Figure(figsize=(9.6, 6.4), dpi=100, layout="constrained")
    grid = figure.add_gridspec(2, 1, height_ratios=(1.3, 1))
    figure.suptitle(f"{insect.name}, beat {len(path) - 1} of {beats}\n{stroke_text(stroke)}", fontsize=11)
    axes = figure.add_subplot(grid[0])
    axes.axhspan(-limit, limit, color=BLUE, alpha=0.06, lw=0)
    for edge in (-limit, limit):
        axes.axhline(edge, color=RED, lw=1, ls="--")
    axes.axhline(0, color=GREY, lw=0.8)
    axes.plot(np.arange(len(path)), path, color=BLUE)
    axes.plot(len(path) - 1, path[-1], "o", color=BLUE)
    axes.annotate(
        f"z = {path[-1]:+.2f} R",
        (len(path) - 1, path[-1]),
        xytext=(-8 if len(path) > 0.8 * beats else 8, 8),
        textcoords="offset points",
        ha="right" if len(path) > 0.8 * beats else "left",
        color=BLUE,
    )
    axes.set(
        xlim=(0, beats), ylim=(-1.15 * limit, 1.15 * limit), xlabel="beat", ylabel="height z/R", title="lost beyond ---"
    )
    draw_wing_sections(figure.add_subplot(grid[1]), insect, stroke)
    return figure


def heave_image(insect: Insect, stroke: Stroke, path: np.ndarray, *, beats: int, limit: float) -> np.ndarray:
    """`draw_heave` as an array (height, width, 3) of uint8."""
    return figure_image(draw_heave(insect, stroke, path, beats=beats, limit=limit))
