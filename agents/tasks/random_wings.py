"""Hover-v0 with random wings: one policy for every wing, judged on wings that it never saw."""

from functools import cached_property
from typing import TYPE_CHECKING, Any

from agents.evaluation.assessment_table import assessment_table
from agents.evaluation.comparison import Comparison
from agents.predictor import Predictor
from agents.tasks.task import Verdict
from agents.tasks.wing_flights import WingFlights, WingPool
from flapenv.aero.checks import record, require_count, shown
from flapenv.envs import HoverVectorEnv
from flapenv.insects import INSECTS, as_insect, described, load_insect
from flapenv.problem import as_problem
from flapenv.tables import text_table

if TYPE_CHECKING:
    from matplotlib.figure import Figure

TEST_WINGS, GLANCE_WINGS = 10_000, 1_000


@record
class RandomWingsTask:
    """Hover with the least power, whatever the wing.

    Attributes:
        problem: by name, as a `HoverProblem` or as the dict of one; with a proven bound.
        pool_size: wings to learn from.
        pool_seed: which pool; test wings are another split of it.
        leave_out: an insect whose like is not learned from, or None.
    """

    problem: Any = "free-frequency"
    pool_size: int = 16_384
    pool_seed: int = 0
    leave_out: Any = None

    environment = "flapenv/Hover-v0"
    distance = f"gap to the optimum, {TEST_WINGS:,} test wings"

    def __post_init__(self) -> None:
        """Resolve the problem and the insect, which may be dicts as from config.json; check the rest."""
        object.__setattr__(self, "problem", as_problem(self.problem))
        if not self.problem.model.has_proven_bound:
            raise ValueError(
                f"problem = {shown(self.problem.name)} proves no bound; allowed: problems with a proven bound"
            )
        object.__setattr__(self, "pool_size", require_count("pool_size", self.pool_size))
        object.__setattr__(self, "pool_seed", require_count("pool_seed", self.pool_seed, low=0))
        if self.leave_out is not None:
            object.__setattr__(self, "leave_out", as_insect(self.leave_out))

    def vector_env(self, rows: int) -> HoverVectorEnv:
        """The environment to train in."""
        return HoverVectorEnv(
            rows,
            insect="random-wing",
            problem=self.problem,
            pool_size=self.pool_size,
            pool_seed=self.pool_seed,
            leave_out=self.leave_out,
            autoreset_mode="SAME_STEP",
            infos="none",
        )

    def pool(self, split: Any, size: int) -> WingPool:
        """Wings with their optima."""
        return WingPool(size, split=split, problem=self.problem, seed=self.pool_seed)

    @cached_property
    def _few(self) -> WingPool:
        return self.pool("test", GLANCE_WINGS)

    @cached_property
    def _pools(self) -> dict[str, WingPool]:
        return {split: self.pool(split, TEST_WINGS) for split in ("test", "outside")}

    def glance(self, policy: Predictor) -> tuple[float, float]:
        """Mean and 95th percentile of the gaps of a thousand test wings."""
        flights = self._few.fly(policy)
        return flights.mean, flights.most

    @cached_property
    def insects(self) -> Comparison:
        """The eight insects, or the one that was left out."""
        chosen = [load_insect(name) for name in INSECTS] if self.leave_out is None else [self.leave_out]
        return Comparison(chosen, self.problem)

    def judge(self, policy: Predictor) -> Verdict:
        """The test split, wings outside of the range that was trained on, and the insects."""
        flown = {split: pool.fly(policy) for split, pool in self._pools.items()}
        insects, test = self.insects.results(policy), flown["test"]
        which = "the insects, on none of which it was trained" if self.leave_out is None else "the species left out"
        return Verdict(
            mean=test.mean,
            worst=test.most,
            text=f"{wings_table(flown)}\n\n{which}:\n{assessment_table(insects)}",
            results={
                "problem": self.problem.to_dict(),
                "wings": {split: flights.to_dict() for split, flights in flown.items()},
                "insects": {one.insect.name: one.to_dict() for one in insects},
            },
            assessments=tuple(insects),
        )

    def draw(self, policy: Predictor) -> "Figure":
        """Gaps and frequency errors over aspect ratio."""
        from agents.tasks.wings_picture import draw_wings

        return draw_wings({split: (pool, pool.fly(policy)) for split, pool in self._pools.items()})

    def to_dict(self) -> dict[str, Any]:
        """As config.json keeps it."""
        return {
            "problem": self.problem.to_dict(),
            "pool_size": self.pool_size,
            "pool_seed": self.pool_seed,
            "leave_out": None if self.leave_out is None else described(self.leave_out),
        }


def wings_table(flown: dict[str, WingFlights]) -> str:
    """Gaps, weight support and errors, one line a split; wings that cannot hover are counted, not averaged."""
    header = (
        "random wings",
        "number",
        "infeasible",
        "mean gap",
        "median",
        "95 %",
        "worst",
        "rms error:",
        "weight",
        "least weight",
    )
    units = ("", "", "", "%", "%", "%", "%", "f %", "support %", "support")
    rows: list[tuple[str, ...]] = [header, units]
    for split, flights in flown.items():
        row = flights.to_dict()
        gaps = (row[f"{name}_gap_percent"] for name in ("mean", "median", "p95", "worst"))
        rows.append(
            (
                split,
                f"{len(flights.gaps):,}",
                f"{row['infeasible']:,}",
                *(f"{gap:.3f}" for gap in gaps),
                f"{100 * flights.rms_frequency_error:.3f}",
                f"{row['rms_weight_support_error_percent']:.3f}",
                f"{row['least_weight_support']:.4f}",
            )
        )
    return text_table(rows, header_rows=2)
