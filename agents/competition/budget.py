"""One wing, one budget of wingbeats: what a competitor sees of a problem, and what is noted of its search."""

import time
from dataclasses import dataclass, field
from typing import Any

import numpy as np

from flapenv.aero.arrays import as_numpy
from flapenv.coordinates import StrokeCoordinates
from flapenv.insects import Insect
from flapenv.objective import HoverObjective
from flapenv.problem import HoverProblem

CARRIED = 1e-4
"""Weight support short of one by no more than this is feasible; what is missing is charged as in the environment."""
GRADIENT_COST = 3
"""Wingbeats that one evaluation with its gradient counts: one forward, two more for the way back."""
EXACT = 1e-9
"""Of the averages: gaps are told to a millionth, and the optimum is as exact."""


class BudgetSpentError(Exception):
    """Raised where a competitor asks for more wingbeats than it has; ends its search."""


@dataclass
class Trace:
    """What a search has found by when; one entry for each improvement.

    Attributes:
        wingbeats: spent at each improvement.
        seconds: by the clock from when the budget was made to each improvement.
        gaps: best feasible gap so far [-].
    """

    wingbeats: list[int] = field(default_factory=list)
    seconds: list[float] = field(default_factory=list)
    gaps: list[float] = field(default_factory=list)

    def gap_at(self, spent: float, *, of: str = "wingbeats") -> float:
        """The best gap [-] after so many wingbeats or seconds; inf before the first."""
        number = int(np.searchsorted(getattr(self, of), spent, side="right"))
        return self.gaps[number - 1] if number else float("inf")

    def first_below(self, gap: float) -> int | None:
        """Wingbeats until the gap was first at most `gap`; None where it never was."""
        return next((n for n, found in zip(self.wingbeats, self.gaps, strict=True) if found <= gap), None)


class Budget:
    """The exact-penalty objective of one insect in the environment's action coordinates, counted.

    A point is an action in [-1, 1]^n. Every evaluation of one stroke on one wing counts one wingbeat, one with a
    gradient `GRADIENT_COST`. What is written down is the best feasible gap so far: power over the optimum, minus
    one, of strokes that carry the weight to 1e-4, with the environment's charge for what they miss.
    """

    def __init__(self, insect: Insect, problem: HoverProblem, wingbeats: int) -> None:
        """Solve the references (not counted) and start the clock.

        Args:
            insect: the insect, which must be able to hover.
            problem: the problem.
            wingbeats: budget.

        Raises:
            ValueError: if no stroke of the box carries the weight: there is no gap then.
        """
        self.objective = HoverObjective([insect], problem, tolerance=EXACT)
        self.best = self.objective.flyers.optima[0]
        if not self.best.feasible:
            raise ValueError(
                f"{insect.name} cannot hover in {problem.name} (largest weight support "
                f"{self.best.max_weight_support:.3f}); allowed: insects with a gap to speak of"
            )
        self.insect, self.problem, self.wingbeats = insect, problem, wingbeats
        self.coordinates = StrokeCoordinates(problem.box)
        self.spent, self.trace = 0, Trace()
        self._started = time.perf_counter()

    @property
    def size(self) -> int:
        """Number of axes."""
        return len(self.coordinates)

    @property
    def left(self) -> int:
        """Wingbeats left."""
        return self.wingbeats - self.spent

    def evaluate(self, points: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        """Λ, P* and the cost -reward (without floor) of strokes at points (m, n), shape (m,) each.

        Raises:
            BudgetSpentError: if the budget holds fewer than m wingbeats; nothing is evaluated then.
        """
        points = np.atleast_2d(points)
        self._spend(len(points))
        strokes, _ = self.coordinates.decode(points, self.insect.reference)
        score = self.objective.score(np.zeros(len(points), dtype=np.intp), strokes)
        self._note(score.specific_power, score.weight_support)
        return score.weight_support, score.specific_power, -(score.power_term + score.lift_term)

    def cost(self, points: np.ndarray) -> np.ndarray:
        """The cost alone; see `evaluate`."""
        return self.evaluate(points)[2]

    def differentiable_cost(self, points: Any) -> Any:
        """The cost of a tensor of points (m, n) with its gradient, `GRADIENT_COST` wingbeats each, shape (m,)."""
        self._spend(GRADIENT_COST * len(points))
        strokes, _ = self.coordinates.decode(points, self.insect.reference)
        weight, power, cost = self.objective.cost(np.zeros(len(points), dtype=np.intp), strokes)
        self._note(as_numpy(power), as_numpy(weight))
        return cost

    def _spend(self, wingbeats: int) -> None:
        if wingbeats > self.left:
            raise BudgetSpentError
        self.spent += wingbeats

    def _note(self, power: np.ndarray, weight: np.ndarray) -> None:
        """Write an improvement down; NaN never is one, nor a stroke that drops the wing."""
        carried = (weight >= 1 - CARRIED) & np.isfinite(power)
        charge = self.objective.gap_charge[0] * np.maximum(0, 1 - weight)
        best = float(np.min(np.where(carried, power / self.best.specific_power - 1 + charge, np.inf)))
        if best < (self.trace.gaps[-1] if self.trace.gaps else np.inf):
            self.trace.wingbeats.append(self.spent)
            self.trace.seconds.append(time.perf_counter() - self._started)
            self.trace.gaps.append(best)
