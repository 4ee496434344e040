"""A search by Optuna, kept in a journal of JSON lines: nothing that lies in a folder is unpickled.

Tune's own OptunaSearch is not used: its trials are not gone on with after a kill, its draws depend on which trial ends
first, and a trial of it is one run, where ours is one a seed. Here settings are chosen a batch at a time, from all that
was found before the batch and a generator seeded by the trial's number, so a search finds the same however often it was
killed, and on however many machines.
"""

import contextlib
import itertools
import json
from collections.abc import Iterator, Mapping
from dataclasses import field
from pathlib import Path
from typing import Any

import numpy as np
import optuna
from optuna.distributions import BaseDistribution, CategoricalDistribution, FloatDistribution, IntDistribution
from optuna.samplers import TPESampler
from optuna.storages import JournalStorage
from optuna.storages.journal import JournalFileBackend
from optuna.trial import FrozenTrial, TrialState

from agents.sweep.plan import SweepPlan
from agents.sweep.search_space import Choices, Range, is_whole
from flapenv.aero.checks import one_line, record
from flapenv.read_json import require_file

NAME = "sweep"
FAILED = "failed"
"""A trial's attribute: which of its runs have no result, and why."""
ENDED = (TrialState.COMPLETE, TrialState.PRUNED)
"""With a distance, or without one: settings that diverged or do not go together count as worse than all others."""


@record
class Trial:
    """Settings that were chosen.

    Attributes:
        number: 0, 1 and so on.
        chosen: the settings.
        value: mean distance over the seeds [-]; None where there is none, or not yet.
        ended: whether it will not be tried again.
        failed: which runs of settings that were tried have no result, and why.
    """

    number: int
    chosen: Mapping[str, Any]
    value: float | None
    ended: bool = False
    failed: Mapping[str, str] = field(default_factory=dict)


def distribution(choice: Range | Choices, held: Any) -> BaseDistribution:
    """What Optuna draws from.

    Args:
        choice: of the search space.
        held: the setting's value in the preset.
    """
    if isinstance(choice, Choices):
        return CategoricalDistribution(tuple(choice.values))
    if is_whole(choice, held):
        return IntDistribution(int(choice.low), int(choice.high), log=choice.log)
    return FloatDistribution(float(choice.low), float(choice.high), log=choice.log)


class Study:
    """What has been chosen and found, and what to try next. One process at a time: the storage's lock is held."""

    def __init__(self, plan: SweepPlan, journal: Path) -> None:
        """Begin, or go on from the journal.

        Raises:
            ValueError: if the journal is not as Optuna writes it.
            OSError: if it cannot be read or written.
        """
        optuna.logging.set_verbosity(optuna.logging.ERROR)
        self._plan, self._journal = plan, journal
        settings = plan.held.settings
        self._space = {name: distribution(one, getattr(settings, name)) for name, one in plan.search.items()}
        self._given_up: set[int] = set()
        if journal.exists():
            require_file(journal, str(journal))
            mend_journal(journal)
            with _as_optuna_writes(journal):  # of a last line that is broken it would tell only later
                for line in journal.read_bytes().splitlines():
                    json.loads(line)
        with _as_optuna_writes(journal):
            self._storage = storage = JournalStorage(JournalFileBackend(str(journal)))
            self._study = optuna.create_study(
                storage=storage, study_name=NAME, direction="minimize", load_if_exists=True, sampler=TPESampler(seed=0)
            )
            for trial in self._raw():
                if trial.state is TrialState.RUNNING and set(trial.params) != set(self._space):
                    self._study.tell(trial.number, state=TrialState.FAIL)  # killed while it was chosen: chosen again
            self.trials()

    def _raw(self) -> list[FrozenTrial]:
        """Optuna's trials, without those that were killed while they were chosen."""
        return [one for one in self._study.get_trials(deepcopy=False) if one.state is not TrialState.FAIL]

    def trials(self) -> list[Trial]:
        """All that were chosen, in their order."""
        return [
            Trial(
                number=number,
                chosen=dict(one.params),
                value=one.value if one.state is TrialState.COMPLETE else None,
                ended=one.state in ENDED,
                failed=_failed(one.user_attrs.get(FAILED)) if one.state is TrialState.PRUNED else {},
            )
            for number, one in enumerate(self._raw())
        ]

    @property
    def over(self) -> bool:
        """Whether every trial has ended; or one is given up until the next time, and with it what would follow it."""
        raw = self._raw()
        return (len(raw) >= self._plan.trials_asked or bool(self._given_up)) and not self._going(raw)

    def _going(self, raw: list[FrozenTrial]) -> list[int]:
        """Numbers of trials that have not ended."""
        return [number for number, one in enumerate(raw) if one.state not in ENDED and number not in self._given_up]

    def batch(self) -> list[Trial]:
        """The trials that are to be run now: those a kill left, or settings chosen anew.

        Raises:
            ValueError: if what the journal holds cannot be chosen from.
        """
        with _as_optuna_writes(self._journal):
            return self._chosen()

    def _chosen(self) -> list[Trial]:
        """What `batch` returns."""
        raw = self._raw()
        behind = len(raw) - len(self._going(raw))
        size = self._plan.batch
        until = min(self._plan.trials_asked, (behind // size + 1) * size)
        for number in itertools.count(len(raw)):
            if number >= until:
                break
            seed = np.random.SeedSequence([self._plan.sampler_seed, number]).generate_state(1)[0]
            self._study.sampler = TPESampler(seed=int(seed))
            self._study.ask(fixed_distributions=self._space)
        going = set(self._going(self._raw()))
        return [trial for trial in self.trials() if trial.number in going]

    def tell(self, number: int, value: float | None, failed: Mapping[str, str] | None = None) -> None:
        """Keep what a trial found.

        Args:
            number: of the trial.
            value: its distance; None if it found nothing and would not another time.
            failed: which of its runs have no result, and why.
        """
        trial = self._raw()[number]
        if failed:
            place = self._storage.get_trial_id_from_study_id_trial_number(
                self._storage.get_study_id_from_name(NAME), trial.number
            )
            self._storage.set_trial_user_attr(place, FAILED, dict(failed))
        if value is None:
            self._study.tell(trial.number, state=TrialState.PRUNED)
        else:
            self._study.tell(trial.number, value)

    def give_up(self, number: int) -> None:
        """Leave a trial to the next time: what stopped it was not its settings."""
        self._given_up.add(number)


@contextlib.contextmanager
def _as_optuna_writes(journal: Path) -> Iterator[None]:
    """Whatever Optuna makes of lines that it did not write, in one line.

    Raises:
        ValueError: naming the journal.
    """
    try:
        yield
    except OSError:
        raise
    except Exception as mistake:
        raise ValueError(
            f"{journal} is not a journal as Optuna writes it: {type(mistake).__name__} {one_line(mistake, 300)}; "
            "allowed: the file as it was written, or another --storage"
        ) from None


def _failed(told: object) -> dict[str, str]:
    """What the journal says of failures; nothing if it is not as it was written."""
    return {str(name): str(why) for name, why in told.items()} if isinstance(told, dict) else {}


def mend_journal(journal: Path) -> None:
    """Remove what a kill leaves: half a line at the end, and Optuna's own lock; ours keeps others out."""
    journal.with_name(f"{journal.name}.lock").unlink(missing_ok=True)
    with journal.open("rb+") as file:
        content = file.read()
        file.truncate(content.rfind(b"\n") + 1)
