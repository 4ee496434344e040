"""`python -m flapenv.waveform`: print what free waveforms reach; draw it, or search again, where asked."""

import argparse
from pathlib import Path

from flapenv.waveform.report import report, write_pictures
from flapenv.waveform.search_all import write_table


def main() -> None:
    """Print the tables; draw the pictures and search anew where asked."""
    parser = argparse.ArgumentParser(
        prog="python -m flapenv.waveform",
        description="Print the best free waveforms of 4, 8, 16 and 32 knots a half-stroke beside the proven bounds.",
        epilog="example: python -m flapenv.waveform --out docs/images",
    )
    parser.add_argument("--out", type=Path, metavar="FOLDER", help="also draw the waveforms there (needs matplotlib)")
    parser.add_argument(
        "--data",
        type=Path,
        metavar="FILE",
        help="first search all of them again and write them to this CSV (needs torch)",
    )
    arguments = parser.parse_args()
    if arguments.data is not None:
        write_table(arguments.data)
        print(f"wrote {arguments.data}")
    print(report())
    if arguments.out is not None:
        for path in write_pictures(arguments.out):
            print(f"wrote {path}")


if __name__ == "__main__":
    main()
