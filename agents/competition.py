"""The equal-budget competition: optimisers and trained policies on the same wings, the same objective, the same count.

Every optimiser gets the same number of wingbeats on every wing and seed; references are solved before the clock starts.
A policy spends its wingbeats once, in training, and one more on each wing it is asked for.
"""

import contextlib
import sys
import warnings
from collections.abc import Sequence
from pathlib import Path
from typing import Any

import numpy as np
from tqdm import tqdm

from agents.budget import Budget, Trace
from agents.comparison import Comparison
from agents.competitors import COMPETITORS, load_libraries, run
from agents.policy_file import load_policy
from agents.run_folder import RESULTS, versions, write_json
from flapenv.aero.checks import record, require_count, require_name
from flapenv.insects import INSECTS, Insect, as_insect, pick
from flapenv.optimum import optimum
from flapenv.problem import HoverProblem, as_problem
from flapenv.tables import text_table
from flapenv.wing_pool import wing_pool

CHECKPOINTS = (10, 100, 1_000, 10_000, 100_000, 1_000_000)
"""Wingbeats at which gaps are read off."""
HOVER = "flapenv/Hover-v0"
SOLVED = 0.001
"""A gap [-] that counts as solved, for the wingbeats and seconds it takes."""


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


@record
class PolicyScore:
    """A trained policy on the same wings.

    Attributes:
        name: of its run folder.
        wingbeats: it was trained with.
        seconds: it was trained for; NaN where its card does not tell.
        gaps: on every wing [-].
    """

    name: str
    wingbeats: int
    seconds: float
    gaps: np.ndarray


@record
class CompetitionResult:
    """What came out.

    Attributes:
        config: what was compared.
        insects: those that could hover.
        left_out: names of those that could not.
        traces: of every competitor, one for each insect and seed.
        policies: the trained policies.
    """

    config: CompetitionConfig
    insects: tuple[Insect, ...]
    left_out: tuple[str, ...]
    traces: dict[str, list[Trace]]
    policies: list[PolicyScore]


def compete(config: CompetitionConfig, *, progress: bool = True) -> CompetitionResult:
    """Let every competitor search on every wing, and ask every policy; Ctrl-C keeps the searches that have ended.

    Args:
        config: what to compare.
        progress: whether to show a progress bar.

    Raises:
        ValueError: if no insect can hover, or a policy belongs to another problem.
        OSError: if a run folder cannot be read.
    """
    import torch

    torch.set_num_threads(1)
    load_libraries()
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
    traces: dict[str, list[Trace]] = {name: [] for name in config.competitors}
    total = len(feasible) * config.seeds * len(config.competitors)
    with (
        tqdm(total=total, disable=not progress, unit=" searches", file=sys.stderr) as bar,
        contextlib.suppress(KeyboardInterrupt),
    ):
        for name in config.competitors:
            for number, insect in enumerate(feasible):
                for seed in range(config.seeds):
                    bar.set_postfix_str(f"{name}, {insect.name}")
                    budget = Budget(insect, config.problem, config.wingbeats)
                    traces[name].append(run(name, budget, (seed, number)).trace)
                    bar.update()
    return CompetitionResult(config=config, insects=feasible, left_out=left_out, traces=traces, policies=policies)


def _policy_score(folder: Path, insects: tuple[Insect, ...], problem: HoverProblem) -> PolicyScore:
    """A policy on the insects, shipped or of a run folder."""
    actor, card = load_policy(folder)
    if card.environment != HOVER:
        raise ValueError(f"policy {folder} flies {card.environment}; allowed: policies of {HOVER}")
    trained = as_problem(card.task["problem"])
    if trained.box != problem.box or trained.model != problem.model:
        raise ValueError(f"policy {folder} was trained for {trained.name}; allowed: {problem.name}")
    gaps = Comparison(insects, problem).gaps(actor)
    seconds = float(card.result.get("seconds", float("nan")))
    return PolicyScore(name=folder.name, wingbeats=card.wingbeats, seconds=seconds, gaps=gaps)


def checkpoints(config: CompetitionConfig) -> list[int]:
    """Wingbeats at which gaps are read off, up to the budget."""
    return [n for n in CHECKPOINTS if n < config.wingbeats] + [config.wingbeats]


def three_quartiles(values: Sequence[Any]) -> tuple[Any, Any, Any]:
    """First quartile, median and third quartile, each one of the values, the larger of two that are as near."""
    ordered = sorted(values)
    low, middle, high = (ordered[int(share * (len(ordered) - 1) + 0.5)] for share in (0.25, 0.5, 0.75))
    return low, middle, high


def quartiles(traces: Sequence[Trace], spent: float, *, of: str = "wingbeats") -> tuple[float, float, float]:
    """Quartiles of the gaps after so many wingbeats or seconds [-]."""
    return three_quartiles([trace.gap_at(spent, of=of) for trace in traces])


