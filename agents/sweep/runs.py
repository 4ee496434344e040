"""One run of a sweep: what it trains, the folder that it is kept in, and whether it is finished."""

import json
import shlex
from collections.abc import Mapping
from pathlib import Path
from typing import Any

from agents import resuming
from agents.benchmark.training_run import differences
from agents.presets import Preset
from agents.run_folder import CONFIG, RESULTS
from agents.training_config import TrainingConfig
from flapenv.aero.checks import one_line, record, require_count, require_scalar, shown
from flapenv.read_json import read_object


@record
class SweepRun:
    """One run.

    Attributes:
        name: of its folder.
        group: the line of the table that it belongs to.
        config: what is trained.
    """

    name: str
    group: str
    config: TrainingConfig

    def described(self) -> dict[str, Any]:
        """What config.json must say of it.

        Raises:
            TypeError: for an argument of the task of another kind.
            ValueError: for one that is not allowed.
        """
        return dict(json.loads(json.dumps(self.config.to_dict())))  # tuples become lists, as in the file


@record
class RunResult:
    """What a finished run's results.json says.

    Attributes:
        run: the run.
        mean: distance of the last policy to the task's reference [-]; None where there is none.
        worst: the same where it is largest [-].
        wingbeats: trained on.
        seconds: of training, by the clock.
        distance: what `mean` and `worst` are, in words.
    """

    run: SweepRun
    mean: float | None
    worst: float | None
    wingbeats: int
    seconds: float
    distance: str


def typed(preset: str, seed: int, arguments: Mapping[str, Any], settings: Mapping[str, Any]) -> str:
    """The command that trains the same, alone.

    Args:
        preset: its name.
        seed: of the run.
        arguments: of the task: a problem, insects.
        settings: of the learner, in place of the preset's.
    """
    words = ["python", "train.py", "--preset", preset, "--seed", str(seed)]
    for name, value in arguments.items():
        words += [f"--{name}", *([value] if isinstance(value, str) else value)]
    for name, value in settings.items():
        if name == "wingbeats":
            words += ["--wingbeats", str(value)]
        else:
            words += ["--set", f"{name}={value if isinstance(value, str) else json.dumps(value)}"]
    return shlex.join(words)


def run_of(
    name: str,
    group: str,
    preset: str,
    seed: int,
    arguments: Mapping[str, Any],
    settings: Mapping[str, Any],
    base: Preset,
) -> SweepRun:
    """A run of a registered preset with other arguments and settings.

    Args:
        name: of its folder.
        group: its line in the table.
        preset: name of the preset.
        seed: of the run.
        arguments: of the task, in place of the preset's.
        settings: of the learner, in place of the preset's.
        base: the preset with both.
    """
    command = typed(preset, seed, arguments, settings)
    return SweepRun(name=name, group=group, config=TrainingConfig(preset=base, seed=seed, name=preset, command=command))


def is_finished(run: SweepRun, storage: Path) -> bool:
    """Whether a run is there, whole; one that is under way or was cut short is not.

    Raises:
        ValueError: if the folder holds a run with other settings, or a file is not as a run writes it.
        OSError: if a file cannot be read, or the folder is a file or something else's.
    """
    folder = storage / run.name
    if not folder.is_dir():
        if folder.exists() or folder.is_symlink():
            raise NotADirectoryError(f"{folder} is no folder; allowed: a run's folder, or nothing of that name")
        return False
    if not (folder / CONFIG).is_file():
        others = sorted(one.name for one in folder.iterdir() if not one.name.startswith("."))
        if others:
            raise FileExistsError(
                f"{folder} holds {shown(others[0])} but no {CONFIG}; allowed: a run's folder, or an empty one"
            )
        return False
    differs = differences(run.described(), read_object(folder / CONFIG))
    if differs:
        raise ValueError(
            f"{folder} was made with other settings: {'; '.join(differs)}; allowed: the same, or another folder"
        )
    return resuming.is_finished(folder)


def found_result(run: SweepRun, storage: Path) -> RunResult | None:
    """What a run reached, or None if it is not finished.

    Raises:
        ValueError: if the folder holds a run with other settings, or a file is not as a run writes it.
        OSError: if a file cannot be read, or the folder is a file or something else's.
    """
    return result_of(run, storage) if is_finished(run, storage) else None


def result_of(run: SweepRun, storage: Path) -> RunResult:
    """What a finished run reached.

    Raises:
        ValueError: if results.json is not as a run writes it.
        OSError: if it cannot be read.
    """
    path = storage / run.name / RESULTS
    found = read_object(path)
    try:
        verdict = found["verdict"]
        mean, worst = (None if verdict[key] is None else require_scalar(key, verdict[key]) for key in ("mean", "worst"))
        return RunResult(
            run=run,
            mean=mean,
            worst=worst,
            wingbeats=require_count("wingbeats", found["wingbeats"], low=0),
            seconds=require_scalar("seconds", found["seconds"], low=0.0),
            distance=str(verdict["distance"]),
        )
    except (KeyError, TypeError, ValueError, OverflowError) as mistake:
        raise ValueError(
            f"{path} is not a run's: {type(mistake).__name__} {one_line(mistake, 300)}; "
            "allowed: the file as it was written"
        ) from None
