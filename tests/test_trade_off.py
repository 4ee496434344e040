"""Fronts of least power against lift, amplitude and frequency."""

import dataclasses
import sys
from pathlib import Path

import numpy as np
import pytest

from flapenv import load_insect, optimum
from flapenv.trade_off import VARIED, draw_trade_offs, trade_off, trade_off_table, weight_front


def test_power_goes_with_the_three_halves_of_the_lift_while_the_frequency_is_free() -> None:
    front = trade_off("hawkmoth", "weight_support", (0.5, 1.0, 2.0))
    assert np.all(front.feasible)
    np.testing.assert_allclose(front.specific_power / front.specific_power[1], np.array([0.5, 1, 2]) ** 1.5, rtol=1e-6)
    assert front.specific_power[1] == pytest.approx(optimum("hawkmoth").specific_power, rel=1e-9)
    assert np.all(front.lower_bound < front.specific_power)


@pytest.mark.parametrize("varied", ["flap_amplitude", "frequency_ratio"])
def test_a_tighter_limit_never_saves_power_and_ends_in_not_hovering(varied: str) -> None:
    front = trade_off("fruitfly", varied)
    power = front.specific_power[front.feasible]
    assert np.all(np.diff(power) <= 1e-6 * power[1:])
    assert not front.feasible[0]
    assert np.all(np.isnan(front.specific_power[~front.feasible]))


def test_a_wing_without_a_table_keeps_the_tip_loss_of_its_own_weight() -> None:
    own = dataclasses.replace(load_insect("hawkmoth"), k_table=None)
    front = trade_off(own, values=(0.5, 1.0))
    assert front.specific_power[0] / front.specific_power[1] == pytest.approx(0.5**1.5, rel=1e-6)


@pytest.mark.parametrize("problem", ["free-frequency", "fixed-frequency", "profile-drag"])
def test_the_quick_front_is_the_one_found_point_by_point(problem: str) -> None:
    weights = (0.7, 1.0, 1.3)
    quick, slow = weight_front("bumblebee", weights, problem), trade_off("bumblebee", values=weights, problem=problem)
    np.testing.assert_array_equal(quick.feasible, slow.feasible)
    np.testing.assert_allclose(quick.specific_power, slow.specific_power, rtol=1e-5)
    np.testing.assert_allclose(quick.lower_bound, slow.lower_bound, rtol=1e-12)
    assert quick.specific_power[1] == pytest.approx(optimum("bumblebee", problem).specific_power, rel=1e-5)


def test_the_quick_front_of_a_wing_without_a_table_keeps_the_tip_loss_of_its_own_weight() -> None:
    own = dataclasses.replace(load_insect("hawkmoth"), k_table=None)
    front = weight_front(own, (0.5, 1.0))
    np.testing.assert_allclose(front.specific_power, trade_off(own, values=(0.5, 1.0)).specific_power, rtol=1e-6)


def test_no_front_begins_at_no_weight() -> None:
    with pytest.raises(ValueError, match=r"values\[0\] = 0 is not allowed"):
        weight_front("hawkmoth", (0.0, 1.0))


def test_the_command_prints_and_draws_the_fronts(
    capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch, tmp_path: Path
) -> None:
    fronts = {varied: [trade_off("hawkmoth", varied, VARIED[varied][1][-2:])] for varied in VARIED}
    figure = draw_trade_offs(fronts)
    assert [axes.get_xlabel() for axes in figure.axes] == [name for name, _ in VARIED.values()]
    assert "hawkmoth" in trade_off_table(fronts["weight_support"])
    short = {varied: (name, values[-2:]) for varied, (name, values) in VARIED.items()}
    monkeypatch.setattr("flapenv.trade_off.VARIED", short)
    monkeypatch.setattr("flapenv.trade_off.INSECTS", ("hawkmoth",))
    monkeypatch.setattr(sys, "argv", ["trade_off", "--out", str(tmp_path / "deep" / "front.png")])
    from flapenv.trade_off import main

    main()
    assert capsys.readouterr().out.count("hawkmoth") == 3
    assert (tmp_path / "deep" / "front.png").stat().st_size > 10_000


@pytest.mark.parametrize(
    ("arguments", "kind", "said"),
    [
        ({"varied": "mass"}, ValueError, "varied = 'mass' is unknown; allowed: weight_support"),
        ({"values": [-1.0]}, ValueError, r"values\[0\] = -1"),
        ({"varied": "flap_amplitude", "values": [2.0]}, ValueError, "flap_amplitude = 2 "),
        ({"varied": "flap_amplitude", "problem": "fixed-frequency"}, ValueError, "not bounded by the box"),
    ],
)
def test_bad_fronts_are_named(arguments: dict[str, object], kind: type[Exception], said: str) -> None:
    with pytest.raises(kind, match=said):
        trade_off("hawkmoth", **arguments)
