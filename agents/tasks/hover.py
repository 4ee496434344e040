"""Hover-v0 with named insects, or a user's own: one policy for all of them, beside optimum, bound and CFD."""

from functools import cached_property
from typing import TYPE_CHECKING, Any

import numpy as np

from agents.evaluation.comparison import Comparison
from agents.predictor import Predictor
from agents.tasks.stroke_verdict import verdict_of
from agents.tasks.task import Verdict
from flapenv.aero.checks import record, shown
from flapenv.envs import HoverVectorEnv
from flapenv.envs.insect_choice import listed_insects
from flapenv.insects import described
from flapenv.problem import as_problem

if TYPE_CHECKING:
    from matplotlib.figure import Figure


@record
class HoverTask:
    """Hover with the least power, a few insects by name.

    Attributes:
        insects: "all", a name, an `Insect`, the dict of one, or a list of these.
        problem: by name, as a `HoverProblem` or as the dict of one.
    """

    insects: Any = "all"
    problem: Any = "free-frequency"

    environment = "flapenv/Hover-v0"
    distance = "gap to the optimum"

    def __post_init__(self) -> None:
        """Resolve insects and problem, which may be dicts as from config.json."""
        object.__setattr__(self, "insects", listed_insects(self.insects))
        object.__setattr__(self, "problem", as_problem(self.problem))
        if self.problem.model.accounting == "positive":
            light = [insect.name for insect in self.insects if insect.wing.mass is None]
            if light:
                raise ValueError(
                    f"problem = {shown(self.problem.name)} needs wing masses, which {', '.join(light)} lack"
                )

    def vector_env(self, rows: int) -> HoverVectorEnv:
        """The environment to train in."""
        return HoverVectorEnv(
            rows, insect=list(self.insects), problem=self.problem, autoreset_mode="SAME_STEP", infos="none"
        )

    @cached_property
    def comparison(self) -> Comparison:
        """What evaluates every insect without noise in double precision."""
        return Comparison(self.insects, self.problem)

    def glance(self, policy: Predictor) -> tuple[float, float]:
        """Mean and largest gap of the feasible insects; NaN where there is none."""
        gaps = self.comparison.gaps(policy)
        return (float(np.mean(gaps)), float(np.max(gaps))) if len(gaps) else (float("nan"), float("nan"))

    def judge(self, policy: Predictor) -> Verdict:
        """Every insect's learned stroke beside its references."""
        return verdict_of(self.comparison.results(policy), self.problem)

    def draw(self, policy: Predictor) -> "Figure":
        """The learned over the optimal strokes."""
        from agents.tasks.hover_picture import draw_strokes

        return draw_strokes(self.comparison.results(policy))

    def to_dict(self) -> dict[str, Any]:
        """As config.json keeps it.

        Raises:
            TypeError: for an insect that no file can hold.
        """
        return {"insects": [described(insect) for insect in self.insects], "problem": self.problem.to_dict()}
