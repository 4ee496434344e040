"""Hidden conditions: limits, scaling, and the table against cut wings computed afresh."""

from typing import Any

import numpy as np
import pytest

from flapenv import INSECTS, FunctionPlanform, HoverModel, Insect, Stroke, Wing, load_insect
from flapenv.adapt import NOMINAL, Condition, flown
from flapenv.adapt.conditions import ConditionTable
from flapenv.case import hover_case

MODEL = HoverModel()
FIELDS = ("lift_scale", "power_scale", "aspect_ratio", "edge_correction", "wing_factor", "downwash_rate")
ALL = tuple(load_insect(name) for name in INSECTS)


def own(planform: Any) -> Insect:
    """A wing of another planform, whose factors are computed."""
    wing = Wing(length=0.02, mean_chord=0.0055, planform=planform)
    stroke = Stroke(frequency=60.0, flap_amplitude=1.1, pitch_amplitude=1.0)
    return Insect(name="own", mass=3e-4, wing=wing, stroke=stroke)


def rounded(r_hat: np.ndarray) -> np.ndarray:
    """A smooth planform that is none of Ellington's."""
    return np.sqrt(r_hat * (1 - r_hat)) * (1 + 0.4 * r_hat)


def direct(insect: Insect, condition: Condition) -> list[float]:
    """The case of the cut wing."""
    case = hover_case(*flown(insect, condition, MODEL))
    return [float(getattr(case, name)) for name in FIELDS]


def test_nominal_flight_is_hover(insect: Insect) -> None:
    expected = [float(getattr(hover_case(insect, MODEL), name)) for name in FIELDS]
    assert direct(insect, NOMINAL) == pytest.approx(expected, rel=1e-12)
    case = ConditionTable((insect,), MODEL).cases(np.zeros(1, dtype=np.intp), NOMINAL)
    assert [float(getattr(case, name)[0]) for name in FIELDS] == pytest.approx(expected, rel=1e-8)


def test_the_table_agrees_with_wings_that_are_cut_afresh(rng: np.random.Generator) -> None:
    rows = 48
    index = np.arange(rows) % len(ALL)
    condition = Condition(
        payload=rng.uniform(1, 1.25, rows),
        density_ratio=rng.uniform(0.8, 1.05, rows),
        span_lost=0.15 * rng.uniform(0, 1, rows) ** 3,  # where it changes most
    )
    case = ConditionTable(ALL, MODEL).cases(index, condition)
    for row in range(rows):
        one = Condition(**{name: float(value[row]) for name, value in vars(condition).items()})
        found = [float(getattr(case, name)[row]) for name in FIELDS]
        assert found == pytest.approx(direct(ALL[index[row]], one), rel=1e-7)


@pytest.mark.parametrize(
    ("insect", "tolerance"),
    [
        (own(FunctionPlanform(function=rounded)), 1e-6),
        (own({"r_hat": [0, 0.3, 0.7, 1], "chord": [0.6, 1, 0.9, 0]}), 2e-4),  # corners are met to 64 terms only
    ],
)
def test_other_planforms_and_computed_factors_work_too(insect: Insect, tolerance: float) -> None:
    table = ConditionTable((insect,), MODEL)
    for lost in (0.0, 0.004, 0.06, 0.15):
        condition = Condition(payload=1.2, density_ratio=0.85, span_lost=lost)
        case = table.cases(np.zeros(1, dtype=np.intp), condition)
        found = [float(getattr(case, name)[0]) for name in FIELDS]
        assert found == pytest.approx(direct(insect, condition), rel=tolerance)


def test_lift_goes_with_density_over_payload_and_so_does_power_per_kilogram_carried() -> None:
    table, index = ConditionTable(ALL, MODEL), np.arange(len(ALL))
    plain = table.cases(index, NOMINAL)
    loaded = table.cases(index, Condition(payload=1.2, density_ratio=0.9))
    for name in ("lift_scale", "power_scale"):
        np.testing.assert_allclose(getattr(loaded, name) / getattr(plain, name), 0.9 / 1.2, rtol=1e-12)
    for name in ("aspect_ratio", "edge_correction"):
        np.testing.assert_array_equal(getattr(loaded, name), getattr(plain, name))


def test_every_burden_raises_the_induced_power_factor() -> None:
    table, index = ConditionTable(ALL, MODEL), np.arange(len(ALL))
    plain = table.cases(index, NOMINAL).wing_factor
    for burden in ({"payload": 1.25}, {"density_ratio": 0.8}, {"span_lost": 0.1}):
        assert np.all(table.cases(index, Condition(**burden)).wing_factor > plain)
    assert np.all(table.cases(index, Condition(density_ratio=1.05)).wing_factor < plain)


@pytest.mark.parametrize(
    ("values", "kind"),
    [
        ({"payload": 0.9}, ValueError),
        ({"density_ratio": 1.2}, ValueError),
        ({"span_lost": 0.2}, ValueError),
        ({"span_lost": np.nan}, ValueError),
        ({"payload": "much"}, TypeError),
        ({"wind": 1.0}, TypeError),
    ],
)
def test_conditions_outside_their_range_are_refused(values: dict[str, Any], kind: type[Exception]) -> None:
    with pytest.raises(kind, match=next(iter(values))):
        Condition(**values)


def test_a_blunt_tip_costs_at_once_and_hardly_more_after_that() -> None:
    table, index = ConditionTable(ALL, MODEL), np.arange(len(ALL))
    _, _, _, little = table.cut(index, 0.05)
    _, _, _, most = table.cut(index, 0.15)
    assert np.all((little > 1.08) & (little < 1.16))
    assert np.all((most >= little) & (most < little + 0.03))
    ratios = table.cases(index, Condition(span_lost=0.15)).aspect_ratio
    assert 2.2 < ratios.min() < 2.25  # below what the paper states the lifting line for
