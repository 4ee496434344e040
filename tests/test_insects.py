"""The eight insects and one's own."""

import dataclasses
import math
import pickle
from dataclasses import asdict

import pytest

from flapenv import INSECTS, Insect, Stroke, Wing, load_insect
from flapenv.insects import as_insect, read_table

OWN = Insect(
    name="robot",
    mass=1e-4,
    wing=Wing(length=0.015, mean_chord=0.004, r1_hat=0.5),
    stroke=Stroke(frequency=120.0, flap_amplitude=1.0, pitch_amplitude=1.0),
)


def test_the_eight_insects_stand_in_the_order_of_table_1() -> None:
    expected = ("fruitfly", "bumblebee", "hawkmoth", "honeybee", "cranefly", "hoverfly", "dronefly", "ladybird")
    assert expected == INSECTS


def test_the_hawkmoth_of_table_1_is_in_si_units() -> None:
    hawkmoth = load_insect("hawkmoth")
    assert hawkmoth.mass == pytest.approx(1.648e-3)
    assert hawkmoth.wing.length == pytest.approx(51.9e-3)
    assert hawkmoth.wing.mean_chord == pytest.approx(18.26e-3)
    assert hawkmoth.stroke.frequency == 26.3
    assert math.degrees(hawkmoth.stroke.flap_amplitude) == pytest.approx(60.5)
    assert 90 - math.degrees(hawkmoth.stroke.pitch_amplitude) == pytest.approx(32)


def test_references_of_tables_2_and_3_come_with_every_insect(insect: Insect) -> None:
    assert insect.k_table is not None
    assert insect.k_table.k_ind * insect.k_table.k_tip == pytest.approx(insect.k_table.k_revolving, abs=0.015)
    assert insect.cfd is not None
    assert insect.cfd.weight_support == 1
    assert insect.published is not None
    assert (insect.berman_wang is not None) == (insect.name in ("fruitfly", "bumblebee", "hawkmoth"))


def test_table_2_is_consistent_with_itself() -> None:
    for row in read_table("induced_power_factors.csv").values():
        assert float(row["k_ind_k_tip"]) * float(row["k_flap"]) == pytest.approx(float(row["k"]), abs=0.02)


def test_insects_are_hashable_pickle_and_come_back_from_dicts(insect: Insect) -> None:
    assert hash(insect) == hash(load_insect(insect.name))
    assert pickle.loads(pickle.dumps(insect)) == insect
    assert as_insect(asdict(insect)) == insect
    assert as_insect(insect.name) is as_insect(insect)


def test_replace_validates_again() -> None:
    with pytest.raises(ValueError, match=r"mass = -1 is not allowed; allowed: finite, in \[1e-15, 1e\+15\] kg"):
        dataclasses.replace(OWN, mass=-1.0)
    with pytest.raises(TypeError, match="wing = 3"):
        dataclasses.replace(OWN, wing=3)
    with pytest.raises(TypeError, match="name = ''"):
        dataclasses.replace(OWN, name="")
    with pytest.raises(TypeError, match="k_ind = 'a' is not a real number"):
        dataclasses.replace(OWN, k_table={"k_ind": "a", "k_tip": 1.1})
    with pytest.raises(TypeError, match="weight_support = 'x'"):
        dataclasses.replace(OWN, cfd={"weight_support": "x"})
    with pytest.raises(ValueError, match=r"k_ind = 0.9 .*\[1, 1e\+15\]"):
        dataclasses.replace(OWN, k_table={"k_ind": 0.9, "k_tip": 1.1})


def test_an_unknown_insect_is_refused_with_all_names_and_the_nearest() -> None:
    with pytest.raises(
        ValueError, match=r"insect = 'hawkmouth' is unknown; allowed: fruitfly, .*did you mean 'hawkmoth'"
    ):
        load_insect("hawkmouth")
    with pytest.raises(TypeError, match="insect = 7"):
        as_insect(7)
