"""`python train.py benchmark`: its arguments, and what it prints."""

import argparse
import os
import sys
from pathlib import Path

from agents.benchmark.data import collect, load, save
from agents.benchmark.machine import machine_text, read_machines, write_machines
from agents.benchmark.report import text_report, write_report
from agents.benchmark.run_queue import CommandOf, Outcome
from agents.benchmark.runner import BENCHMARKED, ROOT, BenchmarkConfig, finished_runs, run_benchmark
from agents.benchmark.training_run import run_command
from agents.commands.one_line_parser import OneLineParser


def benchmark_parser() -> argparse.ArgumentParser:
    """The command line."""
    made = OneLineParser(
        prog="train.py benchmark",
        description=(
            "How near do the learners come, how surely, how fast? Trains every preset with several seeds, each run in\n"
            "a process of its own on one thread, and writes tables and pictures.\n"
            "After Ctrl-C or a crash the same command goes on where it was: runs under way from their checkpoints."
        ),
        epilog=(
            "examples:\n"
            "  python train.py benchmark                        everything: one to two hours on two cores\n"
            "  python train.py benchmark --presets hover-ppo hover-sac --seeds 2\n"
            "  python train.py benchmark --wingbeats 20000 --root runs/try  a rehearsal of some minutes\n"
            "  python train.py benchmark --report docs/benchmark            redraw the numbers kept there\n\n"
            "runs go into ROOT/PRESET-seedN; OUT gets the numbers (runs.csv, insects.csv, curves.csv, machine.json),\n"
            "table.txt, table.md and pictures. A run that fails is named, and ROOT/PRESET-seedN.part holds what it\n"
            "printed; the others go on, and the command ends with 1. The same command goes on with it from its\n"
            "checkpoint; without that folder it begins anew. Tables and pictures are of all finished runs in ROOT,\n"
            "those of earlier benchmarks too"
        ),
    )
    made.add_argument("--presets", nargs="+", metavar="NAME", help=f"what to train (default {' '.join(BENCHMARKED)})")
    made.add_argument("--seeds", type=int, metavar="N", help=f"0 to N-1 (default {BenchmarkConfig.seeds})")
    made.add_argument(
        "--jobs",
        type=int,
        metavar="N",
        help=(
            f"runs at a time, one thread each (default {BenchmarkConfig.jobs}); sensible is at most one a core, of "
            f"which this computer has {os.cpu_count()}: more only slow each other down, and their seconds say less"
        ),
    )
    made.add_argument("--wingbeats", type=int, metavar="N", help="budget of every run (default the presets' own)")
    made.add_argument("--root", type=Path, metavar="DIR", help=f"where the run folders go (default {ROOT})")
    made.add_argument("--out", type=Path, metavar="DIR", help="where tables and pictures go (default ROOT)")
    made.add_argument("--report", type=Path, metavar="DIR", help="only draw the numbers kept in DIR; goes alone")
    made.add_argument("--quiet", action="store_true", help="no progress bar")
    return made


def benchmark_command(arguments: list[str], *, command: CommandOf = run_command) -> int:
    """Run the benchmark, or redraw one.

    Args:
        arguments: the words after `benchmark`.
        command: the command line of a run into a folder.

    Returns:
        0 if every run is there, 1 if one failed, 2 for bad input, 130 after Ctrl-C.
    """
    options = vars(benchmark_parser().parse_args(arguments))
    quiet, report, root, out = (options.pop(name) for name in ("quiet", "report", "root", "out"))
    given = {name: value for name, value in options.items() if value is not None}
    try:
        if report is not None:
            beside = [f"--{name}" for name in (*given, *(["root"] if root else []), *(["out"] if out else []))]
            if beside:
                raise ValueError(f"--report goes alone, not with {', '.join(beside)}: it trains nothing")
            print(write_report(load(report), report), flush=True)
            return 0
        config, root = BenchmarkConfig(**given), root or ROOT
        out = out or root
        for name, folder in (("root", root), ("out", out)):
            if folder.is_file():
                raise NotADirectoryError(f"--{name} {folder} is a file; allowed: a folder")
            folder.mkdir(parents=True, exist_ok=True)  # before hours are spent on what cannot be kept
        outcome = run_benchmark(config, root, command=command, progress=not quiet)
        return _conclude(config, outcome, root, out)
    except (ValueError, TypeError, OSError, ImportError) as mistake:
        print(f"train.py benchmark: {mistake}", file=sys.stderr)
        return 2


def _conclude(config: BenchmarkConfig, outcome: Outcome, root: Path, out: Path) -> int:
    """Print what is there, keep it unless the benchmark was stopped, and say what is not there."""
    found, left_out = finished_runs(root, config.wingbeats)
    if found:
        data = collect({(run.preset, run.seed): root / run.name for run in found})
        machines = read_machines(root)
        if outcome.interrupted:
            print(text_report(data, machine_text(machines)))
        else:
            save(data, out)
            write_machines(out, machines)
            print(f"{write_report(data, out)}\n\nkept in {out}")
    sys.stdout.flush()
    for why in left_out.values():
        print(f"train.py benchmark: left out of the tables: {why}", file=sys.stderr)
    total = len(config.runs())
    if len(outcome.finished) < total:
        how = "stopped with" if outcome.interrupted else "ended with"
        failed = f" (failed: {', '.join(outcome.failed)})" if outcome.failed else ""
        print(
            f"train.py benchmark: {how} {len(outcome.finished)} of {total} runs in {root}{failed}; "
            "the same command goes on",
            file=sys.stderr,
        )
    return 130 if outcome.interrupted else 1 if outcome.failed else 0
