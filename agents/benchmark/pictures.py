"""Pictures of a benchmark: how near each learner came, how fast, on what share of insects, and the other tasks."""

from collections.abc import Sequence
from typing import TYPE_CHECKING

import numpy as np

from agents.benchmark.data import BenchmarkData, CurvePoint
from agents.benchmark.statistics import interquartile_mean, interval, last_known, profile
from agents.competition.picture import COLOURS, DASHES
from flapenv.drawing import BLUE, GREY, ORANGE, require_matplotlib

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

FINAL_PICTURE, CURVES_PICTURE = "hover_final.png", "hover_curves.png"
PROFILE_PICTURE, OTHERS_PICTURE = "hover_profile.png", "other_tasks.png"
HOVER = "hover"
"""What the names of the presets compared with each other begin with."""
LABELS = {"gradient": "gradient", "ppo": "PPO", "sac": "SAC", "td3": "TD3", "tqc": "TQC", "crossq": "CrossQ"}
LEAST = 1e-4
"""Smallest distance that a logarithmic axis shows [%]; the optimum is known no better."""


def draw_all(data: BenchmarkData) -> dict[str, "Figure"]:
    """The pictures that the data give, by file name."""
    require_matplotlib()
    pictures = {}
    learners = [preset for preset in data.presets if _family(preset) == HOVER]
    others = [preset for preset in data.presets if preset not in learners]
    if learners:
        pictures[FINAL_PICTURE] = draw_final(data, learners)
    if any(data.curves_of(preset)[0] for preset in learners):
        pictures[CURVES_PICTURE] = draw_curves(data, learners)
    if any(len(data.gaps_of(preset)) for preset in learners):
        pictures[PROFILE_PICTURE] = draw_profile(data, learners)
    if others:
        pictures[OTHERS_PICTURE] = draw_others(data, others)
    return pictures


def draw_final(data: BenchmarkData, presets: Sequence[str]) -> "Figure":
    """Interquartile mean of the final distances with its interval, and every seed."""
    figure = _figure(7.2, 0.45 * len(presets) + 1.4)
    axes = figure.add_subplot()
    for place, preset in enumerate(presets):
        values = 100 * np.array([run.mean for run in data.runs_of(preset)])
        colour, _ = _style(preset)
        axes.plot(_shown(values), np.full(len(values), place + 0.22), "o", color=colour, ms=4, alpha=0.45, mew=0)
        middle, ends = float(interquartile_mean(values)), interval(values)
        if ends is not None:
            axes.plot(_shown(np.array(ends)), [place, place], color=colour, lw=5, alpha=0.35, solid_capstyle="butt")
        axes.plot(_shown(np.array([middle])), [place], "|", color=colour, ms=17, mew=2.5)
    axes.set(
        xscale="log",
        yticks=range(len(presets)),
        yticklabels=[label(preset) for preset in presets],
        ylim=(len(presets) - 0.4, -0.6),
        xlabel=f"mean gap to the optimum after training [%]{_at_least(data, presets)}",
        title=f"Hover-v0, {_seeds(data, presets)}: interquartile mean, 95 % interval, every seed (dots)",
    )
    axes.title.set_fontsize(10)
    axes.grid(alpha=0.25, axis="x")
    axes.xaxis.set_major_formatter("{x:g}")
    return figure


def draw_curves(data: BenchmarkData, presets: Sequence[str]) -> "Figure":
    """Distance of the noise-free policy against wingbeats and against seconds."""
    figure = _figure(10.0, 4.6)
    panels = figure.subplots(1, 2, sharey=True)
    for axes, of, least in zip(panels, ("wingbeats", "seconds"), (1.0, 1e-2), strict=True):
        for preset in presets:
            curves = [curve for curve in data.curves_of(preset) if curve]
            if curves:
                _draw_band(axes, preset, curves, of, least)
        axes.axhline(1, color=GREY, lw=0.8, ls=":")
        axes.set(xscale="log", yscale="log", xlabel=of if of == "wingbeats" else "seconds on one thread")
        axes.grid(alpha=0.25)
        axes.label_outer()
    panels[0].set_ylabel("mean gap to the optimum [%]")
    panels[0].yaxis.set_major_formatter("{x:g}")
    handles, labels = panels[0].get_legend_handles_labels()
    figure.legend(handles, labels, loc="outside lower center", ncols=len(labels), fontsize=9, frameon=False)
    figure.suptitle(
        f"Hover-v0: interquartile mean (line), smallest and largest (band) of {_seeds(data, presets)}", fontsize=11
    )
    return figure


def _draw_band(axes: "Axes", preset: str, curves: Sequence[Sequence[CurvePoint]], of: str, least: float) -> None:
    """Interquartile mean and extremes of a preset's curves, each held at its last point."""
    places = [np.maximum([getattr(point, of) for point in curve], least) for curve in curves]
    grid = np.geomspace(max(one[0] for one in places), max(one[-1] for one in places), 200)
    means = [np.array([100 * point.mean for point in curve]) for curve in curves]
    values = np.array([last_known(at, mean, grid) for at, mean in zip(places, means, strict=True)])
    colour, dash = _style(preset)
    axes.plot(grid, _shown(interquartile_mean(values, axis=0)), ls=dash, color=colour, label=label(preset))
    axes.fill_between(grid, _shown(values.min(axis=0)), _shown(values.max(axis=0)), color=colour, alpha=0.12, lw=0)


