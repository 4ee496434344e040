"""What rewards and gaps are measured against: the optima of a few insects one by one, or of a pool of wings at once."""

from collections.abc import Sequence
from typing import Literal

import numpy as np

from flapenv.aero.checks import record, require_name, shown
from flapenv.case import HoverCase, hover_case, stack_cases
from flapenv.insects import Insect, pick
from flapenv.many_optima import GRID, many_optima
from flapenv.optimum import Optimum, optimum
from flapenv.problem import HoverProblem

GapTo = Literal["bound", "optimum"]
GAPS_TO: tuple[GapTo, ...] = ("bound", "optimum")
COARSE_GRID = 24
"""Points of the curve of optima that give multipliers of a pool to a percent."""


@record
class References:
    """Of several insects in one problem; arrays of shape (n,).

    Attributes:
        feasible: whether any stroke of the box carries the weight.
        power: P*_ref, the proven bound, or the best stroke's power where none is proven [W/kg].
        best_power: P* of the best stroke [W/kg]; NaN where it was not asked for.
        multiplier: dP*/dΛ of the best stroke [W/kg]; inf at the limit of lift.
    """

    feasible: np.ndarray
    power: np.ndarray
    best_power: np.ndarray
    multiplier: np.ndarray


class Flyers:
    """The insects an environment or an objective scores: a few by name, or a pool as one insect with array fields.

    Attributes:
        names: what infos call them, shape (n,) of str.
        cases: their numbers under the problem's model, array fields of shape (n,).
        r1_hat: r̂₁ of their wings, shape (n,) [-].
        optima: of each insect, where they are given one by one; empty for a pool.
        references: what is measured against.
    """

    def __init__(self, insects: Sequence[Insect] | Insect, problem: HoverProblem, *, gap_to: GapTo = "optimum") -> None:
        """Reduce the insects to numbers and solve their references, once per process.

        Args:
            insects: at least one, or an `Insect` with array fields of shape (n,), as `wing_pool` gives.
            problem: the box and the model.
            gap_to: whether a pool's best powers are wanted ("optimum") or the bounds alone, which takes less time.
                Insects one by one have both.

        Raises:
            ValueError: for an unknown gap_to, or a pool in a problem without a proven bound, where every wing
                would have to be solved alone.
        """
        require_name("gap_to", gap_to, GAPS_TO)
        self.optima: tuple[Optimum, ...] = ()
        self._insects = insects
        self.cases: HoverCase
        if isinstance(insects, Insect):
            if not problem.model.has_proven_bound:
                raise ValueError(
                    f"problem = {shown(problem.name)} proves no bound, and the wings of a pool would have to be solved "
                    "one by one; allowed: coefficients 'lifting-line' or 'extended-lifting-line', elastic power"
                )
            self.cases = hover_case(insects, problem.model)
            self.r1_hat = np.asarray(insects.wing.r1_hat)
            self.names = np.array([f"{insects.name}-{number}" for number in range(len(self.r1_hat))], dtype=object)
            exact = gap_to == "optimum"
            best = many_optima(insects, problem, points=GRID if exact else COARSE_GRID)
            assert best.lower_bound is not None
            self.references = References(
                feasible=best.feasible,
                power=best.lower_bound,
                best_power=best.specific_power if exact else np.full(len(self.names), np.nan),
                multiplier=best.multiplier,
            )
            return
        self.optima = tuple(optimum(insect, problem) for insect in insects)
        self.cases = stack_cases([hover_case(insect, problem.model) for insect in insects])
        self.r1_hat = np.array([insect.wing.r1_hat for insect in insects])
        self.names = np.array([insect.name for insect in insects], dtype=object)
        self.references = References(
            feasible=np.array([best.feasible for best in self.optima]),
            power=np.array([best.reference_power for best in self.optima]),
            best_power=np.array([best.specific_power for best in self.optima]),
            multiplier=np.array([best.multiplier for best in self.optima]),
        )

    def __len__(self) -> int:
        """How many."""
        return len(self.names)

    def __getitem__(self, number: int) -> Insect:
        """One of them, with scalar fields."""
        return pick(self._insects, number) if isinstance(self._insects, Insect) else self._insects[number]
