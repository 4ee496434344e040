"""The bars of savings."""

import dataclasses

import numpy as np
import pytest

from agents.plots.savings import BY_CFD, BY_MODEL, savings
from flapenv import INSECTS, load_insect, optimum
from flapenv.assessment import assess


def test_bars_and_whiskers_are_the_assessments_in_percent() -> None:
    strokes = [assess(name, optimum(name).stroke) for name in INSECTS]
    figure = savings(strokes)
    by_model, by_cfd, as_is = figure.data
    for one, cfd, span, model, raw in zip(strokes, by_cfd.x, by_model.error_x.array, by_model.x, as_is.x, strict=True):
        assert one.cfd_power is not None
        assert one.own_hovering_power is not None
        assert cfd == pytest.approx(100 * (1 - one.specific_power / one.cfd_power), rel=1e-6)  # Λ = 1
        assert span == pytest.approx(abs(cfd - model))
        assert model == pytest.approx(100 * (1 - one.specific_power / one.own_hovering_power), rel=1e-6)
        assert raw == pytest.approx(100 * (1 - one.specific_power / one.own_specific_power), rel=1e-6)
    assert (by_cfd.name, by_model.name) == (BY_CFD, BY_MODEL)
    assert (BY_CFD, BY_MODEL) == ("of CFD's power", "in this model, both carrying the weight")
    assert as_is.name == "in this model, both as they are"
    assert by_model.marker.color != by_model.error_x.color
    assert tuple(by_cfd.y) == INSECTS
    assert by_cfd.error_x.array is None


def test_the_own_stroke_saves_nothing_of_itself() -> None:
    by_model, _, as_is = savings([assess("hawkmoth")]).data
    np.testing.assert_allclose([*by_model.x, *as_is.x], 0, atol=1e-12)


def test_a_wing_without_cfd_has_no_bar_for_it_and_its_name_stays_a_name() -> None:
    robot = dataclasses.replace(load_insect("hawkmoth"), name="<b>$%{x}$</b>", cfd=None)
    by_model, by_cfd, _ = savings([assess(robot, optimum("hawkmoth").stroke)]).data
    assert by_cfd.x == (None,)
    assert (by_cfd.showlegend, by_model.showlegend) == (False, True)
    assert by_model.x[0] > 0
    assert by_cfd.y == ("&lt;b&gt;&#36;%&#123;x}&#36;&lt;/b&gt;",)
