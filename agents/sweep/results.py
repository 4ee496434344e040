"""What a sweep found: tables for people, and the same as JSON and CSV."""

import csv
import io
import json
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

import numpy as np

from agents.benchmark.report import percent
from agents.benchmark.statistics import CONFIDENCE, interquartile_mean, interval
from agents.sweep.plan import SweepPlan
from agents.sweep.runs import RunResult
from agents.sweep.study import Trial
from flapenv.tables import text_table
from flapenv.whole_file import write_json, write_text

RESULTS_FILE, RUNS_FILE, TABLE_FILE = "sweep_results.json", "sweep_runs.csv", "table.txt"
BEST = 20
"""Trials of a search that its table shows."""


def summary_of(group: str, results: Sequence[RunResult], asked: int) -> dict[str, Any]:
    """A line of the table, of the runs that have a distance; None for what is not known.

    Args:
        group: its name.
        results: of the finished runs.
        asked: runs that it should have.
    """
    means = np.array([one.mean for one in results if one.mean is not None])
    worsts = [one.worst for one in results if one.worst is not None]
    ends = interval(means) if len(means) else None
    return {
        "name": group,
        "runs": asked,
        "finished": len(results),
        "mean": float(np.mean(means)) if len(means) else None,
        "interquartile_mean": float(interquartile_mean(means)) if len(means) else None,
        "interval": None if ends is None else list(ends),
        "worst": max(worsts) if worsts else None,
        "wingbeats": float(np.median([one.wingbeats for one in results])) if results else None,
        "seconds": float(np.median([one.seconds for one in results])) if results else None,
    }


def sweep_table(summaries: Sequence[Mapping[str, Any]]) -> str:
    """The lines of a sweep without a search."""
    rows = [
        ["preset", "runs", "mean [%]", "IQM [%]", f"{100 * CONFIDENCE:g} % interval", "worst [%]", "wingbeats", "s"]
    ]
    for one in summaries:
        ends = one["interval"]
        rows.append(
            [
                one["name"],
                f"{one['finished']}/{one['runs']}",
                _percent(one["mean"]),
                _percent(one["interquartile_mean"]),
                "-" if ends is None else f"[{percent(ends[0])}, {percent(ends[1])}]",
                _percent(one["worst"]),
                "-" if one["wingbeats"] is None else f"{one['wingbeats']:,.0f}",
                "-" if one["seconds"] is None else f"{one['seconds']:,.0f}",
            ]
        )
    return text_table(rows)


def trials_table(plan: SweepPlan, trials: Sequence[Trial]) -> str:
    """The trials of a search, the best first."""
    names = list(plan.search)
    rows = [["trial", *names, "mean [%]"]]
    for trial in ranked(trials)[:BEST]:
        cells = [_cell(trial.chosen.get(name)) for name in names]
        rows.append([f"trial{trial.number:04d}", *cells, _percent(trial.value)])
    return text_table(rows)


def ranked(trials: Sequence[Trial]) -> list[Trial]:
    """Trials, the best first and those without a distance last."""
    return sorted(trials, key=lambda one: (one.value is None, one.value or 0.0, one.number))


def best_command(plan: SweepPlan, trials: Sequence[Trial]) -> str | None:
    """The command that trains with the best settings; None before there are any."""
    found = [trial for trial in ranked(trials) if trial.value is not None]
    if not found:
        return None
    return plan.runs_of_trial(found[0].number, found[0].chosen)[0].config.command


def write_results(storage: Path, table: str, results: Sequence[RunResult], content: Mapping[str, Any]) -> None:
    """Keep what was found, each file whole or not at all.

    Raises:
        OSError: if the storage cannot be written.
    """
    text = io.StringIO()
    writer = csv.writer(text, lineterminator="\n")
    writer.writerow(["folder", "group", "seed", "mean", "worst", "wingbeats", "seconds", "command"])
    for one in results:
        run = one.run
        numbers = [one.mean, one.worst, one.wingbeats, one.seconds]
        writer.writerow([run.name, run.group, run.config.seed, *numbers, run.config.command])
    write_text(storage / RUNS_FILE, text.getvalue())
    write_text(storage / TABLE_FILE, f"{table}\n")
    write_json(storage / RESULTS_FILE, content)


def _percent(value: float | None) -> str:
    """A distance that may not be known."""
    return "-" if value is None else percent(value)


def _cell(value: Any) -> str:
    """A setting as the table shows it."""
    return f"{value:.4g}" if isinstance(value, float) else value if isinstance(value, str) else json.dumps(value)
