"""Planforms from three numbers, tables and functions: moments, strips, outlines, and what is refused."""

import dataclasses
import json
import math
import pickle

import numpy as np
import pytest
from conftest import wings
from hypothesis import given
from hypothesis import strategies as st
from scipy.integrate import quad

from flapenv import FunctionPlanform, Insect, TabulatedPlanform, Wing, evaluate
from flapenv.aero.induced import k_ind
from flapenv.aero.planform import HALF_ELLIPSE, BetaPlanform

TRIANGLE = TabulatedPlanform(r_hat=[0, 1], chord=[3.0, 0.0], rounded=False)
"""Straight from the root chord to a pointed tip."""


def ellipse(r_hat: np.ndarray) -> np.ndarray:
    return np.sqrt(r_hat * (1 - r_hat))


@st.composite
def tables(draw: st.DrawFn) -> TabulatedPlanform:
    inner = draw(st.lists(st.floats(0.01, 0.99), min_size=0, max_size=8, unique_by=lambda r: round(r, 2)))
    r_hat = [0.0, *sorted(inner), 1.0]
    chord = draw(st.lists(st.floats(0.01, 5.0), min_size=len(r_hat), max_size=len(r_hat)))
    return TabulatedPlanform(r_hat=r_hat, chord=chord)


def test_a_triangle_has_the_moments_of_a_triangle() -> None:
    assert TRIANGLE.moment(0) == pytest.approx(1)
    assert TRIANGLE.r1_hat == pytest.approx(1 / 3)
    assert TRIANGLE.moment(2) == pytest.approx(1 / 6)
    assert TRIANGLE.moment(0, power=3) == pytest.approx(2)  # ∫(2(1-r))³ dr


def test_the_half_ellipse_has_its_moments() -> None:
    assert HALF_ELLIPSE.moment(0) == pytest.approx(1, rel=1e-13)
    assert HALF_ELLIPSE.r1_hat == pytest.approx(4 / (3 * math.pi), rel=1e-13)
    assert HALF_ELLIPSE.moment(2) == pytest.approx(1 / 4, rel=1e-13)
    assert HALF_ELLIPSE.moment(3) == pytest.approx(8 / (15 * math.pi), rel=1e-13)
    assert HALF_ELLIPSE.relative_chord(np.array([0.0])) == pytest.approx(4 / math.pi)  # c(0) = 4c̄/π


def test_an_end_of_zero_chord_is_rounded_unless_the_table_is_a_polygon() -> None:
    half_parabola = TabulatedPlanform(r_hat=[0, 1], chord=[1.0, 0.0])  # ĉ = 1.5 √(1-r̂)
    np.testing.assert_allclose(half_parabola.relative_chord(np.array([0, 0.75, 1.0])), [1.5, 0.75, 0], atol=1e-12)
    assert half_parabola.r1_hat == pytest.approx(2 / 5)
    assert half_parabola.moment(0, power=2) == pytest.approx(9 / 8)
    both = TabulatedPlanform(r_hat=[0, 0.4, 1], chord=[0.0, 1.0, 0.0])
    assert both.moment(0) == pytest.approx(1)
    assert both.relative_chord(np.array([0.1]))[0] == pytest.approx(both.chord[1] / 2)


@pytest.mark.parametrize("r1_hat", [0.46, 0.50, 0.55])
def test_a_few_points_of_a_wing_give_its_induced_power_factor(r1_hat: float) -> None:
    """Eleven even points: within 0.01, where a pointed tip would add 0.7 and more."""
    beta = Wing(length=0.05, mean_chord=0.015, r1_hat=r1_hat)
    r_hat = np.linspace(0, 1, 11)
    wing = Wing.from_table(r_hat * 0.05, beta.chord(r_hat))
    assert k_ind(wing) == pytest.approx(k_ind(beta), abs=0.01)
    assert wing.area == pytest.approx(beta.area, rel=0.02)
    with pytest.warns(UserWarning, match=r"k_ind = \d\.\d+ is not converged: 64 terms change it by .*rounded table"):
        assert k_ind(Wing.from_table(r_hat * 0.05, beta.chord(r_hat), rounded=False)) > k_ind(beta) + 0.5


