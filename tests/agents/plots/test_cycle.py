"""Curves over the cycle: their means are the model's, their looks differ, their numbers are JSON."""

import dataclasses
import json
from typing import Any

import numpy as np
import pytest

import flapenv
from agents.plots.cycle import forces, terms, waveforms
from agents.plots.style import OTHERS, STYLES, line_styles, rounded

FRUITFLY = flapenv.load_insect("fruitfly")
MODEL = flapenv.HoverModel()
OPTIMAL = flapenv.optimum("fruitfly").stroke
STROKES = {"optimal": OPTIMAL, "own": FRUITFLY.stroke}


def curves(figure: Any, axis: str) -> dict[str, np.ndarray]:
    return {trace.legendgroup: np.array(trace.y) for trace in figure.data if trace.yaxis == axis}


@pytest.mark.parametrize("label", STROKES)
def test_the_means_of_the_curves_are_weight_support_and_power(label: str) -> None:
    figure, wanted = forces(FRUITFLY, STROKES, MODEL), flapenv.evaluate(FRUITFLY, STROKES[label])
    assert np.mean(curves(figure, "y")[label]) == pytest.approx(wanted.weight_support, rel=1e-3)
    assert np.mean(curves(figure, "y2")[label]) == pytest.approx(wanted.specific_power, rel=1e-3)
    (named,) = (trace.name for trace in figure.data if trace.showlegend and trace.legendgroup == label)
    assert f"{wanted.weight_support:.3f} weights, {wanted.specific_power:.1f} W/kg" in named


def test_angles_reach_the_amplitudes() -> None:
    figure = waveforms(FRUITFLY, STROKES, MODEL)
    assert np.max(curves(figure, "y")["optimal"]) == pytest.approx(np.degrees(OPTIMAL.flap_amplitude), abs=1)
    assert np.max(curves(figure, "y2")["optimal"]) == pytest.approx(np.degrees(OPTIMAL.pitch_amplitude), abs=0.1)
    assert np.min(curves(figure, "y3")["optimal"]) == pytest.approx(90 - np.degrees(OPTIMAL.pitch_amplitude), abs=0.1)


def test_terms_add_up_to_their_sum() -> None:
    figure = terms(FRUITFLY, FRUITFLY.stroke, MODEL)
    for axis in ("y", "y2", "y3"):
        drawn = curves(figure, axis)
        total = drawn.pop("sum")
        assert sum(drawn.values()) == pytest.approx(total, rel=2e-3, abs=2e-3 * np.max(np.abs(total)))
    assert {"translational", "rotational", "added mass", "inertia"} <= {trace.name for trace in figure.data}


def test_inertia_is_left_out_where_the_wing_has_no_mass() -> None:
    hoverfly = flapenv.load_insect("hoverfly")
    assert "inertia" not in {trace.name for trace in terms(hoverfly, hoverfly.stroke, MODEL).data}


@pytest.mark.parametrize("shape", [{"flap_shape": 1.0}, {"flap_shape": 0.999, "pitch_shape": 100.0}])
def test_the_sharpest_strokes_are_drawn(shape: dict[str, float]) -> None:
    stroke = dataclasses.replace(OPTIMAL, **shape)
    for figure in (terms(FRUITFLY, stroke, MODEL), waveforms(FRUITFLY, {"yours": stroke}, MODEL)):
        assert "NaN" not in figure.to_json()


@pytest.mark.parametrize("draw", [waveforms, forces])
def test_every_axis_has_a_title_with_a_unit(draw: Any) -> None:
    figure = json.loads(draw(FRUITFLY, STROKES, MODEL).to_json())["layout"]
    titles = [axis["title"]["text"] for name, axis in figure.items() if name.startswith("yaxis")]
    assert titles
    assert all("[" in title for title in titles)


def test_no_two_lines_look_alike_with_or_without_colour() -> None:
    for labels in (STYLES, ["yours", "optimal", "own"], ["a", "b", "c", "d"]):
        chosen = line_styles(labels).values()
        assert len({style.colour for style in chosen}) == len({style.dash for style in chosen}) == len(labels)
        assert len({style.symbol for style in chosen}) == len(labels)


def test_more_lines_than_looks_are_refused() -> None:
    with pytest.raises(ValueError, match="too many to be told apart"):
        line_styles([str(number) for number in range(len(OTHERS) + 1)])


def test_numbers_are_cut_to_four_digits_and_nan_is_nothing() -> None:
    assert rounded([[1.23456, 1e-9], [float("nan"), 98765.4]]) == [[1.235, 1e-9], [None, 98770.0]]
