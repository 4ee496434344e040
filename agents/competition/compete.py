"""The equal-budget competition: optimisers and trained policies on the same wings, the same objective, the same count.

Every optimiser gets the same number of wingbeats on every wing and seed; references are solved before the clock starts.
A policy spends its wingbeats once, in training, and one more on each wing it is asked for.
"""

import math
import sys
import warnings
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

import numpy as np
from tqdm import tqdm

from agents.competition.budget import Budget, Trace
from agents.competition.competitors import COMPETITORS, load_libraries, run
from agents.evaluation.comparison import Comparison
from agents.policy_file import load_policy
from flapenv.aero.checks import record, require_count, require_name
from flapenv.envs import HoverVectorEnv
from flapenv.insects import INSECTS, Insect, as_insect, pick
from flapenv.optimum import optimum
from flapenv.problem import HoverProblem, as_problem
from flapenv.wing_pool import wing_pool

HOVER = "flapenv/Hover-v0"


@record
class CompetitionConfig:
    """What is compared.

    Attributes:
        problem: by name, as a `HoverProblem`, or the dict of one.
        insects: names or `Insect`s; those that cannot hover in the box are left out, and named.
        wings: random wings of the test split beside them.
        competitors: names of `COMPETITORS`.
        wingbeats: budget of each search.
        seeds: how many searches of each kind on each wing.
        policies: names of shipped policies, or run folders.
    """

    problem: Any = "free-frequency"
    insects: Sequence[Any] = INSECTS
    wings: int = 0
    competitors: Sequence[str] = tuple(COMPETITORS)
    wingbeats: int = 10_000
    seeds: int = 5
    policies: Sequence[Path] = ()

    def __post_init__(self) -> None:
        """Resolve and check every field."""
        object.__setattr__(self, "problem", as_problem(self.problem))
        insects = [as_insect(insect) for insect in self.insects]
        _require_once("insects", [insect.name for insect in insects])
        _require_once("competitors", self.competitors)
        _require_once("policies", [str(policy) for policy in self.policies])
        require_count("wings", self.wings, low=0)
        if self.wings:
            floor = 1.05 if self.problem.box.flap_amplitude_ratio is not None else None
            pool = wing_pool(self.wings, split="test", min_weight_support=floor)
            insects += [pick(pool, i) for i in range(self.wings)]
        object.__setattr__(self, "insects", tuple(insects))
        if not self.insects:
            raise ValueError("insects = [] and wings = 0 leave nothing to compare on; allowed: at least one")
        if not self.competitors:
            raise ValueError(f"competitors = [] is not allowed; allowed: some of {', '.join(COMPETITORS)}")
        for name in self.competitors:
            require_name("competitors", name, COMPETITORS)
        require_count("wingbeats", self.wingbeats)
        require_count("seeds", self.seeds)


def _require_once(field: str, names: Sequence[str]) -> None:
    """Refuse a name that is given twice."""
    twice = next((name for name in names if list(names).count(name) > 1), None)
    if twice is not None:
        raise ValueError(f"{field} name {twice} more than once; allowed: each once")


@record
class PolicyScore:
    """A trained policy on the same wings.

    Attributes:
        name: of its run folder.
        wingbeats: it was trained with.
        seconds: it was trained for; None where its card does not tell.
        gaps: on every wing [-].
    """

    name: str
    wingbeats: int
    seconds: float | None
    gaps: np.ndarray


@record
class Prepared:
    """Everything that can be wrong has been looked at, and nothing searched yet.

    Attributes:
        config: what to compare.
        insects: those that can hover.
        left_out: names of those that cannot.
        policies: the trained policies.
    """

    config: CompetitionConfig
    insects: tuple[Insect, ...]
    left_out: tuple[str, ...]
    policies: Sequence[PolicyScore]