def draw_profile(data: BenchmarkData, presets: Sequence[str]) -> "Figure":
    """Share of insects and seeds whose final gap is at most so much."""
    gaps = {preset: 100 * data.gaps_of(preset) for preset in presets if len(data.gaps_of(preset))}
    every = _shown(np.concatenate(list(gaps.values())))
    low, high = min(float(every.min()), 0.05) / 1.5, max(float(every.max()), 2.0) * 1.5
    thresholds = np.geomspace(low, high, 400)
    figure = _figure(7.2, 4.2)
    axes = figure.add_subplot()
    for preset, values in gaps.items():
        colour, dash = _style(preset)
        axes.step(thresholds, profile(values, thresholds), where="post", color=colour, ls=dash, label=label(preset))
    axes.axvline(1, color=GREY, lw=0.8, ls=":")
    axes.set(
        xscale="log",
        xlim=(low, high),
        ylim=(-0.02, 1.02),
        xlabel="τ [%]",
        ylabel="share of insects × seeds with a gap ≤ τ",
        title=f"Hover-v0 after training: every insect, {_seeds(data, presets)}",
    )
    axes.title.set_fontsize(11)
    axes.legend(frameon=False, loc="lower right", fontsize=9)
    axes.grid(alpha=0.25)
    axes.xaxis.set_major_formatter("{x:g}")
    return figure


def draw_others(data: BenchmarkData, presets: Sequence[str]) -> "Figure":
    """Final distances of the other tasks, a panel each because each has a reference of its own."""
    columns = min(2, len(presets))
    lines = -(-len(presets) // columns)
    figure = _figure(4.6 * columns, 2.3 * lines + 0.6)
    panels = figure.subplots(lines, columns, squeeze=False)
    for axes, preset in zip(panels.flat, presets, strict=False):
        runs = data.runs_of(preset)
        seeds = [run.seed for run in runs]
        mean, worst = (np.array([100 * getattr(run, name) for run in runs]) for name in ("mean", "worst"))
        axes.vlines(seeds, mean, worst, color=GREY, lw=0.8, alpha=0.5)
        axes.plot(seeds, worst, "s", color=ORANGE, ms=5, mfc="none", label="worst")
        axes.plot(seeds, mean, "o", color=BLUE, ms=6, label="mean")
        axes.axhline(float(interquartile_mean(mean)), color=BLUE, lw=1, ls="--", alpha=0.7)
        axes.axhline(0, color="black", lw=0.8)
        axes.set_title(f"{preset}\n{runs[0].distance}", fontsize=9)
        axes.set(xticks=seeds, xlim=(min(seeds) - 0.5, max(seeds) + 0.5), ylabel="[%]")
        axes.grid(alpha=0.25, axis="y")
        axes.margins(y=0.15)
    for axes in list(panels.flat)[len(presets) :]:
        axes.set_visible(False)
    for axes in list(panels.flat)[max(0, len(presets) - columns) : len(presets)]:
        axes.set_xlabel("seed")
    handles, labels = panels.flat[0].get_legend_handles_labels()
    figure.legend(handles, labels, loc="outside lower center", ncols=2, fontsize=9, frameon=False)
    figure.suptitle("distance after training; dashed: interquartile mean", fontsize=11)
    return figure


def label(preset: str) -> str:
    """The learner of a preset as one writes it."""
    name = preset.rsplit("-", 1)[-1]
    return LABELS.get(name, name)


def _family(preset: str) -> str:
    """What the preset is for."""
    return preset.rsplit("-", 1)[0]


def _style(preset: str) -> tuple[str, str]:
    """Colour and dash of a preset's learner, the same in every picture."""
    known = dict(zip(LABELS, zip(COLOURS, DASHES, strict=True), strict=True))
    return known.get(preset.rsplit("-", 1)[-1], (GREY, "-"))


def _shown(values: np.ndarray) -> np.ndarray:
    """Distances [%] as a logarithmic axis can show them."""
    return np.maximum(values, LEAST)


def _at_least(data: BenchmarkData, presets: Sequence[str]) -> str:
    """What an axis must say where it shows distances larger than they are."""
    smallest = min(100 * run.mean for preset in presets for run in data.runs_of(preset))
    return f"; {LEAST:g} stands for less, too" if smallest < LEAST else ""


def _seeds(data: BenchmarkData, presets: Sequence[str]) -> str:
    """How many seeds, in words."""
    counts = sorted({len(data.runs_of(preset)) for preset in presets})
    return f"{' to '.join(map(str, {counts[0], counts[-1]}))} seed{'s' if counts[-1] > 1 else ''}"


def _figure(width: float, height: float) -> "Figure":
    """An empty figure that belongs to no window."""
    from matplotlib.figure import Figure

    return Figure(figsize=(width, height), dpi=100, layout="constrained")
