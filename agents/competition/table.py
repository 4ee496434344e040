"""The equal-budget competition as text: gaps against wingbeats, what solving a wing takes, and when training pays."""

from collections.abc import Sequence
from typing import Any

import numpy as np

from agents.competition.budget import Trace
from agents.competition.compete import CompetitionConfig, CompetitionResult, PolicyScore
from flapenv.tables import text_table

CHECKPOINTS = (10, 100, 1_000, 10_000, 100_000, 1_000_000)
"""Wingbeats at which gaps are read off."""
SOLVED = 0.001
"""A gap [-] that counts as solved, for the wingbeats and seconds it takes."""


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
        took = "" if policy.seconds is None else f" ({policy.seconds:.0f} s)"
        lines.append(
            f"policy {policy.name}: {_percent(middle)} [{_percent(low)}, {_percent(high)}] % with one wingbeat a wing, "
            f"after {policy.wingbeats:,} wingbeats of training{took}, "
            f"{policy.wingbeats / len(result.insects) + 1:,.0f} a wing over the {len(result.insects)} here"
        )
        lines += [f"  {line}" for line in break_even(result, policy)]
    if result.left_out:
        lines.append(f"left out, cannot hover in this box or lack a wing mass: {', '.join(result.left_out)}")
    if result.interrupted:
        lines.append("stopped early: of the searches that had ended by then")
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
        if wingbeats <= 1:
            lines.append(f"{name} gets there in one wingbeat: training never pays")
        elif np.isfinite(wingbeats):
            wings = policy.wingbeats / (wingbeats - 1)
            lines.append(f"{name} gets there in {wingbeats:,.0f} wingbeats: training pays from {wings:,.0f} wings on")
    return lines


def _percent(gap: float) -> str:
    """A gap as a short percentage."""
    value = 100 * gap
    if not np.isfinite(value):
        return "-"
    return f"{value:.0f}" if value >= 10 else f"{value:.2g}" if value >= 1e-4 else "<1e-4"
