"""`python -m flapenv.adapt`: tune the references, print their table, and write the data files of the package."""

import argparse
from pathlib import Path

from flapenv.adapt.report import blind_text, references_table
from flapenv.adapt.rungs import write_rungs
from flapenv.adapt.tuning import write_references


def main() -> None:
    """Print the shipped references; tune and write them anew where asked to."""
    parser = argparse.ArgumentParser(
        prog="python -m flapenv.adapt",
        description="The references of flapenv/HoverAdapt-v0: mean returns of the optimum with full knowledge, of the "
        "two controllers and of the best fixed stroke on held-out hidden draws, for every insect.",
        epilog="example: python -m flapenv.adapt --out flapenv/data --rungs",
    )
    parser.add_argument(
        "--out", type=Path, metavar="FOLDER", help="tune all references (about a minute) and write their file there"
    )
    parser.add_argument(
        "--rungs", action="store_true", help="with --out, first solve the lift ladder too (about ten seconds)"
    )
    arguments = parser.parse_args()
    if arguments.rungs and arguments.out is None:
        parser.error("--rungs needs --out FOLDER")
    if arguments.out is not None:
        if arguments.rungs:
            print(f"wrote {write_rungs(arguments.out)}")
        print(f"wrote {write_references(arguments.out)}")
        return
    print(references_table())
    print()
    print(blind_text())


if __name__ == "__main__":
    main()
