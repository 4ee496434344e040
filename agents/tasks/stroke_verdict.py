"""The verdict on strokes of single insects, whoever chose them."""

from collections.abc import Sequence
from typing import Any

from agents.evaluation.assessment_table import LEARNED, assessment_table
from agents.evaluation.comparison import mean_gap, worst_gap
from agents.tasks.task import Verdict
from flapenv.assessment import StrokeAssessment
from flapenv.insects import Insect, described
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
            "insects": {one.insect.name: _entry(one, problem) for one in results},
            "mean_gap_percent": None if mean is None else 100 * mean,
            "infeasible": [one.insect.name for one in results if not one.best.feasible],
        },
        assessments=tuple(results),
    )


def _entry(one: StrokeAssessment, problem: HoverProblem) -> dict[str, Any]:
    """An insect's entry of results.json, with all that it takes to judge the stroke again."""
    own_problem = {} if one.problem == problem else {"problem": one.problem.to_dict()}
    return {**one.to_dict(), **_own_insect(one.insect), **own_problem}


def _own_insect(insect: Insect) -> dict[str, Any]:
    """The numbers of an insect that is none of the eight, where a file can hold them."""
    try:
        told = described(insect)
    except TypeError:  # its planform is a function
        return {}
    return {} if isinstance(told, str) else {"insect": told}
