"""Training runs, a process each, a few at a time; what is finished is never redone.

A run is made in `NAME.part` and renamed when it has ended well, so that it is there whole or not at all. One that has
not ended well goes on there the next time, from its checkpoint.
"""

import signal
import sys
from collections.abc import Callable, Mapping, Sequence
from pathlib import Path

from tqdm import tqdm

from agents.benchmark.machine import note_machine
from agents.benchmark.subprocesses import ERRORS, Command, run_all
from agents.benchmark.training_run import COMMAND, Run, clear, cut_short, goes_on, is_there, run_command
from agents.folder_lock import locked
from agents.run_folder import RESULTS
from flapenv.aero.checks import record
from flapenv.whole_file import write_json

CommandOf = Callable[[Run, Path], Sequence[str]]
"""The command line of a run into a folder; where `goes_on` holds of that, one that goes on with the run there."""


@record
class Outcome:
    """How it ended.

    Attributes:
        finished: runs that are there, those of earlier times too.
        failed: name of each failed run and why.
        interrupted: whether it was stopped before all runs had ended.
    """

    finished: Sequence[Run]
    failed: Mapping[str, str]
    interrupted: bool


def train_all(
    runs: Sequence[Run], root: Path, jobs: int, *, command: CommandOf = run_command, progress: bool = True
) -> Outcome:
    """Run what is not there yet. Ctrl-C ends the runs under way and keeps the finished ones.

    Runs that were under way when an earlier call ended, or was killed, or that failed, go on from their checkpoints.

    Args:
        runs: each with a name of its own.
        root: folder of the run folders; made where it is missing.
        jobs: runs beside each other, one thread each.
        command: the command line of a run into a folder.
        progress: whether to show a progress bar.

    Raises:
        BlockingIOError: if others run into the same folder.
        ValueError: if a run there was made with other settings, or is another's and was cut short.
        FileExistsError: if a folder is in the way that is not our own.
        OSError: if the folder cannot be written, or a process not started.
    """
    root.mkdir(parents=True, exist_ok=True)
    with locked(root) as lock:
        there = {run.name for run in runs if is_there(run, root)}
        for run in runs:
            part = root / f"{run.name}.part"
            if run.name in there or not goes_on(part, run):
                clear(part)
        todo = {run.name: run for run in runs if run.name not in there}
        failed: dict[str, str] = {}
        if todo:
            note_machine(root, jobs)
        with tqdm(total=len(runs), initial=len(there), disable=not progress, unit="run", file=sys.stderr) as bar:

            def ended(over: Command, code: int) -> None:
                bar.update()
                why = _failure(over.folder, code, todo[over.name]) or _put_in_place(over.folder, root / over.name)
                if why is None:
                    there.add(over.name)
                else:
                    failed[over.name] = why
                    bar.write(f"{over.name} failed: {why}", file=sys.stderr)

            completed = run_all(
                (_prepared(run, root, command) for run in todo.values()),
                jobs,
                changed=lambda names: bar.set_postfix_str(", ".join(names)),
                ended=ended,
                inherited=lock,
            )
    return Outcome(
        finished=[run for run in runs if run.name in there],
        failed={run.name: failed[run.name] for run in runs if run.name in failed},
        interrupted=not completed,
    )


def _prepared(run: Run, root: Path, command: CommandOf) -> Command:
    """The run's command, with a folder to run into that is marked as our own: a new one, or one in which it goes on."""
    part, folder = root / f"{run.name}.part", root / run.name
    if not part.exists() and goes_on(folder, run):
        folder.rename(part)
    arguments = list(command(run, part))
    if not part.exists():
        part.mkdir()
        write_json(part / COMMAND, {"command": arguments})
    return Command(name=run.name, arguments=arguments, folder=part)


def _failure(part: Path, code: int, run: Run) -> str | None:
    """Why a run that ended with this exit code failed, and what comes of it; None if it did not fail."""
    why = _reason(part, code, run)
    if why is None or not goes_on(part, run):
        return why
    return f"{why}; the same command goes on with it, or begins it anew once {part} is removed"


def _reason(part: Path, code: int, run: Run) -> str | None:
    """Why a run that ended with this exit code failed; None if it did not."""
    if code == 0:
        if not (part / RESULTS).is_file():
            return f"it ended without {RESULTS}; see {part}"
        try:
            short = cut_short(part / RESULTS, run.described()["settings"]["wingbeats"])
        except ValueError as mistake:
            return str(mistake)
        return None if short is None else f"it {short}; see {part}"
    how = f"exit code {code}" if code > 0 else f"killed by {signal.Signals(-code).name}"
    said = (part / ERRORS).read_text(encoding="utf-8", errors="replace").strip().splitlines()
    return f"{said[-1].strip() if said else 'it said nothing'} ({how}; see {part / ERRORS})"


def _put_in_place(part: Path, folder: Path) -> str | None:
    """Give a run its name, in place of one of our own that was cut short; why not, if that cannot be."""
    try:
        clear(folder)
        part.rename(folder)
    except OSError as mistake:
        return f"it cannot be put in place: {mistake}"
    return None
