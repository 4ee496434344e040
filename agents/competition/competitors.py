"""Why not an optimiser? The competitors of a policy, behind one interface: each spends a budget on one wing.

A competitor is a function of a `Budget` and a random generator. It may evaluate points of the cube until the budget is
spent, restarting as often as it likes, and returns nothing: the budget has written down what it found. Settings are the
libraries' own but for what is said here.
"""

import contextlib
import importlib
import math
import warnings
from collections.abc import Callable, Sequence

import numpy as np

from agents.competition.budget import Budget, BudgetSpentError

Competitor = Callable[[Budget, np.random.Generator], None]
RANDOM_BATCH = 64
ASCENT_ROWS, ASCENT_STEPS, ASCENT_RATE = 16, 200, 0.1
"""Gradient ascent: points at once, steps before it starts afresh, Adam's step at first (it falls to zero linearly)."""
DIFFERENCE = 1e-6
"""SLSQP's forward difference, in units of the cube."""


def corner(budget: Budget, rng: np.random.Generator) -> None:
    """The one line that wins in problem A: every parameter where the proof puts it, then f ← f/√Λ, twice.

    The corner: widest amplitude, sharpest waveforms, smallest angle of attack, symmetric rotation. Nothing is searched.
    """
    low, high = (budget.problem.box.bounds(name, budget.insect.reference) for name in ("pitch_phase", "frequency"))
    names = budget.coordinates.names
    point = np.ones(budget.size)
    values, _ = budget.coordinates.decode(point[None], budget.insect.reference)
    stroke = {name: float(value[0]) for name, value in values.items()}
    stroke["pitch_phase"] = float(np.clip(math.pi / 2, *low))
    for _ in range(3):
        weight, _, _ = budget.evaluate(budget.coordinates.encode(stroke, budget.insect.reference))
        if "frequency" not in names:
            return
        stroke["frequency"] = float(np.clip(stroke["frequency"] / math.sqrt(max(weight[0], 1e-9)), *high))


def random_search(budget: Budget, rng: np.random.Generator) -> None:
    """Uniform points of the cube."""
    while True:
        budget.evaluate(rng.uniform(-1, 1, (min(RANDOM_BATCH, max(budget.left, 1)), budget.size)))


def slsqp(budget: Budget, rng: np.random.Generator) -> None:
    """SciPy's SLSQP with the weight as an explicit constraint, forward differences counted, from random starts."""
    from scipy.optimize import minimize

    while True:
        seen: dict[bytes, tuple[np.ndarray, np.ndarray]] = {}

        def local(point: np.ndarray, seen: dict[bytes, tuple[np.ndarray, np.ndarray]] = seen) -> tuple[np.ndarray, ...]:
            """Values and slopes of log P* and Λ."""
            key = point.tobytes()
            if key not in seen:
                steps = np.where(point > 0, -DIFFERENCE, DIFFERENCE)
                weight, power, _ = budget.evaluate(np.concatenate([point[None], point + np.diag(steps)]))
                values = np.stack([np.log(power), weight])
                seen.clear()
                seen[key] = values[:, 0], (values[:, 1:] - values[:, :1]) / steps
            return seen[key]

        minimize(
            lambda point: float(local(point)[0][0]),
            rng.uniform(-1, 1, budget.size),
            jac=lambda point: local(point)[1][0],
            bounds=[(-1.0, 1.0)] * budget.size,
            constraints=[
                {"type": "ineq", "fun": lambda p: local(p)[0][1] - 1, "jac": lambda p: local(p)[1][1]},
            ],
            method="SLSQP",
            options={"maxiter": 200, "ftol": 1e-10},
        )


def cma_es(budget: Budget, rng: np.random.Generator) -> None:
    """CMA-ES (Hansen's `cma`) within the cube, restarted with a doubled population."""
    import cma

    population = 4 + int(3 * math.log(budget.size))
    while True:
        options = {
            "bounds": [-1, 1],
            "seed": int(rng.integers(1, 2**31)),
            "popsize": population,
            "verbose": -9,
            "tolfun": 1e-9,
        }
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")  # it comments on its own numerics
            search = cma.CMAEvolutionStrategy(rng.uniform(-1, 1, budget.size), 0.5, options)
            while not search.stop():
                points = search.ask()
                search.tell(points, budget.cost(np.asarray(points)).tolist())
        population *= 2


def differential_evolution(budget: Budget, rng: np.random.Generator) -> None:
    """SciPy's differential evolution, a generation at once, restarted when it has converged."""
    from scipy.optimize import differential_evolution as evolve

    while True:
        evolve(
            lambda columns: budget.cost(columns.T if columns.ndim == 2 else columns[None]),
            [(-1.0, 1.0)] * budget.size,
            rng=rng,
            vectorized=True,
            updating="deferred",
            polish=False,
            maxiter=10_000,
            tol=1e-8,
        )


def gradient_ascent(budget: Budget, rng: np.random.Generator) -> None:
    """Adam through the differentiable model, on several points at once, from random starts."""
    import torch

    while True:
        points = torch.tensor(rng.uniform(-1, 1, (ASCENT_ROWS, budget.size)), requires_grad=True)
        adam = torch.optim.Adam([points], lr=ASCENT_RATE)
        for step in range(ASCENT_STEPS):
            adam.param_groups[0]["lr"] = ASCENT_RATE * (1 - step / ASCENT_STEPS)
            adam.zero_grad()
            budget.differentiable_cost(points).sum().backward()
            adam.step()
            with torch.no_grad():
                points.clamp_(-1, 1)


COMPETITORS: dict[str, Competitor] = {
    "corner": corner,
    "SLSQP": slsqp,
    "gradient ascent": gradient_ascent,
    "CMA-ES": cma_es,
    "differential evolution": differential_evolution,
    "random search": random_search,
}
"""By name, as tables and pictures call them."""


def load_libraries() -> None:
    """Import what the competitors use, so that no search pays for it."""
    for name in ("cma", "scipy.optimize", "torch"):
        importlib.import_module(name)


def run(name: str, budget: Budget, seed: int | Sequence[int]) -> Budget:
    """Let a competitor spend a budget.

    Args:
        name: of `COMPETITORS`.
        budget: a fresh one.
        seed: of its draws, one number or several.

    Returns:
        The budget, spent, with its trace.
    """
    if not budget.size:  # nothing to choose
        budget.evaluate(np.zeros((1, 0)))
        return budget
    numbers = [seed] if isinstance(seed, int) else list(seed)
    with contextlib.suppress(BudgetSpentError):
        COMPETITORS[name](budget, np.random.default_rng([*numbers, list(COMPETITORS).index(name)]))
    return budget
