"""The benchmark: every preset with every seed, a process each, a few at a time; what is finished is never redone.

A run is made in `NAME-seedN.part` and renamed when it has ended well, so that it is there whole or not at all.
"""

import json
import shutil
import signal
import sys
import textwrap
from collections.abc import Callable, Mapping, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any

from tqdm import tqdm

from agents.folder_lock import locked
from agents.machine import note_machine
from agents.run_folder import CONFIG, RESULTS, RUNS, write_json
from agents.subprocesses import ERRORS, Command, run_all
from flapenv.aero.checks import record, require_count, require_name

if TYPE_CHECKING:
    from agents.presets import Preset

PRESETS = (
    "hover-ppo",
    "hover-sac",
    "hover-td3",
    "hover-tqc",
    "hover-crossq",
    "hover-gradient",
    "random-wings-ppo",
    "adapt-ppo",
    "adapt-recurrentppo",
    "waveform-ppo",
    "heave-ppo",
)
"""Every learner on Hover-v0's problem A, and the best preset of every other task."""
ROOT = RUNS / "benchmark"
COMMAND = "command.json"
"""The command of a run, which marks its folder as the benchmark's own."""
TRAIN = Path(__file__).parents[1] / "train.py"


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
    """

    preset: str
    seed: int
    wingbeats: int | None = None

    @property
    def name(self) -> str:
        """Of its folder."""
        return f"{self.preset}-seed{self.seed}"

    def described(self) -> dict[str, Any]:
        """What config.json must say of it."""
        budget = {} if self.wingbeats is None else {"wingbeats": self.wingbeats}
        preset = registered()[self.preset].changed({}, budget)
        described: dict[str, Any] = {"preset": self.preset, "seed": self.seed, **preset.to_dict()}
        return dict(json.loads(json.dumps(described)))  # tuples become lists, as in the file


@record
class BenchmarkConfig:
    """What is run.

    Attributes:
        presets: names of `agents.presets.PRESETS`.
        seeds: how many of each: 0, 1 and so on.
        jobs: runs beside each other, one thread each.
        wingbeats: budget of every run instead of the presets' own, to try the benchmark out; None for theirs.
    """

    presets: Sequence[str] = PRESETS
    seeds: int = 5
    jobs: int = 2
    wingbeats: int | None = None

    def __post_init__(self) -> None:
        """Check every field."""
        if isinstance(self.presets, str) or not isinstance(self.presets, Sequence) or not self.presets:
            raise TypeError(f"presets = {self.presets!r} is not allowed; allowed: a list of at least one name")
        for name in self.presets:
            require_name("presets", name, registered())
        twice = [name for name in dict.fromkeys(self.presets) if list(self.presets).count(name) > 1]
        if twice:
            raise ValueError(f"presets name {', '.join(twice)} more than once; allowed: each once")
        object.__setattr__(self, "presets", tuple(self.presets))
        require_count("seeds", self.seeds)
        require_count("jobs", self.jobs)
        if self.wingbeats is not None:
            require_count("wingbeats", self.wingbeats)
        for run in self.runs()[: len(self.presets)]:
            run.described()  # a budget that a preset refuses is refused before anything has run

    def runs(self) -> list[Run]:
        """All runs; seeds outside, so that a benchmark cut short has every preset."""
        return [
            Run(preset=preset, seed=seed, wingbeats=self.wingbeats)
            for seed in range(self.seeds)
            for preset in self.presets
        ]


@record
class BenchmarkOutcome:
    """How it ended.

    Attributes:
        finished: runs that are there, those of earlier times too.
        failed: name of each failed run and why.
        interrupted: whether it was stopped before all runs had ended.
    """

    finished: Sequence[Run]
    failed: Mapping[str, str]
    interrupted: bool


def train_command(run: Run, out: Path) -> list[str]:
    """The command line of a run into the folder `out`."""
    budget = [] if run.wingbeats is None else ["--wingbeats", str(run.wingbeats)]
    base = [sys.executable, str(TRAIN), "--preset", run.preset, "--seed", str(run.seed), "--out", str(out), "--quiet"]
    return base + budget


def run_benchmark(
    config: BenchmarkConfig,
    root: Path = ROOT,
    *,
    command: Callable[[Run, Path], Sequence[str]] = train_command,
    progress: bool = True,
) -> BenchmarkOutcome:
    """Run what is not there yet. Ctrl-C ends the runs under way and keeps the finished ones.

    Args:
        config: what to run.
        root: folder of the run folders.
        command: the command line of a run into a folder.
        progress: whether to show a progress bar.

    Raises:
        BlockingIOError: if another benchmark runs into the same folder.
        ValueError: if a run there was made with other settings.
        FileExistsError: if a folder is in the way that no benchmark made.
        OSError: if the folder cannot be written, or a process not started.
    """
    root.mkdir(parents=True, exist_ok=True)
    with locked(root) as lock:
        runs = config.runs()
        there = [run for run in runs if _is_there(run, root)]
        for run in runs:
            _clear(root / f"{run.name}.part")
        todo = {run.name: run for run in runs if run not in there}
        failed: dict[str, str] = {}
        if todo:
            note_machine(root, config.jobs)
        with tqdm(total=len(runs), initial=len(there), disable=not progress, unit="run", file=sys.stderr) as bar:

            def ended(over: Command, code: int) -> None:
                bar.update()
                why = _failure(over.folder, code)
                if why is None:
                    over.folder.rename(root / over.name)
                    there.append(todo[over.name])
                else:
                    failed[over.name] = why
                    bar.write(f"{over.name} failed: {why}", file=sys.stderr)

            completed = run_all(
                (_prepared(run, root, command) for run in todo.values()),
                config.jobs,
                changed=lambda names: bar.set_postfix_str(", ".join(names)),
                ended=ended,
                inherited=lock,
            )
    return BenchmarkOutcome(
        finished=[run for run in runs if run in there],
        failed={run.name: failed[run.name] for run in runs if run.name in failed},
        interrupted=not completed,
    )


def _is_there(run: Run, root: Path) -> bool:
    """Whether a run has been finished, with the same settings."""
    folder = root / run.name
    if not folder.exists():
        return False
    missing = [name for name in (CONFIG, RESULTS) if not (folder / name).is_file()]
    if missing:
        raise FileExistsError(f"{folder} is in the way: it holds no {' and no '.join(missing)}; allowed: finished runs")
    found = json.loads((folder / CONFIG).read_text(encoding="utf-8"))
    differs = differences(run.described(), found)
    if differs:
        raise ValueError(
            f"{folder} was made with other settings: {'; '.join(differs)}; allowed: the same, or another folder"
        )
    return True


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


def _clear(part: Path) -> None:
    """Remove what an interrupted or failed run left."""
    if not part.exists():
        return
    if not (part / COMMAND).is_file() and any(part.iterdir()):
        raise FileExistsError(f"{part} is in the way: no benchmark made it; allowed: another folder, or move it")
    shutil.rmtree(part)


def _prepared(run: Run, root: Path, command: Callable[[Run, Path], Sequence[str]]) -> Command:
    """The run's command, with a folder to run into that is marked as the benchmark's own."""
    part = root / f"{run.name}.part"
    arguments = list(command(run, part))
    part.mkdir()
    write_json(part / COMMAND, {"command": arguments})
    return Command(name=run.name, arguments=arguments, folder=part)


def _failure(part: Path, code: int) -> str | None:
    """Why a run that ended with this exit code failed; None if it did not."""
    if code == 0:
        return None if (part / RESULTS).is_file() else f"it ended without {RESULTS}; see {part}"
    how = f"exit code {code}" if code > 0 else f"killed by {signal.Signals(-code).name}"
    said = (part / ERRORS).read_text(encoding="utf-8", errors="replace").strip().splitlines()
    return f"{said[-1].strip() if said else 'it said nothing'} ({how}; see {part / ERRORS})"
