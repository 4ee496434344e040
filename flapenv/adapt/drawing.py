"""Pictures of flights in hidden conditions: the last wingbeat with the beats before it, and the references."""

import dataclasses
import warnings
from typing import TYPE_CHECKING

import numpy as np

from flapenv.adapt.conditions import Condition, flown
from flapenv.adapt.references import fly_beats
from flapenv.adapt.task import BEATS, AdaptTask
from flapenv.adapt.tuning import NAMES, controllers, draws_of, tuned_for
from flapenv.aero.stroke import Stroke
from flapenv.drawing import BLUE, GREEN, GREY, ORANGE, figure_image, require_matplotlib, wingbeat_image
from flapenv.insects import Insect, load_insect
from flapenv.model import HoverModel

if TYPE_CHECKING:
    from matplotlib.figure import Figure

EPISODE = 408
"""A held-out episode whose condition grows much worse on the way."""


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


def references_figure(name: str, number: int = EPISODE) -> "Figure":
    """Weight support and reward of the references over one held-out episode.

    Args:
        name: of the insect, one of `INSECTS`.
        number: of the episode.

    Raises:
        ImportError: without matplotlib.
    """
    require_matplotlib()
    from matplotlib.figure import Figure

    task, tuned = AdaptTask((load_insect(name),)), tuned_for(load_insect(name))
    given = draws_of(task, "test")
    change = int(given.draws.change_beat[number])
    before, after = (flight.best_reward[number] for flight in given.flights)
    beats = np.arange(1, BEATS + 1)
    figure = Figure(figsize=(9.6, 3.2), dpi=100, layout="constrained")
    left, right = figure.subplots(1, 2)
    left.axhline(1, color=GREY, lw=1, ls="--")
    right.plot(beats, np.where(beats <= change, before, after), "_", color=GREEN, ms=9, mew=2, label="full knowledge")
    styles = zip(NAMES[1:], ("s-", "^-", "o-"), (GREY, ORANGE, BLUE), strict=True)
    for controller, (reference, style, colour) in zip(controllers(task, tuned, given.index), styles, strict=True):
        rewards, lifted = fly_beats(task, controller, given)
        label = reference.replace("_", " ")
        left.plot(beats, lifted[:, number], style, color=colour, ms=4, lw=1, label=label)
        right.plot(beats, rewards[:, number], style, color=colour, ms=4, lw=1, label=label)
    for axes, quantity in ((left, "true weight support"), (right, "reward")):
        axes.axvline(change + 0.5, color=GREY, lw=1, ls=":")
        axes.set(xlabel="beat; the dotted line is the change", ylabel=quantity, xlim=(0.5, BEATS + 0.5))
        axes.set_xticks(range(0, BEATS + 1, 5))
    handles, labels = right.get_legend_handles_labels()
    figure.legend(handles, labels, loc="outside upper center", ncols=4, frameon=False, fontsize=9)
    return figure
