"""`python -m flapenv.adapt`: tune the references, print their table, and write the data files of the package."""

import argparse
from pathlib import Path

from flapenv.adapt.drawing import references_figure
from flapenv.adapt.report import report
from flapenv.adapt.rungs import write_rungs
from flapenv.adapt.tuning import write_references
from flapenv.insects import INSECTS


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
    parser.add_argument(
        "--picture",
        type=Path,
        metavar="FILE",
        help="draw the references over an episode into a PNG (needs matplotlib)",
    )
    arguments = parser.parse_args()
    if arguments.rungs and arguments.out is None:
        parser.error("--rungs needs --out FOLDER")
    if arguments.out is not None:
        if arguments.rungs:
            print(f"wrote {write_rungs(arguments.out)}")
        print(f"wrote {write_references(arguments.out)}")
        return
    if arguments.picture is not None:
        references_figure(INSECTS[0]).savefig(arguments.picture)
        print(f"wrote {arguments.picture}")
        return
    print(report())


if __name__ == "__main__":
    main()
