"""Bad input is refused at the boundary, by an error that names the field, the value and what is allowed."""

import difflib
import functools
from collections.abc import Iterable
from dataclasses import MISSING, dataclass, fields, is_dataclass
from typing import Any, TypeVar, cast, dataclass_transform

import numpy as np

from flapenv.aero.arrays import Real, as_numpy, is_tensor

T = TypeVar("T")
TINIEST, HUGEST = 1e-15, 1e15
"""Sizes, masses and frequencies in SI units lie between these, far beyond what flaps: their products stay numbers."""
LONGEST_SHOWN, LONGEST_LINE = 80, 1000
"""Letters of a value in an error, and of a whole error; what is longer is cut in the middle."""


def one_line(text: object, most: int = LONGEST_LINE) -> str:
    """A text on one line that changes no screen: what does not print is escaped, the middle of much left out.

    Args:
        text: a text, a path or a mistake.
        most: letters from which on it is cut.
    """
    whole = str(text)
    if len(whole) > most:
        whole = f"{whole[: most * 2 // 3]} ... {whole[-most // 3 :]}"
    return "".join(one if one.isprintable() else ascii(one)[1:-1] for one in whole)


def shown(value: object) -> str:
    """A value of unknown origin as an error shows it."""
    try:
        return one_line(repr(value), LONGEST_SHOWN)
    except ValueError:  # a whole number of more digits than Python writes
        return f"a {type(value).__name__} that cannot be shown"


@dataclass_transform(frozen_default=True, kw_only_default=True)
def record(cls: type[T]) -> type[T]:
    """Make a frozen, keyword-only dataclass whose errors list the fields that exist.

    Raises:
        TypeError: on construction, for an unknown or a missing field.
    """
    made: Any = dataclass(frozen=True, kw_only=True)(cls)
    generated = made.__init__
    arguments = [f for f in fields(made) if f.init]
    known = [f.name for f in arguments]
    needed = [f.name for f in arguments if f.default is MISSING and f.default_factory is MISSING]

    @functools.wraps(generated)
    def checked_init(self: Any, **values: Any) -> None:
        for name, value in values.items():
            if name not in known:
                raise TypeError(
                    f"{made.__name__} has no field {shown(name)} (got {shown(value)}); {allowed(name, known)}"
                )
        missing = [name for name in needed if name not in values]
        if missing:
            raise TypeError(f"{made.__name__} needs {', '.join(missing)}; its fields are {', '.join(known)}")
        generated(self, **values)

    made.__init__ = checked_init
    return cast(type[T], made)


def allowed(name: object, names: Iterable[str]) -> str:
    """The end of an error message: what may stand in the place of `name`, and the nearest guess."""
    names = list(names)
    near = difflib.get_close_matches(name[:LONGEST_SHOWN] if isinstance(name, str) else shown(name), names, n=1)
    guess = f"; did you mean {near[0]!r}?" if near else ""
    return f"allowed: {', '.join(names)}{guess}"


def require_name(field: str, value: object, names: Iterable[str]) -> str:
    """`value` if it is one of `names`.

    Raises:
        ValueError: naming the field, the value, all names and the nearest one.
    """
    names = list(names)
    if not isinstance(value, str) or value not in names:
        raise ValueError(f"{field} = {shown(value)} is unknown; {allowed(value, names)}")
    return value


def interval_text(low: float, high: float, *, open_low: bool, open_high: bool, unit: str) -> str:
    """A range as one reads it, `(0, 1.571] rad`."""
    ends = ("(" if open_low or np.isinf(low) else "[", ")" if open_high or np.isinf(high) else "]")
    return f"{ends[0]}{low:.6g}, {high:.6g}{ends[1]}{f' {unit}' if unit else ''}"


def require_real(
    field: str,
    value: Real,
    low: float = -np.inf,
    high: float = np.inf,
    *,
    open_low: bool = False,
    open_high: bool = False,
    unit: str = "",
) -> Real:
    """`value`, finite and within the interval, as a float, an array of floats or the tensor it was.

    Args:
        field: the name used in the error.
        value: a scalar, array or tensor, any shape.
        low: lower end [`unit`].
        high: upper end [`unit`].
        open_low: whether the lower end itself is refused.
        open_high: whether the upper end itself is refused.
        unit: the unit's name, for the error.

    Raises:
        TypeError: if `value` is not real numbers.
        ValueError: if any element is NaN, infinite or outside.
    """
    where = interval_text(low, high, open_low=open_low, open_high=open_high, unit=unit)
    try:
        kind = np.asarray(value.detach().cpu() if is_tensor(value) else value).dtype.kind
        numbers = np.array(as_numpy(value)) if kind in "fiu" else np.empty(0)
    except (TypeError, ValueError, OverflowError):  # ragged, or too large for a float
        numbers = np.empty(0)
    if not numbers.size:
        raise TypeError(f"{field} = {shown(value)} is not a real number or an array of them; allowed: {where}")
    bad = ~np.isfinite(numbers)
    bad |= (numbers <= low) if open_low else (numbers < low)
    bad |= (numbers >= high) if open_high else (numbers > high)
    if np.any(bad):
        index = tuple(int(i) for i in np.argwhere(bad)[0])
        place = f"{field}[{', '.join(map(str, index))}]" if index else field
        raise ValueError(f"{place} = {numbers[index]:.12g} is not allowed; allowed: finite, in {where}")
    if is_tensor(value):
        return value
    numbers.flags.writeable = False  # a copy that nobody can change behind the check
    return numbers if numbers.ndim else float(numbers)


def require_scalar(field: str, value: object, low: float = -np.inf, high: float = np.inf, **ends: Any) -> float:
    """One real number as a Python float; arguments as `require_real`.

    Raises:
        TypeError: if `value` is not one real number.
        ValueError: if it is NaN, infinite or outside.
    """
    number = require_real(field, value, low, high, **ends)
    if np.ndim(number):
        raise TypeError(f"{field} = {shown(value)} is not allowed; allowed: one number")
    return float(number)


def require_flag(field: str, value: object) -> bool:
    """`value` if it is True or False.

    Raises:
        TypeError: for anything else.
    """
    if not isinstance(value, bool):
        raise TypeError(f"{field} = {shown(value)} is not allowed; allowed: True, False")
    return value


def is_single(value: Any) -> bool:
    """Whether a value, or every field of a record and of the records in it, is free of array axes.

    A tuple is the structure of one thing, such as a planform's table; only arrays and tensors are batches.
    """
    if is_dataclass(value) and not isinstance(value, type):
        return all(is_single(part) for part in vars(value).values())
    return not hasattr(value, "shape") or np.ndim(value) == 0


def require_count(field: str, value: object, low: int = 1, high: int | None = None) -> int:
    """`value` as an int of at least `low` and, where there is a `high`, at most that.

    Raises:
        TypeError: if it is not a whole number.
        ValueError: if it is out of range.
    """
    where = f"whole numbers from {low}" if high is None else f"whole numbers from {low} to {high}"
    if isinstance(value, bool | np.bool_) or not isinstance(value, int | np.integer):
        raise TypeError(f"{field} = {shown(value)} is not a whole number; allowed: {where}")
    if value < low or (high is not None and value > high):
        raise ValueError(f"{field} = {value} is not allowed; allowed: {where}")
    return int(value)
