"""Runs that go on: whether a folder's run is finished, and whether it is the one that is asked for."""

import json
import sys
from pathlib import Path
from typing import Any

from agents.checkpoint import STATE
from agents.policy_file import load_policy
from agents.run_folder import CHECKPOINT, CONFIG, RECIPE, REPORT, RESULTS, versions
from agents.tasks import Task
from agents.training_config import TrainingConfig, TrainingResult
from flapenv.aero.checks import shown
from flapenv.read_json import read_object
from flapenv.whole_file import write_json

TOLD = ("command", "versions")
"""Keys of config.json that say how a run came about, not what it is."""


def keep_config(folder: Path, config: TrainingConfig) -> None:
    """Write config.json, or find it there and equal.

    Other versions of what a run depends on are told and no reason to refuse it.

    Raises:
        ValueError: if the folder's run has another config.
        OSError: if it cannot be read or written.
    """
    path, described = folder / CONFIG, config.to_dict()
    if not path.exists():
        write_json(path, {**described, "command": config.command, "versions": versions()})
        return
    found = read_object(path)
    own = json.loads(json.dumps(described))  # tuples become lists, as in the file
    for key in sorted({*own, *found} - set(TOLD)):
        if key not in found and key not in RECIPE:  # an older file, or one made by hand, may not tell it
            continue
        if own.get(key) != found.get(key):
            raise ValueError(
                f"{path} has {key} = {shown(found.get(key))}; allowed: {shown(own.get(key))}, as the run that goes on"
            )
    before, now = found.get("versions"), versions()
    if before is not None and before != now:
        told = before if isinstance(before, dict) else {}
        others = ", ".join(f"{name} {told.get(name)}, now {now[name]}" for name in now if told.get(name) != now[name])
        print(f"{folder} was begun with {others}: it goes on, perhaps to another end", file=sys.stderr)


def require_nothing_lost(folder: Path) -> None:
    """Refuse to begin anew, for want of a checkpoint, over the policy that Ctrl-C kept.

    Raises:
        FileExistsError: if there is such a policy and no checkpoint.
        ValueError: if its results.json is not JSON.
        OSError: if that cannot be read.
    """
    if (folder / CHECKPOINT / STATE).exists() or not (folder / RESULTS).exists():
        return
    kept = read_object(folder / RESULTS).get("wingbeats")
    if kept:
        raise FileExistsError(
            f"{folder} holds the policy of {shown(kept)} wingbeats and no checkpoint to go on from; allowed: a run "
            f"with one, or without {RESULTS} in it, to begin again"
        )


def is_finished(folder: Path) -> bool:
    """Whether a run has come to its end and everything of it is written.

    Raises:
        ValueError: if its results.json is not JSON.
        OSError: if it cannot be read.
    """
    if (folder / CHECKPOINT / STATE).exists() or not (folder / RESULTS).exists():
        return False
    return read_object(folder / RESULTS).get("interrupted") is False


def finished_result(folder: Path, task: Task) -> TrainingResult:
    """What a finished run ended with, its verdict made again.

    Raises:
        ValueError: if its files are not as a run writes them.
        OSError: if they cannot be read.
    """
    results = read_object(folder / RESULTS)
    numbers: dict[str, Any] = {name: results.get(name) for name in ("wingbeats", "seconds")}
    if type(numbers["wingbeats"]) is not int or type(numbers["seconds"]) not in (int, float):
        raise ValueError(f"{folder / RESULTS}: {shown(numbers)} is not a run's; allowed: numbers, as it was written")
    actor, _ = load_policy(folder)
    report = folder / REPORT
    return TrainingResult(
        out=folder, verdict=task.judge(actor), interrupted=False, report=report if report.exists() else None, **numbers
    )
