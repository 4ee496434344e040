"""Numbers of the report, the terminal and results.json are the same, and the oracle finds them, too."""

import dataclasses
import json
from collections.abc import Callable
from typing import Any

import pytest

from agents.evaluation.assessment_table import number
from agents.report import ReportContent
from agents.report.page import report_page
from agents.report.tables import models_table, results_table, steps_table, strokes_table
from agents.report.words import span, summary
from flapenv import INSECTS, Stroke, load_insect, optimum
from flapenv.assessment import assess
from flapenv.simulation import evaluate_by_blade_element

Make = Callable[..., ReportContent]


@pytest.fixture(scope="module")
def content(content_of: Make) -> ReportContent:
    return content_of(*INSECTS)


@pytest.fixture(scope="module")
def table(content: ReportContent, page_of: Callable[[str], Any]) -> list[list[str]]:
    rows: list[list[str]] = page_of(report_page(content)).tables["results"]
    return rows


def test_the_table_of_the_report_says_what_results_json_does(content: ReportContent, table: list[list[str]]) -> None:
    kept = json.loads(json.dumps(content.verdict.results))["insects"]
    assert [row[0] for row in table[1:]] == list(INSECTS)
    for name, weight, power, best, bound, gap, cfd, own, own_weight, saved, by_cfd in table[1:]:
        entry = kept[name]
        assert weight == f"{entry['weight_support']:.4f} ± {entry['weight_uncertainty']:.3f}"
        assert power == f"{entry['specific_power']:.2f} ± {entry['power_uncertainty']:.1f}"
        assert best == f"{entry['optimum_specific_power']:.2f}"
        assert bound == f"{entry['lower_bound']:.2f}"
        assert gap == number(entry["gap_percent"], 2)
        assert cfd == f"{entry['cfd_specific_power']:.0f}"
        assert own == f"{entry['own_stroke_specific_power']:.1f}"
        assert own_weight == f"{entry['own_stroke_weight_support']:.3f}"
        assert saved == f"{entry['saving_percent']:.0f} ± {entry['saving_uncertainty_percent']:.0f}"
        assert by_cfd == f"{entry['saving_to_cfd_percent']:.0f}"


def test_the_table_of_the_report_says_what_the_terminal_does(content: ReportContent, table: list[list[str]]) -> None:
    for row in table[1:]:
        line = next(text for text in content.verdict.text.splitlines() if text.startswith(row[0]))
        assert line.split() == " ".join(row).replace("±", " ").split()


def test_the_oracle_finds_the_powers_of_the_report(content: ReportContent, table: list[list[str]]) -> None:
    kept = content.verdict.results["insects"]
    for name in ("fruitfly", "ladybird"):
        stroke = Stroke(**kept[name]["stroke"])
        weight, power = evaluate_by_blade_element(load_insect(name), stroke, strips=6, steps=40_000, spacing="gauss")
        row = next(row for row in table if row[0] == name)
        assert float(row[1].split()[0]) == pytest.approx(weight, abs=1e-4)
        assert float(row[2].split()[0]) == pytest.approx(power, abs=0.006)


def test_a_model_in_which_the_own_stroke_needs_less_is_marked(content_of: Make) -> None:
    strokes = content_of("hawkmoth").verdict.assessments
    table = models_table(strokes)
    cells = dict(zip([name for name, _ in table.columns], table.rows[0], strict=True))
    for ranking in strokes[0].rankings:
        assert cells[ranking.model].startswith("✗") == (not ranking.survives)
    assert cells["positive power"].startswith("✗")
    assert not cells["polhamus"].startswith("✗")


def test_a_wing_without_cfd_says_so() -> None:
    robot = dataclasses.replace(load_insect("hawkmoth"), name="robot", cfd=None)
    row = results_table([assess(robot, optimum("hawkmoth").stroke)], "learned").rows[0]
    assert row[0] == "robot"
    assert row[6] == "none"
    assert float(row[9].split(" ± ")[0]) > float(row[9].split(" ± ")[1]) > 0
    assert row[10] == "none"


def test_strokes_are_told_in_degrees_beside_each_other() -> None:
    table = strokes_table({"learned": optimum("hawkmoth").stroke, "own": load_insect("hawkmoth").stroke})
    rows = {row[0]: row[1:] for row in table.rows}
    assert rows["φmax [°]"] == ("90.00", "60.50")
    assert rows["f [Hz]"][1] == "26.3"


def test_steps_point_to_the_bounds_they_leave(content: ReportContent) -> None:
    best = content.verdict.assessments[2].best
    table = steps_table(content.verdict.assessments)
    arrows = {cell[-1] for cell in table.rows[2][1:] if not cell[-1].isdigit()}
    assert arrows == {"↑"}
    assert sum(cell.endswith("↑") for cell in table.rows[2]) == len(best.active_bounds)


def test_the_summary_says_how_much_how_sure_and_against_what(content: ReportContent) -> None:
    strokes = content.verdict.assessments
    said = " ".join(summary(content))
    by_cfd = span([100 * (one.saving_to_cfd or 0) for one in strokes], 0)
    assert f"That saves {by_cfd} % of the power that CFD found for the own strokes." in said
    assert f"± {span([100 * (one.saving_uncertainty or 0) for one in strokes], 0)} points" in said
    assert f"That saves {span([100 * (one.saving or 0) for one in strokes], 0)} % of the power of the own" in said
    assert "off CFD by 0 to 25 % in weight support and 3 to 17 % in power, which is taken as" in said
    assert "each more than that uncertainty" in said
    assert "not with positive power: hawkmoth" in said
    published = span([100 * one.saving_as_published for one in strokes], 0)
    assert f"That saves {published} % of the power of the strokes as published, which carry " in said
    proven = span([100 * (one.best.gap_to_bound or 0) for one in strokes], 1)
    assert f"The optimum itself lies {proven} % above a proven bound" in said
    assert "the learned stroke needs less than the own stroke in" in said.replace("The", "the")
    assert "outside of what the eight CFD cases cover, listed below; read it with care." in said
    assert "angles" not in said


def test_a_stroke_that_saves_less_than_is_known_is_named(content_of: Make) -> None:
    own = load_insect("hawkmoth").stroke
    nearly = dataclasses.replace(own, pitch_amplitude=own.pitch_amplitude * 1.01)
    said = " ".join(summary(content_of("hawkmoth", "bumblebee", strokes={"hawkmoth": nearly})))
    assert "for all but hawkmoth more than that uncertainty" in said


def test_what_lies_beyond_the_box_is_told_because_a_gap_may_then_be_negative(content_of: Make) -> None:
    best = optimum("hawkmoth").stroke
    steeper = dataclasses.replace(best, pitch_amplitude=best.pitch_amplitude * 1.1)
    said = " ".join(summary(content_of("hawkmoth", strokes={"hawkmoth": steeper})))
    assert "θmax: beyond the problem's box" in said
    assert "beyond the problem's box" not in " ".join(summary(content_of("hawkmoth")))


def test_a_span_of_one_number_is_that_number() -> None:
    assert span([1.004, 0.996], 2) == "1.00"
    assert span([0.5, 1.26], 1) == "0.5 to 1.3"
    assert span([-0.001], 1) == "0.0"
