"""Train policies that hover with the least power, judge them, and compare them with optimisers: see --help."""

import sys
import warnings
from importlib import import_module

from agents.file_rights import keep_others_from_writing
from flapenv.aero.checks import allowed, shown

COMMANDS = {
    "benchmark": "agents.benchmark.command",
    "compare": "agents.competition.command",
    "evaluate": "agents.commands.evaluate",
    "explore": "agents.commands.explore",
    "optimum": "agents.commands.optimum",
    "sweep": "agents.sweep.command",
}
"""Where each command NAME is, as NAME_command; without one of them a policy is trained."""


def main(arguments: list[str] | None = None) -> int:
    """Run the command asked for; 0 on success, 2 for bad input, 130 after Ctrl-C."""
    arguments = sys.argv[1:] if arguments is None else arguments
    keep_others_from_writing()
    name, rest = ("train", arguments)
    if arguments and not arguments[0].startswith("-"):
        name, *rest = arguments
        if name not in COMMANDS:
            print(f"train.py: command {shown(name)} is unknown; {allowed(name, COMMANDS)}", file=sys.stderr)
            return 2
    try:
        with warnings.catch_warnings():
            warnings.showwarning = lambda message, *_: print(f"train.py: {message}", file=sys.stderr)
            command = getattr(import_module(COMMANDS.get(name, "agents.commands.train")), f"{name}_command")
            return int(command(rest))
    except ImportError as missing:
        extra = name if name in ("explore", "sweep") else "train"
        print(f"train.py: {missing}; install what {name} needs: pip install -e '.[{extra}]'", file=sys.stderr)
        return 2
    except KeyboardInterrupt:
        print("train.py: stopped outside of training; files already written are kept", file=sys.stderr)
        return 130


if __name__ == "__main__":
    sys.exit(main())
