"""A benchmark's numbers as three small tables: one line a run, one an insect of a run, one a point of a curve."""

import csv
from collections import Counter
from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import fields
from pathlib import Path
from typing import Any, TypeVar, get_type_hints

import numpy as np

from agents.benchmark.statistics import first_below
from agents.run_folder import CURVE, RESULTS, write_atomically
from flapenv.aero.checks import record, require_scalar, shown
from flapenv.read_json import read_object

RUNS_TABLE, INSECTS_TABLE, CURVES_TABLE = "runs.csv", "insects.csv", "curves.csv"
THRESHOLDS = (0.05, 0.01, 0.001)
"""Distances [-] of which the table tells when they were first reached."""
CURVE_POINTS = 60
"""Most points kept of a curve."""
COUNTED = ("seed", "wingbeats", "seconds")
"""Fields that are never negative."""
Row = TypeVar("Row")


@record
class RunRow:
    """A finished run.

    Attributes:
        preset: its name.
        seed: its seed.
        environment: id.
        distance: what `mean` and `worst` are, in words.
        mean: distance of the last policy to the task's reference [-].
        worst: the same where it is largest [-].
        wingbeats: trained on.
        seconds: of training, by the clock.
    """

    preset: str
    seed: int
    environment: str
    distance: str
    mean: float
    worst: float
    wingbeats: int
    seconds: float

    def __post_init__(self) -> None:
        """Refuse what no table can tell."""
        _require_texts(self, "preset", "environment", "distance")
        _require_numbers(self, "seed", "mean", "worst", "wingbeats", "seconds")


@record
class InsectRow:
    """One insect of a finished run.

    Attributes:
        preset: of the run.
        seed: of the run.
        insect: its name.
        gap: of the last policy to the insect's optimum [-].
    """

    preset: str
    seed: int
    insect: str
    gap: float

    def __post_init__(self) -> None:
        """Refuse what no table can tell."""
        _require_texts(self, "preset", "insect")
        _require_numbers(self, "seed", "gap")


@record
class CurvePoint:
    """A point of a learning curve.

    Attributes:
        preset: of the run.
        seed: of the run.
        wingbeats: so far.
        seconds: so far, by the clock.
        mean: distance to the task's reference then [-].
        worst: the same where it is largest [-].
    """

    preset: str
    seed: int
    wingbeats: int
    seconds: float
    mean: float
    worst: float

    def __post_init__(self) -> None:
        """Refuse what no picture can show."""
        _require_numbers(self, "seed", "wingbeats", "seconds", "mean", "worst")


def _require_texts(row: object, *names: str) -> None:
    """Refuse fields that are not text."""
    for name in names:
        if not isinstance(getattr(row, name), str):
            raise TypeError(f"{name} = {shown(getattr(row, name))} is not allowed; allowed: a text")


def _require_numbers(row: object, *names: str) -> None:
    """Refuse fields that are not finite numbers, or negative where that means nothing."""
    for name in names:
        require_scalar(name, getattr(row, name), 0.0 if name in COUNTED else -np.inf)


@record
class BenchmarkData:
    """Everything that tables and pictures are made from.

    Attributes:
        runs: presets in the benchmark's order.
        insects: of the runs that name them.
        curves: points in their order.
    """

    runs: Sequence[RunRow]
    insects: Sequence[InsectRow]
    curves: Sequence[CurvePoint]

    @property
    def presets(self) -> list[str]:
        """Their names, in the order of the runs."""
        return list(dict.fromkeys(run.preset for run in self.runs))

    def runs_of(self, preset: str) -> list[RunRow]:
        """A preset's runs."""
        return [run for run in self.runs if run.preset == preset]

    def gaps_of(self, preset: str) -> np.ndarray:
        """Gaps of a preset over seeds and insects [-], shape (n,)."""
        return np.array([row.gap for row in self.insects if row.preset == preset])

    def curves_of(self, preset: str) -> list[list[CurvePoint]]:
        """A preset's curves, one a run; a run without any is an empty one."""
        points: dict[int, list[CurvePoint]] = {run.seed: [] for run in self.runs_of(preset)}
        for point in self.curves:
            if point.preset == preset:
                points[point.seed].append(point)
        return list(points.values())


def collect(folders: Mapping[tuple[str, int], Path]) -> BenchmarkData:
    """Read run folders.

    Args:
        folders: of each preset and seed.

    Raises:
        OSError: if a file cannot be read.
        ValueError: if a file is not as a run writes it; names it.
    """
    runs, insects, curves = list[RunRow](), list[InsectRow](), list[CurvePoint]()
    for (preset, seed), folder in folders.items():
        results = read_object(folder / RESULTS)
        try:
            verdict = results["verdict"]
            runs.append(
                RunRow(
                    preset=preset,
                    seed=seed,
                    environment=results["environment"],
                    distance=verdict["distance"],
                    mean=float(verdict["mean"]),
                    worst=float(verdict["worst"]),
                    wingbeats=int(results["wingbeats"]),
                    seconds=float(results["seconds"]),
                )
            )
            insects += [
                InsectRow(preset=preset, seed=seed, insect=name, gap=one["gap_percent"] / 100)
                for name, one in results.get("insects", {}).items()
                if one.get("gap_percent") is not None  # one that cannot hover has no gap, nor have other tasks
            ]
        except (KeyError, TypeError, AttributeError, ValueError, OverflowError) as mistake:
            raise ValueError(f"{folder / RESULTS} is not a run's: {type(mistake).__name__} {mistake}") from None
        curves += thinned(_curve(preset, seed, folder / CURVE))
    return BenchmarkData(runs=runs, insects=insects, curves=curves)


