"""Tables with one header row, `name [unit]` in every column of numbers, so that no unit can be mistaken."""

import csv
import io
import math
import re
from collections.abc import Mapping
from pathlib import Path

from flapenv.aero.checks import allowed
from flapenv.read_json import read_text

NUMBER = re.compile(r"[+-]?(\d+\.?\d*|\.\d+)([eE][+-]?\d+)?", re.ASCII)
"""Stricter than Python, which also takes underlines, other alphabets' digits, and nan."""


def heading(name: str, unit: str) -> str:
    """The header of a column of numbers."""
    return f"{name} [{unit}]"


def read_columns(
    path: Path, units: Mapping[str, str], *, names: tuple[str, ...] = (), most: int
) -> list[dict[str, float | str]]:
    """Rows of a CSV file.

    Args:
        path: of the file.
        units: of the columns of numbers, all needed, in any order.
        names: columns of text that may be there.
        most: rows up to which it is read.

    Returns:
        A dict for every row that is not blank: numbers by name, and texts where their column is there.

    Raises:
        ValueError: for a table that is anything else, naming the file, the line and the column.
        OSError: if it cannot be read.
    """
    text = read_text(path)
    reader = csv.reader(io.StringIO(text, newline=""), strict=True)
    rows: list[dict[str, float | str]] = []
    header: list[str] = []
    try:
        for cells in reader:
            if not any(cell.strip() for cell in cells):
                continue
            if not header:
                header = _checked_header([cell.strip() for cell in cells], units, names, str(path))
                continue
            if len(rows) == most:
                raise ValueError(f"{path} has more than {most:,} rows; allowed: up to {most:,}")
            rows.append(_row(cells, header, units, f"{path} line {reader.line_num}"))
    except csv.Error as mistake:
        raise ValueError(f"{path} line {reader.line_num} is not CSV: {mistake}; allowed: {_expected(units)}") from None
    if not header:
        raise ValueError(f"{path} is empty; allowed: a header {_expected(units)} and rows of numbers")
    if not rows:
        raise ValueError(f"{path} has a header but no rows; allowed: at least one")
    return rows


def _expected(units: Mapping[str, str]) -> str:
    """The header that is asked for."""
    return ",".join(heading(name, unit) for name, unit in units.items())


def _checked_header(cells: list[str], units: Mapping[str, str], names: tuple[str, ...], path: str) -> list[str]:
    """Names of the columns, once each cell says a known name and its unit."""
    if len(cells) == 1 and ";" in cells[0]:
        raise ValueError(f"{path}: columns are parted by semicolons; allowed: commas, and points in numbers")
    found = []
    for cell in cells:
        name, bracket, unit = (part.strip() for part in cell.partition("["))
        unit = unit.removesuffix("]").strip()
        if name in names and not bracket:
            found.append(name)
            continue
        if name not in units:
            raise ValueError(
                f"{path}: unknown column {cell!r}; {allowed(cell, [*names, *_expected(units).split(',')])}"
            )
        if not bracket:
            wanted = heading(name, units[name])
            raise ValueError(f"{path}: column {cell!r} has no unit; allowed: {wanted!r}, so that no unit is mistaken")
        if unit != units[name]:
            raise ValueError(
                f"{path}: column {cell!r} is not in {units[name]}; allowed: {heading(name, units[name])!r}; convert "
                "the numbers and say so"
            )
        found.append(name)
    for name in found:
        if found.count(name) > 1:
            raise ValueError(f"{path}: column {name!r} stands twice; allowed: once")
    missing = [heading(name, unit) for name, unit in units.items() if name not in found]
    if missing:
        raise ValueError(f"{path}: no column {', '.join(missing)}; allowed: a header {_expected(units)}")
    return found


def _row(cells: list[str], header: list[str], units: Mapping[str, str], where: str) -> dict[str, float | str]:
    """One row by column."""
    if len(cells) != len(header):
        raise ValueError(f"{where} has {len(cells)} cells; allowed: {len(header)}, one for each column of the header")
    row: dict[str, float | str] = {}
    for name, cell in zip(header, cells, strict=True):
        text = cell.strip()
        if name not in units:
            row[name] = text
            continue
        if not (NUMBER.fullmatch(text) and math.isfinite(float(text))):
            raise ValueError(f"{where}: {name} = {text!r} is not a number; allowed: a finite number such as 0.5")
        row[name] = float(text)
    return row
