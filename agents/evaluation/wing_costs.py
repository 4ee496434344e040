"""What an answer for a wing that nobody saw costs: a policy beside multi-start SLSQP and the batched optimum."""

import time
import warnings
from typing import Any

import numpy as np

from agents.competition.budget import Budget
from agents.competition.competitors import load_libraries, run
from agents.competition.table import median_to_solve
from agents.predictor import Predictor, begin
from flapenv.aero.checks import record
from flapenv.envs import HoverVectorEnv
from flapenv.envs.insect_choice import choose_pool
from flapenv.insects import pick
from flapenv.many_optima import many_optima
from flapenv.problem import HoverProblem
from flapenv.tables import text_table

WINGS, SEARCHED = 10_000, 20
"""Wings of the test split answered at once, and of those how many are searched for one by one."""
SEARCH_BUDGET, SEARCH_GAP = 2_000, 1e-3
"""Wingbeats of a search on one wing, and the gap at which it counts as done [-]."""
REPETITIONS = 5


@record
class WingCost:
    """What one way to an answer costs.

    Attributes:
        name: what answers.
        wings: answered at once.
        wingbeats: evaluations of the model for one wing; None where it is no search, or most searches missed.
        seconds: for one wing [s]; None where most searches missed.
    """

    name: str
    wings: int
    wingbeats: float | None
    seconds: float | None


def wing_costs(policy: Predictor, problem: HoverProblem, seed: int = 0) -> list[WingCost]:
    """Seconds and wingbeats for a new wing by every way; the clock of this machine, on as many threads as it is given.

    The policy's time is that of its network alone, without the beat that shows what it is worth. The batched optimum
    is that of `many_optima`, whose curve is solved once per process and not counted. SLSQP starts afresh from random
    points until its gap to the known optimum is at most `SEARCH_GAP`, the median over wings; without knowing the
    optimum it could not stop there. Where half of the searches spend their budget before that, it has no cost to tell.

    Args:
        policy: observations to actions.
        problem: with a proven bound.
        seed: of the wings and of the starts.
    """
    pool = choose_pool(problem, size=WINGS, seed=seed, split="test", leave_out=None)
    with warnings.catch_warnings():
        warnings.filterwarnings("ignore", message=".*outside the range of the lifting-line")  # wings reach 2.6
        env = HoverVectorEnv(
            WINGS,
            insect="random-wing",
            problem=problem,
            pool_size=WINGS,
            pool_seed=seed,
            pool_split="test",
            infos="none",
            autoreset_mode="DISABLED",
        )
        observations, _ = env.reset(seed=seed)
        costs = [
            WingCost(name="policy", wings=n, wingbeats=0, seconds=_best(policy, observations[:n]) / n)
            for n in (1, WINGS)
        ]
        started = time.perf_counter()
        many_optima(pool, problem)
        took = (time.perf_counter() - started) / WINGS
        costs.append(WingCost(name="batched optimum", wings=WINGS, wingbeats=None, seconds=took))
        load_libraries()
        traces = []
        for number in range(SEARCHED):
            budget = Budget(pick(pool, number), problem, SEARCH_BUDGET)
            traces.append(run("SLSQP", budget, (seed, number)).trace)
    wingbeats, seconds = (number if np.isfinite(number) else None for number in median_to_solve(traces, SEARCH_GAP))
    costs.append(WingCost(name="multi-start SLSQP", wings=1, wingbeats=wingbeats, seconds=seconds))
    return costs


def _best(policy: Predictor, observations: np.ndarray) -> float:
    """The quickest of several answers [s]."""
    best = np.inf
    for _ in range(REPETITIONS):
        started = time.perf_counter()
        begin(policy)
        policy.predict(observations, deterministic=True)
        best = min(best, time.perf_counter() - started)
    return float(best)


def costs_table(costs: list[WingCost], wingbeats: int) -> str:
    """The costs as text, and from how many wings on the training pays.

    Args:
        costs: of `wing_costs`.
        wingbeats: that the policy was trained on.
    """
    rows: list[tuple[str, ...]] = [("a new wing", "answered at once", "wingbeats a wing", "microseconds a wing")]
    for cost in costs:
        beats = "-" if cost.wingbeats is None else f"{cost.wingbeats:,.0f}"
        seconds = "-" if cost.seconds is None else f"{1e6 * cost.seconds:,.3g}"
        rows.append((cost.name, f"{cost.wings:,}", beats, seconds))
    search = costs[-1]
    lines = [text_table(rows)]
    if search.wingbeats is None:
        lines.append(
            f"{search.name}: half or more of {SEARCHED} wings did not get to a gap of {100 * SEARCH_GAP:g} % in "
            f"{SEARCH_BUDGET:,} wingbeats"
        )
    elif search.wingbeats:
        wings = wingbeats / search.wingbeats
        lines.append(
            f"{search.name}: to a gap of {100 * SEARCH_GAP:g} %, median of {SEARCHED} wings; the policy's training "
            f"took as many wingbeats as {wings:,.0f} such searches"
        )
    return "\n".join(lines)


def costs_of(policy: Any, problem: HoverProblem, wingbeats: int) -> tuple[list[dict[str, Any]], str]:
    """The costs as JSON keeps them, and as text; arguments as `wing_costs` and `costs_table`."""
    costs = wing_costs(policy, problem)
    return [vars(cost) for cost in costs], costs_table(costs, wingbeats)
