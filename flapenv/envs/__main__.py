"""`python -m flapenv.envs`: the pages of all environments."""

import argparse
from pathlib import Path

from flapenv.envs.pages import page, write_pages
from flapenv.envs.registration import ENV_IDS


def main() -> None:
    """Print or write the pages."""
    parser = argparse.ArgumentParser(
        prog="python -m flapenv.envs", description="The pages of the environments, made from their docstrings."
    )
    parser.add_argument("id", nargs="?", choices=ENV_IDS, help="print this page")
    parser.add_argument("--out", type=Path, metavar="FOLDER", help="write all pages, such as docs/environments")
    given = parser.parse_args()
    if given.out is not None:
        for path in write_pages(given.out):
            print(path)
    else:
        print("\n".join(page(name) for name in ([given.id] if given.id else ENV_IDS)))


if __name__ == "__main__":
    main()
