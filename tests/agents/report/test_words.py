"""Sentences of the summary where something is not as in the default run."""

import dataclasses
from collections.abc import Callable

import pytest

from agents.report import ReportContent
from agents.report.figures import savings_figure
from agents.report.tables import models_table, outside_tables
from agents.report.words import saved, small_span, summary
from flapenv import Stroke, load_insect, optimum
from flapenv.assessment import assess
from flapenv.assessment.validity import ANGLES, CASES, Quantity

Make = Callable[..., ReportContent]


def said(content: ReportContent) -> str:
    return " ".join(summary(content))


def slower(name: str, share: float) -> Stroke:
    """The optimal stroke, beaten more slowly."""
    best = optimum(name).stroke
    return dataclasses.replace(best, frequency=share * best.frequency)


def test_one_insect_is_told_in_the_singular(content_of: Make) -> None:
    text = said(content_of("hawkmoth"))
    assert "The learned stroke of hawkmoth carries 1.0000 of the weight" in text
    assert "points: more than that uncertainty." in text
    assert "of the power of the stroke as published, which carries" in text
    assert "Gap to the optimum: 0.000 %." in text
    for word in ("each more", "mean ", "worst", "own strokes"):
        assert word not in text


def test_a_stroke_that_does_not_carry_the_weight_saves_nothing_unqualified(content_of: Make) -> None:
    for share, light in ((0.999, False), (0.9, True)):
        text = said(content_of("hawkmoth", strokes={"hawkmoth": slower("hawkmoth", share)}))
        assert ("The full weight is not carried by hawkmoth." in text) == light
        assert ("(as found, hawkmoth does not carry it)" in text) == light
        assert ("as published" in text) != light


def test_what_needs_more_power_is_not_said_to_save_less_than_nothing(content_of: Make) -> None:
    assert saved({"a": -0.2}) == "needs 20 % more than"
    assert saved({"a": 0.1, "b": 0.3}) == "saves 10 to 30 % of"
    assert saved({"a": 0.1, "b": -0.05}) == "needs more for b (5 %) and else saves 10 % of"
    wasteful = dataclasses.replace(load_insect("hawkmoth").stroke, pitch_phase=1.0)
    text = said(content_of("hawkmoth", strokes={"hawkmoth": wasteful}))
    assert "% more than the power of the own stroke, both beaten" in text
    assert "saves -" not in text


def test_a_wing_of_one_s_own_has_a_reference_stroke_and_nothing_published(content_of: Make) -> None:
    text = said(content_of("hawkmoth", renamed="robot"))
    assert "the reference stroke, which carries" in text
    assert "as published" not in text


def test_nobody_has_run_cfd_is_said_only_of_strokes_that_are_not_own(content_of: Make) -> None:
    mixed = content_of("hawkmoth", "bumblebee", strokes={"hawkmoth": load_insect("hawkmoth").stroke})
    assert "nobody has run CFD on the strokes that are not the insects' own." in said(mixed)
    own = content_of("hawkmoth", strokes={"hawkmoth": load_insect("hawkmoth").stroke})
    assert "nobody" not in said(own)


def test_small_uncertainties_do_not_read_nothing() -> None:
    assert small_span([0.4821, 12]) == "0.5 to 12.0"
    assert small_span([0.021]) == "0.02"
    assert small_span([3.2, 12]) == "3 to 12"


def test_the_worst_insect_is_named(content_of: Make) -> None:
    content = content_of("hawkmoth", "bumblebee", strokes={"bumblebee": slower("bumblebee", 1.05)})
    text = said(content)
    assert f"worst {100 * (content.verdict.worst or 0):.3f} % (bumblebee)." in text


def test_angles_are_the_model_s_and_cfd_cases_are_cfd_s(content_of: Make) -> None:
    best = optimum("hawkmoth").stroke
    flat = dataclasses.replace(best, pitch_amplitude=1.3)
    content = content_of("hawkmoth", strokes={"hawkmoth": flat})
    one = content.verdict.assessments[0]
    captions = {table.caption: [row[0] for row in table.rows] for table in outside_tables([one])}
    angles = [quantity.name for quantity in one.outside if quantity.basis == ANGLES]
    assert len(angles) == 1
    assert captions["Angles for which the model is not called accurate"] == angles
    assert angles[0] not in captions["What no CFD case covers"]
    assert "θmax" in captions["What lies beyond the problem's box, where the optimum was not sought"]
    assert f"{angles[0]}: outside of the angles for which the model is called accurate." in said(content)
    inside = Quantity(name="Re", value=9.0, low=1.0, high=2.0, basis=CASES)
    (table,) = outside_tables([dataclasses.replace(one, outside=(inside,), beyond_box=())])
    assert table.caption == "What no CFD case covers"


def test_hatched_bars_are_told_where_there_are_some(content_of: Make) -> None:
    strokes = content_of("hawkmoth").verdict.assessments
    assert "Hatched bars: of the power that CFD found." in savings_figure(strokes, "learned").text
    robot = dataclasses.replace(load_insect("hawkmoth"), name="robot", cfd=None)
    bare = savings_figure([assess(robot, strokes[0].stroke)], "learned")
    assert "atched" not in bare.text


def test_the_models_table_says_what_each_model_saves_and_what_this_one_does(content_of: Make) -> None:
    (one,) = content_of("hawkmoth").verdict.assessments
    table = models_table([one])
    cells = dict(zip([name for name, _ in table.columns], table.rows[0], strict=True))
    assert float(cells["this model"]) == pytest.approx(100 * (one.saving or 0), abs=0.051)
    for ranking in one.rankings:
        if ranking.saving is not None:
            assert float(cells[ranking.model].lstrip("✗ ")) == pytest.approx(100 * ranking.saving, abs=0.051)