@record
class CompetitionResult:
    """What came out.

    Attributes:
        config: what was compared.
        insects: those that could hover.
        left_out: names of those that could not.
        traces: of every competitor, one for each insect and seed.
        policies: the trained policies.
        interrupted: whether Ctrl-C came before the last search had ended.
    """

    config: CompetitionConfig
    insects: tuple[Insect, ...]
    left_out: tuple[str, ...]
    traces: Mapping[str, Sequence[Trace]]
    policies: Sequence[PolicyScore]
    interrupted: bool = False


def prepare(config: CompetitionConfig) -> Prepared:
    """Solve the references and ask every policy.

    Args:
        config: what to compare.

    Raises:
        ValueError: if no insect can hover, or a policy is none of this problem.
        OSError: if a policy cannot be read.
    """
    needs_mass = config.problem.model.accounting == "positive"
    with warnings.catch_warnings():
        warnings.filterwarnings("ignore", message=".*outside the range of the lifting-line")  # random wings reach 2.6
        feasible = tuple(
            insect
            for insect in config.insects
            if not (needs_mass and insect.wing.mass is None) and optimum(insect, config.problem).feasible
        )
    left_out = tuple(insect.name for insect in config.insects if insect not in feasible)
    if not feasible:
        raise ValueError(f"insects = {', '.join(left_out)}: none can hover in {config.problem.name}")
    policies = [_policy_score(Path(folder), feasible, config.problem) for folder in config.policies]
    return Prepared(config=config, insects=feasible, left_out=left_out, policies=policies)


def compete(prepared: Prepared, *, progress: bool = True) -> CompetitionResult:
    """Let every competitor search on every wing; Ctrl-C keeps the searches that have ended.

    Args:
        prepared: of `prepare`.
        progress: whether to show a progress bar.
    """
    import torch

    torch.set_num_threads(1)
    load_libraries()
    config, interrupted = prepared.config, False
    traces: dict[str, list[Trace]] = {name: [] for name in config.competitors}
    total = len(prepared.insects) * config.seeds * len(config.competitors)
    with tqdm(total=total, disable=not progress, unit=" searches", file=sys.stderr) as bar:
        try:
            for name in config.competitors:
                for number, insect in enumerate(prepared.insects):
                    for seed in range(config.seeds):
                        bar.set_postfix_str(f"{name}, {insect.name}")
                        budget = Budget(insect, config.problem, config.wingbeats)
                        traces[name].append(run(name, budget, (seed, number)).trace)
                        bar.update()
        except KeyboardInterrupt:
            interrupted = True
    return CompetitionResult(
        config=config,
        insects=prepared.insects,
        left_out=prepared.left_out,
        traces=traces,
        policies=prepared.policies,
        interrupted=interrupted,
    )


def _policy_score(folder: Path, insects: tuple[Insect, ...], problem: HoverProblem) -> PolicyScore:
    """A policy on the insects, shipped or of a run folder."""
    actor, card = load_policy(folder)
    if card.environment != HOVER:
        raise ValueError(f"policy {folder} flies {card.environment}; allowed: policies of {HOVER}")
    if "problem" not in card.task:
        raise ValueError(f"policy {folder}: the task of its card names no problem; allowed: policies of {problem.name}")
    try:
        trained = as_problem(card.task["problem"])
    except (TypeError, ValueError) as mistake:
        raise ValueError(f"policy {folder}: {mistake}") from None
    if trained.box != problem.box or trained.model != problem.model:
        raise ValueError(f"policy {folder} was trained for {trained.name}; allowed: {problem.name}")
    card.require_fit(HoverVectorEnv(1, insect=insects[0], problem=problem))
    gaps = Comparison(insects, problem).gaps(actor)
    told = card.result.get("seconds")
    seconds = float(told) if isinstance(told, int | float) and math.isfinite(told) else None
    return PolicyScore(name=folder.resolve().name, wingbeats=card.wingbeats, seconds=seconds, gaps=gaps)
