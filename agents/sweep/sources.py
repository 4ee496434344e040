"""Where the runs of a sweep come from, one after another: a list of them, or a search that chooses as it learns."""

from collections.abc import Callable, Iterable, Mapping, Sequence
from pathlib import Path
from typing import Protocol

from agents.sweep.runs import SweepRun, found_result, result_of
from agents.sweep.study import Study
from flapenv.aero.checks import one_line, record


@record
class Failure:
    """Why a run has no result.

    Attributes:
        why: in one line.
        final: whether it would end so again: the settings are at fault.
    """

    why: str
    final: bool


class Source(Protocol):
    """What hands out runs and is told how they ended."""

    def following(self) -> SweepRun | None:
        """The next run; None while there is none, until others have ended or for good."""

    def ended(self, run: SweepRun, failure: Failure | None) -> None:
        """Take note that a run has ended, well or not."""

    @property
    def over(self) -> bool:
        """Whether no run will follow."""


class Listed:
    """Runs that are known from the start."""

    def __init__(self, runs: Iterable[SweepRun]) -> None:
        """Of runs that are not finished yet."""
        self._waiting = list(runs)

    def following(self) -> SweepRun | None:
        """The next run, in their order."""
        return self._waiting.pop(0) if self._waiting else None

    def ended(self, run: SweepRun, failure: Failure | None) -> None:
        """Nothing depends on it."""

    @property
    def over(self) -> bool:
        """Whether all have been handed out."""
        return not self._waiting


class Searched:
    """Runs that a study chooses, batch after batch; those finished earlier are counted, not handed out again."""

    def __init__(
        self,
        study: Study,
        runs_of: Callable[[int, Mapping[str, object]], Sequence[SweepRun]],
        storage: Path,
        refused: Callable[[str, str], None],
    ) -> None:
        """A search.

        Args:
            study: what chooses.
            runs_of: the runs of a trial's number and settings.
            storage: of the run folders.
            refused: told the name of a trial, and why, whose settings do not go together, or of a run whose folder
                cannot be gone on with.
        """
        self._study, self._runs_of, self._storage, self._refused = study, runs_of, storage, refused
        self._waiting: list[SweepRun] = []
        self._open: dict[str, int] = {}
        self._left: dict[int, set[str]] = {}
        self._trials: dict[int, Sequence[SweepRun]] = {}
        self._failures: dict[int, dict[str, Failure]] = {}

    def following(self) -> SweepRun | None:
        """The next run of the batch; a new batch when all of the last one have ended."""
        while not self._waiting and not self._left and not self._study.over:
            for trial in self._study.batch():
                self._begin(trial.number, trial.chosen)
            self._conclude()
        return self._waiting.pop(0) if self._waiting else None

    def _begin(self, number: int, chosen: Mapping[str, object]) -> None:
        """Line up what is missing of a trial's runs."""
        self._failures[number], name = {}, f"trial{number:04d}"
        try:
            self._trials[number] = runs = self._runs_of(number, chosen)
            for run in runs:
                run.described()
        except (TypeError, ValueError) as mistake:
            self._refused(name, str(mistake))
            self._failures[number][name] = Failure(why=str(mistake), final=True)
            self._left[number] = set()
            return
        todo = []
        for run in runs:
            try:
                if found_result(run, self._storage) is None:
                    todo.append(run)
            except (ValueError, OSError) as mistake:
                self._refused(run.name, str(mistake))
                self._failures[number][run.name] = Failure(why=str(mistake), final=False)
        self._left[number] = {run.name for run in todo}
        self._open |= dict.fromkeys((run.name for run in todo), number)
        self._waiting += todo

    def ended(self, run: SweepRun, failure: Failure | None) -> None:
        """Tell the study when the whole batch has ended, in the order of its trials."""
        number = self._open.pop(run.name)
        self._left[number].discard(run.name)
        if failure is not None:
            self._failures[number][run.name] = failure
        self._conclude()

    def _conclude(self) -> None:
        """Tell the study of the batch if all of it has ended."""
        if any(self._left.values()):
            return
        for number in sorted(self._left):
            failures = self._failures[number]
            if not failures:
                means = [result_of(run, self._storage).mean for run in self._trials[number]]
                known = [mean for mean in means if mean is not None]
                self._study.tell(number, sum(known) / len(known) if len(known) == len(means) else None)
            elif any(failure.final for failure in failures.values()):
                self._study.tell(number, None, {name: one_line(one.why) for name, one in failures.items()})
            else:
                self._study.give_up(number)
        self._left.clear()

    @property
    def over(self) -> bool:
        """Whether every trial has ended, or is given up until the next time."""
        return not self._waiting and not self._left and self._study.over
