"""`python -m flapenv.validation`: print Tables 2 and 3 beside ours, and write and draw everything with --out."""

import argparse
from pathlib import Path

from flapenv.validation.report import report, write_report


def main() -> None:
    """Print the report; write it with its figures where a folder is given."""
    parser = argparse.ArgumentParser(
        prog="python -m flapenv.validation",
        description="Reproduce Nabawy & Crowther (2014, Part II): print Tables 2 and 3 beside the paper's numbers and "
        "CFD's with their errors, the other coefficient models, and how far everything is converged.",
        epilog="example: python -m flapenv.validation --out runs/validation",
    )
    parser.add_argument(
        "--out",
        type=Path,
        metavar="FOLDER",
        help="also write validation.md there, and draw Figs 2, 4, 5, 6 and the convergence to its images/ "
        "(needs matplotlib: the extra 'report'); --out docs refreshes the documentation",
    )
    folder = parser.parse_args().out
    print(report())
    if folder is not None:
        for path in write_report(folder):
            print(f"wrote {path}")


if __name__ == "__main__":
    main()
