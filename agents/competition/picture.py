"""A picture of the equal-budget competition."""

from typing import TYPE_CHECKING

import numpy as np

from agents.competition.compete import CompetitionResult
from agents.competition.table import quartiles
from flapenv.drawing import BLUE, GREEN, GREY, ORANGE, RED, require_matplotlib

if TYPE_CHECKING:
    from matplotlib.figure import Figure

COLOURS = ("black", BLUE, GREEN, ORANGE, RED, "#CC79A7")
DASHES = (":", "-", "--", "-.", "-", "--")
LEAST_GAP = 1e-2
"""Smallest gap a logarithmic axis shows [%]."""


def draw_competition(result: CompetitionResult) -> "Figure":
    """Best gap so far against wingbeats and against seconds: median and interquartile range over wings and seeds."""
    require_matplotlib()
    from matplotlib.figure import Figure

    figure = Figure(figsize=(10.0, 4.6), dpi=100, layout="constrained")
    panels = figure.subplots(1, 2, sharey=True)
    ends = {"wingbeats": float(result.config.wingbeats), "seconds": 0.0}
    seen_last = [trace.seconds[-1] for traces in result.traces.values() for trace in traces if trace.seconds]
    ends["seconds"] = max(seen_last, default=1.0)
    starts = {"wingbeats": 1.0, "seconds": 1e-3}
    for axes, of in zip(panels, ("wingbeats", "seconds"), strict=True):
        grid = np.geomspace(starts[of], max(ends[of], 2 * starts[of]), 120)
        for (name, traces), colour, dash in zip(result.traces.items(), COLOURS, DASHES, strict=False):
            if not traces:
                continue
            low, middle, high = (
                100 * np.clip(column, LEAST_GAP / 1e4, None)
                for column in np.transpose([quartiles(traces, spent, of=of) for spent in grid])
            )
            seen = np.isfinite(middle)
            if not np.any(seen):  # most of its searches found no stroke that carries the weight
                continue
            axes.plot(grid[seen], middle[seen], ls=dash, color=colour, label=name)
            axes.fill_between(grid[seen], low[seen], np.minimum(high[seen], 1e4), color=colour, alpha=0.12, lw=0)
        for policy in result.policies if of == "wingbeats" else []:
            gap = 100 * float(np.median(policy.gaps))
            axes.axhline(
                max(gap, LEAST_GAP / 1e2),
                color=GREY,
                lw=1.2,
                ls="--",
                label=f"policy, one wingbeat (trained on {policy.wingbeats:,})",
            )
        axes.set(xscale="log", yscale="log", xlabel=f"{of} on one wing", ylim=(1e-4, 1e3))
        axes.grid(alpha=0.25)
        axes.label_outer()
    panels[0].set_ylabel("gap to the optimum [%]")
    figure.legend(
        *panels[0].get_legend_handles_labels(), loc="outside lower center", ncols=4, fontsize=8, frameon=False
    )
    wings = len(result.insects)
    figure.suptitle(
        f"{result.config.problem.name}: best stroke so far, median and quartiles over {wings} wings, "
        f"{result.config.seeds} seeds",
        fontsize=11,
    )
    return figure
