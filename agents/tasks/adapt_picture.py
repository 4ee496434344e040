"""A policy in hidden conditions beside the references. matplotlib is imported inside."""

from collections.abc import Sequence
from typing import TYPE_CHECKING

import numpy as np

from flapenv.drawing import BLUE, GREEN, GREY, ORANGE, RED, require_matplotlib, verbatim

if TYPE_CHECKING:
    from matplotlib.figure import Figure

    from agents.tasks.adapt_flights import Flown

STYLES = {
    "full_knowledge": (GREEN, "_"),
    "lift_ladder": (BLUE, "-"),
    "felt_lift": (ORANGE, "--"),
    "fixed_stroke": (GREY, ":"),
    "policy": (RED, "o-"),
}


def draw_flights(flown: "Flown", names: Sequence[str]) -> "Figure":
    """Weight support and rewards of one episode, and mean rewards of every beat over all episodes.

    The episode is the one of the first insect whose optimum falls the most at the change.

    Args:
        flown: as many episodes of every insect, in their order.
        names: of the insects.

    Raises:
        ImportError: without matplotlib.
    """
    require_matplotlib()
    from matplotlib.figure import Figure

    best = flown.rewards["full_knowledge"]
    row = int(np.argmax(np.ptp(best[:, : best.shape[1] // len(names)], axis=0)))
    change = int(np.argmax(flown.changed[:, row]))
    beats = np.arange(1, len(best) + 1)
    figure = Figure(figsize=(12.0, 3.8), dpi=100, layout="constrained")
    lift, one, mean = figure.subplots(1, 3)
    lift.axhline(1, color=GREY, lw=1, ls="--")
    lift.plot(beats, flown.weight_support[:, row], "o-", color=RED, ms=4, lw=1)
    lift.set_ylabel("true weight support")
    for name, (colour, style) in STYLES.items():
        rewards = flown.rewards[name]
        if not np.isfinite(rewards).all():
            continue
        line = {"color": colour, "ms": 9 if style == "_" else 3, "lw": 1.2, "label": name.replace("_", " ")}
        one.plot(beats, rewards[:, row], style, **line)
        mean.plot(beats, np.mean(rewards, axis=1), style, **line)
    one.set(ylabel="reward", title=f"one episode of the {verbatim(names[0])}", ylim=_most_of(flown, row))
    mean.set(ylabel="mean reward", title=f"mean of {best.shape[1]:,} held-out episodes")
    lift.set_title(f"one episode of the {verbatim(names[0])}")
    for axes in (lift, one):
        axes.axvline(change + 0.5, color=GREY, lw=1, ls=":")
    for axes in (lift, one, mean):
        axes.set(xlabel="beat", xlim=(0.5, len(best) + 0.5), xticks=range(0, len(best) + 1, 5))
    handles, labels = mean.get_legend_handles_labels()
    figure.legend(handles, labels, loc="outside lower center", ncols=len(labels), frameon=False, fontsize=9)
    return figure


def _most_of(flown: "Flown", row: int) -> tuple[float, float]:
    """A range that holds the policy, the ladder and the optimum, whatever the fixed stroke is charged."""
    shown = [flown.rewards[name][:, row] for name in ("policy", "lift_ladder", "full_knowledge")]
    values = np.concatenate([rewards[np.isfinite(rewards)] for rewards in shown])
    room = 0.08 * float(np.ptp(values)) + 0.02
    return float(np.min(values)) - room, float(np.max(values)) + room