@given(tables())
def test_moments_of_a_table_are_the_integrals_of_its_chord(table: TabulatedPlanform) -> None:
    for order, power in ((0, 1), (1, 1), (3, 1), (1, 2), (0, 3)):
        integral = sum(
            quad(lambda r, k=power, n=order: float(table.relative_chord(r)) ** k * r**n, a, b)[0]
            for a, b in zip(table.r_hat[:-1], table.r_hat[1:], strict=True)
        )
        assert table.moment(order, power) == pytest.approx(integral, rel=1e-7)


@given(wings())
def test_higher_powers_of_the_beta_chord_integrate_exactly(wing: Wing) -> None:
    shape = BetaPlanform(r1_hat=wing.r1_hat)
    smooth = FunctionPlanform(function=shape.relative_chord)
    for order, power in ((0, 2), (1, 2), (0, 3), (2, 1)):
        assert shape.moment(order, power) == pytest.approx(smooth.moment(order, power), rel=1e-6)


@given(tables())
def test_strips_of_every_planform_integrate_its_moments(table: TabulatedPlanform) -> None:
    for shape in (table, BetaPlanform(r1_hat=0.5), HALF_ELLIPSE):
        r_hat, area = shape.strips(24)
        for n in (0, 1, 2, 3):
            assert np.sum(area * r_hat**n) == pytest.approx(shape.moment(n), rel=1e-7)


def test_a_fine_table_of_a_beta_wing_tends_to_the_beta_wing() -> None:
    beta = Wing(length=0.05, mean_chord=0.018, r1_hat=0.5)
    errors = []
    for points in (11, 41, 161, 641):
        r_hat = np.sin(np.linspace(0, math.pi / 2, points)) ** 2
        wing = Wing.from_table(r_hat * 0.05, beta.chord(r_hat))
        ratios = wing.moment(2) / beta.moment(2), wing.area / beta.area, k_ind(wing) / k_ind(beta)
        errors.append(max(abs(ratio - 1) for ratio in ratios))
    assert errors == sorted(errors, reverse=True)
    assert errors[-1] < 1e-4


def test_a_wing_from_a_table_reports_size_and_centre_of_area() -> None:
    wing = Wing.from_table([0, 0.02, 0.04], [0.01, 0.01, 0.01], mass=1e-5)
    assert (wing.length, wing.mean_chord, wing.mass) == pytest.approx((0.04, 0.01, 1e-5))
    assert wing.r1_hat == pytest.approx(0.5)
    assert wing.aspect_ratio == pytest.approx(4)
    np.testing.assert_allclose(wing.chord(np.array([0.1, 0.9])), 0.01)


def test_an_ellipse_laid_about_its_axis_has_the_ellipses_edge_correction() -> None:
    for aspect_ratio in (2.5, 4.0):
        wing = Wing(length=aspect_ratio, mean_chord=1, planform=FunctionPlanform(function=ellipse))
        assert wing.edge_correction("symmetric") == pytest.approx(wing.edge_correction("ellipse"), rel=3e-5)


def test_a_triangles_edges_are_straight() -> None:
    wing = Wing(length=3, mean_chord=1, planform=TRIANGLE)
    assert wing.edge_correction("symmetric") == pytest.approx(math.hypot(1, 1 / 3), rel=1e-12)


def test_both_outlines_of_an_insect_lie_close_and_move_its_lift_by_about_one_percent(insect: Insect) -> None:
    ellipse_, symmetric = (insect.wing.edge_correction(outline) for outline in ("ellipse", "symmetric"))
    assert symmetric == pytest.approx(ellipse_, rel=0.03)
    lift = evaluate(insect, edge_correction="symmetric").weight_support
    assert lift == pytest.approx(evaluate(insect).weight_support, rel=0.015)


