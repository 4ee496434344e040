"""What Ray Tune costs: the same runs as plain processes and as a sweep, `python -m benchmarks.sweep`.

Both train runs of the default preset beside each other, one thread each, and write the same files; the processes are
those of `train.py benchmark`. They take turns in going first, as a machine slows down when it gets warm.
"""

import argparse
import subprocess
import sys
import tempfile
import time
from collections.abc import Callable
from pathlib import Path

import numpy as np

from agents.benchmark.run_queue import train_all
from agents.benchmark.training_run import TRAIN, Run
from agents.presets import DEFAULT_PRESET
from flapenv.tables import text_table

WINGBEATS = 2_000_000
"""Of a run: at least a minute."""
RUNS, JOBS, REPETITIONS = 4, 2, 2


def plain(folder: Path, runs: int, wingbeats: int) -> None:
    """Plain processes, a few at a time."""
    asked = [Run(preset=DEFAULT_PRESET, seed=seed, wingbeats=wingbeats) for seed in range(runs)]
    outcome = train_all(asked, folder, JOBS, progress=False)
    if len(outcome.finished) < runs:
        raise RuntimeError(f"runs have failed: {dict(outcome.failed)}")


def sweep(folder: Path, runs: int, wingbeats: int) -> None:
    """Trials of Ray Tune, with the time that Ray takes to start and to end."""
    words = [sys.executable, str(TRAIN), "sweep", "--presets", DEFAULT_PRESET, "--seeds", str(runs), "--quiet"]
    words += ["--wingbeats", str(wingbeats), "--jobs", str(JOBS), "--storage", str(folder)]
    subprocess.run(words, check=True, stdout=subprocess.DEVNULL)


def seconds(way: Callable[[Path, int, int], None], runs: int, wingbeats: int) -> float:
    """By the clock, from nothing to the last file."""
    with tempfile.TemporaryDirectory() as folder:
        started = time.perf_counter()
        way(Path(folder), runs, wingbeats)
        return time.perf_counter() - started


def main(arguments: list[str] | None = None) -> None:
    """Print the seconds of both, and their ratio."""
    parser = argparse.ArgumentParser(description=(__doc__ or "").splitlines()[0])
    parser.add_argument("--runs", type=int, default=RUNS, help=f"of a repetition (default {RUNS})")
    parser.add_argument("--wingbeats", type=int, default=WINGBEATS, help=f"of a run (default {WINGBEATS:,})")
    parser.add_argument("--repetitions", type=int, default=REPETITIONS, help=f"default {REPETITIONS}")
    options = parser.parse_args(arguments)
    ways = {"plain processes": plain, "train.py sweep": sweep}
    took: dict[str, list[float]] = {name: [] for name in ways}
    for repetition in range(options.repetitions):
        order = list(ways) if repetition % 2 == 0 else list(reversed(ways))
        for name in order:
            took[name].append(seconds(ways[name], options.runs, options.wingbeats))
    head = [f"{options.runs} runs of {DEFAULT_PRESET}, {options.wingbeats:,} wingbeats, {JOBS} at a time", "s", "each"]
    rows = [[name, f"{np.mean(found):.1f}", ", ".join(f"{one:.1f}" for one in found)] for name, found in took.items()]
    plainly, swept = (float(np.mean(found)) for found in took.values())
    print(text_table([head, *rows]))
    print(f"\noverhead of the sweep: {100 * (swept / plainly - 1):+.1f} %, {(swept - plainly):+.1f} s")


if __name__ == "__main__":
    main()
