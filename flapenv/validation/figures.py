"""Figs 2, 4, 5 and 6 of the paper, and the convergence of our numbers. matplotlib is imported inside."""

import math
from collections.abc import Callable
from typing import TYPE_CHECKING

import numpy as np

from flapenv.aero.coefficients import (
    berman_wang_drag,
    drag_coefficient,
    extended_lift_curve_slope,
    lift_coefficient,
    polhamus_factor,
    polhamus_lift,
    robofly_drag,
    robofly_lift,
)
from flapenv.aero.stroke import flap_waveform, pitch_waveform
from flapenv.drawing import BLUE, GREEN, GREY, ORANGE, RED, require_matplotlib
from flapenv.insects import INSECTS, load_insect
from flapenv.validation.axes_figure import draw_axes
from flapenv.validation.convergence import STEPS, STRIPS, TERMS, step_errors, strip_errors, term_errors
from flapenv.validation.tables import figure5_wings, figure6

if TYPE_CHECKING:
    from matplotlib.figure import Figure

COLOURS = (BLUE, ORANGE, GREEN, RED, "#CC79A7")
DASHES = ("-", "--", "-.", ":", (0, (5, 1, 1, 1, 1, 1)))
FLAP_SHAPES = (0.0, 0.9, 0.99, 1.0)
PITCH_SHAPES = (0.0, 2.0, 5.0, 20.0)
ALPHA = np.radians(np.linspace(0, 90, 181))


def _figure(width: float, height: float) -> "Figure":
    """An empty figure."""
    require_matplotlib()
    from matplotlib.figure import Figure

    return Figure(figsize=(width, height), dpi=100, layout="constrained")


def draw_figure2() -> "Figure":
    """Fig. 2: flapping angle for several Cφ, pitching angle for several Cθ (δ = 90°)."""
    figure = _figure(9.0, 3.6)
    left, right = figure.subplots(1, 2)
    phase = np.linspace(0, 2 * math.pi, 721)
    for axes, shapes, waveform, turn, symbol in (
        (left, FLAP_SHAPES, flap_waveform, 0.0, "Cφ"),
        (right, PITCH_SHAPES, pitch_waveform, math.pi / 2, "Cθ"),
    ):
        for shape, colour, dash in zip(shapes, COLOURS, DASHES, strict=False):
            wave = waveform(np.sin(phase + turn), shape)
            axes.plot(phase / (2 * math.pi), wave, ls=dash, color=colour, label=f"{symbol} = {shape:g}")
        axes.axhline(0, color=GREY, lw=0.5)
        axes.set(xlim=(0, 1), ylim=(-1.1, 1.1), xlabel="t/T")
        axes.legend(fontsize=8, frameon=False)
    left.set(ylabel="φ/φmax", title="(a) flapping (2.1)")
    right.set(ylabel="θ/θmax", title="(b) pitching (2.2), δ = 90°")
    return figure


def draw_figure4() -> "Figure":
    """Fig. 4: shape of the Polhamus relation against sin 2α, and K_Polhamus against the aspect ratio."""
    figure = _figure(9.0, 3.6)
    left, right = figure.subplots(1, 2)
    slope = extended_lift_curve_slope(3.0)
    lift = polhamus_lift(ALPHA, slope, 1.0, 3.0)
    left.plot(np.degrees(ALPHA), np.sin(2 * ALPHA), color=BLUE, label="sin 2α (2.7)")
    left.plot(np.degrees(ALPHA), lift / np.max(lift), "--", color=RED, label="Polhamus (3.1), AR = 3, k = 1")
    left.set(xlim=(0, 90), ylim=(0, 1.1), xticks=range(0, 91, 15), xlabel="α [°]", ylabel="C_L over its largest value")
    left.legend(fontsize=8, frameon=False, loc="lower center")
    left.set_title("(a) shape")
    aspect_ratio = np.linspace(1, 6, 101)
    factor = polhamus_factor(math.pi / 4, extended_lift_curve_slope(aspect_ratio), 1.0, aspect_ratio)
    right.plot(aspect_ratio, factor, color=BLUE)
    right.axhline(1, color=GREY, lw=0.5)
    right.set(xlim=(1, 6), ylim=(0.9, 1.3), xlabel="aspect ratio of one wing", ylabel="K_Polhamus at 45°, k = 1")
    right.set_title("(b) amplitude (3.2)")
    return figure