def test_a_chord_that_is_infinite_at_the_root_has_no_outline_and_no_square() -> None:
    wing = Wing(length=3, mean_chord=1, r1_hat=0.3)
    with pytest.raises(ValueError, match=r"r1_hat = 0.3 .*symmetric outline.*above 0.38"):
        wing.edge_correction("symmetric")
    with pytest.raises(ValueError, match=r"r1_hat = 0.15 .*power 3"):
        BetaPlanform(r1_hat=0.15).moment(0, 3)
    with pytest.raises(ValueError, match="outline = 'round' is unknown; allowed: ellipse, symmetric"):
        wing.edge_correction("round")


def test_replacing_a_field_validates_again_and_keeps_the_planform() -> None:
    wing = Wing.from_table([0, 0.02, 0.04], [0.01, 0.012, 0.0])
    longer = dataclasses.replace(wing, length=0.08)
    assert longer.r1_hat == wing.r1_hat
    assert dataclasses.replace(longer, length=0.04) == wing
    with pytest.raises(ValueError, match=r"r1_hat = 0.3 is not the planform's; allowed: 0\.\d+, or None"):
        dataclasses.replace(wing, r1_hat=0.3)


def test_wings_of_tables_hash_pickle_and_come_back_from_json() -> None:
    wing = Wing.from_table([0, 0.01, 0.04], [0.01, 0.012, 0.003], mass=1e-5, pitch_axis=0.3)
    assert pickle.loads(pickle.dumps(wing)) == wing
    assert hash(pickle.loads(pickle.dumps(wing))) == hash(wing)
    assert Wing(**json.loads(json.dumps(dataclasses.asdict(wing)))) == wing


@pytest.mark.parametrize(
    ("radius", "chord", "kind", "said"),
    [
        ([0, 0.02], [0.01, -0.01], ValueError, r"chord\[1\] = -0.01 .*\[0, 1e\+15\] m"),
        ([0, 0.02], [0.0, 0.0], ValueError, "zero everywhere|mean_chord = 0"),
        ([0.005, 0.02], [0.01, 0.01], ValueError, "radius runs from 0.005 to 0.02 m and does not cover the span"),
        ([0, 0.02, 0.01], [1, 1, 1], ValueError, r"r_hat\[2\] = 1 does not exceed r_hat\[1\]"),
        ([0, float("nan")], [1, 1], ValueError, r"radius\[1\] = nan"),
        ([0, 0.02], [1, 1, 1], TypeError, "equal length"),
        ([0], [1], TypeError, "equal length"),
        ("abc", [1, 1], TypeError, "radius = 'abc'"),
    ],
)
def test_a_bad_table_is_refused(radius: object, chord: object, kind: type[Exception], said: str) -> None:
    with pytest.raises(kind, match=said):
        Wing.from_table(radius, chord)


@pytest.mark.parametrize(
    ("fields", "kind", "said"),
    [
        ({"r_hat": [0, 0.9], "chord": [1, 1]}, ValueError, "r_hat runs from 0 to 0.9 and does not cover the span"),
        ({"r_hat": [0, 1], "chord": [0, 0]}, ValueError, "chord is zero everywhere"),
        ({"r_hat": [0, 1], "chord": [1]}, TypeError, "two columns of equal length"),
        ({"r_hat": [0, 0.5, 0.5, 1], "chord": [1, 1, 2, 1]}, ValueError, r"r_hat\[2\] = 0.5 does not exceed"),
    ],
)
def test_a_bad_planform_is_refused(fields: dict[str, object], kind: type[Exception], said: str) -> None:
    with pytest.raises(kind, match=said):
        TabulatedPlanform(**fields)


