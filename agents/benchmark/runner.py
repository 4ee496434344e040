"""The benchmark: every learner on the eight insects, and every other task, with several seeds."""

import re
from collections.abc import Mapping, Sequence
from pathlib import Path

from agents.benchmark.run_queue import CommandOf, Outcome, train_all
from agents.benchmark.training_run import Run, is_there, registered, run_command
from agents.run_folder import RUNS
from flapenv.aero.checks import record, require_count, require_name, shown

BENCHMARKED = (
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
"""Every learner on the eight insects, and the presets of every other task that learn from rewards; of the presets of
`agents.presets.PRESETS` those that are trained unless others are asked for."""
ROOT = RUNS / "benchmark"


@record
class BenchmarkConfig:
    """What is run.

    Attributes:
        presets: names of `agents.presets.PRESETS`.
        seeds: how many of each: 0, 1 and so on.
        jobs: runs beside each other, one thread each.
        wingbeats: budget of every run instead of the presets' own, to try the benchmark out; None for theirs.
    """

    presets: Sequence[str] = BENCHMARKED
    seeds: int = 5
    jobs: int = 2
    wingbeats: int | None = None

    def __post_init__(self) -> None:
        """Check every field."""
        if isinstance(self.presets, str) or not isinstance(self.presets, Sequence) or not self.presets:
            raise TypeError(f"presets = {shown(self.presets)} is not allowed; allowed: a list of at least one name")
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


def run_benchmark(
    config: BenchmarkConfig, root: Path = ROOT, *, command: CommandOf = run_command, progress: bool = True
) -> Outcome:
    """Run what is not there yet; arguments, errors and Ctrl-C as those of `train_all`."""
    return train_all(config.runs(), root, config.jobs, command=command, progress=progress)


def finished_runs(root: Path, wingbeats: int | None = None) -> tuple[list[Run], Mapping[str, str]]:
    """All finished runs of registered presets in a folder, whoever asked for them.

    Args:
        root: folder of the run folders.
        wingbeats: their budget; None for the presets' own.

    Returns:
        The runs, presets in the order of `BENCHMARKED` and then of the registry; and why each other folder that is
        called like a run was left out, by its name.
    """
    known = list(dict.fromkeys([name for name in BENCHMARKED if name in registered()] + list(registered())))
    called = (re.fullmatch(r"(.+)-seed(0|[1-9][0-9]*)", path.name) for path in root.iterdir() if path.is_dir())
    candidates = [
        Run(preset=match[1], seed=int(match[2]), wingbeats=wingbeats) for match in called if match and match[1] in known
    ]
    runs, left_out = list[Run](), dict[str, str]()
    for run in sorted(candidates, key=lambda one: (known.index(one.preset), one.seed)):
        try:
            if is_there(run, root):
                runs.append(run)
            else:
                left_out[run.name] = f"{root / run.name} was cut short"
        except (ValueError, TypeError, OSError) as why:
            left_out[run.name] = str(why)
    return runs, left_out
