"""The files that a report holds, so that what it shows can be repeated from it alone."""

import dataclasses
import functools
from collections.abc import Callable, Sequence

from flapenv.aero.checks import one_line
from flapenv.assessment import StrokeAssessment
from flapenv.files import NamedStroke, WingFile, strokes_to_text
from flapenv.files.wings import wing_to_text
from flapenv.insects import INSECTS
from flapenv.problem import StrokeBox
from flapenv.whole_file import json_text


def kept_files(strokes: Sequence[StrokeAssessment]) -> list[tuple[str, str]]:
    """Titles and texts: the strokes at full precision, wings that are not the package's, and the problem.

    Args:
        strokes: one an insect.
    """
    if not strokes:
        return []
    files = [("The strokes, a file for train.py evaluate", _written(lambda: _strokes(strokes)))]
    files += [
        (f"The wing file of {one.insect.name}, for --wing", _written(functools.partial(_wing, one)))
        for one in strokes
        if one.insect.name not in INSECTS
    ]
    return [*files, ("The problem", _written(lambda: json_text(strokes[0].problem.to_dict())))]


def _written(text: Callable[[], str]) -> str:
    """A file's text, or why it has none."""
    try:
        return text()
    except (ValueError, TypeError) as mistake:  # a planform or coefficients that are functions
        return f"It cannot be written to a file: {one_line(mistake)}"


def _strokes(strokes: Sequence[StrokeAssessment]) -> str:
    """The strokes with their insects."""
    return strokes_to_text([NamedStroke(stroke=one.stroke, insect=one.insect) for one in strokes])


def _wing(one: StrokeAssessment) -> str:
    """The wing with the limits that its box has beside the widest."""
    box, widest = one.problem.box, StrokeBox()
    fields = [field.name for field in dataclasses.fields(box)]
    limits = {name: bounds for name in fields if (bounds := getattr(box, name)) not in (None, getattr(widest, name))}
    return wing_to_text(WingFile(insect=one.insect, limits=limits))
