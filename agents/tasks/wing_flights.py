"""A policy on a pool of random wings: gaps to every wing's own optimum, and the error in frequency they are made of."""

import math
import warnings

import numpy as np

from agents.predictor import Predictor, begin
from flapenv.aero.checks import record, shown
from flapenv.envs import HoverVectorEnv
from flapenv.envs.insect_choice import choose_pool
from flapenv.many_optima import many_optima
from flapenv.problem import HoverProblem
from flapenv.wing_pool import Split

MOST_OF_THEM = 95.0
"""The percentile that is told beside the mean [%]."""


@record
class WingFlights:
    """One wingbeat of a policy on every wing of a pool; arrays of shape (n,).

    Attributes:
        feasible: which wings of the pool some stroke of the box lifts, shape (pool,); the others are left out of what
            follows.
        gaps: to the optimum of the box, missing weight charged [-].
        weight_support: Λ [-].
        frequency_error: log of f over the optimum's [-]; 0 where the problem fixes f.
    """

    feasible: np.ndarray
    gaps: np.ndarray
    weight_support: np.ndarray
    frequency_error: np.ndarray

    @property
    def mean(self) -> float:
        """Mean gap [-]."""
        return float(np.mean(self.gaps))

    @property
    def most(self) -> float:
        """95th percentile of the gaps [-]."""
        return float(np.percentile(self.gaps, MOST_OF_THEM))

    @property
    def rms_frequency_error(self) -> float:
        """Root mean square of the frequency's error [-]."""
        return math.sqrt(float(np.mean(self.frequency_error**2)))

    def to_dict(self) -> dict[str, float | int]:
        """As results.json keeps it."""
        return {
            "wings": len(self.gaps),
            "infeasible": int(np.sum(~self.feasible)),
            "mean_gap_percent": 100 * self.mean,
            "median_gap_percent": 100 * float(np.median(self.gaps)),
            "p95_gap_percent": 100 * self.most,
            "worst_gap_percent": 100 * float(np.max(self.gaps)),
            "rms_frequency_error_percent": 100 * self.rms_frequency_error,
            "mean_frequency_error_percent": 100 * float(np.mean(self.frequency_error)),
            "rms_weight_support_error_percent": 100 * math.sqrt(float(np.mean((self.weight_support - 1) ** 2))),
            "least_weight_support": float(np.min(self.weight_support)),
        }


class WingPool:
    """A split of random wings with all of their optima, flown by one policy after the other."""

    def __init__(self, size: int, *, split: Split, problem: HoverProblem, seed: int) -> None:
        """Draw the wings and solve them.

        Args:
            size: number of wings.
            split: "train", "test" or "outside".
            problem: with a proven bound.
            seed: of the pool.

        Raises:
            ValueError: for a problem without a proven bound, or one in which no wing hovers.
        """
        with warnings.catch_warnings():
            warnings.filterwarnings("ignore", message=".*outside the range of the lifting-line")  # AR 2.2 and 2.6
            self.env = HoverVectorEnv(
                size,
                insect="random-wing",
                problem=problem,
                pool_size=size,
                pool_seed=seed,
                pool_split=split,
                gap_to="optimum",
                autoreset_mode="DISABLED",
                dtype="float64",
            )
            self.best = many_optima(choose_pool(problem, size=size, seed=seed, split=split, leave_out=None), problem)
        if not np.any(self.best.feasible):
            raise ValueError(
                f"problem = {shown(problem.name)} lets none of {size} {split} wings hover; allowed: wider bounds"
            )

    def fly(self, policy: Predictor) -> WingFlights:
        """One noise-free wingbeat of every wing."""
        observations, _ = self.env.reset(options={"insect": list(self.env.flyers.names)})
        begin(policy)
        actions, _ = policy.predict(observations, deterministic=True)
        info = self.env.step(actions)[-1]
        known = info["_optimality_gap"]
        error = np.log(info["stroke/frequency"] / self.best.stroke.frequency)
        return WingFlights(
            feasible=known,
            gaps=info["optimality_gap"][known],
            weight_support=info["weight_support"][known],
            frequency_error=np.broadcast_to(error, known.shape)[known],
        )