def median_to_solve(traces: Sequence[Trace], gap: float = SOLVED) -> tuple[float, float]:
    """Median wingbeats and seconds until the gap was first at most `gap`; inf where half never got there."""
    found = []
    for trace in traces:
        wingbeats = trace.first_below(gap)
        seconds = trace.seconds[trace.wingbeats.index(wingbeats)] if wingbeats is not None else np.inf
        found.append((np.inf if wingbeats is None else float(wingbeats), float(seconds)))
    _, middle, _ = three_quartiles(found)
    return middle


def competition_table(result: CompetitionResult) -> str:
    """Gap against wingbeats, medians with quartiles, and what it takes to solve a wing."""
    marks = checkpoints(result.config)
    header = ("gap after wingbeats [%]", *(f"{n:,}" for n in marks), f"to {100 * SOLVED:g} %", "seconds")
    rows: list[tuple[str, ...]] = [header]
    for name, traces in result.traces.items():
        if not traces:
            continue
        cells = []
        for mark in marks:
            low, middle, high = quartiles(traces, mark)
            cells.append(f"{_percent(middle)} [{_percent(low)}, {_percent(high)}]")
        wingbeats, seconds = median_to_solve(traces)
        solved = ("-", "-") if np.isinf(wingbeats) else (f"{wingbeats:,.0f}", f"{seconds:.2g}")
        rows.append((name, *cells, *solved))
    lines = [text_table(rows)]
    for policy in result.policies:
        low, middle, high = three_quartiles(policy.gaps.tolist())
        lines.append(
            f"policy {policy.name}: {_percent(middle)} [{_percent(low)}, {_percent(high)}] % with one wingbeat a wing, "
            f"after {policy.wingbeats:,} wingbeats of training ({policy.seconds:.0f} s), "
            f"{policy.wingbeats / len(result.insects) + 1:,.0f} a wing over the {len(result.insects)} here"
        )
        lines += [f"  {line}" for line in break_even(result, policy)]
    if result.left_out:
        lines.append(f"left out, cannot hover in this box or lack a wing mass: {', '.join(result.left_out)}")
    return "\n".join(lines)


def wing_table(result: CompetitionResult) -> str:
    """Median wingbeats to solve every wing apart, and the policies' gaps on it."""
    names = [insect.name for insect in result.insects]
    rows: list[tuple[str, ...]] = [(f"wingbeats to {100 * SOLVED:g} %", *names)]
    seeds = result.config.seeds
    for name, traces in result.traces.items():
        cells = []
        for number in range(len(names)):
            own = traces[number * seeds : (number + 1) * seeds]
            wingbeats = median_to_solve(own)[0] if own else np.inf
            cells.append("-" if np.isinf(wingbeats) else f"{wingbeats:,.0f}")
        rows.append((name, *cells))
    rows += [(f"gap of {policy.name} [%]", *(_percent(gap) for gap in policy.gaps)) for policy in result.policies]
    return text_table(rows)


def break_even(result: CompetitionResult, policy: PolicyScore) -> list[str]:
    """How many wings a policy must serve before its training is paid back, against every optimiser that gets as far."""
    _, reached, _ = three_quartiles(policy.gaps.tolist())
    lines = []
    for name, traces in result.traces.items():
        wingbeats, _ = median_to_solve(traces, reached) if traces else (np.inf, np.inf)
        if np.isfinite(wingbeats) and wingbeats > 1:
            wings = policy.wingbeats / (wingbeats - 1)
            lines.append(f"{name} gets there in {wingbeats:,.0f} wingbeats: training pays from {wings:,.0f} wings on")
    return lines


def _percent(gap: float) -> str:
    """A gap as a short percentage."""
    value = 100 * gap
    if not np.isfinite(value):
        return "-"
    return f"{value:.0f}" if value >= 10 else f"{value:.2g}" if value >= 1e-4 else "<1e-4"


def save(result: CompetitionResult, folder: Path) -> None:
    """Keep traces, table and picture.

    Args:
        result: what came out.
        folder: there already, of `open_run_folder`.
    """
    from agents.competition_picture import draw_competition

    config = result.config
    write_json(
        folder / RESULTS,
        {
            "problem": config.problem.to_dict(),
            "insects": [insect.name for insect in result.insects],
            "left_out": list(result.left_out),
            "wingbeats": config.wingbeats,
            "seeds": config.seeds,
            "traces": {name: [vars(trace) for trace in traces] for name, traces in result.traces.items()},
            "policies": [{**vars(policy), "gaps": policy.gaps.tolist()} for policy in result.policies],
            "versions": versions(),
        },
    )
    (folder / "table.txt").write_text(f"{competition_table(result)}\n\n{wing_table(result)}\n", encoding="utf-8")
    draw_competition(result).savefig(folder / "competition.png")
