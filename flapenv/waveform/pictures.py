"""Pictures of free waveforms. matplotlib is imported inside, so that only those who draw need it (extra "report")."""

import math
from typing import TYPE_CHECKING

import numpy as np

from flapenv.aero.motions import Motion
from flapenv.aero.spline_motion import SplineMotion
from flapenv.aero.stroke import Stroke
from flapenv.case import hover_case
from flapenv.drawing import (
    BLUE,
    GREEN,
    GREY,
    ORANGE,
    RED,
    draw_angles,
    draw_history,
    draw_wing_sections,
    figure_image,
    require_matplotlib,
    verbatim,
)
from flapenv.insects import Insect, load_insect
from flapenv.model import HoverModel
from flapenv.optimum import optimum
from flapenv.problem import PROBLEMS
from flapenv.simulation import simulate
from flapenv.waveform.performance import evaluate_waveform
from flapenv.waveform.shipped import known_optimum

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

SHADES = {4: ORANGE, 8: GREEN, 16: BLUE, 32: RED}
"""Colours by the number of knots."""
SHOWN = ("honeybee", "bumblebee", "hawkmoth", "fruitfly")
"""Insects drawn in problem B: from much lift to spare to none."""


def draw_waveform(insect: Insect, motion: SplineMotion, model: HoverModel | None = None) -> "Figure":
    """A free wingbeat on one sheet: wing sections along both half-strokes, angles, speed and power over the cycle.

    Args:
        insect: the insect.
        motion: its wingbeat.
        model: options of the aerodynamic model.

    Returns:
        A matplotlib figure, not attached to any window.

    Raises:
        ImportError: without matplotlib.
    """
    require_matplotlib()
    from matplotlib.figure import Figure

    model = model or HoverModel()
    performance = evaluate_waveform(insect, motion, **vars(model))
    history = simulate(insect, motion, model=model, strips=4, steps=720, spacing="gauss")
    figure = Figure(figsize=(9.6, 6.4), dpi=100, layout="constrained")
    grid = figure.add_gridspec(2, 3, height_ratios=(1.15, 1))
    figure.suptitle(
        f"{verbatim(insect.name)}: weight support {performance.weight_support:.3f}, "
        f"{performance.specific_power:.2f} W/kg\n"
        f"f = {motion.frequency:.4g} Hz   φmax = {math.degrees(motion.flap_amplitude):.1f}°   {motion.knots} knots a "
        "half-stroke",
        fontsize=11,
    )
    draw_wing_sections(figure.add_subplot(grid[0, :]), insect, motion)
    time = history.phase / (2 * math.pi)
    draw_angles(figure.add_subplot(grid[1, 0]), time, history)
    speed = history.kinematics.flap_rate / motion.mean_flap_speed
    draw_history(figure.add_subplot(grid[1, 1]), time, speed, float(np.mean(np.abs(speed))), GREEN, "φ̇ / mean |φ̇|")
    power = history.power / insect.mass
    draw_history(figure.add_subplot(grid[1, 2]), time, power, performance.specific_power, RED, "power / mass [W/kg]")
    return figure


def waveform_image(insect: Insect, motion: SplineMotion, model: HoverModel | None = None) -> np.ndarray:
    """`draw_waveform` as an array (height, width, 3) of uint8."""
    return figure_image(draw_waveform(insect, motion, model))


def best_motion(insect: str, problem: str, knots: int) -> SplineMotion:
    """The best shipped waveform of one of the eight insects.

    Raises:
        LookupError: where none is shipped.
    """
    case = hover_case(load_insect(insect), PROBLEMS[problem].model)
    best = known_optimum(case, PROBLEMS[problem], knots)
    if best is None:
        raise LookupError(f"no waveform of {knots} knots is shipped for {insect} in {problem}")
    return best.waveform.motion()


