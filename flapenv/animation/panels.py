"""The panels of a moving picture: the wing section, the wings from above, and traces over the cycle."""

import itertools
import math
from collections.abc import Sequence
from typing import TYPE_CHECKING, Any, Protocol

import numpy as np

from flapenv.aero.axes import LEFT, RIGHT
from flapenv.animation.beat import DrawnBeat
from flapenv.drawing import BLACK, BLUE, GREY, ORANGE, RED

if TYPE_CHECKING:
    from matplotlib.axes import Axes

SIDE_MARGIN, MARGIN = 0.14, 0.06
"""Around the section's path: left of it, where the scale stands, and elsewhere, over its width or height."""
ROOM_USED, TALLEST_WEIGHT = 0.96, 0.7
"""How far arrows may go into the room there is, and how much of the height one weight may take."""
LEAST_HEIGHT = 1.7
"""Of the panel, over that of the section as it turns."""
SMALLEST_FORCE = 1e-6
"""Body weights; stands in for zero where a force divides."""


class Panel(Protocol):
    """A panel whose artists move."""

    artists: list[Any]

    def move(self, row: int) -> None:
        """Put the artists where they are at an instant of the history."""


class SectionPanel:
    """The section at r̂₂ R going back and forth along its unrolled arc, with its trail and the force on it."""

    def __init__(self, axes: "Axes", beat: DrawnBeat) -> None:
        """Draw the arc; what has a scale follows in `fit`, once the panel has its size."""
        from matplotlib.collections import LineCollection
        from matplotlib.patches import Polygon

        self.axes, self.beat = axes, beat
        self.unit, self.thickness = 1.0, 0.0  # mean chords: of an arrow of one weight, of its shaft
        axes.set(yticks=[], xlabel="arc of the section at r̂₂ [mean chords]")
        axes.axhline(0, color=GREY, lw=0.5, ls=":", zorder=0)
        self.trail = LineCollection([], lw=2.5, animated=True)
        self.trail_forces = LineCollection([], lw=1, animated=True)
        for lines in (self.trail, self.trail_forces):
            axes.add_collection(lines, autolim=False)
        (self.chord,) = axes.plot([], [], color=ORANGE, lw=5, solid_capstyle="round", animated=True)
        (self.front,) = axes.plot([], [], "o", color=ORANGE, mec=BLACK, ms=8, animated=True)
        (self.pivot,) = axes.plot([], [], "o", color="white", mec=BLACK, ms=4, animated=True)
        self.drag, self.lift, self.total = (
            Polygon([(0, 0)], closed=True, fc=colour, ec="none", animated=True) for colour in (RED, BLUE, BLACK)
        )
        for arrow in (self.drag, self.lift, self.total):
            axes.add_patch(arrow)
        self.sense = axes.text(0.5, 0.03, "", transform=axes.transAxes, ha="center", va="bottom", animated=True)
        self.artists = [
            *(self.trail_forces, self.trail, self.chord, self.front),
            *(self.drag, self.lift, self.total, self.pivot, self.sense),
        ]

    def fit(self, beats: Sequence[DrawnBeat]) -> None:
        """Choose the limits, so that both directions have one scale, and the longest arrows that stay inside.

        Args:
            beats: all that the picture shows, for one scale.
        """
        from matplotlib.patches import Polygon

        axes = self.axes
        ends = np.concatenate([edge for beat in beats for edge in (beat.leading, beat.trailing)])
        axis, force = (np.concatenate([getattr(beat, name) for beat in beats]) for name in ("axis", "force"))
        (left, bottom), (right, top) = ends.min(axis=0), ends.max(axis=0)
        shape = axes.bbox.height / axes.bbox.width
        spare = max(0.0, LEAST_HEIGHT * (top - bottom) / shape - (right - left)) / 2  # where a wing hardly flaps
        left, right = left - spare, right + spare
        left, right = left - SIDE_MARGIN * (right - left), right + MARGIN * (right - left)
        height = (right - left) * shape
        if np.min(force[:, 1]) > -SMALLEST_FORCE:  # all arrows go up: give them the room
            bottom -= MARGIN * height
        else:
            bottom = (bottom + top - height) / 2
        low, high = np.array([left, bottom]), np.array([right, bottom + height])
        axes.set(xlim=(left, right), ylim=(low[1], high[1]))
        room = np.where(force > 0, high - axis, axis - low)
        self.unit = ROOM_USED * float(np.min(room / np.maximum(np.abs(force), SMALLEST_FORCE)))
        self.unit = min(self.unit, TALLEST_WEIGHT * height)
        self.thickness = 0.008 * (right - left)
        foot = np.array([left + 0.03 * (right - left), high[1] - 0.05 * height - self.unit])
        bar = arrow_outline(foot, np.array([0.0, self.unit]), self.thickness)
        axes.add_patch(Polygon(bar, closed=True, fc=GREY, ec="none"))
        beside = foot[0] + 2 * self.thickness, foot[1] + self.unit / 2
        axes.text(*beside, "1 weight", color=GREY, fontsize=9, va="center")

    def move(self, row: int) -> None:
        """Put section, trail and arrows where they are at an instant."""
        beat, foot = self.beat, self.beat.axis[row]
        force = self.unit * beat.force[row]
        self.drag.set_xy(arrow_outline(foot, force * [1, 0], 0.7 * self.thickness))
        self.lift.set_xy(arrow_outline(foot, force * [0, 1], 0.7 * self.thickness))
        self.total.set_xy(arrow_outline(foot, force, self.thickness))
        self.chord.set_data(*np.stack([beat.trailing[row], beat.leading[row]], axis=1))
        self.front.set_data(*beat.leading[row, :, None])
        self.pivot.set_data(*foot[:, None])
        rows, fresh = beat.trail(row)
        tips = beat.axis[rows] + self.unit * beat.force[rows]
        self.trail.set_segments(list(np.stack([beat.trailing[rows], beat.leading[rows]], axis=1)))
        self.trail.set_color([(ORANGE, 0.6 * share) for share in fresh])
        self.trail_forces.set_segments(list(np.stack([beat.axis[rows], tips], axis=1)))
        self.trail_forces.set_color([(BLACK, 0.35 * share) for share in fresh])
        self.sense.set_text("forward half-stroke →" if beat.sense(row) > 0 else "← backward half-stroke")


