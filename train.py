"""Train a policy that hovers with the least power, and compare it with the proven optimum and CFD.

With no argument: one policy for all eight insects, from random weights, on the CPU, in a few minutes.
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
            "  python train.py --insects hawkmoth fruitfly --wingbeats 500000\n\n"
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


def main(arguments: list[str] | None = None) -> int:
    """Train as the command line says; 0 on success, 2 for bad input, 130 after Ctrl-C."""
    try:
        return run(arguments)
    except KeyboardInterrupt:
        print("train.py: stopped outside of training; files already written are kept", file=sys.stderr)
        return 130


def run(arguments: list[str] | None) -> int:
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