@pytest.mark.parametrize(
    ("function", "kind", "said"),
    [
        (3, TypeError, "chord function = 3"),
        (lambda r: r - 0.5, ValueError, r"chord function's value\[0\] = -0.4999"),
        (lambda r: 0 * r, ValueError, "zero everywhere"),
        (lambda r: 1.0, TypeError, r"shape \(\) for radii"),
        (lambda r: np.where(r > 0.5, np.nan, 1.0), ValueError, "nan"),
    ],
)
def test_a_bad_chord_function_is_refused(function: object, kind: type[Exception], said: str) -> None:
    with pytest.raises(kind, match=said):
        FunctionPlanform(function=function)


def test_a_wing_needs_a_shape_and_one_that_is_a_planform() -> None:
    with pytest.raises(TypeError, match="needs r1_hat, for the beta planform, or a planform"):
        Wing(length=1, mean_chord=1)
    with pytest.raises(TypeError, match="planform = 'oval' is not allowed"):
        Wing(length=1, mean_chord=1, planform="oval")
    with pytest.raises(ValueError, match="wing mass = 0 "):
        Wing(length=1, mean_chord=1, r1_hat=0.5, mass=0)
    with pytest.raises(ValueError, match=r"pitch_axis = 1.5 .*\[0, 1\]"):
        Wing(length=1, mean_chord=1, r1_hat=0.5, pitch_axis=1.5)


def test_what_is_no_planform_instance_or_has_no_outline_is_named() -> None:
    with pytest.raises(TypeError, match=r"planform = <class .*TabulatedPlanform'> is not allowed"):
        Wing(length=1, mean_chord=1, planform=TabulatedPlanform)
    with pytest.raises(TypeError, match="r1_hat = 'x' is not a real number"):
        Wing(length=1, mean_chord=1, r1_hat="x", planform=HALF_ELLIPSE)
    undefined = Wing(length=3, mean_chord=1, planform=FunctionPlanform(function=lambda r: np.sin(np.pi * r) / r))
    with pytest.raises(ValueError, match="no symmetric outline: its chord at an end is not finite"):
        undefined.edge_correction("symmetric")
    with pytest.raises(ValueError, match=r"no finite area; allowed: smaller numbers|zero everywhere"):
        TabulatedPlanform(r_hat=[0, 0.5, 1], chord=[1.7e308] * 3)


def test_many_strips_of_an_uneven_planform_stay_finite() -> None:
    half = FunctionPlanform(function=lambda r: np.where(r < 0.5, 1.0, 0.0))
    for count in (8, 300):
        r_hat, area = half.strips(count)
        assert np.all(np.isfinite(r_hat))
        assert np.sum(area) == pytest.approx(1, rel=1e-2)


def test_a_wing_that_is_a_class_or_a_word_has_no_induced_power_factor() -> None:
    with pytest.raises(TypeError, match="wing = 'x' is not allowed; allowed: a Wing"):
        k_ind("x")
    spike = Wing(length=3, mean_chord=1, planform=TabulatedPlanform(r_hat=[0, 0.9, 1], chord=[0, 0, 1]))
    with pytest.raises(ValueError, match="terms = 1 are too few"):
        k_ind(spike, terms=1)


@pytest.mark.parametrize("r1_hat", [5e-324, 1e-300, 1e-4, 0.75973])
def test_a_beta_planform_whose_exponents_vanish_or_blow_up_is_refused(r1_hat: float) -> None:
    with pytest.raises(ValueError, match=r"r1_hat = .* is not allowed; allowed: finite, in \[0.001, 0.759\]"):
        Wing(length=1, mean_chord=0.3, r1_hat=r1_hat)
    for end in (1e-3, 0.759):
        assert np.isfinite(Wing(length=1, mean_chord=0.3, r1_hat=end).shape.strips(8)).all()


@pytest.mark.parametrize("radius", [[0, -1e308, 1e-300], [0, 5e-324], [0, 1e16], [0, -1e15, 1e-15]])
def test_radii_of_numbers_only_are_refused(radius: list[float]) -> None:
    with pytest.raises(ValueError, match=r"is not allowed; allowed|does not cover the span|does not exceed"):
        Wing.from_table(radius, [1.0] * len(radius))
