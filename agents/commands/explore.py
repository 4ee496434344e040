"""`python train.py explore`: the explorer on this machine alone."""

import contextlib
import logging
import os
import socket
import sys
import warnings
import webbrowser
from pathlib import Path
from typing import TYPE_CHECKING

from agents.commands.one_line_parser import OneLineParser, folder
from flapenv.aero.checks import require_count, require_name

if TYPE_CHECKING:
    from flask import Flask
    from werkzeug.serving import BaseWSGIServer

DEFAULT_PORT, HIGHEST_PORT = 8050, 65535
LOOPBACK = "127.0.0.1"
"""The only address that is listened on: nobody else's machine reaches it."""


def parser() -> OneLineParser:
    """The command line."""
    from flapenv import INSECTS

    made = OneLineParser(
        prog="train.py explore",
        description=(
            "Serve a page on this machine alone, on which one moves a stroke's parameters and sees weight support,\n"
            "power, the gap to the optimum, forces and the beating wing change at once. Ctrl-C ends it."
        ),
        epilog=(
            "examples:\n"
            "  python train.py explore                      the eight insects, or a wing that one types\n"
            "  python train.py explore --insect hawkmoth --port 9000\n"
            "  python train.py explore --wing docs/examples/robot.json    your own wing, within its limits\n"
        ),
    )
    made.add_argument(
        "--port", type=int, default=DEFAULT_PORT, metavar="N", help="0 takes a free one (default %(default)s)"
    )
    which = made.add_mutually_exclusive_group()
    which.add_argument("--insect", metavar="NAME", help=f"shown first; of {', '.join(INSECTS)}")
    which.add_argument("--wing", type=folder, metavar="FILE", help="a wing of one's own, shown first")
    made.add_argument("--no-browser", action="store_true", help="do not open a browser")
    return made


def explore_command(arguments: list[str]) -> int:
    """Serve until Ctrl-C; 0 then, 2 for bad input."""
    options = parser().parse_args(arguments)
    try:
        require_count("--port", options.port, low=0, high=HIGHEST_PORT)
        listening = listen(options.port)
    except (ValueError, TypeError, OSError) as mistake:
        print(f"train.py explore: {mistake}", file=sys.stderr)
        return 2
    with contextlib.closing(listening):
        try:
            server = served(options.insect, options.wing)
        except (ValueError, TypeError, OSError) as mistake:
            print(f"train.py explore: {mistake}", file=sys.stderr)
            return 2
        address = f"http://{LOOPBACK}:{listening.getsockname()[1]}/"
        print(f"flapenv explorer at {address}   (this machine alone; Ctrl-C ends it)", flush=True)
        if not options.no_browser:
            webbrowser.open(address)
        serve(server, listening)
    return 0


def listen(port: int) -> socket.socket:
    """A socket on the loopback, listening.

    Args:
        port: 0 for any that is free.

    Raises:
        OSError: for a port that is taken or not ours.
    """
    made = socket.socket(socket.AF_INET, socket.SOCK_STREAM)
    try:
        if os.name == "posix":  # where it only frees a port that nobody listens on any more
            made.setsockopt(socket.SOL_SOCKET, socket.SO_REUSEADDR, 1)
        made.bind((LOOPBACK, port))
        made.listen()
    except OSError as mistake:
        made.close()
        why = mistake.strerror or "it cannot be had"
        raise OSError(f"port {port} of {LOOPBACK} is not free: {why}; allowed: another --port, or 0 for any") from None
    return made


def served(insect: str | None, wing: Path | None) -> "Flask":
    """The app, showing what was asked for first.

    Args:
        insect: name of one of the eight, or None.
        wing: a file, or None.

    Raises:
        ImportError: where the extra "explore" is not installed.
        ValueError: for an unknown insect, or a file that does not hold a wing.
        OSError: for a file that cannot be read.
    """
    from agents.explorer.app import make_app
    from flapenv.files import read_wing
    from flapenv.insects import INSECTS

    if insect is not None:
        require_name("--insect", insect, INSECTS)
    extra = None if wing is None else read_wing(wing)
    server: Flask = make_app(extra, first=insect).server
    return server


def serve(server: "Flask", listening: socket.socket) -> None:
    """Answer requests until Ctrl-C."""
    logging.getLogger("werkzeug").setLevel(logging.ERROR)  # not a line for every request
    warnings.filterwarnings("ignore", category=UserWarning)  # the page says what is out of range
    with contextlib.suppress(KeyboardInterrupt):
        answering(server, listening).serve_forever()


def answering(server: "Flask", listening: socket.socket) -> "BaseWSGIServer":
    """What answers several requests at a time on a socket."""
    from werkzeug.serving import make_server

    return make_server(LOOPBACK, listening.getsockname()[1], server, threaded=True, fd=listening.fileno())
