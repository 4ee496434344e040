"""What a search may choose: ranges and choices of the learner's settings, from a command line or a file."""

import json
import math
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any

from flapenv.aero.checks import LONGEST_SHOWN, allowed, one_line, record, require_flag, require_scalar, shown
from flapenv.read_json import read_object

if TYPE_CHECKING:
    from agents.presets import Preset

FORMS = "NAME=LOW:HIGH, NAME=LOW:HIGH:log or NAME=A,B,C"
KEYS = ("low", "high", "log")
"""Of a range in a file."""


@record
class Range:
    """Numbers from `low` to `high`, both included; whole ones where both ends are and the setting is.

    Attributes:
        low: the smallest.
        high: the largest.
        log: whether they are drawn evenly on a logarithmic axis.
    """

    low: float
    high: float
    log: bool = False

    def __post_init__(self) -> None:
        """Check the ends.

        Raises:
            TypeError: for an end that is no number.
            ValueError: for ends in the wrong order, or a logarithmic axis from zero or below.
        """
        for name in ("low", "high"):
            value = getattr(self, name)
            if isinstance(value, bool):
                raise TypeError(f"{name} = {value!r} is not allowed; allowed: a number")
            require_scalar(name, value)
        if self.low >= self.high:
            raise ValueError(f"low = {self.low} is not allowed; allowed: below high = {self.high}")
        if require_flag("log", self.log) and self.low <= 0:
            raise ValueError(f"low = {self.low} is not allowed on a logarithmic axis; allowed: above 0")

    @property
    def samples(self) -> tuple[Any, ...]:
        """Values that must all be allowed."""
        return (self.low, self.high)

    def to_json(self) -> dict[str, Any]:
        """As a file holds it."""
        return {"low": self.low, "high": self.high, "log": self.log}


@record
class Choices:
    """One of several values, in no order.

    Attributes:
        values: numbers, texts, true, false or null; at least two.
    """

    values: Sequence[Any]

    def __post_init__(self) -> None:
        """Check the values.

        Raises:
            TypeError: for what is no list, or a value that is a list or an object.
            ValueError: for fewer than two values, one that stands twice, and numbers that are not finite.
        """
        if isinstance(self.values, str) or not isinstance(self.values, Sequence):
            raise TypeError(f"values = {shown(self.values)} is not allowed; allowed: a list")
        object.__setattr__(self, "values", tuple(self.values))
        for value in self.values:
            if not (value is None or isinstance(value, str | int | float)):
                raise TypeError(f"values hold {shown(value)}; allowed: numbers, texts, true, false, null")
            if isinstance(value, float) and not math.isfinite(value):
                raise ValueError(f"values hold {value}; allowed: finite numbers")
        if len(self.values) < 2 or len({json.dumps(value) for value in self.values}) < len(self.values):
            raise ValueError(f"values = {shown(list(self.values))} is not allowed; allowed: two or more, each once")

    @property
    def samples(self) -> tuple[Any, ...]:
        """Values that must all be allowed."""
        return tuple(self.values)

    def to_json(self) -> list[Any]:
        """As a file holds it."""
        return list(self.values)


Space = Mapping[str, Range | Choices]
"""What may be chosen of each setting."""


def dimension_of(text: str) -> tuple[str, Range | Choices]:
    """One `--search` of a command line: the name of a setting, and what may be chosen.

    Raises:
        ValueError: for another form, naming it.
    """
    name, equals, told = text.partition("=")
    try:
        if not (name and equals and told):
            raise ValueError("it has no name or no value")
        if ":" not in told:
            return name, Choices(values=[_value(one) for one in told.split(",")])
        low, high, *rest = told.split(":")
        if rest not in ([], ["log"]):
            raise ValueError(f"{shown(':'.join(rest))} follows the ends")
        return name, Range(low=_number(low), high=_number(high), log=bool(rest))
    except (ValueError, TypeError) as mistake:
        raise ValueError(
            f"--search {one_line(text, LONGEST_SHOWN)} is not allowed: {mistake}; allowed: {FORMS}"
        ) from None


def _number(text: str) -> float:
    """A finite number, whole where it is written so."""
    try:
        return int(text)
    except ValueError:
        try:
            number = float(text)
        except ValueError:
            raise ValueError(f"{shown(text)} is no number") from None
    if not math.isfinite(number):
        raise ValueError(f"{one_line(text, LONGEST_SHOWN)} is not finite")
    return number


def _value(text: str) -> Any:
    """A choice: a number, true, false, null, or else a text."""
    if not text:
        raise ValueError("a choice is empty")
    try:
        value = json.loads(text)
    except (json.JSONDecodeError, RecursionError):
        return text
    return text if isinstance(value, dict | list) else value


def space_of(content: Mapping[str, Any], called: str) -> Space:
    """The search space in an object of JSON.

    Args:
        content: a range `{"low": 1e-4, "high": 1e-2, "log": true}` or a list of choices for each setting.
        called: how errors call it.

    Raises:
        ValueError: for a range or choices that are not allowed; names the setting.
        TypeError: for another kind of thing.
    """
    space: dict[str, Range | Choices] = {}
    for name, told in content.items():
        try:
            if isinstance(told, list):
                space[name] = Choices(values=told)
            elif isinstance(told, Mapping):
                for key in told:
                    if key not in KEYS:
                        raise TypeError(f"key {shown(key)} is unknown; {allowed(key, KEYS)}")
                space[name] = Range(**told)
            else:
                raise TypeError(f"{shown(told)} is no range and no list; allowed: low, high and log, or a list")
        except (ValueError, TypeError) as mistake:
            raise type(mistake)(f"{called}: {one_line(name, LONGEST_SHOWN)}: {mistake}") from None
    return space


def read_space(path: Path) -> Space:
    """The search space in a file of JSON.

    Raises:
        ValueError: for what is not JSON, or not allowed.
        TypeError: for another kind of thing.
        OSError: if it cannot be read.
    """
    return space_of(read_object(path, called=f"--space {path}"), f"--space {path}")


def require_settings(space: Space, preset: "Preset") -> None:
    """Refuse what a preset's learner has not, or does not allow.

    Raises:
        TypeError: for a setting that does not exist, or is of another kind; names those that do.
        ValueError: for an end or a choice that is not allowed.
    """
    for name, choice in space.items():
        for value in choice.samples:
            try:
                preset.changed({}, {name: value})
            except (TypeError, ValueError) as mistake:
                raise type(mistake)(f"the search space's {one_line(name, LONGEST_SHOWN)}: {mistake}") from None
        held = getattr(preset.settings, name)
        if isinstance(choice, Range) and not isinstance(held, int | float | None):
            raise TypeError(f"the search space's {name} = {shown(held)} is no number; allowed: a list of choices")


def is_whole(choice: Range, held: Any) -> bool:
    """Whether a range is of whole numbers.

    Args:
        choice: the range.
        held: the setting's value in the preset.
    """
    return isinstance(choice.low, int) and isinstance(choice.high, int) and not isinstance(held, float)
