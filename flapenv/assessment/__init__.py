"""A stroke of an insect, judged: beside optimum, own stroke and CFD, under other models, within the validated range."""

from flapenv.assessment.assess import StrokeAssessment, assess, assess_another
from flapenv.assessment.rankings import Ranking, rankings
from flapenv.assessment.validity import outside_validated, reynolds_number

__all__ = [
    "Ranking",
    "StrokeAssessment",
    "assess",
    "assess_another",
    "outside_validated",
    "rankings",
    "reynolds_number",
]
