"""Gusts and the random numbers behind them."""

import math

import numpy as np
import pytest

from flapenv.heave.gusts import LARGEST_GUST, EpisodeStreams, GustModel


def streams(rows: int, key: int = 12345) -> EpisodeStreams:
    made = EpisodeStreams(rows)
    made.begin(np.ones(rows, dtype=bool), key)
    return made


def walk(model: GustModel, rows: int, beats: int) -> np.ndarray:
    made = streams(rows)
    gust = [model.first(made.normal(0))]
    for beat in range(beats - 1):
        gust.append(model.following(gust[-1], made.normal(2 + 2 * beat)))
    return np.array(gust)


def test_gusts_are_stationary_with_the_strength_and_correlation_asked_for() -> None:
    gusts = walk(GustModel(strength=0.02, correlation=20.0), 20_000, 60)
    for beat in (0, 1, 30, 59):
        assert np.std(gusts[beat]) == pytest.approx(0.02, rel=0.02)
        assert abs(np.mean(gusts[beat])) < 6e-4
    for lag in (1, 20, 40):
        found = np.mean(gusts[lag:] * gusts[:-lag]) / np.mean(gusts**2)
        assert found == pytest.approx(math.exp(-lag / 20), abs=0.02)


def test_gusts_have_a_bound_and_no_strength_means_none() -> None:
    model = GustModel()
    assert model.following(np.array([0.1]), np.array([50.0]))[0] == LARGEST_GUST * model.strength
    assert model.first(np.array([-9.0]))[0] == -LARGEST_GUST * model.strength
    assert not walk(GustModel(strength=0.0), 10, 5).any()


def test_numbers_depend_on_row_episode_and_place_alone() -> None:
    some, more = streams(3), streams(8)
    np.testing.assert_array_equal(some.uniform(4), more.uniform(4)[:3])
    np.testing.assert_array_equal(some.uniform(4), some.uniform(np.array([4, 4, 4])))
    before = some.uniform(7)
    some.begin(np.array([False, True, False]), None)
    after = some.uniform(7)
    assert list(before == after) == [True, False, True]
    assert np.all(streams(3).uniform(4) != streams(3, key=12346).uniform(4))


def test_a_key_begins_the_series_again() -> None:
    made = streams(2)
    first = made.uniform(0)
    made.begin(np.ones(2, dtype=bool), None)
    assert np.all(made.uniform(0) != first)
    made.begin(np.ones(2, dtype=bool), 12345)
    np.testing.assert_array_equal(made.uniform(0), first)


def test_uniform_and_normal_numbers_are_what_they_say() -> None:
    made = streams(200_000)
    uniform, normal, other = made.uniform(0), made.normal(1), made.normal(3)
    assert np.all((uniform > 0) & (uniform < 1))
    assert np.histogram(uniform, 20, (0, 1))[0] == pytest.approx(np.full(20, 10_000), rel=0.05)
    assert [np.mean(normal**n) for n in (1, 2, 3, 4)] == pytest.approx([0, 1, 0, 3], abs=0.06)
    for one, two in ((uniform, normal), (normal, other), (normal[:-1], normal[1:])):
        assert abs(np.corrcoef(one, two)[0, 1]) < 0.01


@pytest.mark.parametrize(
    ("fields", "said"),
    [
        ({"strength": -0.1}, "gust strength = -0.1"),
        ({"strength": 0.2}, "gust strength = 0.2"),
        ({"strength": math.nan}, "gust strength"),
        ({"correlation": 0}, "gust correlation = 0"),
    ],
)
def test_bad_gusts_are_refused(fields: dict[str, float], said: str) -> None:
    with pytest.raises(ValueError, match=said):
        GustModel(**fields)
