"""What a policy learned beside the proven optimum and CFD."""

from collections.abc import Sequence

import numpy as np

from agents.predictor import Predictor, begin
from flapenv.aero.parameters import STROKE_PARAMETERS
from flapenv.aero.stroke import Stroke
from flapenv.assessment import StrokeAssessment, assess
from flapenv.envs import HoverVectorEnv
from flapenv.insects import Insect
from flapenv.problem import HoverProblem


class Comparison:
    """Evaluates policies on every insect of a problem, without noise and in double precision."""

    def __init__(self, insects: Sequence[Insect], problem: HoverProblem) -> None:
        """Make one row for each insect; names must differ."""
        self.env = HoverVectorEnv(
            len(insects),
            insect=list(insects),
            problem=problem,
            autoreset_mode="DISABLED",
            dtype="float64",
        )
        self.names = list(self.env.flyers.names)

    def beat(self, policy: Predictor) -> dict[str, np.ndarray]:
        """The infos of one wingbeat of every insect."""
        observations, _ = self.env.reset(options={"insect": self.names})
        begin(policy)
        actions, _ = policy.predict(observations, deterministic=True)
        return self.env.step(actions)[-1]

    def gaps(self, policy: Predictor) -> np.ndarray:
        """Gap of every feasible insect [-]."""
        info = self.beat(policy)
        return np.asarray(info["optimality_gap"][info["_optimality_gap"]])

    def strokes(self, policy: Predictor) -> list[tuple[Insect, Stroke]]:
        """Every insect with the stroke that the policy chooses for it."""
        info = self.beat(policy)
        return [
            (
                self.env.flyers[number],
                Stroke(**{name: float(info[f"stroke/{name}"][number]) for name in STROKE_PARAMETERS}),
            )
            for number in range(len(self.names))
        ]

    def results(self, policy: Predictor) -> list[StrokeAssessment]:
        """Every insect's learned stroke, evaluated afresh through `flapenv.evaluate` and assessed."""
        return [assess(insect, stroke, self.env.problem) for insect, stroke in self.strokes(policy)]


def mean_gap(results: Sequence[StrokeAssessment]) -> float | None:
    """Mean gap of the feasible insects [-]; None where there is none."""
    gaps = [result.gap for result in results if result.gap is not None]
    return float(np.mean(gaps)) if gaps else None


def worst_gap(results: Sequence[StrokeAssessment]) -> float | None:
    """Largest gap of the feasible insects [-]; None where there is none."""
    return max((result.gap for result in results if result.gap is not None), default=None)
