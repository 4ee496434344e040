"""Train a policy that hovers with the least power, and compare it with the proven optimum and CFD.

With no argument: one policy for all eight insects, from random weights, on the CPU, in a few minutes.
`python train.py compare` lets optimisers search the same strokes with equal budgets; see `train.py compare --help`.
"""

import argparse
import sys
from dataclasses import replace
from pathlib import Path


def parser() -> argparse.ArgumentParser:
    """The command line."""
    from agents.presets import PPOPreset
    from flapenv import INSECTS, PROBLEMS

    preset = PPOPreset()
    made = argparse.ArgumentParser(
        prog="train.py",
        description=__doc__,
        formatter_class=argparse.RawDescriptionHelpFormatter,
        epilog=(
            "examples:\n"
            "  python train.py                              all eight insects, seed 0, into runs/hover-ppo-seed0/\n"
            "  python train.py --seed 1 --out runs/second   another seed, a folder of your own\n"
            "  python train.py --insects hawkmoth fruitfly --wingbeats 500000\n"
            "  python train.py compare --policy runs/second the same wings by optimisers, equal budgets\n\n"
            "a run folder holds config.json, results.json, policy.zip, curve.csv, TensorBoard logs and two pictures;\n"
            "Ctrl-C stops early, keeps what was learned and prints the comparison for it"
        ),
    )
    made.add_argument("--seed", type=int, default=0, metavar="N", help="of networks, noise and draws (default 0)")
    made.add_argument(
        "--out", type=Path, metavar="DIR", help="folder of the run, new or empty (default runs/hover-ppo-seedN/)"
    )
    made.add_argument(
        "--insects", nargs="+", default=list(INSECTS), metavar="NAME", help=f"of {', '.join(INSECTS)} (default all)"
    )
    made.add_argument(
        "--problem", default=next(iter(PROBLEMS)), metavar="NAME", help=f"of {', '.join(PROBLEMS)} (default the first)"
    )
    made.add_argument(
        "--wingbeats",
        type=int,
        default=preset.wingbeats,
        metavar="N",
        help=f"training budget (default {preset.wingbeats:,})",
    )
    made.add_argument("--quiet", action="store_true", help="no progress bar")
    return made


def compare_parser() -> argparse.ArgumentParser:
    """The command line of `compare`."""
    from agents.competitors import COMPETITORS
    from flapenv import INSECTS, PROBLEMS

    made = argparse.ArgumentParser(
        prog="train.py compare",
        description="Why not an optimiser? Let each search with the same budget of wingbeats on the same wings.",
        formatter_class=argparse.RawDescriptionHelpFormatter,
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
    made.add_argument("--policy", type=Path, action="append", default=[], metavar="DIR", help="run folder; repeatable")
    made.add_argument(
        "--out", type=Path, metavar="DIR", help="folder without a run in it (default runs/compare-PROBLEM/)"
    )
    made.add_argument("--quiet", action="store_true", help="no progress bar")
    return made


def compare(arguments: list[str]) -> int:
    """Run the competition; 0 on success, 2 for bad input."""
    options = compare_parser().parse_args(arguments)
    from agents.competition import CompetitionConfig, compete, competition_table, save, wing_table
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
        folder = open_run_folder(options.out, f"compare-{config.problem.name}")
        result = compete(config, progress=not options.quiet)
        print(f"{competition_table(result)}\n\n{wing_table(result)}", flush=True)
        save(result, folder)
        print(f"kept in {folder}")
    except (ValueError, TypeError, OSError, ArithmeticError) as mistake:
        print(f"train.py compare: {mistake}", file=sys.stderr)
        return 2
    return 0


def main(arguments: list[str] | None = None) -> int:
    """Train as the command line says; 0 on success, 2 for bad input, 130 after Ctrl-C."""
    arguments = sys.argv[1:] if arguments is None else arguments
    try:
        return compare(arguments[1:]) if arguments[:1] == ["compare"] else run(arguments)
    except KeyboardInterrupt:
        print("train.py: stopped outside of training; files already written are kept", file=sys.stderr)
        return 130


def run(arguments: list[str]) -> int:
    """`main` without the guard against Ctrl-C."""
    options = parser().parse_args(arguments)
    try:
        from agents.presets import PPOPreset
        from agents.training import TrainingConfig, draw_pictures, summary, train
    except ImportError as missing:
        print(f"train.py: {missing}; install the learners: pip install -e '.[train]'", file=sys.stderr)
        return 2
    try:
        config = TrainingConfig(
            insects=options.insects,
            problem=options.problem,
            preset=replace(PPOPreset(), wingbeats=options.wingbeats),
            seed=options.seed,
        )
        result = train(config, options.out, progress=not options.quiet)
    except (ValueError, TypeError, OSError, ArithmeticError) as mistake:
        print(f"train.py: {mistake}", file=sys.stderr)
        return 2
    print(summary(result), flush=True)
    draw_pictures(config, result)
    return 130 if result.interrupted else 0


if __name__ == "__main__":
    sys.exit(main())
