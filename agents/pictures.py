"""Pictures of a run: its learning curve, and the learned strokes over the optimal ones."""

import csv
import math
from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from agents.comparison import InsectResult
from agents.competition import CompetitionResult, quartiles
from agents.run_folder import CURVE
from flapenv.drawing import BLUE, GREEN, GREY, ORANGE, RED, require_matplotlib

if TYPE_CHECKING:
    from matplotlib.figure import Figure

COLOURS = ("black", BLUE, GREEN, ORANGE, RED, "#CC79A7")
DASHES = (":", "-", "--", "-.", "-", "--")
LEAST_GAP = 1e-2
"""Smallest gap a logarithmic axis shows [%]."""


def draw_learning_curve(out: Path, seed: int) -> "Figure":
    """Mean and worst gap of the noise-free policy against wingbeats, from the run's CSV file."""
    require_matplotlib()
    from matplotlib.figure import Figure

    with (out / CURVE).open(encoding="utf-8", newline="") as file:
        rows = list(csv.DictReader(file))
    wingbeats = np.array([float(row["wingbeats"]) for row in rows]) / 1e6
    figure = Figure(figsize=(7.2, 4.2), dpi=110, layout="constrained")
    axes = figure.add_subplot()
    for column, colour, dash, label in (
        ("worst_gap", ORANGE, "--", "worst insect"),
        ("mean_gap", BLUE, "-", "mean"),
    ):
        gap = 100 * np.array([float(row[column]) for row in rows])
        axes.plot(wingbeats, np.maximum(gap, LEAST_GAP), dash, color=colour, label=label)
    axes.axhline(1, color=GREY, lw=0.8, ls=":")
    axes.set(
        yscale="log",
        xlabel="wingbeats [millions]",
        ylabel="gap to the optimum of the box [%]",
        title=f"Learning to hover: one policy, all insects (seed {seed})",
    )
    axes.legend(frameon=False)
    axes.grid(alpha=0.25)
    return figure


def draw_strokes(results: Sequence[InsectResult]) -> "Figure":
    """Flapping and pitching angle over the cycle, learned against optimal, one panel an insect."""
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
        axes.set_title(f"{result.insect.name}\n{frequencies}", fontsize=9)
        axes.axhline(0, color=GREY, lw=0.5)
        axes.set(xlim=(0, 1), ylim=(-105, 105), yticks=(-90, -45, 0, 45, 90))
    for axes in list(grid.flat)[len(results) :]:
        axes.set_visible(False)
    for axes in grid[-1]:
        axes.set_xlabel("t/T")
    for axes in grid[:, 0]:
        axes.set_ylabel("angle [°]")
    figure.suptitle("flapping φ (blue) and pitching θ (orange): learned thin, optimal broad", fontsize=11)
    return figure


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
            axes.plot(grid[seen], middle[seen], ls=dash, color=colour, label=name)
            axes.fill_between(grid[seen], low[seen], np.minimum(high[seen], 1e4), color=colour, alpha=0.12, lw=0)
        for policy in result.policies if of == "wingbeats" else []:
            gap = 100 * float(np.median(policy.gaps))
            axes.axhline(
                gap, color=GREY, lw=1.2, ls="--", label=f"policy, one wingbeat (trained on {policy.wingbeats:,})"
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
