"""The paper's tables and figures: acceptance, the report that prints them, the pictures and the convergence."""

import runpy
import sys
from pathlib import Path

import numpy as np
import pytest

from flapenv import INSECTS, evaluate
from flapenv.validation import (
    report,
    specific_power_errors,
    step_errors,
    strip_errors,
    table3,
    term_errors,
    weight_support_errors,
)
from flapenv.validation.figures import FIGURES
from flapenv.validation.tables import berman_wang_check, figure5_wings, figure6, k_ind_anchors


def test_table_3_is_met_for_all_eight_insects() -> None:
    rows = table3()
    lift, power = weight_support_errors(rows), specific_power_errors(rows)
    paper = np.array([row.paper.weight_support for row in rows])
    assert np.max(np.abs(lift)) <= 0.05
    assert np.max(np.abs(power)) <= 1.0
    assert np.sqrt(np.mean((lift / paper) ** 2)) <= 0.025
    assert np.sqrt(np.mean(power**2)) <= 0.5


def test_power_lies_within_a_fifth_of_cfd() -> None:
    for row in table3():
        assert row.specific_power == pytest.approx(row.cfd.specific_power, rel=0.2), row.insect


def test_the_parts_of_k_in_figure_6_bring_the_lift_down_one_by_one() -> None:
    fruitfly, hoverfly = figure6()
    for row in (fruitfly, hoverfly):
        assert row.ideal > row.with_k_ind > row.with_k_tip > row.full
        assert row.full == pytest.approx(evaluate(row.insect).weight_support, rel=1e-12)
        assert row.ideal == pytest.approx(evaluate(row.insect, induced=False).weight_support, rel=1e-12)
    assert hoverfly.ideal - 1 == pytest.approx(0.23, abs=0.015)  # the paper's 23 %
    assert fruitfly.ideal - fruitfly.with_k_tip > fruitfly.with_k_tip - fruitfly.full  # k_ind and k_tip matter most
    assert hoverfly.with_k_tip - hoverfly.full > hoverfly.ideal - hoverfly.with_k_tip  # k_flap does


def test_the_revolving_wings_of_figure_5_have_their_lift_constants() -> None:
    for wing, (low, high) in zip(figure5_wings(), ((1.33, 1.35), (1.41, 1.42), (1.345, 1.355)), strict=True):
        assert low <= wing.lift_constant <= high, wing.name


def test_anchors_and_berman_and_wangs_model_come_out_as_reported() -> None:
    arcsech, beta = k_ind_anchors(4.0).values()
    assert all(1.02 <= value <= 1.06 for value in arcsech)
    assert all(1.07 <= value <= 1.10 for value in beta)
    assert [round(ours, 3) for ours, _ in berman_wang_check().values()] == [1.007, 0.943, 1.173]


@pytest.mark.parametrize("name", INSECTS)
def test_strips_steps_and_terms_converge(name: str) -> None:
    strips = np.abs(strip_errors(name))
    assert np.all(np.diff(strips, axis=0) < 0)
    assert np.all(strips[1:] < 0.5 * strips[:-1])  # better than first order in strips
    assert np.all(np.abs(step_errors(name, (64, 500))) < [[1e-4, 1e-4], [1e-8, 1e-8]])
    terms = np.abs(term_errors(name))
    assert np.all(terms[1:] < 0.4 * terms[:-1])
    assert terms[3] < 1e-4  # 64 terms


def test_the_command_prints_every_table_and_writes_the_page_with_every_figure(
    capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch, tmp_path: Path
) -> None:
    monkeypatch.setattr(sys, "argv", ["flapenv.validation", "--out", str(tmp_path)])
    runpy.run_module("flapenv.validation", run_name="__main__")
    printed = capsys.readouterr().out
    assert report() in printed
    assert "k_tip: differs in the second decimal for dronefly" in printed
    assert "k_flap: differs in the second decimal for none" in printed
    for heading in ("Table 2", "Table 3", "Fig. 5", "Fig. 6", "k_ind of", "Λ at the own stroke", "Berman & Wang"):
        assert heading in printed
    for name in FIGURES:
        assert (tmp_path / "images" / f"{name}.png").stat().st_size > 10_000
    assert (tmp_path / "validation.md").read_text(encoding="utf-8").count("hoverfly") >= 3


@pytest.mark.parametrize("name", FIGURES)
def test_every_panel_of_a_figure_is_labelled(name: str) -> None:
    figure = FIGURES[name]()
    for axes in figure.axes:
        assert axes.get_title()
    if name not in ("axes", "figure6"):
        assert all(axes.get_xlabel() or axes.get_subplotspec().rowspan.stop < 3 for axes in figure.axes)


def test_figure_2_draws_the_waveforms_from_sinusoid_to_triangle_and_square() -> None:
    flapping, pitching = FIGURES["figure2"]().axes
    sinusoid, *_, triangle = (line.get_ydata() for line in flapping.lines if line.get_label().startswith("C"))
    phase = np.linspace(0, 2 * np.pi, 721)
    np.testing.assert_allclose(sinusoid, np.sin(phase), atol=1e-9)
    np.testing.assert_allclose(triangle, 2 / np.pi * np.arcsin(np.sin(phase)), atol=1e-7)
    square = next(line.get_ydata() for line in pitching.lines if line.get_label() == "Cθ = 20")
    assert np.mean(np.abs(square)) > 0.97
