"""A picture of a flight in hidden conditions: its last wingbeat, and how the beats before it went."""

import dataclasses
import warnings

import numpy as np

from flapenv.adapt.conditions import Condition, flown
from flapenv.aero.stroke import Stroke
from flapenv.drawing import BLUE, GREEN, GREY, ORANGE, figure_image, require_matplotlib, wingbeat_image
from flapenv.insects import Insect
from flapenv.model import HoverModel


def flight_image(
    insect: Insect, stroke: Stroke, condition: Condition, model: HoverModel, trace: np.ndarray, horizon: int
) -> np.ndarray:
    """The last wingbeat as it was flown, above weight support and reward of the episode so far.

    Args:
        insect: as it is known.
        stroke: of the last beat.
        condition: of the last beat, scalar fields.
        model: the air that the insect is known in.
        trace: of every beat the weight support, true and felt, the reward, and that of the optimum; shape (4, beats).
        horizon: beats of the whole episode.

    Returns:
        A picture (height, width, 3) of uint8, of the same size whatever it shows.

    Raises:
        ImportError: without matplotlib.
    """
    require_matplotlib()
    from matplotlib.figure import Figure

    changed, air = flown(insect, condition, model)
    name = (
        f"{insect.name}, beat {trace.shape[1]} of {horizon}, carrying {100 * (condition.payload - 1):.0f} %, air "
        f"{condition.density_ratio:.2f}, {100 * condition.span_lost:.0f} % of the span lost"
    )
    with warnings.catch_warnings():  # a short wing's aspect ratio is part of the task, docs/hover_adapt.md says so
        warnings.simplefilter("ignore", UserWarning)
        top = wingbeat_image(dataclasses.replace(changed, name=name), stroke, air)
    figure = Figure(figsize=(9.6, 2.4), dpi=100, layout="constrained")
    left, right = figure.subplots(1, 2)
    beats = np.arange(1, trace.shape[1] + 1)
    weight_support, felt, reward, best = trace
    left.axhline(1, color=GREY, lw=1, ls="--")
    left.plot(beats, weight_support, "o-", color=BLUE, ms=4, label="true")
    left.plot(beats, felt, "x", color=ORANGE, ms=5, label="felt")
    left.set(ylabel="weight support", ylim=_limits(np.append(np.concatenate([weight_support, felt]), 1.0), 0.1))
    left.legend(fontsize=8, loc="upper right", frameon=False, ncols=2)
    right.plot(beats, best, "_", color=GREEN, ms=8, mew=2, label="optimum, full knowledge")
    right.plot(beats, reward, "o-", color=BLUE, ms=4, label="this flight")
    right.set(ylabel="reward", ylim=_limits(np.concatenate([reward, best, [-1.0]]), 0.5))
    right.legend(fontsize=8, loc="upper right", frameon=False, ncols=2)
    for axes in (left, right):
        axes.set(xlabel="beat", xlim=(0.5, horizon + 0.5), xticks=range(0, horizon + 1, 5))
    return np.concatenate([top, figure_image(figure)])


def _limits(values: np.ndarray, least: float) -> tuple[float, float]:
    """A range that holds values with room above for a legend, and is not narrower than twice `least`."""
    low, high = float(np.min(values)), float(np.max(values))
    spread = max(high - low, 2 * least)
    middle = (low + high) / 2
    return middle - 0.6 * spread, middle + 0.75 * spread
