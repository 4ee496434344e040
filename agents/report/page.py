"""Writes a report: every text escaped, every script named by its hash, nothing that could reach the network."""

import base64
import hashlib
import json
from collections.abc import Sequence
from pathlib import Path
from typing import Any

from jinja2 import Environment, FileSystemLoader, StrictUndefined
from markupsafe import Markup
from plotly.offline import get_plotlyjs

from agents.evaluation.assessment_table import assessment_table
from agents.plots import style
from agents.plots.beat import SCRIPT as BEAT_SCRIPT
from agents.report.content import ReportContent
from agents.report.figures import (
    PlacedFigure,
    curve_figure,
    front_figure,
    insect_figures,
    savings_figure,
    sensitivities_figure,
    strokes_of,
)
from agents.report.files import kept_files
from agents.report.tables import (
    Table,
    models_table,
    outside_tables,
    results_table,
    steps_table,
    strokes_table,
)
from agents.report.words import summary
from agents.run_folder import write_atomically
from flapenv.aero.checks import record
from flapenv.assessment import StrokeAssessment

HERE = Path(__file__).parent
TEMPLATE = "report.html.j2"


@record
class InsectPart:
    """What the report shows of one insect.

    Attributes:
        name: of the insect.
        heading: its powers in a line.
        strokes: the numbers of its strokes.
        beat: the moving wing.
        waveforms: angles over the cycle.
        forces: lift and power over the cycle.
        terms: the same by term.
        flags: what of it lies outside of the validated range.
    """

    name: str
    heading: str
    strokes: Table
    beat: PlacedFigure
    waveforms: PlacedFigure
    forces: PlacedFigure
    terms: PlacedFigure
    flags: Sequence[str]


def write_report(path: Path, content: ReportContent) -> Path:
    """Write the report as one HTML file.

    Args:
        path: the file, replaced in one step.
        content: what it shows.

    Returns:
        The path.

    Raises:
        OSError: if it cannot be written.
    """
    page = report_page(content)
    write_atomically(path, lambda part: part.write_text(page, encoding="utf-8", newline="\n"))
    return path


def report_page(content: ReportContent) -> str:
    """The report as HTML."""
    environment = Environment(
        loader=FileSystemLoader(HERE), autoescape=True, undefined=StrictUndefined, keep_trailing_newline=True
    )
    environment.filters["script_data"] = script_data
    scripts = [get_plotlyjs(), _script(BEAT_SCRIPT), _script(HERE / "report.js")]
    template = environment.get_template(TEMPLATE)
    return template.render(
        content=content,
        policy=security_policy(scripts),
        css=Markup((HERE / "report.css").read_text(encoding="utf-8")),
        scripts=[Markup(script) for script in scripts],
        plot_config=json.dumps(style.config()),
        summary=summary(content),
        picture=None if content.picture is None else base64.b64encode(content.picture).decode("ascii"),
        config=json.dumps(content.config, indent=2, ensure_ascii=False) if content.config else "",
        curve=curve_figure(content),
        files=kept_files(content.verdict.assessments),
        **_of_strokes(content),
    )


def _of_strokes(content: ReportContent) -> dict[str, Any]:
    """What there is to show where single insects' strokes were judged."""
    strokes, called = content.verdict.assessments, content.called
    if not strokes:
        return {"results": None, "insects": (), "savings": None}
    others = [one for one in strokes if not one.is_own]  # an own stroke saves nothing of itself
    return {
        "results": results_table(strokes, called),
        "savings": savings_figure(others, called) if others else None,
        "insects": [_insect_part(one, called, number) for number, one in enumerate(strokes)],
        "front": front_figure(strokes, called),
        "sensitivities": sensitivities_figure(strokes),
        "steps": steps_table(strokes),
        "models": models_table(others) if any(one.rankings for one in others) else None,
        "outside": outside_tables(strokes),
        "repeated": content.verdict.text == assessment_table(strokes, called),
    }


def _insect_part(one: StrokeAssessment, called: str, number: int) -> InsectPart:
    """One insect."""
    return InsectPart(
        name=one.insect.name,
        heading=(
            f"{one.specific_power:.2f}"
            + ("" if one.power_uncertainty is None else f" ± {one.power_uncertainty:.1f}")
            + f" W/kg, own stroke {one.own_specific_power:.1f} W/kg"
            + _told_by_cfd(one)
        ),
        strokes=strokes_table(strokes_of(one, called)),
        flags=one.flags,
        **insect_figures(one, called, number),
    )


def _told_by_cfd(one: StrokeAssessment) -> str:
    """What CFD found for the own stroke, in brackets; where springs are missing here, that CFD has them."""
    if one.cfd_power is None:
        return ""
    springs = "" if one.problem.model.accounting == "elastic" else " of aerodynamic power, with springs"
    return f" (CFD {one.cfd_power:.0f}{springs})"


def script_data(text: str) -> Markup:
    """JSON as it may stand within a script element, which nothing in it can then close."""
    return Markup(text.replace("&", r"\u0026").replace("<", r"\u003c").replace(">", r"\u003e"))


def security_policy(scripts: Sequence[str]) -> str:
    """What the browser lets the page do: run these scripts and no other, show what it holds, and reach nothing."""
    digests = (base64.b64encode(hashlib.sha256(script.encode()).digest()).decode("ascii") for script in scripts)
    allowed = " ".join(f"'sha256-{digest}'" for digest in digests)
    return (
        f"default-src 'none'; script-src {allowed}; style-src 'unsafe-inline'; img-src data: blob:; base-uri 'none'; "
        "form-action 'none'"
    )


def _script(path: Path) -> str:
    """A script of our own, with the line ends that its hash counts."""
    return path.read_text(encoding="utf-8").replace("\r\n", "\n")
