"""A sweep from its plan to its tables."""

import contextlib
import os
import sys
from collections.abc import Collection, Iterator, Mapping, Sequence
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
from agents.sweep.runs import RunResult, SweepRun, found_result, result_of
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
        self.failed[name] = one_line(why)
        tqdm.write(f"{name} failed: {self.failed[name]}", file=sys.stderr)


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
        todo, there = [], 0
        for run in runs:
            try:
                if found_result(run, storage) is None:
                    todo.append(run)
                else:
                    there += 1
            except (ValueError, OSError) as mistake:  # one folder's fault, and not the others'
                watched.fail(run.name, str(mistake))
        watched.total, watched.there = len(runs), there
        return Listed(todo), None
    study = Study(plan, storage / JOURNAL)
    known = [run for trial in study.trials() for run in _runs_of(plan, trial)]
    watched.total, watched.there = plan.trials_asked * plan.seeds, len(_results(known, storage))
    return Searched(study, plan.runs_of_trial, storage, watched.fail), study


def _runs_of(plan: SweepPlan, trial: Trial) -> Sequence[SweepRun]:
    """A trial's runs; none where its settings do not go together."""
    try:
        return plan.runs_of_trial(trial.number, trial.chosen)
    except (TypeError, ValueError):
        return ()


def _results(runs: Sequence[SweepRun], storage: Path) -> list[RunResult]:
    """Of the runs that are finished; one whose task or whose folder is refused is not."""
    results = []
    for run in runs:
        with contextlib.suppress(ValueError, TypeError, OSError):
            results.append(found_result(run, storage))
    return [one for one in results if one is not None]


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


def _given_up_for_good(plan: SweepPlan, trials: Sequence[Trial], there: Collection[str]) -> dict[str, str]:
    """What of a search has failed, now or at an earlier time, and is not tried again: why."""
    failed: dict[str, str] = {}
    for trial in trials:
        if not trial.ended or trial.value is not None:
            continue
        missing = [run.name for run in _runs_of(plan, trial) if run.name not in there]
        failed |= trial.failed or dict.fromkeys(missing, "its settings diverged or do not go together")
    return failed


def _concluded(
    plan: SweepPlan, storage: Path, study: Study | None, failed: Mapping[str, str], interrupted: bool
) -> Outcome:
    """Tables and files of what is there."""
    trials = [] if study is None else study.trials()
    runs = plan.grid() if study is None else [run for trial in trials for run in _runs_of(plan, trial)]
    results = _results(runs, storage)
    failed = {**failed, **_given_up_for_good(plan, trials, {one.run.name for one in results})}
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
