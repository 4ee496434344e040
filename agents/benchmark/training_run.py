"""One training run in a folder of its own: its command line, whether it is there, and whether it can go on."""

import json
import shutil
import sys
import textwrap
from collections.abc import Mapping
from dataclasses import field
from pathlib import Path
from typing import TYPE_CHECKING, Any

from agents.run_folder import CONFIG, RESULTS
from flapenv.aero.checks import record
from flapenv.read_json import read_object
from flapenv.whole_file import PARTIAL

if TYPE_CHECKING:
    from agents.presets import Preset

COMMAND = "command.json"
"""The command of a run, which marks its folder as made by `run_queue`: such a folder may be removed."""
TRAIN = Path(__file__).parents[2] / "train.py"
QUIETLY = ("--quiet", "--no-report")


def registered() -> "Mapping[str, Preset]":
    """The named presets, imported when first needed: help and reports do without them."""
    from agents import presets

    return presets.PRESETS


@record
class Run:
    """One training run.

    Attributes:
        preset: its name.
        seed: its seed.
        wingbeats: its budget; None for the preset's own.
        arguments: of the task in place of the preset's, each by its name and as one word of train.py's command line.
        name: of its folder; PRESET-seedN if empty.
    """

    preset: str
    seed: int
    wingbeats: int | None = None
    arguments: Mapping[str, str] = field(default_factory=dict)
    name: str = ""

    def __post_init__(self) -> None:
        """Name the folder."""
        object.__setattr__(self, "name", self.name or f"{self.preset}-seed{self.seed}")

    def described(self) -> dict[str, Any]:
        """What config.json must say of it.

        Raises:
            TypeError: for an argument that the task has not.
            ValueError: for a budget or an argument that is not allowed.
        """
        budget = {} if self.wingbeats is None else {"wingbeats": self.wingbeats}
        preset = registered()[self.preset].changed(self.arguments, budget)
        described: dict[str, Any] = {"preset": self.preset, "seed": self.seed, **preset.to_dict()}
        return dict(json.loads(json.dumps(described)))  # tuples become lists, as in the file


def run_command(run: Run, out: Path) -> list[str]:
    """The command line of a run into the folder `out`, which goes on with the run that may lie there."""
    if goes_on(out, run):
        return [sys.executable, str(TRAIN), "--resume", str(out), *QUIETLY]
    words = [sys.executable, str(TRAIN), "--preset", run.preset, "--seed", str(run.seed)]
    for name, value in run.arguments.items():
        words += [f"--{name.replace('_', '-')}", value]
    if run.wingbeats is not None:
        words += ["--wingbeats", str(run.wingbeats)]
    return [*words, "--out", str(out), *QUIETLY]


def is_there(run: Run, root: Path) -> bool:
    """Whether a run has been finished, with the same settings; one of our own that was cut short is not.

    Raises:
        FileExistsError: if a folder is in the way that holds no run.
        ValueError: if the run there was made with other settings, or was cut short and is not our own, or its files
            are not as a run writes them.
        OSError: if a file cannot be read.
    """
    folder = root / run.name
    if not folder.exists():
        return False
    missing = [name for name in (CONFIG, RESULTS) if not (folder / name).is_file()]
    if missing:
        raise FileExistsError(f"{folder} is in the way: it holds no {' and no '.join(missing)}; allowed: finished runs")
    described = run.described()
    differs = differences(described, read_object(folder / CONFIG))
    if differs:
        raise ValueError(
            f"{folder} was made with other settings: {'; '.join(differs)}; allowed: the same, or another folder"
        )
    short = cut_short(folder / RESULTS, described["settings"]["wingbeats"])
    if short is None or (folder / COMMAND).is_file():
        return short is None
    raise ValueError(f"{folder} is in the way: its run {short}; allowed: finished runs, or move it")


def goes_on(folder: Path, run: Run) -> bool:
    """Whether a folder of our own holds this run, begun, so that it goes on from its checkpoint or gets its name.

    Not where its settings are others now, where a file is not as a run writes it, nor where its results say that it
    came to its end before its budget's: nothing would be trained any more.

    Raises:
        OSError: if a file cannot be read.
    """
    if not all((folder / name).is_file() for name in (COMMAND, CONFIG)):
        return False
    described, results = run.described(), folder / RESULTS
    try:
        if differences(described, read_object(folder / CONFIG)):
            return False
        if not results.is_file() or read_object(results).get("interrupted") is True:
            return True
        return cut_short(results, described["settings"]["wingbeats"]) is None
    except ValueError:
        return False


def cut_short(results: Path, budget: int) -> str | None:
    """How a run ended early, in words; None if it did not.

    Args:
        results: its results.json.
        budget: wingbeats that it was to train on.

    Raises:
        ValueError: if the file is not as a run writes it.
        OSError: if it cannot be read.
    """
    found = read_object(results)
    wingbeats = found.get("wingbeats")
    if isinstance(wingbeats, bool) or not isinstance(wingbeats, int):
        raise ValueError(f"{results} is not a run's: wingbeats = {wingbeats!r}; allowed: a whole number")
    if found.get("interrupted", False) is not False:
        return f"was interrupted after {wingbeats:,} wingbeats"
    return f"ended after {wingbeats:,} of {budget:,} wingbeats" if wingbeats < budget else None


def clear(folder: Path) -> None:
    """Remove what a run of our own left; killed meanwhile, it leaves what is still our own and does not go on.

    Raises:
        FileExistsError: for a folder that is not our own, unless it is empty.
        OSError: if it cannot be removed.
    """
    if not folder.exists():
        return
    content = list(folder.iterdir())
    if not (folder / COMMAND).is_file() and any(not one.name.startswith(PARTIAL) for one in content):
        raise FileExistsError(
            f"{folder} is in the way: it holds no {COMMAND}, so we did not make it; allowed: another folder, or move it"
        )
    (folder / CONFIG).unlink(missing_ok=True)
    for one in content:
        if one.is_dir() and not one.is_symlink():
            shutil.rmtree(one)
        elif one.name != COMMAND:
            one.unlink(missing_ok=True)
    shutil.rmtree(folder)


def differences(wanted: Mapping[str, Any], found: Mapping[str, Any], within: str = "") -> list[str]:
    """What `found` says otherwise than `wanted`, in words; what it says beside that does not count."""
    said: list[str] = []
    for key, value in wanted.items():
        name = f"{within}{key}"
        if isinstance(value, Mapping) and isinstance(found.get(key), Mapping):
            said += differences(value, found[key], f"{name}.")
        elif key not in found:
            said.append(f"{name} is missing there, wanted {_short(value)}")
        elif found[key] != value:
            said.append(f"{name} = {_short(found[key])} there, wanted {_short(value)}")
    return said


def _short(value: object) -> str:
    """A value as an error can show it."""
    return textwrap.shorten(repr(value), 80, placeholder=" ...")
