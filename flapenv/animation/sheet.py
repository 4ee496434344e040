"""The sheet of a moving picture: drawn once, then only what moves is drawn again."""

import math
from collections.abc import Sequence
from typing import TYPE_CHECKING, Any

import numpy as np

from flapenv.aero.stroke import Stroke
from flapenv.animation.beat import DrawnBeat
from flapenv.animation.panels import AbovePanel, Panel, SectionPanel, TracePanel
from flapenv.drawing import BLACK, BLUE, GREEN, ORANGE, RED, stroke_text, verbatim

if TYPE_CHECKING:
    from matplotlib.axes import Axes

WIDTH, HEIGHT = 960, 540
"""Pixels at which lines and letters have their nominal size."""
ROUNDING = 1e-3
"""Pixels that keep a size in inches from being cut down to one pixel less."""
SMALLEST_RANGE = 1e-9
"""Of an axis, in its unit, where nothing varies."""


class MovingSheet:
    """The figure of one or more beats; `image` gives one frame after the other."""

    def __init__(self, beats: Sequence[DrawnBeat], width: int) -> None:
        """Draw all that stands still.

        Args:
            beats: from top to bottom, of equally many frames.
            width: of the picture, even [pixels].
        """
        from matplotlib.backends.backend_agg import FigureCanvasAgg
        from matplotlib.figure import Figure
        from matplotlib.layout_engine import ConstrainedLayoutEngine

        height = len(beats) * 2 * round(width * HEIGHT / WIDTH / 2)
        dpi = 100 * width / WIDTH
        size = (width + ROUNDING) / dpi, (height + ROUNDING) / dpi
        figure: Any = Figure(figsize=size, dpi=dpi, layout=ConstrainedLayoutEngine(w_pad=0.08, h_pad=0.06))
        canvas: Any = FigureCanvasAgg(figure)
        self.canvas, self.beats, self.panels = canvas, beats, list[Sequence[Panel]]()
        limits = _limits([beat.force[:, 1] for beat in beats]), _limits([beat.specific_power for beat in beats])
        sections = []
        for beat, part in zip(beats, figure.subfigures(len(beats), 1, squeeze=False)[:, 0], strict=True):
            section, others = _panels(part, beat, *limits)
            sections.append(section)
            self.panels.append([section, *others])
        canvas.draw()
        figure.set_layout_engine("none")  # every panel keeps the size it has now
        for section in sections:
            section.fit(beats)
        canvas.draw()
        self.still = canvas.copy_from_bbox(figure.bbox)

    def image(self, frame: int) -> np.ndarray:
        """One frame, shape (height, width, 3) of uint8.

        Args:
            frame: its number, from 0; the one after the last is the first again.
        """
        self.canvas.restore_region(self.still)
        for beat, panels in zip(self.beats, self.panels, strict=True):
            for panel in panels:
                panel.move(int(beat.rows[frame % len(beat.rows)]))
                for artist in panel.artists:
                    artist.axes.draw_artist(artist)
        return np.asarray(self.canvas.buffer_rgba())[..., :3].copy()


def _limits(values: Sequence[np.ndarray]) -> tuple[float, float]:
    """The least and the largest of all, and zero."""
    low, high = float(np.min(values, initial=0.0)), float(np.max(values, initial=0.0))
    return low, max(high, low + SMALLEST_RANGE)


def _panels(
    part: Any, beat: DrawnBeat, lift_limits: tuple[float, float], power_limits: tuple[float, float]
) -> tuple[SectionPanel, list[Panel]]:
    """The panels of one beat: the section; the wings from above and three traces."""
    part.suptitle(
        f"{verbatim(beat.name)}: weight support {beat.weight_support:.3f}, {beat.mean_power:.2f} W/kg\n"
        f"{_motion_text(beat)}",
        fontsize=11,
    )
    left, right = part.add_gridspec(1, 2, width_ratios=(1.6, 1))
    upper, lower = left.subgridspec(2, 1, height_ratios=(1.25, 1))
    above, legend = lower.subgridspec(1, 2, width_ratios=(1, 1.1))
    angles_axes, lift_axes, power_axes = right.subgridspec(3, 1, height_ratios=(1.25, 1, 1)).subplots(sharex=True)
    _draw_legend(part.add_subplot(legend))
    at = beat.history.kinematics
    angles = (
        (np.degrees(at.flap), BLUE, "-", "φ flap"),
        (np.degrees(at.pitch), ORANGE, "--", "θ pitch"),
        (np.degrees(beat.history.angle_of_attack), GREEN, "-.", "α attack"),
    )
    lift, power = beat.force[:, 1], beat.specific_power
    others: list[Panel] = [
        AbovePanel(part.add_subplot(above), beat),
        TracePanel(angles_axes, beat, angles, "angle [°]"),
        TracePanel(lift_axes, beat, [(lift, BLUE, "-", "")], "lift / weight", beat.weight_support, lift_limits),
        TracePanel(power_axes, beat, [(power, RED, "-", "")], "power [W/kg]", beat.mean_power, power_limits),
    ]
    angles_axes.set(ylim=(-110, 190), yticks=range(-90, 181, 90))
    power_axes.set(xlabel="t/T", xlim=(0, 1))
    part.align_ylabels([angles_axes, lift_axes, power_axes])
    return SectionPanel(part.add_subplot(upper), beat), others


def _motion_text(beat: DrawnBeat) -> str:
    """The motion in one line."""
    if isinstance(beat.motion, Stroke):
        return stroke_text(beat.motion)
    return f"f = {beat.motion.frequency:.4g} Hz   φmax = {math.degrees(beat.motion.flap_amplitude):.1f}°"


def _draw_legend(axes: "Axes") -> None:
    """What the section's panel shows."""
    from matplotlib.lines import Line2D

    axes.axis("off")
    entries = [
        Line2D([], [], color=BLACK, lw=3, label="force of both wings"),
        Line2D([], [], color=BLUE, lw=2, label="its lift"),
        Line2D([], [], color=RED, lw=2, label="its drag"),
        Line2D([], [], color=ORANGE, lw=4, marker="o", mec=BLACK, label="wing section, leading edge"),
        Line2D([], [], color="none", marker="o", mfc="white", mec=BLACK, label="pitching axis"),
    ]
    axes.legend(handles=entries, loc="center left", frameon=False, fontsize=9)
