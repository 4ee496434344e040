"""What a report is made of."""

from collections.abc import Mapping, Sequence
from typing import Any

from agents.evaluation.assessment_table import LEARNED
from agents.tasks.task import Verdict
from flapenv.aero.checks import record


@record
class ReportContent:
    """Everything that a report shows.

    Attributes:
        title: of the page: what was judged.
        about: one line below it.
        verdict: on it.
        distance: what `verdict.mean` is, in a few words.
        called: what the strokes are, in a word.
        told: what else was found, each a table or a few lines as a terminal shows them.
        picture: the task's picture, a PNG file's bytes; None to leave it out.
        curve: points of the learning curve, from `agents.curve_picture.read_curve`; empty where nothing was trained.
        missing: what could not be shown and why, a sentence each.
        facts: what is needed to repeat it, by name, in the order shown: command, seed, versions.
        config: the rest of it, as JSON keeps it; empty for none.
    """

    title: str
    about: str
    verdict: Verdict
    distance: str
    called: str = LEARNED
    told: Sequence[str] = ()
    picture: bytes | None = None
    curve: Sequence[Mapping[str, float]] = ()
    missing: Sequence[str] = ()
    facts: Mapping[str, str]
    config: Mapping[str, Any]
