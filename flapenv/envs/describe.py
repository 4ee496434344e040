"""Tables of the environments' docstrings, made from the one parameter table."""

import math
from collections.abc import Callable, Iterable, Sequence
from typing import TypeVar

from flapenv.aero.parameters import STROKE_PARAMETERS
from flapenv.problem import StrokeBox

Class = TypeVar("Class", bound=type)
Row = Sequence[str]

ACTION_HEADER = ("Num", "Name", "Symbol", "Unit", "-1", "+1", "Scale")


def markdown_table(header: Row, rows: Iterable[Row]) -> str:
    """Rows of words as a Markdown table."""
    lines = [header, ["---"] * len(header), *rows]
    return "\n".join("| " + " | ".join(line) + " |" for line in lines)


def stroke_rows(box: StrokeBox, names: Iterable[str]) -> list[Row]:
    """A line of the action table, but for its number, for parameters of a stroke along an action's axes.

    Args:
        box: where the parameters may lie.
        names: of `STROKE_PARAMETERS`, or "tip_speed" for q = f φmax.
    """
    return [_tip_speed_row(box) if name == "tip_speed" else _stroke_row(box, name) for name in names]


def action_table(rows: Iterable[Row]) -> str:
    """The action table of a docstring, its rows numbered from 0."""
    return markdown_table(ACTION_HEADER, [(str(number), *row) for number, row in enumerate(rows)])


def described(**tables: str) -> Callable[[Class], Class]:
    """Put tables into the docstring of a class, where it says `{name}` on a line of its own."""

    def put(cls: Class) -> Class:
        text: str = cls.__doc__ or ""
        for name, table in tables.items():
            text = text.replace(f"    {{{name}}}", "\n".join(f"    {line}" for line in table.splitlines()))
        cls.__doc__ = text
        return cls

    return put


def _stroke_row(box: StrokeBox, name: str) -> Row:
    row = STROKE_PARAMETERS[name]
    relative = getattr(box, name, None) is None
    low, high = getattr(box, f"{name}_ratio") if relative else getattr(box, name)
    ends = (f"{end:g} {row.symbol}_ref" if relative else _text(end, row.unit) for end in (low, high))
    scale = f"log(1 - {row.symbol})" if row.scale == "log-complement" else row.scale
    return (name, row.symbol, row.unit or "-", *ends, scale)


def _tip_speed_row(box: StrokeBox) -> Row:
    frequency, amplitude = _stroke_row(box, "frequency"), _stroke_row(box, "flap_amplitude")
    name = f"tip speed, q = f φmax; f = q/φmax is clipped to {frequency[3]} - {frequency[4]}"
    return (name, "q", "rad Hz", f"{frequency[3]} {amplitude[3]}", f"{frequency[4]} {amplitude[4]}", "log")


def _text(value: float, unit: str) -> str:
    return f"{math.degrees(value):g}°" if unit == "rad" else f"{value:g}{f' {unit}' if unit else ''}"
