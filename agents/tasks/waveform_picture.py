"""Learned waveforms over the best ones. matplotlib is imported inside, so that only those who draw need it."""

import math
from collections.abc import Sequence
from typing import TYPE_CHECKING

import numpy as np

from flapenv.aero.spline_motion import SplineMotion
from flapenv.drawing import BLUE, GREY, require_matplotlib, verbatim

if TYPE_CHECKING:
    from matplotlib.figure import Figure

COLUMNS = 4


def draw_learned_waveforms(titles: Sequence[str], pairs: Sequence[tuple[SplineMotion, SplineMotion]]) -> "Figure":
    """φ̇ over its mean and θ over a cycle, two panels an insect.

    Args:
        titles: of each insect.
        pairs: its learned and its best wingbeat.

    Raises:
        ImportError: without matplotlib.
    """
    require_matplotlib()
    from matplotlib.figure import Figure

    columns = min(COLUMNS, len(pairs))
    lines = math.ceil(len(pairs) / columns)
    figure = Figure(figsize=(2.5 * columns + 0.8, 3.4 * lines + 0.5), dpi=100, layout="constrained")
    panels = figure.subplots(2 * lines, columns, sharex=True, sharey="row", squeeze=False)
    time = np.linspace(0, 1, 481)
    for number in range(lines * columns):
        rate, pitch = panels[2 * (number // columns) : 2 * (number // columns) + 2, number % columns]
        if number >= len(pairs):
            rate.axis("off")
            pitch.axis("off")
            continue
        learned, best = pairs[number]
        for motion, style in ((best, {"color": GREY, "lw": 4, "alpha": 0.45}), (learned, {"color": BLUE, "lw": 1.3})):
            phase = 2 * math.pi * time + motion.reversal
            label = "learned" if motion is learned else "best splines"
            rate.plot(time, motion.flap_rate(phase) / motion.mean_flap_speed, label=label, **style)
            pitch.plot(time, np.degrees(motion.pitch_angle(phase)), **style)
        rate.set_title(verbatim(titles[number]), fontsize=9)
        pitch.set(xlim=(0, 1), yticks=(-60, 0, 60))
    for line in range(lines):
        panels[2 * line, 0].set_ylabel("φ̇ / mean |φ̇|")
        panels[2 * line + 1, 0].set_ylabel("θ [°]")
    for axes in panels[-1]:
        axes.set_xlabel("t/T, from the reversal")
    handles, labels = panels[0, 0].get_legend_handles_labels()
    figure.legend(handles, labels, loc="outside upper center", ncols=2, frameon=False, fontsize=9)
    return figure
