"""Curves over the cycle: their means are the model's, their looks differ, their numbers are JSON."""

import dataclasses
import json
from typing import Any

import numpy as np
import pytest

import flapenv
from agents.plots.cycle import forces, terms, waveforms
from agents.plots.style import OTHERS, STYLES, line_styles, rounded
from flapenv.aero.blade_element import TERMS

FRUITFLY = flapenv.load_insect("fruitfly")
MODEL = flapenv.HoverModel()
OPTIMAL = flapenv.optimum("fruitfly").stroke
STROKES = {"optimal": OPTIMAL, "own": FRUITFLY.stroke}


def curves(figure: Any, axis: str) -> dict[str, np.ndarray]:
    return {trace.legendgroup: np.array(trace.y) for trace in figure.data if trace.yaxis == axis}


def mean(figure: Any, axis: str, label: str) -> float:
    """Of a drawn curve over the cycle, whose instants are not even."""
    (trace,) = (trace for trace in figure.data if trace.yaxis == axis and trace.legendgroup == label)
    x, y = np.array(trace.x), np.array(trace.y)
    return float(np.trapezoid([*y, y[0]], [*x, x[0] + 1]))


@pytest.mark.parametrize("label", STROKES)
def test_the_means_of_the_curves_are_weight_support_and_power(label: str) -> None:
    figure, wanted = forces(FRUITFLY, STROKES, MODEL), flapenv.evaluate(FRUITFLY, STROKES[label])
    assert mean(figure, "y", label) == pytest.approx(wanted.weight_support, rel=1e-3)
    assert mean(figure, "y2", label) == pytest.approx(wanted.specific_power, rel=1e-3)
    (named,) = (trace.name for trace in figure.data if trace.showlegend and trace.legendgroup == label)
    assert f"{wanted.weight_support:.3f} weights, {wanted.specific_power:.1f} W/kg" in named


def test_angles_reach_the_amplitudes() -> None:
    figure = waveforms(FRUITFLY, STROKES, MODEL)
    assert np.max(curves(figure, "y")["optimal"]) == pytest.approx(np.degrees(OPTIMAL.flap_amplitude), abs=1)
    assert np.max(curves(figure, "y2")["optimal"]) == pytest.approx(np.degrees(OPTIMAL.pitch_amplitude), abs=0.1)
    assert np.min(curves(figure, "y3")["optimal"]) == pytest.approx(90 - np.degrees(OPTIMAL.pitch_amplitude), abs=0.1)


def test_an_angle_of_attack_that_reaches_90_degrees_at_the_turn_is_drawn_so() -> None:
    for shape in (OPTIMAL.pitch_shape, 100.0):
        stroke = dataclasses.replace(OPTIMAL, pitch_shape=shape, pitch_phase=np.pi / 2)
        figure = waveforms(FRUITFLY, {"optimal": stroke}, MODEL)
        assert np.max(curves(figure, "y3")["optimal"]) == pytest.approx(90, rel=0.02)
        assert figure.layout.yaxis3.range == (0, 95)


@pytest.mark.parametrize("pitch_shape", [10.0, 100.0])
def test_extrema_of_every_term_are_those_of_a_fine_simulation(pitch_shape: float) -> None:
    stroke = dataclasses.replace(OPTIMAL, pitch_shape=pitch_shape)
    known = [name for name in TERMS if name != "inertia"]
    fine = flapenv.simulate(FRUITFLY, stroke, model=MODEL, terms=known, strips=12, steps=60_000, spacing="graded")
    figure = terms(FRUITFLY, stroke, MODEL)
    for name in known:
        for axis, wanted in (
            ("y", fine.terms[name].force[:, 2] / (FRUITFLY.mass * MODEL.gravity)),
            ("y2", fine.terms[name].power.sum(axis=0) / FRUITFLY.mass),
        ):
            drawn, reach = curves(figure, axis)[name.replace("-", " ")], np.max(np.abs(wanted))
            assert [np.min(drawn), np.max(drawn)] == pytest.approx([np.min(wanted), np.max(wanted)], abs=0.02 * reach)


def test_every_term_is_drawn_under_its_own_name_in_its_own_unit() -> None:
    figure, stroke = terms(FRUITFLY, FRUITFLY.stroke, MODEL), FRUITFLY.stroke
    for name in TERMS:
        at, weight = flapenv.simulate(FRUITFLY, stroke, model=MODEL, terms=[name], steps=1440), FRUITFLY.mass * 9.81
        wanted = {"y": at.terms[name].force[:, 2] / weight, "y2": at.terms[name].power.sum(axis=0) / FRUITFLY.mass}
        if name == "inertia":
            wanted = {"y3": wanted["y2"]}
        for axis, values in wanted.items():
            (trace,) = (one for one in figure.data if one.yaxis == axis and one.legendgroup == name.replace("-", " "))
            found = np.interp(at.phase / (2 * np.pi), trace.x, trace.y, period=1)
            assert found == pytest.approx(values, abs=0.1 * np.max(np.abs(values)))
    support = flapenv.evaluate(FRUITFLY).weight_support
    assert mean(figure, "y", "translational") == pytest.approx(support, rel=2e-3)


def test_short_spikes_do_not_flatten_what_counts_and_are_told() -> None:
    figure = terms(FRUITFLY, dataclasses.replace(OPTIMAL, pitch_shape=100.0), MODEL)
    low, high = figure.layout.yaxis2.range
    counted = curves(figure, "y2")["translational"]
    assert low <= np.min(counted) < np.max(counted) <= high < 1000 * np.max(counted)
    peak = np.max([np.max(values) for values in curves(figure, "y2").values()])
    told = figure.layout.annotations[1].text.split(", ")[1]
    assert float(told.replace(",", "")) == pytest.approx(peak, rel=0.01)
    gentle = dataclasses.replace(FRUITFLY.stroke, pitch_shape=0.1)
    assert "peaks" not in terms(FRUITFLY, gentle, MODEL).layout.annotations[0].text


def test_the_power_that_is_drawn_is_the_one_that_is_counted() -> None:
    model = dataclasses.replace(MODEL, accounting="positive")
    figure = forces(FRUITFLY, STROKES, model)
    assert "paid" in figure.layout.annotations[1].text
    for label, stroke in STROKES.items():
        wanted = flapenv.evaluate(FRUITFLY, stroke, accounting="positive")
        (named,) = (trace.name for trace in figure.data if trace.showlegend and trace.legendgroup == label)
        assert float(named.split()[-2]) == pytest.approx(wanted.specific_power, rel=0.01)
        assert mean(figure, "y2", label) == pytest.approx(wanted.specific_power, rel=0.03)
        assert mean(figure, "y", label) == pytest.approx(wanted.weight_support, rel=2e-3)
        assert np.min(curves(figure, "y2")[label]) >= 0


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
