"""Pictures of wingbeats. matplotlib is imported inside, so that only those who draw need it (extra "report")."""

import importlib.util
import math
from typing import TYPE_CHECKING, Any

import numpy as np

from flapenv.aero.history import WingbeatHistory
from flapenv.aero.motions import Motion
from flapenv.aero.parameters import STROKE_PARAMETERS
from flapenv.aero.stroke import Stroke
from flapenv.insects import Insect
from flapenv.model import HoverModel
from flapenv.performance import evaluate
from flapenv.simulation import simulate

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

BLUE, ORANGE, GREEN, RED, GREY, BLACK = "#0072B2", "#E69F00", "#009E73", "#D55E00", "#666666", "#000000"
"""Okabe and Ito's colours, told apart without colour vision."""
CHORDS = 11
"""Wing sections drawn a half-stroke."""


def require_matplotlib() -> None:
    """Say how to get matplotlib where it is missing.

    Raises:
        ImportError: naming the extra to install.
    """
    if importlib.util.find_spec("matplotlib") is None:
        raise ImportError("pictures need matplotlib: pip install 'flapenv[report]'")


def verbatim(text: str) -> str:
    """A text as matplotlib shows it letter by letter: what stands between two dollars would be read as a formula."""
    return text.replace("$", r"\$")


def stroke_text(stroke: Stroke) -> str:
    """A stroke in one line as one reads it, angles in degrees."""
    words = []
    for name, parameter in STROKE_PARAMETERS.items():
        value = float(getattr(stroke, name))
        number = f"{math.degrees(value):.1f}°" if parameter.unit == "rad" else f"{value:.4g}"
        unit = f" {parameter.unit}" if parameter.unit not in ("rad", "") else ""
        words.append(f"{parameter.symbol} = {number}{unit}")
    return "   ".join(words)


def draw_wingbeat(insect: Insect, stroke: Stroke, model: HoverModel | None = None) -> "Figure":
    """A wingbeat on one sheet: wing sections along both half-strokes, angles, lift and power over the cycle.

    Args:
        insect: the insect.
        stroke: its stroke, scalar fields.
        model: options of the aerodynamic model.

    Returns:
        A matplotlib figure, not attached to any window.

    Raises:
        ImportError: without matplotlib.
    """
    require_matplotlib()
    from matplotlib.figure import Figure

    model = model or HoverModel()
    performance = evaluate(insect, stroke, **vars(model))
    history = simulate(insect, stroke, model=model, strips=4, steps=720, spacing="gauss")
    figure = Figure(figsize=(9.6, 6.4), dpi=100, layout="constrained")
    grid = figure.add_gridspec(2, 3, height_ratios=(1.15, 1))
    figure.suptitle(
        f"{verbatim(insect.name)}: weight support {performance.weight_support:.3f}, "
        f"{performance.specific_power:.2f} W/kg\n{stroke_text(stroke)}",
        fontsize=11,
    )
    draw_wing_sections(figure.add_subplot(grid[0, :]), insect, stroke)
    time = history.phase / (2 * math.pi)
    draw_angles(figure.add_subplot(grid[1, 0]), time, history)
    weight = insect.mass * model.gravity
    draw_history(
        figure.add_subplot(grid[1, 1]), time, history.lift / weight, performance.weight_support, BLUE, "lift / weight"
    )
    draw_history(
        figure.add_subplot(grid[1, 2]),
        time,
        history.power / insect.mass,
        performance.specific_power,
        RED,
        "power / mass [W/kg]",
    )
    return figure


def draw_wing_sections(axes: "Axes", insect: Insect, stroke: Motion) -> None:
    """Wing sections at equal times along both half-strokes, to scale at r̂₂ R, turned about its pitching axis."""
    radius = math.sqrt(insect.wing.moment(2)) * insect.wing.aspect_ratio  # in mean chords
    for start, level, colour, label in (
        (-math.pi / 2, 0.9, BLUE, "forward half-stroke →"),
        (math.pi / 2, -0.6, ORANGE, "← backward half-stroke"),
    ):
        phase = start + math.pi * (np.arange(CHORDS) + 0.5) / CHORDS
        place = stroke.flap_angle(phase) * radius
        theta = stroke.pitch_angle(phase)
        chord = np.stack([np.sin(theta), np.cos(theta)])  # trailing to leading edge
        front = np.stack([place, np.full(CHORDS, level)]) + insect.wing.pitch_axis * chord
        axes.plot(*np.stack([front - chord, front], axis=1), color=colour, lw=2)
        axes.plot(*front, "o", color=colour, ms=5)
        axes.axhline(level, color=GREY, lw=0.5, ls=":", zorder=0)
        axes.annotate(label, (0.01, 0.94 if level > 0 else 0.03), xycoords="axes fraction", color=colour, fontsize=9)
    reach = 1.08 * (float(stroke.flap_amplitude) * radius + 0.6)
    axes.set(
        xlim=(-reach, reach),
        ylim=(-1.6, 1.6),
        yticks=[],
        xlabel="arc of the section at r̂₂ [mean chords]; • leading edge",
    )
    axes.set_aspect("equal")


def draw_angles(axes: "Axes", time: np.ndarray, history: WingbeatHistory) -> None:
    """φ, θ and α over the cycle."""
    for angle, colour, dash, label in (
        (history.kinematics.flap, BLUE, "-", "φ flap"),
        (history.kinematics.pitch, ORANGE, "--", "θ pitch"),
        (history.angle_of_attack, GREEN, "-.", "α attack"),
    ):
        axes.plot(time, np.degrees(angle), dash, color=colour, label=label)
    axes.set(xlabel="t/T", ylabel="angle [°]", xlim=(0, 1), ylim=(-110, 165), yticks=range(-90, 136, 45))
    axes.axhline(0, color=GREY, lw=0.5)
    axes.legend(ncols=3, fontsize=7, loc="upper center", frameon=False, columnspacing=1, handlelength=1.8)


def draw_history(axes: "Axes", time: np.ndarray, value: np.ndarray, mean: float, colour: str, label: str) -> None:
    """One quantity over the cycle with its mean."""
    axes.plot(time, value, color=colour)
    axes.axhline(mean, color=GREY, lw=1, ls="--", label=f"mean {mean:.3f}" if mean < 10 else f"mean {mean:.2f}")
    axes.axhline(0, color=GREY, lw=0.5)
    top, bottom = max(0.0, float(np.max(value))), min(0.0, float(np.min(value)))
    axes.set(
        xlabel="t/T", ylabel=label, xlim=(0, 1), ylim=(bottom - 0.05 * (top - bottom), bottom + 1.25 * (top - bottom))
    )
    axes.legend(fontsize=8, loc="upper right", frameon=False)


def figure_image(figure: "Figure") -> np.ndarray:
    """A figure as an array (height, width, 3) of uint8."""
    from matplotlib.backends.backend_agg import FigureCanvasAgg

    canvas: Any = FigureCanvasAgg(figure)
    canvas.draw()
    return np.asarray(canvas.buffer_rgba())[..., :3].copy()


def wingbeat_image(insect: Insect, stroke: Stroke, model: HoverModel | None = None) -> np.ndarray:
    """`draw_wingbeat` as an array (height, width, 3) of uint8."""
    return figure_image(draw_wingbeat(insect, stroke, model))
