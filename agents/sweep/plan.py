"""What a sweep runs: seeds × presets × problems, or a search; kept in sweep.json, so that it can be gone on with."""

import json
from collections import Counter
from collections.abc import Mapping, Sequence
from dataclasses import asdict, field
from functools import cached_property
from typing import Any

from agents.presets import PRESETS, Preset
from agents.sweep.runs import SweepRun, run_of
from agents.sweep.search_space import Choices, Range, require_settings, space_of
from agents.training_config import LAST_SEED
from flapenv.aero.checks import LONGEST_SHOWN, one_line, record, require_count, require_name, shown
from flapenv.problem import PROBLEMS

MOST_SEEDS = 10_000
LETTERS = dict(zip("ABCD", PROBLEMS, strict=True))
"""The problems' letters in the documentation."""


@record
class SweepPlan:
    """What is run.

    Attributes:
        presets: names of `agents.presets.PRESETS`; of a search one.
        problems: names of `flapenv.problem.PROBLEMS` or their letters; None for the presets' own. Of a search one.
        insects: names, in place of the presets'; None for theirs.
        seeds: how many of each: 0, 1 and so on.
        wingbeats: budget of every run; None for the presets' own.
        settings: of the learners, in place of the presets'.
        search: what a search may choose: of each setting a range or choices; nothing for no search.
        trials: how many settings a search tries.
        batch: settings chosen at a time, the next ones after all of them have ended: what is found does not depend on
            which ended first.
        sampler_seed: of the search's choices.
    """

    presets: Sequence[str]
    problems: Sequence[str] | None = None
    insects: Sequence[str] | None = None
    seeds: int = 5
    wingbeats: int | None = None
    settings: Mapping[str, Any] = field(default_factory=dict)
    search: Mapping[str, Range | Choices] = field(default_factory=dict)
    trials: int | None = None
    batch: int = 4
    sampler_seed: int = 0

    def __post_init__(self) -> None:
        """Check every field, and that every preset takes them, before anything has run."""
        for name in ("presets", "problems", "insects"):
            self._require_names(name)
        for name in ("settings", "search"):
            _require_object(name, getattr(self, name))
        for name in self.presets:
            require_name("presets", name, PRESETS)
        if self.problems is not None:
            named = tuple(LETTERS.get(name, name) for name in self.problems)
            for name in named:
                require_name("problems", name, PROBLEMS)
            object.__setattr__(self, "problems", named)
            self._require_names("problems")
        require_count("seeds", self.seeds, high=MOST_SEEDS)
        require_count("batch", self.batch)
        require_count("sampler_seed", self.sampler_seed, low=0, high=LAST_SEED)
        if self.wingbeats is not None:
            require_count("wingbeats", self.wingbeats)
            if "wingbeats" in {**self.settings, **self.search}:
                raise ValueError("wingbeats are told twice; allowed: --wingbeats, or a setting of that name")
        self._check_search()
        for run in self.grid() if not self.search else self.runs_of_trial(0, {}):
            if run.config.seed == 0:
                run.described()  # arguments and settings that a preset refuses are refused before anything has run

    def _require_names(self, name: str) -> None:
        """Refuse what is no list of different names."""
        value = getattr(self, name)
        if value is None and name != "presets":
            return
        if isinstance(value, str) or not isinstance(value, Sequence) or not value:
            raise TypeError(f"{name} = {shown(value)} is not allowed; allowed: a list of at least one name")
        for one in value:
            if not isinstance(one, str):
                raise TypeError(f"{name} hold {shown(one)}; allowed: names")
        most, times = Counter(value).most_common(1)[0]
        if times > 1:
            raise ValueError(f"{name} name {one_line(most, LONGEST_SHOWN)} more than once; allowed: each once")
        object.__setattr__(self, name, tuple(value))

    def _check_search(self) -> None:
        """Refuse a search that cannot be."""
        if not self.search:
            if self.trials is not None:
                raise ValueError("trials are of a search; allowed: --search NAME=LOW:HIGH beside them")
            return
        if self.trials is None:
            raise ValueError("a search needs a number of trials; allowed: --trials N beside --search")
        require_count("trials", self.trials)
        for name in ("presets", "problems"):
            if len(getattr(self, name) or ()) > 1:
                raise ValueError(f"{name} = {', '.join(getattr(self, name))} of a search; allowed: one")
        twice = [name for name in self.search if name in self.settings]
        if twice:
            raise ValueError(
                f"setting {one_line(twice[0], LONGEST_SHOWN)} is both set and searched; allowed: one of the two"
            )
        [[_, _, base]] = self._bases
        require_settings(self.search, base)

    @cached_property
    def _fixed(self) -> dict[str, Any]:
        """Settings that are the same in every run."""
        return {**self.settings, **({} if self.wingbeats is None else {"wingbeats": self.wingbeats})}

    @cached_property
    def _bases(self) -> list[tuple[str, dict[str, Any], Preset]]:
        """Every preset × problem: its name, its task's arguments, the preset with them and with the settings."""
        bases = []
        for name in self.presets:
            for problem in self.problems or (None,):
                arguments: dict[str, Any] = {} if problem is None else {"problem": problem}
                arguments |= {} if self.insects is None else {"insects": list(self.insects)}
                try:
                    base = PRESETS[name].changed(arguments, self._fixed)
                except (TypeError, ValueError) as mistake:
                    raise type(mistake)(f"preset {name!r}: {mistake}") from None
                bases.append((name, arguments, base))
        return bases

    @property
    def held(self) -> Preset:
        """The preset of a search, with all that it does not choose."""
        return self._bases[0][2]

    @property
    def trials_asked(self) -> int:
        """How many settings a search tries; 0 without one."""
        return self.trials or 0

    def grid(self) -> list[SweepRun]:
        """All runs of a sweep without a search; seeds outside, so that one cut short has every preset."""
        runs = []
        for seed in range(self.seeds):
            for preset, arguments, base in self._bases:
                group = "-".join([preset, *([arguments["problem"]] if "problem" in arguments else [])])
                runs.append(run_of(f"{group}-seed{seed}", group, preset, seed, arguments, self._fixed, base))
        return runs

    def runs_of_trial(self, number: int, chosen: Mapping[str, Any]) -> list[SweepRun]:
        """A search's runs with the settings it has chosen, one a seed.

        Raises:
            TypeError: for a setting of another kind.
            ValueError: for settings that do not go together.
        """
        [[preset, arguments, base]] = self._bases
        changed, group = base.changed({}, chosen), f"trial{number:04d}"
        settings = {**self._fixed, **chosen}
        return [
            run_of(f"{group}-seed{seed}", group, preset, seed, arguments, settings, changed)
            for seed in range(self.seeds)
        ]

    def to_dict(self) -> dict[str, Any]:
        """As sweep.json keeps it."""
        plain = {**asdict(self), "search": {name: choice.to_json() for name, choice in self.search.items()}}
        return dict(json.loads(json.dumps(plain)))

    @classmethod
    def from_dict(cls, content: Mapping[str, Any], called: str) -> "SweepPlan":
        """The plan in a sweep.json.

        Args:
            content: as `to_dict` gives it.
            called: how errors call it.

        Raises:
            TypeError: for an unknown key, or a value of another kind.
            ValueError: for a value that is not allowed.
        """
        for name in ("settings", "search"):
            _require_object(f"{called}: {name}", content.get(name, {}))
        try:
            return cls(**{**content, "search": space_of(content.get("search", {}), "search")})
        except (TypeError, ValueError) as mistake:
            raise type(mistake)(f"{called}: {mistake}") from None


def _require_object(field: str, value: object) -> None:
    """Refuse what has no names."""
    if not isinstance(value, Mapping):
        raise TypeError(f"{field} = {shown(value)} is not allowed; allowed: an object")
