"""The drawing of docs/axes.md: earth and stroke-plane axes, both wings from above, and a wing section."""

import math
from typing import TYPE_CHECKING, Any

import numpy as np

from flapenv.aero.axes import LEFT, RIGHT, flapping_directions, to_earth
from flapenv.drawing import BLUE, GREEN, GREY, ORANGE, RED, require_matplotlib

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

Point = Any
"""Two numbers, as a pair or an array."""
SLANT, FLAP, PITCH, AXIS = math.radians(25), math.radians(35), math.radians(50), 0.25
"""Angles that are drawn: σ, φ, θ [rad]; and the pitching axis behind the leading edge [chords]."""


def draw_axes() -> "Figure":
    """Three panels: from the left side, from above, and along the wing; directions by the code's own formulas."""
    require_matplotlib()
    from matplotlib.figure import Figure

    figure = Figure(figsize=(10.5, 3.7), dpi=100, layout="constrained")
    side, above, section = figure.subplots(1, 3)
    _draw_side(side)
    _draw_above(above)
    _draw_section(section)
    for axes in (side, above, section):
        axes.set_aspect("equal")
        axes.axis("off")
    return figure


def _arrow(axes: "Axes", start: Point, end: Point, colour: str, label: str, shift: Point = (0.0, 0.0)) -> None:
    """An arrow with its name at the tip."""
    axes.annotate(
        "", end, xytext=start, arrowprops={"arrowstyle": "-|>", "color": colour, "lw": 1.6, "shrinkA": 0, "shrinkB": 0}
    )
    axes.text(end[0] + shift[0], end[1] + shift[1], label, color=colour, fontsize=10, ha="center", va="center")


def _arc(axes: "Axes", centre: Point, radius: float, start: float, end: float, label: str) -> None:
    """An arc from one angle to another with an arrow head at its end and its name at its middle."""
    angles = np.linspace(start, end, 40)
    x, y = centre[0] + radius * np.cos(angles), centre[1] + radius * np.sin(angles)
    axes.plot(x[:-1], y[:-1], color=GREY, lw=1.2)
    head = {"arrowstyle": "->", "color": GREY, "lw": 1.2, "shrinkA": 0, "shrinkB": 0}
    axes.annotate("", (x[-1], y[-1]), xytext=(x[-4], y[-4]), arrowprops=head)
    middle = (start + end) / 2
    place = centre[0] + (radius + 0.14) * math.cos(middle), centre[1] + (radius + 0.14) * math.sin(middle)
    axes.text(*place, label, color=GREY, fontsize=10, ha="center", va="center")


def _draw_side(axes: "Axes") -> None:
    """Earth axes, the tilted stroke plane and its force, seen from the right (forward is to the right)."""
    x1, z1 = (to_earth(np.array(v), SLANT)[[0, 2]] for v in ((1.0, 0, 0), (0, 0, 1.0)))
    _arrow(axes, (0, 0), (1.15, 0), GREY, "x forward", (0.0, 0.12))
    _arrow(axes, (0, 0), (0, 1.15), GREY, "z up", (-0.2, 0.0))
    axes.plot(*np.stack([-x1, x1 * 0.9], axis=1), color=BLUE, lw=4, alpha=0.35, solid_capstyle="round")
    _arrow(axes, (0, 0), x1, BLUE, "x₁", (0.12, -0.06))
    _arrow(axes, (0, 0), z1, BLUE, "z₁", (0.1, 0.1))
    _arc(axes, (0, 0), 0.6, math.pi / 2, math.pi / 2 - SLANT, "σ")
    _arc(axes, (0, 0), 0.75, 0, -SLANT, "σ")
    axes.text(-0.95, 0.6, "stroke plane", color=BLUE, fontsize=9, ha="center")
    axes.set(xlim=(-1.3, 1.5), ylim=(-0.65, 1.35))
    axes.set_title("(a) from the right side\nσ > 0: the normal leans forward", fontsize=10)


def _draw_above(axes: "Axes") -> None:
    """Both wings at a positive flapping angle, seen along -z₁; x₁ points up the page, y to the left."""
    for side, name in ((RIGHT, "right wing"), (LEFT, "left wing")):
        along, outward = (row[0] for row in flapping_directions(np.array([FLAP]), side))
        out, turn = (np.array([-v[1], v[0]]) for v in (outward, along))  # page: right is -y, up is x₁
        axes.plot(*np.stack([0.12 * out, 1.1 * out], axis=1), color=ORANGE, lw=7, alpha=0.5, solid_capstyle="round")
        _arrow(axes, 0.95 * out, 0.95 * out + 0.4 * turn, RED, r"$\hat{e}_\varphi$", 0.14 * turn)
        _arrow(axes, (0, 0), 1.35 * out, GREEN, r"$\hat{e}_r$", 0.13 * out)
        rest = 0.0 if side == RIGHT else math.pi
        _arc(axes, (0, 0), 0.62, rest, rest + side * FLAP, "φ")
        axes.plot([0, side * 1.1], [0, 0], color=GREY, lw=0.8, ls=":")
        axes.text(side * 1.0, -0.18, name, color=ORANGE, fontsize=9, ha="center")
    axes.plot(0, 0, "o", color="black", ms=7)
    _arrow(axes, (0, 0), (0, 0.95), BLUE, "x₁", (0.0, 0.12))
    _arrow(axes, (0, 0), (-0.55, 0), BLUE, "y", (-0.02, -0.14))
    axes.set(xlim=(-1.5, 1.5), ylim=(-0.75, 1.35))
    axes.set_title("(b) from above\nφ > 0: both wings forward", fontsize=10)


def _draw_section(axes: "Axes") -> None:
    """A strip seen from its tip in the forward half-stroke: chord, normal, velocity, angles and the force."""
    chord = np.array([math.sin(PITCH), math.cos(PITCH)])
    normal = np.array([-math.cos(PITCH), math.sin(PITCH)])
    front, back = AXIS * chord, -(1 - AXIS) * chord
    axes.plot(*np.stack([back, front], axis=1), color="black", lw=4, solid_capstyle="round")
    axes.plot(*front, "o", color="black", ms=8)
    axes.plot(0, 0, "o", color="white", mec="black", ms=6, zorder=5)
    axes.text(0.55, -0.5, "●  leading edge\n○  pitching axis", fontsize=9, ha="left")
    axes.plot([0, 0], [0, 1.0], color=GREY, lw=0.8, ls=":")
    axes.text(0, 1.06, r"$\hat{z}_1$", color=GREY, fontsize=10, ha="center")
    _arrow(axes, (0, 0), (1.25, 0), RED, r"$V=\dot\varphi\,r\,\hat{e}_\varphi$", (-0.05, 0.14))
    _arrow(axes, front, front + 0.5 * chord, GREEN, r"$\hat{e}_c$", (0.12, 0.07))
    _arrow(axes, (0, 0), 0.55 * normal, GREEN, r"$\hat{n}$", (-0.1, -0.1))
    _arrow(axes, (0, 0), 1.15 * normal, BLUE, "dF", (-0.05, 0.12))
    _arc(axes, (0, 0), 0.78, math.pi / 2, math.pi / 2 - PITCH, "θ")
    _arc(axes, (0, 0), 0.5, 0, math.pi / 2 - PITCH, "α")
    axes.set(xlim=(-1.25, 1.65), ylim=(-0.75, 1.3))
    axes.set_title("(c) a strip of the right wing from its tip\nforward half-stroke, θ > 0", fontsize=10)
