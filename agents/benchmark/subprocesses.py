"""Commands in processes of their own, a few at a time; Ctrl-C ends them all and leaves none behind."""

import contextlib
import os
import signal
import subprocess
import time
from collections.abc import Callable, Iterable, Iterator, Sequence
from pathlib import Path
from types import FrameType

from flapenv.aero.checks import record

PRINTED, ERRORS = "printed.txt", "errors.txt"
"""Where a command's output and its errors go."""
ONE_THREAD = dict.fromkeys(("OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS", "MKL_NUM_THREADS"), "1")
STOPPING = tuple(getattr(signal, name) for name in ("SIGINT", "SIGTERM", "SIGHUP") if hasattr(signal, name))
PATIENCE = 10.0
"""Seconds that a command has to end before it is killed."""
GLANCE = 0.05
"""Seconds between two looks at the processes."""


@record
class Command:
    """What to run.

    Attributes:
        name: for people.
        arguments: program and arguments.
        folder: there already; gets the files `PRINTED` and `ERRORS`.
    """

    name: str
    arguments: Sequence[str]
    folder: Path


def run_all(
    commands: Iterable[Command],
    at_once: int,
    *,
    changed: Callable[[Sequence[str]], None],
    ended: Callable[[Command, int], None],
    inherited: int,
) -> bool:
    """Run the commands in their order, each on one thread, and wait for them.

    Args:
        commands: what to run; the next is asked for when there is room for it.
        at_once: how many beside each other.
        changed: told the names of what is running when that has changed.
        ended: told each command that has ended by itself, with its exit code (minus the signal that killed it).
        inherited: file descriptor that every process holds open, such as that of a lock.

    Returns:
        True if all have ended by themselves; False if a signal of `STOPPING` came first. Those running were ended
        then, and the rest not begun.
    """
    waiting = iter(commands)
    running: list[tuple[Command, subprocess.Popen[bytes]]] = []
    with counted_signals() as signals:
        try:
            while True:
                over = [one for one in running if one[1].poll() is not None]
                for command, process in over:
                    running.remove((command, process))
                    ended(command, process.returncode)
                if signals:
                    return False
                kept = len(running)
                while len(running) < at_once and (following := next(waiting, None)) is not None:
                    running.append((following, _start(following, inherited)))
                if not running:
                    return True
                if over or len(running) > kept:
                    changed([command.name for command, _ in running])
                time.sleep(GLANCE)
        finally:
            _stop([process for _, process in running], signals)


def _start(command: Command, inherited: int) -> subprocess.Popen[bytes]:
    """Start a command in a session of its own, so that the terminal's Ctrl-C reaches us alone."""
    with (command.folder / PRINTED).open("wb") as printed, (command.folder / ERRORS).open("wb") as errors:
        return subprocess.Popen(
            list(command.arguments),
            stdin=subprocess.DEVNULL,
            stdout=printed,
            stderr=errors,
            env={**os.environ, **ONE_THREAD},
            start_new_session=True,
            pass_fds=(inherited,),
        )


def _stop(processes: Sequence[subprocess.Popen[bytes]], signals: list[int]) -> None:
    """End processes: politely, then, after some seconds or a second Ctrl-C, by force."""
    for process in processes:
        process.terminate()
    deadline = time.monotonic() + PATIENCE
    while any(process.poll() is None for process in processes):
        if time.monotonic() > deadline or len(signals) > 1:
            for process in processes:
                process.kill()
        time.sleep(GLANCE)


@contextlib.contextmanager
def counted_signals() -> Iterator[list[int]]:
    """Write signals of `STOPPING` down rather than raise; yields those seen so far.

    So none falls between the start of a process and its being known.
    """
    seen: list[int] = []

    def note(number: int, _: FrameType | None) -> None:
        seen.append(number)

    before = {one: signal.getsignal(one) for one in STOPPING}
    heeded = {one: handler for one, handler in before.items() if handler is not signal.SIG_IGN}  # nohup stays nohup
    for one in heeded:
        signal.signal(one, note)
    try:
        yield seen
    finally:
        for one, handler in heeded.items():
            signal.signal(one, handler)
