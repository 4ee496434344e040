"""Beta planform, exact moments and edge correction."""

import math

import numpy as np
import pytest
from conftest import wings
from hypothesis import given
from scipy.integrate import quad
from scipy.special import ellipe

from flapenv import Wing
from flapenv.aero.planform import LARGEST_R1_HAT, BetaPlanform


@given(wings())
def test_moments_are_the_integrals_of_the_chord(wing: Wing) -> None:
    # Gauss-Legendre in a variable that flattens both ends, where c may rise steeply
    x, weights = np.polynomial.legendre.leggauss(200)
    s = (x + 1) / 2
    r_hat, jacobian = s**3 * (10 - 15 * s + 6 * s**2), 30 * s**2 * (1 - s) ** 2 / 2
    chord = wing.chord(r_hat) / wing.mean_chord
    for n in (0, 1, 2, 3):
        assert np.sum(chord * r_hat**n * jacobian * weights) == pytest.approx(wing.moment(n), rel=1e-6)


@given(wings())
def test_first_moment_is_r1_hat_and_second_follows_ellingtons_correlation(wing: Wing) -> None:
    assert wing.moment(0) == 1
    assert wing.moment(1) == pytest.approx(wing.r1_hat, rel=1e-12)
    assert math.sqrt(wing.moment(2)) == pytest.approx(0.929 * wing.r1_hat**0.732, rel=1e-12)  # Ellington 1984


@given(wings())
def test_radii_of_higher_moments_lie_further_out(wing: Wing) -> None:
    radii = [wing.moment(n) ** (1 / n) for n in (1, 2, 3, 4)]
    assert radii == sorted(radii)
    assert radii[-1] < 1


def test_edge_correction_is_the_ellipses_semi_perimeter_over_its_length() -> None:
    for aspect_ratio in (2.2, 3.0, 5.5):
        wing = Wing(length=aspect_ratio, mean_chord=1.0, r1_hat=0.5)
        a, b = 0.5, 2 / (math.pi * aspect_ratio)  # semi-axes over R: area π a b R² = R c̄
        exact = 2 * max(a, b) * ellipe(1 - (min(a, b) / max(a, b)) ** 2)
        assert wing.edge_correction("ellipse") == pytest.approx(exact, rel=2e-5)


def test_edge_correction_of_a_very_slender_wing_tends_to_one() -> None:
    assert Wing(length=1.0, mean_chord=1e-4, r1_hat=0.5).edge_correction("ellipse") == pytest.approx(1, abs=1e-3)


def test_array_fields_give_what_scalars_give() -> None:
    r1_hats = np.array([0.46, 0.5, 0.56])
    together = Wing(length=0.01, mean_chord=np.array([2e-3, 3e-3, 4e-3]), r1_hat=r1_hats)
    for i, r1_hat in enumerate(r1_hats):
        alone = Wing(length=0.01, mean_chord=float(together.mean_chord[i]), r1_hat=float(r1_hat))
        assert together.moment(3)[i] == pytest.approx(alone.moment(3), rel=1e-14)
        assert together.edge_correction("ellipse")[i] == pytest.approx(alone.edge_correction("ellipse"), rel=1e-14)
        np.testing.assert_allclose(together.chord(np.array([0.3, 0.7]))[i], alone.chord(np.array([0.3, 0.7])))


def test_the_limit_of_r1_hat_is_where_the_beta_exponents_blow_up() -> None:
    p, q = BetaPlanform(r1_hat=LARGEST_R1_HAT).exponents
    assert min(p, q) > 100
    assert quad(lambda r: Wing(length=1, mean_chord=1, r1_hat=0.7).chord(np.array([r]))[0], 0, 1)[0] == pytest.approx(1)


@pytest.mark.parametrize(
    ("field", "value", "said"),
    [
        ("length", 0.0, r"length = 0 .*\[1e-15, 1e\+15\] m"),
        ("length", float("nan"), "length = nan"),
        ("mean_chord", -1e-3, r"mean_chord = -0.001 "),
        ("mean_chord", float("inf"), "mean_chord = inf"),
        ("r1_hat", 0.8, r"r1_hat = 0.8 .*\[0.001, 0.759\]"),
        ("r1_hat", np.array([0.5, 1.2]), r"r1_hat\[1\] = 1.2"),
    ],
)
def test_a_bad_value_is_named_with_the_allowed_range(field: str, value: object, said: str) -> None:
    good = {"length": 0.01, "mean_chord": 0.003, "r1_hat": 0.5}
    with pytest.raises(ValueError, match=said):
        Wing(**{**good, field: value})


@pytest.mark.parametrize("value", ["long", None, True, [1, "a"], 1j])
def test_what_is_not_a_real_number_is_refused(value: object) -> None:
    with pytest.raises(TypeError, match="length"):
        Wing(length=value, mean_chord=0.003, r1_hat=0.5)


def test_an_unknown_field_is_refused_with_the_nearest_name() -> None:
    with pytest.raises(TypeError, match=r"Wing has no field 'lenght'.*did you mean 'length'"):
        Wing(lenght=1.0, mean_chord=0.003, r1_hat=0.5)
    with pytest.raises(TypeError, match="Wing needs length"):
        Wing(mean_chord=0.003, r1_hat=0.5)
