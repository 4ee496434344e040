"""The verdict on strokes of single insects, whoever chose them."""

from collections.abc import Sequence

from agents.assessment_table import LEARNED, assessment_table
from agents.comparison import mean_gap, worst_gap
from agents.tasks.task import Verdict
from flapenv.assessment import StrokeAssessment
from flapenv.problem import HoverProblem


def verdict_of(results: Sequence[StrokeAssessment], problem: HoverProblem, called: str = LEARNED) -> Verdict:
    """The verdict on strokes of single insects.

    Args:
        results: one an insect.
        problem: that they were assessed in.
        called: what the strokes are, in a word.
    """
    mean = mean_gap(results)
    return Verdict(
        mean=mean,
        worst=worst_gap(results),
        text=assessment_table(results, called),
        results={
            "problem": problem.to_dict(),
            "insects": {one.insect.name: one.to_dict() for one in results},
            "mean_gap_percent": None if mean is None else 100 * mean,
            "infeasible": [one.insect.name for one in results if not one.best.feasible],
        },
        assessments=tuple(results),
    )
