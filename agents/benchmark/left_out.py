"""Each species left out in turn: `python -m agents.benchmark.left_out` trains without its like and judges it."""

import argparse
import sys
from collections.abc import Sequence
from pathlib import Path

from agents.benchmark.run_queue import CommandOf, train_all
from agents.benchmark.training_run import Run, registered, run_command
from agents.commands.one_line_parser import OneLineParser
from agents.run_folder import RESULTS, RUNS, write_atomically
from flapenv.aero.checks import require_count, require_name
from flapenv.insects import INSECTS
from flapenv.read_json import read_object
from flapenv.tables import text_table

ROOT = RUNS / "left-out"
PRESET = "random-wings-ppo"
TASK = "random-wings"
TABLE = "table.txt"
NOTE = "test wings: the whole test split, those like the species included"


def runs_without(names: Sequence[str], preset: str, seed: int) -> list[Run]:
    """A run without each species, in a folder called like it.

    Args:
        names: of the species.
        preset: of random wings.
        seed: of every run.
    """
    return [Run(preset=preset, seed=seed, arguments={"leave_out": name}, name=name) for name in names]


def left_out_table(root: Path, names: Sequence[str]) -> str:
    """The species' own gaps, and those on test wings, of policies that never saw their like.

    Raises:
        OSError: for a run that is missing.
        ValueError: for one that does not tell what the table needs.
    """
    rows: list[tuple[str, ...]] = [
        ("left out", "gap", "weight", "learned", "optimum", "test wings:", "mean", "95 %"),
        ("", "%", "support", "W/kg", "W/kg", "", "%", "%"),
    ]
    gaps = []
    for name in names:
        results = read_object(root / name / RESULTS)
        try:
            own, test = results["insects"][name], results["wings"]["test"]
            gaps.append(float(own["gap_percent"]))
            rows.append(
                (
                    name,
                    f"{own['gap_percent']:.2f}",
                    f"{own['weight_support']:.4f}",
                    f"{own['specific_power']:.2f}",
                    f"{own['optimum_specific_power']:.2f}",
                    "",
                    f"{test['mean_gap_percent']:.2f}",
                    f"{test['p95_gap_percent']:.2f}",
                )
            )
        except (KeyError, TypeError, ValueError) as mistake:
            why = f"{type(mistake).__name__} {mistake}"
            raise ValueError(f"{root / name / RESULTS} is not that of a run without {name}: {why}") from None
    return f"{text_table(rows, header_rows=2)}\nmean {sum(gaps) / len(gaps):.2f} %, worst {max(gaps):.2f} %\n{NOTE}"


def parser() -> argparse.ArgumentParser:
    """The command line."""
    made = OneLineParser(prog="python -m agents.benchmark.left_out", description=__doc__)
    made.add_argument("--insects", nargs="+", default=list(INSECTS), metavar="NAME", help="default: all eight")
    made.add_argument("--preset", default=PRESET, metavar="NAME", help=f"of random wings (default {PRESET})")
    made.add_argument("--seed", type=int, default=0, metavar="N", help="of every run (default 0)")
    made.add_argument("--jobs", type=int, default=2, metavar="N", help="runs at a time, one thread each (default 2)")
    made.add_argument("--root", type=Path, default=ROOT, metavar="DIR", help=f"folder of the runs (default {ROOT}/)")
    return made


def check(options: argparse.Namespace) -> None:
    """Refuse bad input before anything is trained.

    Raises:
        ValueError: for unknown names, a species that is named twice, or a number that is not allowed.
    """
    from agents.training_config import LAST_SEED

    for name in options.insects:
        require_name("--insects", name, INSECTS)
        if options.insects.count(name) > 1:
            raise ValueError(f"--insects name {name} more than once; allowed: each once")
    require_name("--preset", options.preset, [name for name, one in registered().items() if one.task == TASK])
    if require_count("--seed", options.seed, low=0) > LAST_SEED:
        raise ValueError(f"--seed = {options.seed} is not allowed; allowed: whole numbers from 0 to {LAST_SEED}")
    require_count("--jobs", options.jobs)


def main(arguments: Sequence[str] | None = None, *, command: CommandOf = run_command) -> int:
    """Train, print and keep the table; 0 on success, 1 where a run failed, 2 for bad input, 130 after Ctrl-C.

    Args:
        arguments: the words after the module's name.
        command: the command line of a run into a folder.
    """
    options = parser().parse_args(arguments)
    try:
        check(options)
        runs = runs_without(options.insects, options.preset, options.seed)
        outcome = train_all(runs, options.root, options.jobs, command=command)
        if outcome.interrupted:
            print("stopped; runs that have ended are kept, and the same command goes on", file=sys.stderr)
            return 130
        if outcome.failed:
            print(f"failed: {', '.join(outcome.failed)}; the same command goes on", file=sys.stderr)
            return 1
        table = left_out_table(options.root, options.insects)
        write_atomically(options.root / TABLE, lambda part: part.write_text(f"{table}\n", encoding="utf-8"))
        print(table)
    except (ValueError, TypeError, OSError) as mistake:
        print(f"error: {mistake}", file=sys.stderr)
        return 2
    return 0


if __name__ == "__main__":
    sys.exit(main())