def draw_towards_the_triangle(insect: str = "hawkmoth") -> "Figure":
    """What is found in problem A: φ, φ̇ and θ of 4, 8, 16 and 32 knots beside the triangle and the square wave."""
    require_matplotlib()
    from matplotlib.figure import Figure

    figure = Figure(figsize=(9.6, 3.4), dpi=100, layout="constrained")
    panels = figure.subplots(1, 3)
    sharp = Stroke(
        frequency=1.0,
        flap_amplitude=1.0,
        pitch_amplitude=PROBLEMS["free-frequency"].box.pitch_amplitude[1],
        flap_shape=1.0,
        pitch_shape=1e4,
    )
    _draw_motion(panels, sharp, 1.0, {"color": GREY, "lw": 2.5, "ls": ":", "label": "triangle, square wave"})
    for knots, colour in SHADES.items():
        motion = best_motion(insect, "free-frequency", knots)
        _draw_motion(panels, motion, motion.flap_amplitude, {"color": colour, "lw": 1.4, "label": f"{knots} knots"})
    for axes, label in zip(panels, ("φ / φmax", "φ̇ / mean |φ̇|", "θ [°]"), strict=True):
        axes.set(xlabel="t/T, from the reversal", ylabel=label, xlim=(0, 1))
    figure.legend(
        *panels[0].get_legend_handles_labels(), loc="outside lower center", ncols=5, fontsize=8, frameon=False
    )
    return figure


def draw_away_from_the_triangle() -> "Figure":
    """What is found in problem B: φ, φ̇ and θ beside the best of (2.1), (2.2), for insects from strong to weak."""
    require_matplotlib()
    from matplotlib.figure import Figure

    figure = Figure(figsize=(9.6, 6.6), dpi=100, layout="constrained")
    rows = figure.subplots(3, len(SHOWN), sharex=True, sharey="row")
    for column, name in zip(rows.T, SHOWN, strict=True):
        best = optimum(name, "fixed-frequency")
        _draw_motion(
            column, best.stroke, best.stroke.flap_amplitude, {"color": GREY, "lw": 1.6, "ls": ":"}, middle=True
        )
        power = f"{best.specific_power:.1f} W/kg" if best.feasible else f"lifts {best.weight_support:.2f} of the weight"
        for knots, colour in list(SHADES.items())[:3]:
            motion = best_motion(name, "fixed-frequency", knots)
            line = {"color": colour, "lw": 1.4, "label": f"{knots} knots"}
            _draw_motion(column, motion, motion.flap_amplitude, line, middle=True)
        own = evaluate_waveform(name, best_motion(name, "fixed-frequency", 8)).specific_power
        column[0].set_title(f"{name}\n(2.1), (2.2): {power}\n8 knots: {own:.1f} W/kg", fontsize=8)
        column[0].plot([], [], color=GREY, lw=1.6, ls=":", label="best of (2.1), (2.2)")
        column[-1].set(xlabel="t/T", xlim=(0, 1))
    for axes, label in zip(rows[:, 0], ("φ / φmax", "φ̇ / mean |φ̇|", "θ [°]"), strict=True):
        axes.set_ylabel(label)
    handles, labels = rows[0, 0].get_legend_handles_labels()
    figure.legend(handles, labels, loc="outside lower center", ncols=5, fontsize=8, frameon=False)
    return figure


def _draw_motion(
    panels: "np.ndarray | list[Axes]", motion: Motion, amplitude: float, line: dict, *, middle: bool = False
) -> None:
    """φ/φmax, φ̇ over its mean and θ over a cycle.

    It begins with the forward half-stroke or, with `middle`, a quarter of a cycle before the wing passes φ = 0: when
    in a half-stroke a short beat falls makes no difference, so it is put into the middle.
    """
    time = np.linspace(0, 1, 961)
    start = motion.reversal if isinstance(motion, SplineMotion) else -math.pi / 2
    if middle:
        half = start + math.pi * np.linspace(0, 1, 961)
        start = float(np.interp(0.0, motion.flap_angle(half), half)) - math.pi / 2
    phase = 2 * math.pi * time + start
    values = (
        motion.flap_angle(phase) / amplitude,
        motion.flap_rate(phase) / motion.mean_flap_speed,
        np.degrees(motion.pitch_angle(phase)),
    )
    for axes, value in zip(panels, values, strict=True):
        axes.plot(time, value, **line)