def _curve(preset: str, seed: int, path: Path) -> list[CurvePoint]:
    """A run's learning curve; empty where it kept none."""
    if not path.is_file():
        return []

    def point(row: Mapping[str, str]) -> CurvePoint:
        return CurvePoint(
            preset=preset,
            seed=seed,
            wingbeats=int(float(row["wingbeats"])),
            seconds=float(row["seconds"]),
            mean=float(row["mean_gap"]),
            worst=float(row["worst_gap"]),
        )

    return _lines(path, point)


def thinned(points: Sequence[CurvePoint]) -> list[CurvePoint]:
    """At most `CURVE_POINTS` points: evenly on a logarithmic axis, the ends, and the first below each threshold."""
    if len(points) <= CURVE_POINTS:
        return list(points)
    mean = np.array([point.mean for point in points])
    firsts = {number for number in (first_below(mean, one) for one in THRESHOLDS) if number is not None}
    wingbeats = np.array([max(point.wingbeats, 1) for point in points])
    marks = np.geomspace(wingbeats[0], wingbeats[-1], CURVE_POINTS - len(THRESHOLDS))
    even = np.minimum(np.searchsorted(wingbeats, marks * (1 - 1e-9)), len(points) - 1)
    kept = sorted({0, len(points) - 1, *firsts, *even.tolist()})
    return [points[number] for number in kept]


def save(data: BenchmarkData, folder: Path) -> None:
    """Write the three tables into a folder that is there."""
    _write(folder / RUNS_TABLE, RunRow, data.runs)
    _write(folder / INSECTS_TABLE, InsectRow, data.insects)
    _write(folder / CURVES_TABLE, CurvePoint, data.curves)


def load(folder: Path) -> BenchmarkData:
    """Read the three tables back.

    Raises:
        FileNotFoundError: if one is missing.
        ValueError: if one is not as `save` writes it; names file and line.
    """
    missing = [name for name in (RUNS_TABLE, INSECTS_TABLE, CURVES_TABLE) if not (folder / name).is_file()]
    if missing:
        raise FileNotFoundError(f"{folder} holds no {', no '.join(missing)}; allowed: a folder that a benchmark wrote")
    data = BenchmarkData(
        runs=_read(folder / RUNS_TABLE, RunRow),
        insects=_read(folder / INSECTS_TABLE, InsectRow),
        curves=_read(folder / CURVES_TABLE, CurvePoint),
    )
    counts = Counter((run.preset, run.seed) for run in data.runs)
    twice = [f"{preset}, seed {seed}" for (preset, seed), count in counts.items() if count > 1]
    if twice or not counts:
        raise ValueError(f"{folder / RUNS_TABLE} has {f'{twice[0]}, more than once' if twice else 'no run'}")
    for name, rows in ((INSECTS_TABLE, data.insects), (CURVES_TABLE, data.curves)):
        strange = next((row for row in rows if (row.preset, row.seed) not in counts), None)
        if strange is not None:
            raise ValueError(f"{folder / name} has {strange.preset}, seed {strange.seed}, which {RUNS_TABLE} lacks")
    return data


def _write(path: Path, kind: type, rows: Iterable[Any]) -> None:
    """Records as lines of a CSV file, numbers with six digits."""
    names = [field.name for field in fields(kind)]

    def write(part: Path) -> None:
        with part.open("w", encoding="utf-8", newline="") as file:
            writer = csv.writer(file, lineterminator="\n")
            writer.writerow(names)
            for row in rows:
                values = [getattr(row, name) for name in names]
                writer.writerow([f"{value:.6g}" if isinstance(value, float) else value for value in values])

    write_atomically(path, write)


def _read(path: Path, kind: type[Row]) -> list[Row]:
    """Records from the lines of a CSV file."""
    make: Any = kind
    types: dict[str, Any] = get_type_hints(kind)

    def made(values: Mapping[str, str]) -> Row:
        row: Row = make(**{name: types[name](value) for name, value in values.items()})
        return row

    return _lines(path, made, list(types))


def _lines(path: Path, make: Callable[[Mapping[str, str]], Row], columns: Sequence[str] | None = None) -> list[Row]:
    """What `make` makes of the lines of a CSV file with these columns, or any; errors name file and line."""
    with path.open(encoding="utf-8", newline="") as file:
        reader = csv.DictReader(file)
        rows = []
        try:
            if columns is not None and reader.fieldnames != columns:
                raise ValueError(f"{path} has columns {reader.fieldnames}; allowed: {', '.join(columns)}")
        except (UnicodeDecodeError, csv.Error) as mistake:
            raise ValueError(f"{path} is no table: {mistake}") from None
        try:
            rows += [make(values) for values in reader]
        except (TypeError, ValueError, KeyError, OverflowError, csv.Error) as mistake:
            raise ValueError(f"{path}, line {reader.line_num}: {type(mistake).__name__} {mistake}") from None
    return rows
