"""Whose strokes, terms, fronts and models the figures of a report show."""

import dataclasses
import json
from collections.abc import Callable
from typing import Any

import pytest

from agents.plots.cycle import forces, terms, waveforms
from agents.plots.front import front
from agents.report import ReportContent
from agents.report.figures import FRONT_WEIGHTS, front_figure, insect_figures, sensitivities_figure
from agents.report.page import report_page
from agents.report.tables import steps_table
from agents.tasks.stroke_verdict import verdict_of
from flapenv import load_insect, optimum
from flapenv.assessment import StrokeAssessment, assess
from flapenv.files import read_strokes, read_wing
from flapenv.problem import HoverProblem, as_problem
from flapenv.trade_off import weight_front

Make = Callable[..., ReportContent]
Take = Callable[[str], Any]
HAWKMOTH = load_insect("hawkmoth")


@pytest.fixture(scope="module")
def judged() -> StrokeAssessment:
    """A stroke that is neither the own nor the optimal one, in a model that is not the default."""
    problem = HoverProblem(model={"profile_drag": 0.3})
    return assess("hawkmoth", dataclasses.replace(optimum("hawkmoth").stroke, pitch_shape=4.0), problem)


def same(placed_json: str, figure: Any) -> bool:
    return bool(json.loads(placed_json) == json.loads(figure.to_json()))


def test_each_curve_is_of_the_stroke_whose_name_it_has(judged: StrokeAssessment) -> None:
    shown, model = insect_figures(judged, "learned", 0), judged.problem.model
    strokes = {"learned": judged.stroke, "optimal": judged.best.stroke, "own": HAWKMOTH.stroke}
    assert same(shown["waveforms"].json, waveforms(HAWKMOTH, strokes, model))
    assert same(shown["forces"].json, forces(HAWKMOTH, strokes, model))
    assert same(shown["terms"].json, terms(HAWKMOTH, judged.stroke, model))
    titles = [note["text"] for note in json.loads(shown["beat"].json)["layout"]["annotations"]]
    assert [title.split("</b>")[0] for title in titles] == ["<b>learned", "<b>own"]
    assert f"{judged.stroke.frequency:.4g} Hz" in titles[0]
    assert f"{HAWKMOTH.stroke.frequency:.4g} Hz" in titles[1]


def test_each_front_is_of_its_own_insect() -> None:
    strokes = [assess(name, optimum(name).stroke) for name in ("ladybird", "bumblebee")]
    wanted = front(strokes, [weight_front(one.insect, FRONT_WEIGHTS, one.problem) for one in strokes])
    shown = front_figure(strokes, "learned")
    assert shown is not None
    assert same(shown.json, wanted)
    other = front(strokes, [weight_front(strokes[0].insect, FRONT_WEIGHTS)] * 2)
    assert other.to_json() != wanted.to_json()


def test_the_heading_says_what_is_needed_and_by_whom(content_of: Make, page_of: Take) -> None:
    content = content_of("bumblebee")
    (one,) = content.verdict.assessments
    assert one.cfd_power is not None
    wanted = (
        f"{one.specific_power:.2f} ± {one.power_uncertainty:.1f} W/kg, own stroke {one.own_specific_power:.1f} W/kg "
        f"(CFD {one.cfd_power:.0f})"
    )
    assert wanted in page_of(report_page(content)).text


def test_without_springs_captions_say_what_is_paid_and_what_cfd_is(content_of: Make, page_of: Take) -> None:
    problem = as_problem("inertial")
    verdict = verdict_of([assess("bumblebee", optimum("bumblebee", problem).stroke, problem)], problem)
    page = page_of(report_page(content_of("bumblebee", verdict=verdict)))
    assert "added mass and inertia together, where it is positive, over the cycle" in page.text
    assert "aerodynamic power over body mass" not in page.text
    assert "Only the translational term counts" not in page.text
    assert "of aerodynamic power, with springs)" in page.text
    assert "atched" not in page.text
    elastic = page_of(report_page(content_of("bumblebee"))).text
    assert "Translational lift over weight and aerodynamic power over body mass" in elastic
    assert "Only the translational term counts" in elastic


def test_a_parameter_that_the_problem_fixes_is_not_said_to_lie_inside() -> None:
    one = assess("bumblebee", None, as_problem("fixed-frequency"))
    table = steps_table([one])
    cells = dict(zip([name for name, _ in table.columns], table.rows[0], strict=True))
    assert (cells["f by 1 %"], cells["φmax by 1°"]) == ("fixed", "fixed")
    assert cells["Cθ by 1"] != "fixed"
    shown = sensitivities_figure([one])
    assert shown is not None
    assert "parameters that the problem fixes have no line" in shown.text
    (bars,) = json.loads(shown.json)["data"]
    assert "f by 1 %" not in bars["y"]
    assert len(bars["y"]) == 5


def test_everything_needed_to_repeat_it_is_in_the_report(content_of: Make, page_of: Take, tmp_path: Any) -> None:
    content = content_of("bumblebee", renamed="robot")
    (one,) = content.verdict.assessments
    page = page_of(report_page(content))
    files = [title for title in page.summaries if title.startswith("The ")]
    at = page.summaries.index(files[0]) - len(page.summaries)
    blocks = dict(zip(files, page.blocks[at:], strict=False))
    for title, name in (("The strokes, a file", "strokes.json"), ("The wing file of robot", "robot.json")):
        text = next(block for summary, block in blocks.items() if summary.startswith(title))
        (tmp_path / name).write_text(text, encoding="utf-8")
    (kept,) = read_strokes(tmp_path / "strokes.json")
    assert (kept.stroke, kept.insect) == (one.stroke, one.insect)
    assert read_wing(tmp_path / "robot.json").problem(HoverProblem()).box == one.problem.box
    assert read_wing(tmp_path / "robot.json").insect == one.insect
    assert HoverProblem(**json.loads(blocks["The problem"])) == one.problem
