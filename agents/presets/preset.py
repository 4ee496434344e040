"""What a named preset is: a task, its arguments, and the settings of one learner."""

import inspect
import json
from collections.abc import Mapping
from dataclasses import asdict, field, fields, replace
from typing import TYPE_CHECKING, Any, ClassVar, Protocol

from agents.tasks import TASKS, make_task
from agents.tasks.task import Task
from flapenv.aero.checks import LONGEST_SHOWN, allowed, one_line, record, require_name, shown

if TYPE_CHECKING:
    from stable_baselines3.common.base_class import BaseAlgorithm
    from stable_baselines3.common.vec_env import VecEnv


class Settings(Protocol):
    """Everything a learner depends on beside its task; a frozen record, its fields plain numbers and strings."""

    __dataclass_fields__: ClassVar[dict[str, Any]]
    algorithm: ClassVar[str]

    @property
    def wingbeats(self) -> int:
        """Training budget, one wingbeat a row."""

    @property
    def rows(self) -> int:
        """Of the batch that is flown at once."""

    def build(self, env: "VecEnv", seed: int) -> "BaseAlgorithm":
        """The learner with random weights."""

    def anneal(self, model: Any, left: float) -> None:
        """Set on `model` what falls, before a rollout, with the fraction `left` of the budget still to go."""


@record
class Preset:
    """A recipe: everything a run depends on but its seed.

    Attributes:
        task: name of one of `TASKS`.
        settings: of the learner.
        arguments: of the task, by name.
    """

    task: str
    settings: Any
    arguments: Mapping[str, Any] = field(default_factory=dict)

    def __post_init__(self) -> None:
        """Check the task's name and those of its arguments."""
        require_name("task", self.task, TASKS)
        known = list(inspect.signature(TASKS[self.task]).parameters)
        for name, value in self.arguments.items():
            if name not in known:
                raise TypeError(
                    f"task {shown(self.task)} has no argument {shown(name)} (got {shown(value)}); "
                    f"{allowed(name, known)}"
                )

    def make_task(self) -> Task:
        """The task itself.

        Raises:
            TypeError: for an argument of another kind.
            ValueError: for one outside its range.
        """
        return make_task(self.task, self.arguments)

    def changed(self, arguments: Mapping[str, Any], settings: Mapping[str, Any]) -> "Preset":
        """The preset with other arguments of its task and other settings.

        Raises:
            TypeError: for names that do not exist, or values of another kind.
            ValueError: for values that are not allowed.
        """
        known = [one.name for one in fields(self.settings)]
        for name, value in settings.items():
            if name not in known:
                kind = self.settings.algorithm
                raise TypeError(f"{kind} has no setting {shown(name)} (got {shown(value)}); {allowed(name, known)}")
        return Preset(
            task=self.task,
            arguments={**self.arguments, **arguments},
            settings=replace(self.settings, **settings),
        )

    def to_dict(self) -> dict[str, Any]:
        """As config.json keeps it."""
        task = self.make_task()
        return {
            "environment": task.environment,
            "task": {"name": self.task, **task.to_dict()},
            "algorithm": self.settings.algorithm,
            "settings": asdict(self.settings),
        }


def setting_of(text: str) -> tuple[str, Any]:
    """NAME=VALUE of a command line as a name and a number, a list, null, or else a string.

    Raises:
        ValueError: for text of another form.
    """
    name, equals, value = text.partition("=")
    if not (name and equals and value):
        raise ValueError(f"--set {one_line(text, LONGEST_SHOWN)} is not allowed; allowed: NAME=VALUE")
    try:
        return name, json.loads(value)
    except (json.JSONDecodeError, RecursionError):
        return name, value
