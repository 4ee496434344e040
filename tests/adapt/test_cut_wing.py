"""Wings without their tip: limits, directions, and agreement with planforms built directly."""

from typing import Any

import numpy as np
import pytest

from flapenv import FunctionPlanform, Insect, TabulatedPlanform, Wing, evaluate, load_insect
from flapenv.adapt import CutPlanform, cut_wing
from flapenv.aero import induced
from flapenv.simulation import evaluate_by_blade_element


def test_a_wing_that_lost_nothing_is_the_wing(insect: Insect) -> None:
    wing = insect.wing
    same = cut_wing(wing, 0.0)
    assert same.length == wing.length
    assert same.mean_chord == pytest.approx(wing.mean_chord, rel=1e-14)
    for order in (0, 1, 2, 3):
        assert same.moment(order) == pytest.approx(wing.moment(order), rel=1e-13)
    radii = np.linspace(0.01, 0.99, 50)
    np.testing.assert_allclose(same.chord(radii), wing.chord(radii), rtol=1e-12)


@pytest.mark.parametrize("lost", [0.01, 0.08, 0.15, 0.5])
def test_what_is_left_of_a_beta_wing_is_the_planform_given_as_a_function(insect: Insect, lost: float) -> None:
    wing, kept = insect.wing, 1 - lost
    left = cut_wing(wing, lost)
    direct = FunctionPlanform(function=lambda r_hat: wing.shape.relative_chord(kept * r_hat))
    assert left.length == pytest.approx(kept * wing.length)
    for order in (1, 2, 3):
        assert left.moment(order) == pytest.approx(direct.moment(order), rel=1e-7)
    radii = np.linspace(0.01, 1, 40)
    np.testing.assert_allclose(left.chord(radii), wing.chord(kept * radii), rtol=1e-12)
    np.testing.assert_allclose(left.shape.relative_chord(radii), direct.relative_chord(radii), rtol=1e-7)
    same = Wing(length=left.length, mean_chord=left.mean_chord, planform=direct)
    assert induced.k_ind(left) == pytest.approx(induced.k_ind(same), rel=1e-7)


def test_what_is_left_of_a_polygon_is_the_polygon_with_fewer_points() -> None:
    whole = Wing.from_table([0, 5e-3, 10e-3], [3e-3, 4e-3, 1e-3], rounded=False)
    left = cut_wing(whole, 0.2)  # through the outer panel, where the chord is 2.2 mm
    direct = TabulatedPlanform(r_hat=[0, 0.625, 1], chord=[3, 4, 2.2], rounded=False)
    assert left.area == pytest.approx((3.5 * 5 + 3.1 * 3) * 1e-6, rel=1e-5)
    for order in (1, 2, 3):
        assert left.moment(order) == pytest.approx(direct.moment(order), rel=1e-5)


def test_cutting_more_takes_area_moments_and_aspect_ratio(insect: Insect) -> None:
    lost = np.linspace(0, 0.3, 16)
    wings = cut_wing(insect.wing, lost)
    dimensional = [wings.area, *(wings.area * wings.length**n * wings.moment(n) for n in (1, 2, 3))]
    for falling in (*dimensional, wings.aspect_ratio):
        assert np.all(np.diff(falling) < 0)
    shares = np.stack([value / value[0] for value in dimensional])
    assert np.all(np.diff(shares[:, 1:], axis=0) < 0)  # the tip counts more in higher moments


def test_a_cut_wing_weighs_what_its_area_does(hawkmoth: Insect) -> None:
    left = cut_wing(hawkmoth.wing, 0.1)
    assert left.mass / left.area == pytest.approx(hawkmoth.wing.mass / hawkmoth.wing.area, rel=1e-12)
    assert cut_wing(load_insect("cranefly").wing, 0.1).mass is None


@pytest.mark.parametrize("strips", [8, 40])
@pytest.mark.filterwarnings("ignore:.*aspect ratio:UserWarning")
def test_the_blade_element_confirms_the_moments_of_a_cut_wing(strips: int) -> None:
    whole = load_insect("honeybee")
    cut = Insect(
        name="cut",
        mass=whole.mass,
        wing=cut_wing(whole.wing, 0.12),
        stroke=whole.stroke,
        k_table=whole.k_table,
    )
    fast = evaluate(cut)
    slow = evaluate_by_blade_element(cut, cut.stroke, strips=strips, spacing="gauss", steps=4000)
    assert slow == pytest.approx((fast.weight_support, fast.specific_power), rel=1e-5)


def test_the_same_stroke_lifts_less_with_cut_wings_and_takes_less_power_for_it(insect: Insect) -> None:
    def loads(lost: float) -> tuple[float, float]:
        cut = Insect(name="cut", mass=insect.mass, wing=cut_wing(insect.wing, lost), stroke=insect.stroke)
        found = evaluate(cut, insect.stroke, coefficients="robofly")  # the same coefficients whatever the wing
        return found.weight_support, found.specific_power

    (lift, power), (less, cheaper) = loads(0.0), loads(0.1)
    assert less < 0.95 * lift
    assert cheaper / less < power / lift  # the lost tip was the fastest part


@pytest.mark.parametrize(
    ("lost", "kind"), [(1.0, ValueError), (-0.1, ValueError), (np.nan, ValueError), ("half", TypeError)]
)
def test_impossible_losses_are_refused(lost: Any, kind: type[Exception]) -> None:
    with pytest.raises(kind, match="span lost"):
        CutPlanform(planform=load_insect("hawkmoth").wing.shape, lost=lost)
