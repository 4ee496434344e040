"""What agents are trained for: one file a task, each with its environment and its own way to judge a policy."""

from collections.abc import Callable, Mapping
from typing import Any

from agents.predictor import Predictor
from agents.tasks.adapt import HoverAdaptTask
from agents.tasks.heave import HeaveTask
from agents.tasks.hover import HoverTask
from agents.tasks.random_wings import RandomWingsTask
from agents.tasks.task import Task, Verdict
from agents.tasks.waveform import WaveformTask

__all__ = ["TASKS", "HoverTask", "Predictor", "RandomWingsTask", "Task", "Verdict", "make_task"]

TASKS: dict[str, Callable[..., Task]] = {
    "hover": HoverTask,
    "random-wings": RandomWingsTask,
    "adapt": HoverAdaptTask,
    "waveform": WaveformTask,
    "heave": HeaveTask,
}
"""Every task by its name."""


def make_task(name: str, arguments: Mapping[str, Any]) -> Task:
    """One of `TASKS` with its arguments.

    Raises:
        TypeError: for an unknown argument or one of another kind.
        ValueError: for one outside its range.
    """
    return TASKS[name](**arguments)