def draw_figure5() -> "Figure":
    """Fig. 5: lift against angle of attack and drag polars of three revolving wings, curves only."""
    figure = _figure(9.0, 9.6)
    grid = figure.subplots(3, 2, sharex="col", sharey=True)
    for (left, right), wing in zip(grid, figure5_wings(), strict=True):
        constants = load_insect(wing.name).force_constants
        assert constants is not None
        curves = {
            f"this model, C_T = {wing.lift_constant:.2f}": (
                lift_coefficient(ALPHA, wing.lift_constant),
                drag_coefficient(ALPHA, wing.lift_constant),
            ),
            "Dickinson et al. 1999": (robofly_lift(ALPHA), robofly_drag(ALPHA)),
            "Berman & Wang 2007": (
                lift_coefficient(ALPHA, constants.lift_constant),
                berman_wang_drag(ALPHA, constants.zero_drag, constants.normal_drag),
            ),
        }
        for (label, (lift, drag)), colour, dash in zip(curves.items(), COLOURS, DASHES, strict=False):
            left.plot(np.degrees(ALPHA), lift, ls=dash, color=colour, label=label)
            right.plot(drag, lift, ls=dash, color=colour)
        left.axvspan(25, 45, color=GREY, alpha=0.12, lw=0)
        left.set(ylabel="C_L", title=f"{wing.name}: AR = {wing.aspect_ratio:.2f}, k = {wing.k:.2f}")
        left.legend(fontsize=8, frameon=False, loc="upper right")
        right.set(title=f"{wing.name}: polar")
    grid[0, 0].set(xlim=(0, 90), ylim=(0, 2.6), xticks=range(0, 91, 15))
    grid[0, 1].set(xlim=(0, 3.8))
    grid[2, 0].set(xlabel="α [°]   (shaded: where insects fly)")
    grid[2, 1].set(xlabel="C_D")
    return figure


def draw_figure6() -> "Figure":
    """Fig. 6: weight support of fruit fly and hoverfly as the parts of k come in."""
    figure = _figure(9.0, 3.8)
    for axes, row in zip(figure.subplots(1, 2, sharey=True), figure6(), strict=True):
        values = [row.ideal, row.with_k_ind, row.with_k_tip, row.full]
        bars = axes.bar(
            ("k = 1", "k_ind", "k_ind k_tip", "k_ind k_tip\nk_flap"), values, color=(GREY, BLUE, BLUE, ORANGE)
        )
        axes.bar_label(
            bars, [f"{value:.2f}\nΔ = {100 * (value - 1):+.0f} %" for value in values], fontsize=9, padding=2
        )
        axes.axhline(1, color=RED, lw=1, ls="--")
        axes.set(title=row.insect, ylim=(0, 1.5))
        axes.set_ylabel("weight support")
        axes.label_outer()
    return figure


def draw_convergence() -> "Figure":
    """Errors of strips, steps and terms for every insect, against their number."""
    figure = _figure(9.0, 3.6)
    panels = figure.subplots(1, 3)
    for name in INSECTS:
        for axes, counts, errors in (
            (panels[0], STRIPS, strip_errors(name)[:, 1]),
            (panels[1], STEPS, step_errors(name)[:, 1]),
            (panels[2], TERMS, term_errors(name)),
        ):
            axes.loglog(counts, np.maximum(np.abs(errors), 1e-15), "o-", ms=3, lw=1, label=name)
    for axes, title, number, label, used in (
        (panels[0], "blade element: strips", "strips (dashed: the paper's 50)", "relative error of P*", 50),
        (panels[1], "blade element: steps", "steps (dashed: the paper's 500)", "relative error of P*", 500),
        (panels[2], "lifting line: terms", "terms (dashed: 64, used here)", "error of k_ind", 64),
    ):
        axes.set(title=title, xlabel=number, ylabel=label)
        axes.axvline(used, color=GREY, lw=1, ls="--")
        axes.grid(alpha=0.3)
    panels[0].legend(fontsize=7, frameon=False)
    return figure


FIGURES: dict[str, Callable[[], "Figure"]] = {
    "figure2": draw_figure2,
    "figure4": draw_figure4,
    "figure5": draw_figure5,
    "figure6": draw_figure6,
    "convergence": draw_convergence,
    "axes": draw_axes,
}
"""Every figure by the name of its file."""
