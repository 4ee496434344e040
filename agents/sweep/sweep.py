"""A sweep from its plan to its tables."""

import contextlib
import os
import sys
from collections.abc import Iterator, Mapping, Sequence
from pathlib import Path
from types import ModuleType
from typing import Any

from tqdm import tqdm

from agents.benchmark.report import percent
from agents.benchmark.subprocesses import counted_signals
from agents.sweep.cluster import reached, require_head, started
from agents.sweep.nodes import require_fit_nodes
from agents.sweep.plan import SweepPlan
from agents.sweep.results import best_command, summary_of, sweep_table, trials_table, write_results
from agents.sweep.runs import RunResult, SweepRun, is_finished, result_of
from agents.sweep.sources import Failure, Listed, Searched, Source
from agents.sweep.storage import JOURNAL, opened, remove_ray
from agents.sweep.study import Study, Trial
from flapenv.aero.checks import one_line, record


@record
class Outcome:
    """How a sweep ended.

    Attributes:
        table: what was found, for people.
        finished: runs that are there, those of earlier times too.
        total: runs that were asked for.
        failed: each run, or trial of a search, without a result, and why.
        interrupted: whether it was stopped.
    """

    table: str
    finished: int
    total: int
    failed: Mapping[str, str]
    interrupted: bool


class Watched:
    """The progress bar, and what has failed."""

    def __init__(self, storage: Path) -> None:
        """Of runs in a storage: so many in all, of which some are there."""
        self.failed: dict[str, str] = {}
        self.total, self.there = 0, 0
        self._storage = storage
        self._bar = tqdm(disable=True)

    @contextlib.contextmanager
    def shown(self, progress: bool) -> Iterator[None]:
        """Show the bar, unless there is to be none."""
        total, there = self.total, self.there
        with tqdm(total=total, initial=there, disable=not progress, unit="run", file=sys.stderr) as self._bar:
            yield

    def ended(self, run: SweepRun, failure: Failure | None) -> None:
        """Count a run that has ended."""
        if failure is not None:
            self.fail(run.name, failure.why)
        else:
            mean = result_of(run, self._storage).mean
            self._bar.set_postfix_str(f"{run.name} {'-' if mean is None else percent(mean) + ' %'}")
        self._bar.update()

    def fail(self, name: str, why: str) -> None:
        """Say at once what has failed."""
        self.failed[name] = why
        tqdm.write(f"{name} failed: {one_line(why)}", file=sys.stderr)


def run_sweep(
    plan: SweepPlan, storage: Path, *, jobs: int | None, address: str | None = None, progress: bool = True
) -> Outcome:
    """Run what is not there yet. Ctrl-C ends it, and the same call goes on.

    Args:
        plan: what is run.
        storage: of the run folders; seen by all nodes at the same path.
        jobs: trials beside each other; None for one a CPU.
        address: HOST:PORT of a cluster's head; None for this machine alone.
        progress: whether to show a progress bar.

    Raises:
        ValueError: if the storage holds another plan or runs with other settings.
        ConnectionError: if the address does not answer, or Ray does not start.
        RuntimeError: if a node has other versions.
        OSError: if the storage cannot be written, here or on a node, or is another's.
        ImportError: if Ray or Optuna is not installed.
    """
    if address is not None:
        require_head(address)
    with opened(storage, plan):
        watched = Watched(storage)
        source, study = _prepared(plan, storage, watched)
        interrupted = False
        if not source.over:
            with _cluster(address, jobs) as ray:
                if address is not None:
                    require_fit_nodes(ray, storage.absolute())
                with watched.shown(progress):
                    interrupted = not _run(source, watched, storage, jobs if address else None)
            remove_ray(storage)
        return _concluded(plan, storage, study, watched.failed, interrupted)


def _prepared(plan: SweepPlan, storage: Path, watched: Watched) -> tuple[Source, Study | None]:
    """What is to be run, of which the watch is told how much is there."""
    if not plan.search:
        runs = plan.grid()
        todo = [run for run in runs if not is_finished(run, storage)]
        watched.total, watched.there = len(runs), len(runs) - len(todo)
        return Listed(todo), None
    study = Study(plan, storage / JOURNAL)
    known = [run for trial in study.trials() for run in _runs_of(plan, trial) if _is_there(run, storage)]
    watched.total, watched.there = plan.trials_asked * plan.seeds, len(known)
    return Searched(study, plan.runs_of_trial, storage, watched.fail), study


def _runs_of(plan: SweepPlan, trial: Trial) -> Sequence[SweepRun]:
    """A trial's runs; none where its settings do not go together."""
    try:
        return plan.runs_of_trial(trial.number, trial.chosen)
    except (TypeError, ValueError):
        return ()


def _is_there(run: SweepRun, storage: Path) -> bool:
    """Whether a run is finished; one whose task is refused is not."""
    return (storage / run.name).is_dir() and is_finished(run, storage)


@contextlib.contextmanager
def _cluster(address: str | None, jobs: int | None) -> Iterator[ModuleType]:
    """Ray, reached or started."""
    with reached(address) if address is not None else started(jobs or os.cpu_count() or 1) as ray:
        yield ray


def _run(source: Source, watched: Watched, storage: Path, at_once: int | None) -> bool:
    """Run everything; False if a signal came first."""
    from agents.sweep.queue import RunQueue, run_all_trials

    with counted_signals() as signals:
        try:
            run_all_trials(RunQueue(source, storage, watched.ended), storage, signals, at_once)
        except KeyboardInterrupt:
            return False
    return not signals


def _concluded(
    plan: SweepPlan, storage: Path, study: Study | None, failed: Mapping[str, str], interrupted: bool
) -> Outcome:
    """Tables and files of what is there."""
    trials = [] if study is None else study.trials()
    runs = plan.grid() if study is None else [run for trial in trials for run in _runs_of(plan, trial)]
    results = [result_of(run, storage) for run in runs if _is_there(run, storage)]
    content: dict[str, Any] = {"plan": plan.to_dict(), "failed": dict(failed)}
    if study is None:
        groups = dict.fromkeys(run.group for run in runs)
        summaries = [summary_of(name, [one for one in results if one.run.group == name], plan.seeds) for name in groups]
        content["groups"] = summaries
        table = _with_notes(sweep_table(summaries), results)
    else:
        command = best_command(plan, trials)
        content["trials"] = [{"number": one.number, "settings": dict(one.chosen), "mean": one.value} for one in trials]
        content["best"] = command
        best = "no trial has a distance yet" if command is None else f"best settings:\n  {command}"
        table = f"{_with_notes(trials_table(plan, trials), results)}\n\n{best}"
    write_results(storage, table, results, content)
    total = plan.trials_asked * plan.seeds if plan.search else len(runs)
    return Outcome(table=table, finished=len(results), total=total, failed=failed, interrupted=interrupted)


def _with_notes(table: str, results: Sequence[RunResult]) -> str:
    """A table, and what its distances are."""
    return "\n".join([table, *(f"distance: {words}" for words in dict.fromkeys(one.distance for one in results))])
