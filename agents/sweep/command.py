"""`python train.py sweep`: its arguments, and what it prints."""

import argparse
import os
import sys
from importlib.util import find_spec
from pathlib import Path
from typing import Any

from agents.commands.one_line_parser import OneLineParser, folder, said
from agents.presets import setting_of
from agents.run_folder import RUNS
from agents.sweep.plan import SweepPlan
from agents.sweep.search_space import FORMS, dimension_of, read_space
from agents.sweep.storage import read_plan
from agents.sweep.sweep import Outcome, run_sweep
from flapenv.aero.checks import one_line, require_count
from flapenv.insects import INSECTS
from flapenv.problem import PROBLEMS

STORAGE = RUNS / "sweep"
ELSEWHERE = ("resume", "storage", "jobs", "address", "quiet", "space")
"""Options that are not fields of the plan."""


def sweep_parser() -> argparse.ArgumentParser:
    """The command line."""
    made = OneLineParser(
        prog="train.py sweep",
        description=(
            "Train seeds × presets × problems, or search for settings, as trials of Ray Tune: on this machine, or on\n"
            "a cluster with the same command and an address. Every run is one that train.py would make, in a folder\n"
            "of its own. Ctrl-C, a crash or a lost node loses no finished run: the same command goes on."
        ),
        epilog=(
            "examples:\n"
            "  python train.py sweep --presets hover-ppo hover-sac --seeds 8\n"
            "  python train.py sweep --presets hover-ppo --problems A C --wingbeats 500000 --storage runs/problems\n"
            "  python train.py sweep --presets hover-ppo --search learning_rate=1e-3:3e-2:log \\\n"
            "      --search activation=relu,tanh --trials 20 --seeds 3 --wingbeats 200000 --storage runs/search\n"
            "  python train.py sweep --resume runs/search --jobs 4\n"
            "  python train.py sweep --presets hover-ppo --seeds 8 --storage /shared/eight --address 10.0.0.1:6379\n\n"
            "the storage gets sweep.json (what was asked for), a folder a run, and table.txt, sweep_runs.csv and\n"
            "sweep_results.json; a search keeps what it tried in search.jsonl, a journal of Optuna's. Without an\n"
            "address Ray is started for this sweep alone, on the loopback, and ends with it. With one, this machine\n"
            "must be a node of the cluster, and --storage a folder that all nodes share: see docs/how-to/many-runs.md"
        ),
    )
    made.add_argument("--presets", nargs="+", metavar="NAME", help="what to train, see train.py --list")
    made.add_argument(
        "--problems", nargs="+", metavar="NAME", help=f"of {', '.join(PROBLEMS)}, or A to D; of tasks with one"
    )
    made.add_argument("--insects", nargs="+", metavar="NAME", help=f"of {', '.join(INSECTS)}; of tasks that name them")
    made.add_argument("--seeds", type=int, metavar="N", help=f"0 to N-1 (default {SweepPlan.seeds})")
    made.add_argument("--wingbeats", type=int, metavar="N", help="budget of every run (default the presets' own)")
    made.add_argument(
        "--set", action="append", metavar="NAME=VALUE", dest="settings", help="of the learners; repeatable"
    )
    made.add_argument(
        "--search", action="append", metavar="NAME=SPACE", help=f"what to search: {FORMS}; repeatable, needs --trials"
    )
    made.add_argument(
        "--space", type=folder, metavar="FILE", help='the same as JSON: {"NAME": {"low": 1e-4, "high": 1, "log": true}}'
    )
    made.add_argument("--trials", type=int, metavar="N", help="settings to try, each with all seeds")
    made.add_argument(
        "--batch",
        type=int,
        metavar="N",
        help=f"settings chosen at a time, from what all earlier ones found (default {SweepPlan.batch})",
    )
    made.add_argument("--seed", type=int, metavar="N", dest="sampler_seed", help="of the search's draws (default 0)")
    made.add_argument("--storage", type=folder, metavar="DIR", help=f"where everything goes (default {STORAGE})")
    made.add_argument("--resume", type=folder, metavar="DIR", help="go on with the sweep in DIR, as it was asked for")
    made.add_argument(
        "--jobs",
        type=int,
        metavar="N",
        help=f"runs at a time, one thread each (default the cores: {os.cpu_count()} here, all of a cluster)",
    )
    made.add_argument(
        "--address", metavar="HOST:PORT", help="of the head of a Ray cluster (default this machine alone)"
    )
    made.add_argument("--quiet", action="store_true", help="no progress bar")
    return made


