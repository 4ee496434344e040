"""Plain-text tables."""

import unicodedata
from collections.abc import Sequence


def text_table(rows: Sequence[Sequence[str]], *, header_rows: int = 1) -> str:
    """Rows of strings as aligned text: the first column to the left, the rest to the right, a rule below the header.

    Args:
        rows: all of the same length, header first.
        header_rows: rows above the rule.
    """
    widths = [max(_width(row[column]) for row in rows) for column in range(len(rows[0]))]
    lines = []
    for row in rows:
        padded = []
        for column, (cell, width) in enumerate(zip(row, widths, strict=True)):
            space = " " * (width - _width(cell))
            padded.append(cell + space if column == 0 else space + cell)
        lines.append("  ".join(padded).rstrip())
    lines.insert(header_rows, "-" * max(map(_width, lines)))
    return "\n".join(lines)


def _width(text: str) -> int:
    """Columns that a text takes: marks such as the hat of r̂ take none."""
    return sum(not unicodedata.combining(character) for character in text)
