"""A command line whose mistakes are told in one line."""

import argparse
from pathlib import Path
from typing import Any, NoReturn

from flapenv.aero.checks import one_line


class OneLineParser(argparse.ArgumentParser):
    """`ArgumentParser` without the usage before an error, without abbreviations, its texts kept as they are written."""

    def __init__(self, **arguments: Any) -> None:
        """Arguments as `ArgumentParser`'s."""
        super().__init__(formatter_class=argparse.RawDescriptionHelpFormatter, allow_abbrev=False, **arguments)

    def error(self, message: str) -> NoReturn:
        """Print the mistake and end with code 2."""
        self.exit(2, f"{self.prog}: {one_line(message)}; see --help\n")


def said(mistake: Exception) -> str:
    """A mistake in one line."""
    return one_line(mistake) or ("not enough memory" if isinstance(mistake, MemoryError) else type(mistake).__name__)


def folder(text: str) -> Path:
    """A path that is not empty, as an unset variable of a shell would be.

    Raises:
        ArgumentTypeError: for nothing.
    """
    if not text:
        raise argparse.ArgumentTypeError("an empty path is not allowed")
    return Path(text)
