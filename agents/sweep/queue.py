"""Tune's side of a sweep: each run is a trial, started where a CPU is free, and again elsewhere if its node is lost."""

import time
import uuid
from collections.abc import Callable, Sequence
from pathlib import Path
from typing import Any

import ray
from ray import tune
from ray.exceptions import RayError
from ray.tune.search import Searcher

from agents.sweep.runs import SweepRun, found_result
from agents.sweep.sources import Failure, Source
from agents.sweep.storage import RAY
from agents.sweep.trials import packed, run_trial
from agents.sweep.watch import Watch, watched
from flapenv.aero.checks import one_line

LOSSES = 20
"""How often a run is started again because its worker was lost."""
SEEN = 10.0
"""Seconds until a file that another node wrote is seen here: shared folders lag behind."""


class RunQueue(Searcher):
    """Hands Tune the runs of a source. What a run reached is read from its folder, not from what Tune says."""

    def __init__(self, source: Source, storage: Path, ended: Callable[[SweepRun, Failure | None], None]) -> None:
        """A queue.

        Args:
            source: of the runs.
            storage: of their folders.
            ended: told each run that has ended, and why it has no result.
        """
        super().__init__()
        self._source, self._storage, self._ended = source, storage, ended
        self._runs: dict[str, SweepRun] = {}

    def suggest(self, trial_id: str) -> Any:
        """The next run, None while there is none, or that there will be none."""
        run = self._source.following()
        if run is None:
            return Searcher.FINISHED if self._source.over else None
        self._runs[trial_id] = run
        return {"folder": str(self._storage.absolute() / run.name), "packed": packed(run.config)}

    def on_trial_complete(self, trial_id: str, result: dict[str, Any] | None = None, error: bool = False) -> None:
        """Take note of a run that has ended."""
        run = self._runs.pop(trial_id, None)
        if run is None:
            return
        failure = self._failure(run, result or {}, error)
        self._source.ended(run, failure)
        self._ended(run, failure)

    def _failure(self, run: SweepRun, result: dict[str, Any], error: bool) -> Failure | None:
        """Why a run that has ended has no result."""
        if result.get("failed") is not None:
            return Failure(why=str(result["failed"]), final=bool(result["final"]))
        deadline = time.monotonic() + (0.0 if error else SEEN)
        try:
            while (there := found_result(run, self._storage)) is None and time.monotonic() < deadline:
                time.sleep(0.5)
            if there is not None:
                return None
        except (ValueError, OSError) as mistake:
            return Failure(why=str(mistake), final=False)
        lost = f"its worker was lost {LOSSES + 1} times" if error else "it ended without a result"
        return Failure(why=f"{lost}; see {self._storage / run.name}", final=False)

    def save_to_dir(self, checkpoint_dir: str, session_str: str = "default") -> None:
        """Nothing: a sweep is gone on with from its run folders."""

    def save(self, checkpoint_path: str) -> None:
        """Nothing, for the same reason."""

    def restore(self, checkpoint_path: str) -> None:
        """Never: Tune's states are pickles.

        Raises:
            RuntimeError: whatever is asked for.
        """
        raise RuntimeError(f"{checkpoint_path} is Tune's and a pickle; allowed: going on from the run folders")


class Interrupts(tune.Callback):
    """Ends a sweep between two of Tune's steps when a signal was seen, or the cluster is lost."""

    def __init__(self, signals: Sequence[int], watch: Watch) -> None:
        """Of the signals seen so far, and of a cluster."""
        self._signals, self._watch = signals, watch

    def on_step_begin(self, iteration: int, trials: list[Any], **info: Any) -> None:
        """Look whether there was a signal, and whether the cluster lives.

        Raises:
            KeyboardInterrupt: if there was one.
            ConnectionError: if it does not.
        """
        if self._signals:
            raise KeyboardInterrupt
        if self._watch.wrong is not None:
            raise ConnectionError(self._watch.wrong)


def run_all_trials(queue: RunQueue, storage: Path, signals: Sequence[int], at_once: int | None) -> None:
    """Run everything that the queue hands out; Ray is connected.

    Args:
        queue: of the runs.
        storage: of the sweep; Tune's own files go below it, where all nodes see them.
        signals: those seen, which end it.
        at_once: trials beside each other; None for as many as there are CPUs.

    Raises:
        KeyboardInterrupt: after a signal.
        ConnectionError: if the cluster is lost.
        OSError: if the storage cannot be written.
    """
    watch = watched(ray)
    tuner = tune.Tuner(
        tune.with_resources(run_trial, {"cpu": 1}),
        tune_config=tune.TuneConfig(
            search_alg=queue,
            num_samples=-1,
            max_concurrent_trials=at_once,
            trial_dirname_creator=lambda trial: str(trial.trial_id),
        ),
        run_config=tune.RunConfig(
            name=uuid.uuid4().hex[:8],
            storage_path=str(storage.absolute() / RAY),
            verbose=0,
            callbacks=[Interrupts(signals, watch)],
            failure_config=tune.FailureConfig(max_failures=LOSSES),
        ),
    )
    try:
        tuner.fit()
    except (RayError, tune.TuneError, ConnectionError) as mistake:
        raise ConnectionError(
            f"Ray has failed: {one_line(mistake, 300)}; finished runs are kept, and the same command goes on"
        ) from None
    except OSError as mistake:  # of a full disk, say
        raise OSError(
            f"{storage} cannot be written ({one_line(mistake, 300)}); finished runs are kept, and the same command "
            "goes on when it can"
        ) from None
    finally:
        watch.end()
