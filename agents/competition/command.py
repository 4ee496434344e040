"""`python train.py compare`: optimisers and policies on the same wings with equal budgets."""

import argparse
import sys
from pathlib import Path

from agents.commands.one_line_parser import OneLineParser


def parser() -> argparse.ArgumentParser:
    """The command line of `compare`."""
    from agents.competition.competitors import COMPETITORS
    from flapenv import INSECTS, PROBLEMS

    made = OneLineParser(
        prog="train.py compare",
        description="Why not an optimiser? Let each search with the same budget of wingbeats on the same wings.",
        epilog=(
            "examples:\n"
            "  python train.py compare                                  eight insects, five seeds, 10,000 wingbeats\n"
            "  python train.py compare --problem fixed-frequency --wings 20\n"
            "  python train.py compare --policy runs/hover-ppo-seed0     a trained policy in the same table\n\n"
            "one evaluation of one stroke on one wing is one wingbeat, with its gradient three; writes results.json,\n"
            "table.txt and competition.png"
        ),
    )
    made.add_argument("--problem", default=next(iter(PROBLEMS)), metavar="NAME", help=f"of {', '.join(PROBLEMS)}")
    made.add_argument("--insects", nargs="*", default=list(INSECTS), metavar="NAME", help="default: all eight")
    made.add_argument("--wings", type=int, default=0, metavar="N", help="random wings beside them (default 0)")
    made.add_argument(
        "--competitors", nargs="+", default=list(COMPETITORS), metavar="NAME", help=f"of {', '.join(COMPETITORS)}"
    )
    made.add_argument("--wingbeats", type=int, default=10_000, metavar="N", help="budget of a search (default 10,000)")
    made.add_argument("--seeds", type=int, default=5, metavar="N", help="searches of each kind a wing (default 5)")
    made.add_argument(
        "--policy", type=Path, action="append", default=[], metavar="DIR", help="shipped or run folder; repeatable"
    )
    made.add_argument(
        "--out", type=Path, metavar="DIR", help="folder without a run in it (default runs/compare-PROBLEM/)"
    )
    made.add_argument("--quiet", action="store_true", help="no progress bar")
    return made


def compare_command(arguments: list[str]) -> int:
    """Run the competition; 0 on success, 2 for bad input, 130 after Ctrl-C."""
    options = parser().parse_args(arguments)
    from agents.competition.compete import CompetitionConfig, compete, prepare
    from agents.competition.keep import save
    from agents.competition.table import competition_table, wing_table
    from agents.run_folder import open_run_folder

    try:
        config = CompetitionConfig(
            problem=options.problem,
            insects=options.insects,
            wings=options.wings,
            competitors=options.competitors,
            wingbeats=options.wingbeats,
            seeds=options.seeds,
            policies=options.policy,
        )
        prepared = prepare(config)  # what is wrong is found before a folder is made
        folder = open_run_folder(options.out, f"compare-{config.problem.name}")
        result = compete(prepared, progress=not options.quiet)
        print(f"{competition_table(result)}\n\n{wing_table(result)}", flush=True)
        save(result, folder)
        print(f"kept in {folder}")
    except (ValueError, TypeError, OSError, ArithmeticError) as mistake:
        print(f"train.py compare: {mistake}", file=sys.stderr)
        return 2
    return 130 if result.interrupted else 0
