"""Where a policy for random wings is off."""

from typing import TYPE_CHECKING

import numpy as np

from agents.tasks.wing_flights import WingFlights, WingPool
from flapenv.drawing import BLUE, GREY, ORANGE, require_matplotlib

if TYPE_CHECKING:
    from matplotlib.figure import Figure

SHOWN = 3_000
"""Wings of each split that are drawn."""
LEAST_GAP = 1e-3
"""Smallest gap that the logarithmic axis shows [%]."""


def draw_wings(flown: dict[str, tuple[WingPool, WingFlights]]) -> "Figure":
    """Gap and frequency error of every wing over its aspect ratio, test wings and those outside."""
    require_matplotlib()
    from matplotlib.figure import Figure

    figure = Figure(figsize=(9.6, 4.0), dpi=110, layout="constrained")
    gaps, errors = figure.subplots(1, 2, sharex=True)
    for (split, (pool, flights)), colour in zip(flown.items(), (BLUE, ORANGE), strict=False):
        aspect_ratio = pool.env.flyers.cases.aspect_ratio[flights.feasible][:SHOWN]
        label = f"{split}: mean {100 * flights.mean:.2f} %, 95 % below {100 * flights.most:.2f} %"
        style = {"color": colour, "s": 3, "alpha": 0.35, "lw": 0}
        gaps.scatter(aspect_ratio, np.maximum(100 * flights.gaps[:SHOWN], LEAST_GAP), label=label, **style)
        label = f"{split}: rms {100 * flights.rms_frequency_error:.2f} %"
        errors.scatter(aspect_ratio, 100 * flights.frequency_error[:SHOWN], label=label, **style)
    gaps.set(yscale="log", ylabel="gap to the wing's own optimum [%]", xlabel="aspect ratio of one wing")
    errors.set(ylabel="log of frequency over the optimum's [%]", xlabel="aspect ratio of one wing")
    errors.axhline(0, color=GREY, lw=0.8)
    for axes in (gaps, errors):
        axes.legend(frameon=False, fontsize=8, markerscale=3)
        axes.grid(alpha=0.25)
    return figure
