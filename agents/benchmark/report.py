"""What a benchmark found, as tables and pictures, from its small tables alone."""

import textwrap
from collections.abc import Sequence
from functools import partial
from pathlib import Path

import numpy as np

from agents.benchmark.data import THRESHOLDS, BenchmarkData, CurvePoint, RunRow
from agents.benchmark.machine import machine_text, read_machines
from agents.benchmark.statistics import CONFIDENCE, first_below, interquartile_mean, interval, median_of_reached
from agents.run_folder import write_atomically
from flapenv.tables import text_table

TABLE, PAGE = "table.txt", "table.md"
FEW = 10
"""Runs below which an interval is rough."""
LINE = 110
"""Columns of the notes for a terminal."""


def reached_rows(data: BenchmarkData) -> list[list[str]]:
    """What the last policies reached: a header, then a line a preset."""
    confidence = f"{100 * CONFIDENCE:g} % interval"
    rows = [["preset", "runs", "IQM [%]", confidence, "worst [%]", "wingbeats", "seconds"]]
    for preset in data.presets:
        runs = data.runs_of(preset)
        mean = np.array([run.mean for run in runs])
        ends = interval(mean)
        rows.append(
            [
                preset,
                str(len(runs)),
                percent(float(interquartile_mean(mean))),
                "-" if ends is None else f"[{percent(ends[0])}, {percent(ends[1])}]",
                percent(max(run.worst for run in runs)),
                f"{np.median([run.wingbeats for run in runs]):,.0f}",
                f"{np.median([run.seconds for run in runs]):,.0f}",
            ]
        )
    return rows


def spent_rows(data: BenchmarkData) -> list[list[str]]:
    """Wingbeats and seconds until the mean distance was first at each threshold: a header, then a line a preset."""
    header = ["preset"]
    for threshold in THRESHOLDS:
        header += [f"to {100 * threshold:g} %", "seconds", "runs"]
    rows = [header]
    for preset in data.presets:
        cells = [preset]
        for threshold in THRESHOLDS:
            firsts = [_first(curve, threshold) for curve in data.curves_of(preset)]
            wingbeats = median_of_reached([None if point is None else point.wingbeats for point in firsts])
            seconds = median_of_reached([None if point is None else point.seconds for point in firsts])
            cells += [
                "-" if wingbeats is None else f"{wingbeats:,.0f}",
                "-" if seconds is None else f"{seconds:,.0f}" if seconds >= 10 else f"{seconds:.2g}",
                f"{sum(point is not None for point in firsts)}/{len(firsts)}",
            ]
        rows.append(cells)
    return rows


def notes(data: BenchmarkData, machine: str) -> list[str]:
    """What the columns mean and where the seconds were measured."""
    said = [
        "IQM: interquartile mean over seeds of the last policy's mean distance (of five seeds, the middle three)",
        "worst: of the worst seed, on its worst insect or, of many random wings, at their 95th percentile",
    ]
    for words, runs in _distances(data).items():
        said.append(f"distance of {', '.join(dict.fromkeys(run.preset for run in runs))}: {words}")
    fewest = min(len(data.runs_of(preset)) for preset in data.presets)
    if fewest < FEW:
        said.append(
            f"interval: percentile bootstrap over seeds; of {fewest} runs it is rough and rather too narrow"
            if fewest > 1
            else "interval: percentile bootstrap over seeds, for which one run is not enough"
        )
    said.append("to 5 %: median over seeds until a point of the curve was first there, - where half never were")
    said += machine.splitlines()
    return said


def text_report(data: BenchmarkData, machine: str) -> str:
    """Both tables with their notes, for a terminal."""
    tables = [text_table(reached_rows(data)), text_table(spent_rows(data))]
    said = [textwrap.fill(note, LINE, subsequent_indent="  ") for note in notes(data, machine)]
    return "\n\n".join([*tables, "\n".join(said)])


def markdown_report(data: BenchmarkData, machine: str) -> str:
    """The same in Markdown, as a page."""
    tables = [_markdown_table(rows) for rows in (reached_rows(data), spent_rows(data))]
    return "\n\n".join(["# The benchmark's tables", *tables, "\n".join(f"- {note}" for note in notes(data, machine))])


def write_report(data: BenchmarkData, folder: Path) -> str:
    """Write tables and pictures into a folder that is there.

    Args:
        data: at least one run.
        folder: its machine.json is told.

    Returns:
        The tables as text.
    """
    from agents.benchmark.pictures import draw_all

    machine = machine_text(read_machines(folder))
    text = text_report(data, machine)
    for name, content in ((TABLE, text), (PAGE, markdown_report(data, machine))):
        write_atomically(folder / name, partial(_write_text, f"{content}\n"))
    for name, figure in draw_all(data).items():
        write_atomically(folder / name, partial(figure.savefig, metadata={"Software": None}))
    return text


def _write_text(content: str, path: Path) -> None:
    path.write_text(content, encoding="utf-8")


def percent(value: float) -> str:
    """A distance as a percentage of three digits."""
    number = 100 * value
    return f"{number:.0f}" if abs(number) >= 100 else f"{number:.3g}" if abs(number) >= 1e-4 else f"{number:.1g}"


def _first(curve: Sequence[CurvePoint], threshold: float) -> CurvePoint | None:
    """The first point whose mean distance is at most the threshold."""
    number = first_below(np.array([point.mean for point in curve]), threshold)
    return None if number is None else curve[number]


def _distances(data: BenchmarkData) -> dict[str, list[RunRow]]:
    """Runs by what their distance is."""
    found: dict[str, list[RunRow]] = {}
    for run in data.runs:
        found.setdefault(run.distance, []).append(run)
    return found


def _markdown_table(rows: Sequence[Sequence[str]]) -> str:
    """Rows of strings as a Markdown table, numbers to the right."""
    header, *body = [f"| {' | '.join(row)} |" for row in rows]
    rule = f"|---|{'---:|' * (len(rows[0]) - 1)}"
    return "\n".join([header, rule, *body])
