"""Picture of an episode: heights over the beats so far, and the last wingbeat. matplotlib is imported inside."""

from typing import TYPE_CHECKING

import numpy as np

from flapenv.aero.stroke import Stroke
from flapenv.drawing import (
    BLUE,
    GREY,
    ORANGE,
    RED,
    draw_wing_sections,
    figure_image,
    require_matplotlib,
    stroke_text,
    verbatim,
)
from flapenv.insects import Insect

if TYPE_CHECKING:
    from matplotlib.axes import Axes
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
    grid = figure.add_gridspec(2, 2, width_ratios=(2.2, 1))
    figure.suptitle(f"{verbatim(insect.name)}, beat {len(path) - 1} of {beats}\n{stroke_text(stroke)}", fontsize=11)
    _draw_path(figure.add_subplot(grid[0, :]), path, beats, limit)
    sections = figure.add_subplot(grid[1, 0])
    draw_wing_sections(sections, insect, stroke)
    sections.set_ylim(-2.2, 2.2)  # room for the words above wings of high aspect ratio
    axes = figure.add_subplot(grid[1, 1])
    phase = np.linspace(0, 2 * np.pi, 361)
    axes.plot(phase / (2 * np.pi), np.degrees(stroke.flap_angle(phase)), color=BLUE, label="φ flap")
    axes.plot(phase / (2 * np.pi), np.degrees(stroke.pitch_angle(phase)), "--", color=ORANGE, label="θ pitch")
    axes.axhline(0, color=GREY, lw=0.5)
    axes.set(xlabel="t/T", ylabel="angle [°]", xlim=(0, 1), ylim=(-100, 135), yticks=range(-90, 91, 45))
    axes.legend(ncols=2, fontsize=8, loc="upper center", frameon=False)
    return figure


def _draw_path(axes: "Axes", path: np.ndarray, beats: int, limit: float) -> None:
    """Heights over the beats, and the band."""
    axes.axhspan(-limit, limit, color=BLUE, alpha=0.06, lw=0)
    for edge in (-limit, limit):
        axes.axhline(edge, color=RED, lw=1, ls="--")
    axes.annotate(f"lost beyond ±{limit:g} R", (0, limit), (6, -14), textcoords="offset points", color=RED, fontsize=9)
    axes.axhline(0, color=GREY, lw=0.8)
    axes.plot(np.arange(len(path)), path, color=BLUE)
    axes.plot(len(path) - 1, path[-1], "o", color=BLUE, clip_on=False)
    late = len(path) > 0.8 * beats
    axes.annotate(
        f"z = {path[-1]:+.2f} R",
        (len(path) - 1, path[-1]),
        (-8 if late else 8, -14 if path[-1] > 0.8 * limit else 8),
        textcoords="offset points",
        ha="right" if late else "left",
        color=BLUE,
    )
    axes.set(xlim=(0, beats), ylim=(-1.12 * limit, 1.12 * limit), xlabel="beat", ylabel="height z/R")


def heave_image(insect: Insect, stroke: Stroke, path: np.ndarray, *, beats: int, limit: float) -> np.ndarray:
    """`draw_heave` as an array (height, width, 3) of uint8."""
    return figure_image(draw_heave(insect, stroke, path, beats=beats, limit=limit))