def sweep_command(arguments: list[str]) -> int:
    """Run a sweep, or go on with one.

    Args:
        arguments: the words after `sweep`.

    Returns:
        0 if every run is there, 1 if one is not, 2 for bad input, 130 after Ctrl-C.

    Raises:
        ImportError: if Ray is not installed.
    """
    options = sweep_parser().parse_args(arguments)
    if find_spec("ray") is None:  # not imported yet: it reads the environment when it is
        raise ModuleNotFoundError("No module named 'ray'")
    try:
        if options.jobs is not None:
            require_count("jobs", options.jobs)
        plan, storage = plan_of(options)
        outcome = run_sweep(plan, storage, jobs=options.jobs, address=options.address, progress=not options.quiet)
    except (ValueError, TypeError, OSError, RuntimeError) as mistake:
        print(f"train.py sweep: {said(mistake)}", file=sys.stderr)
        return 2
    return _conclude(outcome, storage)


def plan_of(options: argparse.Namespace) -> tuple[SweepPlan, Path]:
    """What the command line asks for, and where it is kept.

    Raises:
        ValueError: for names or values that are not allowed.
        TypeError: for values of another kind.
        OSError: for a file that cannot be read.
    """
    given: dict[str, Any] = {name: value for name, value in vars(options).items() if value is not None}
    asked = {name: value for name, value in given.items() if name not in ELSEWHERE}
    if options.resume is not None:
        names = {"sampler_seed": "seed", "settings": "set"}
        beside = [f"--{names.get(name, name)}" for name in (*asked, *(set(given) & {"storage", "space"}))]
        if beside:
            raise ValueError(
                f"--resume goes without {', '.join(beside)}, its plan being kept; allowed: --jobs, --address, --quiet"
            )
        return read_plan(options.resume), options.resume
    if options.presets is None:
        raise ValueError("a sweep needs presets; allowed: --presets NAME ..., or --resume DIR")
    space = {} if options.space is None else dict(read_space(options.space))
    for text in asked.pop("search", []):
        name, choice = dimension_of(text)
        if name in space:
            raise ValueError(f"--search {one_line(text, 80)}: {one_line(name, 80)} is searched twice; allowed: once")
        space[name] = choice
    for name, told in (("batch", "--batch"), ("sampler_seed", "--seed")):
        if name in asked and not space:
            raise ValueError(f"{told} is of a search; allowed: --search beside it, or --seeds N for the seeds of runs")
    settings = dict(setting_of(text) for text in asked.pop("settings", []))
    return SweepPlan(**asked, search=space, settings=settings), options.storage or STORAGE


def _conclude(outcome: Outcome, storage: Path) -> int:
    """Print what is there, and say what is not."""
    print(f"{outcome.table}\n\nkept in {storage}", flush=True)
    incomplete = bool(outcome.failed) or outcome.finished < outcome.total
    if outcome.interrupted or incomplete:
        how = "stopped with" if outcome.interrupted else "ended with"
        failed = f" (failed: {one_line(', '.join(outcome.failed))})" if outcome.failed else ""
        print(
            f"train.py sweep: {how} {outcome.finished} of {outcome.total} runs in {storage}{failed}; "
            "the same command goes on",
            file=sys.stderr,
        )
    return 130 if outcome.interrupted else 1 if incomplete else 0
