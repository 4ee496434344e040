"""Plain-text tables."""

from collections.abc import Sequence


def text_table(rows: Sequence[Sequence[str]], *, header_rows: int = 1) -> str:
    """Rows of strings as aligned text: the first column to the left, the rest to the right, a rule below the header.

    Args:
        rows: all of the same length, header first.
        header_rows: rows above the rule.
    """
    widths = [max(len(row[column]) for row in rows) for column in range(len(rows[0]))]
    lines = [
        "  ".join(
            cell.ljust(width) if column == 0 else cell.rjust(width)
            for column, (cell, width) in enumerate(zip(row, widths, strict=True))
        ).rstrip()
        for row in rows
    ]
    lines.insert(header_rows, "-" * max(map(len, lines)))
    return "\n".join(lines)