def arrow_outline(foot: np.ndarray, vector: np.ndarray, width: float) -> np.ndarray:
    """Corners of an arrow; a short one is all head, none at all a point.

    Args:
        foot: where it starts, shape (2,).
        vector: to its tip, shape (2,).
        width: of the shaft.

    Returns:
        Shape (7, 2).
    """
    length = float(np.hypot(*vector))
    if length == 0:
        return np.tile(foot, (7, 1))
    along = vector / length
    across = np.array([-along[1], along[0]])
    head = min(4 * width, length)
    neck = foot + (length - head) * along
    half, barb = min(width / 2, head / 4) * across, head / 2.4 * across
    return np.stack([foot + half, neck + half, neck + barb, foot + vector, neck - barb, neck - half, foot - half])


class AbovePanel:
    """Body and wings from above, forward to the right."""

    def __init__(self, axes: "Axes", beat: DrawnBeat) -> None:
        """Draw the body and what the wings sweep."""
        from matplotlib.patches import Ellipse, Polygon

        self.beat = beat
        axes.set(xlim=(-1.12, 1.12), ylim=(-1.12, 1.12), xticks=[], yticks=[])
        axes.set_xlabel("from above, forward →\ndotted: paths of tip and section", fontsize=9)
        axes.set_aspect("equal")
        axes.add_patch(Ellipse((-0.1, 0), 0.75, 0.2, facecolor="#dddddd", edgecolor=GREY, lw=1))
        flap = beat.history.kinematics.flap
        angles = np.linspace(np.min(flap), np.max(flap), 60)
        for side, radius in itertools.product((RIGHT, LEFT), (math.sqrt(beat.wing.moment(2)), 1.0)):
            axes.plot(radius * np.sin(angles), -side * radius * np.cos(angles), color=GREY, lw=0.8, ls=":")
        self.wings = [Polygon([(0, 0)], closed=True, fc=ORANGE, ec="none", alpha=0.8, animated=True) for _ in range(2)]
        for wing in self.wings:
            axes.add_patch(wing)
        self.edges = [axes.plot([], [], color=BLACK, lw=1.5, animated=True)[0] for _ in range(2)]
        self.artists = [*self.wings, *self.edges]

    def move(self, row: int) -> None:
        """Put both wings where they are at an instant."""
        for wing, edge, outline in zip(self.wings, self.edges, self.beat.outlines(row), strict=True):
            wing.set_xy(outline)
            edge.set_data(*outline[: len(outline) // 2].T)


class TracePanel:
    """Quantities over the cycle, with a line and dots at the instant."""

    def __init__(
        self,
        axes: "Axes",
        beat: DrawnBeat,
        traces: Sequence[tuple[np.ndarray, str, str, str]],
        label: str,
        mean: float | None = None,
        limits: tuple[float, float] = (0.0, 0.0),
    ) -> None:
        """Draw the traces.

        Args:
            axes: of the panel.
            beat: for its time.
            traces: values (steps,), colour, dash and name of each.
            label: of the vertical axis.
            mean: drawn as a line with its number, where given.
            limits: with a mean, the least and the largest value of all panels that this one compares with.
        """
        self.time, self.traces = beat.time, [trace[0] for trace in traces]
        axes.axhline(0, color=GREY, lw=0.5)
        for values, colour, dash, name in traces:
            axes.plot(beat.time, values, dash, color=colour, lw=1.5, label=name or None)
        axes.set_ylabel(label)
        if mean is not None:
            number = f"mean {mean:.3f}" if abs(mean) < 10 else f"mean {mean:.2f}"
            axes.axhline(mean, color=GREY, lw=1, ls="--", label=number)
            reach = limits[1] - limits[0]
            axes.set_ylim(limits[0] - 0.05 * reach, limits[0] + 1.35 * reach)  # the legend stands above
        axes.legend(ncols=3, fontsize=8, loc="upper right", frameon=False, columnspacing=1, handlelength=1.6)
        self.line = axes.axvline(0, color=BLACK, lw=0.8, animated=True)
        self.dots = [axes.plot([], [], "o", color=trace[1], mec=BLACK, ms=5, animated=True)[0] for trace in traces]
        self.artists = [self.line, *self.dots]

    def move(self, row: int) -> None:
        """Put line and dots where they are at an instant."""
        self.line.set_xdata([self.time[row]] * 2)
        for dot, values in zip(self.dots, self.traces, strict=True):
            dot.set_data([self.time[row]], [values[row]])
