"""The task: what is drawn, and that the reward asks for the cheapest stroke that carries the weight."""

import dataclasses

import numpy as np
import pytest

from flapenv import INSECTS, HoverProblem, Insect, Stroke, StrokeBox, Wing, WingFactors, load_insect, optimum
from flapenv.adapt import NOMINAL, AdaptTask
from flapenv.adapt.conditions import DENSITY_RATIO, PAYLOAD, SPAN_LOST
from flapenv.adapt.task import BEATS, CHANGE, LEAST_MARGIN, choose

ROWS = 4000


@pytest.fixture(scope="module")
def task() -> AdaptTask:
    return AdaptTask(tuple(load_insect(name) for name in INSECTS))


def test_nominal_flight_has_the_bound_of_problem_a_and_its_optimum_at_a_lower_amplitude(task: AdaptTask) -> None:
    flight = task.flight(np.arange(len(INSECTS)), NOMINAL)
    bounds = [optimum(name).lower_bound for name in INSECTS]
    np.testing.assert_allclose(flight.reference_power, bounds, rtol=1e-7)
    assert np.all(flight.best_power > [optimum(name).specific_power for name in INSECTS])  # f is not free here
    np.testing.assert_allclose(task.frequency, [1.15 * optimum(name).stroke.frequency for name in INSECTS], rtol=1e-6)


def test_draws_lie_in_their_ranges_and_can_be_hovered_in(task: AdaptTask, rng: np.random.Generator) -> None:
    index = rng.integers(len(INSECTS), size=ROWS)
    draws = task.draw(rng, index)
    for condition in (draws.before, draws.after):
        for name, (low, high) in (("payload", PAYLOAD), ("density_ratio", DENSITY_RATIO), ("span_lost", SPAN_LOST)):
            values = getattr(condition, name)
            assert low <= values.min() < low + 0.05 * (high - low)
            assert high - 0.05 * (high - low) < values.max() <= high
        assert np.min(task.flight(index, condition).max_weight_support) >= LEAST_MARGIN


def test_one_thing_changes_and_lost_span_does_not_come_back(task: AdaptTask, rng: np.random.Generator) -> None:
    draws = task.draw(rng, np.zeros(ROWS, dtype=np.intp))
    loaded = draws.before.payload != draws.after.payload
    cut = draws.before.span_lost != draws.after.span_lost
    assert np.all(loaded ^ cut)
    assert 0.3 < np.mean(cut) < 0.7
    assert np.all(draws.after.span_lost >= draws.before.span_lost)
    np.testing.assert_array_equal(draws.before.density_ratio, draws.after.density_ratio)
    beats, counts = np.unique(draws.change_beat, return_counts=True)
    np.testing.assert_array_equal(beats, np.arange(CHANGE[0], CHANGE[1] + 1))
    assert counts.max() < 1.3 * counts.min()
    assert CHANGE[1] < BEATS


def test_the_same_generator_draws_the_same(task: AdaptTask) -> None:
    index = np.arange(64) % len(INSECTS)
    one, same, other = (task.draw(np.random.default_rng(seed), index) for seed in (3, 3, 4))
    np.testing.assert_array_equal(one.before.payload, same.before.payload)
    np.testing.assert_array_equal(one.after.span_lost, same.after.span_lost)
    assert np.any(one.before.payload != other.before.payload)


def test_the_best_reward_of_a_condition_belongs_to_the_optimum_which_carries_the_weight(
    task: AdaptTask, rng: np.random.Generator
) -> None:
    index = rng.integers(len(INSECTS), size=ROWS)
    flight = task.flight(index, task.draw(rng, index).before)
    full, ladder = task.ladder.full_lift(flight.case, task.model), task.ladder
    rewards = []
    places = np.linspace(0.5, 1.04, 109)  # in Λ; the 101st is 1
    for wanted in places:
        rung = ladder.rung(flight.case, task.model, wanted / full)
        weight_support, power, _ = task.loads(flight.case, rung.flap_amplitude, rung.lift, rung.power)
        rewards.append(task.reward_terms(flight, weight_support, power)[0])
    np.testing.assert_allclose(places[np.argmax(rewards, axis=0)], 1.0)
    np.testing.assert_allclose(np.max(rewards, axis=0), flight.best_reward, rtol=1e-8)
    assert np.all(flight.lift_penalty >= 2 * flight.multiplier / flight.reference_power - 1e-9)


def test_rows_are_chosen_one_by_one(task: AdaptTask, rng: np.random.Generator) -> None:
    index = np.zeros(6, dtype=np.intp)
    draws = task.draw(rng, index)
    before, after = task.flight(index, draws.before), task.flight(index, draws.after)
    mask = np.array([True, False, True, False, False, True])
    mixed = choose(mask, after, before)
    np.testing.assert_array_equal(mixed.best_power, np.where(mask, after.best_power, before.best_power))
    np.testing.assert_array_equal(mixed.case.lift_scale[mask], after.case.lift_scale[mask])
    assert mixed.cast("float32").case.lift_scale.dtype == np.float32


def test_an_insect_that_cannot_hover_in_problem_a_is_refused() -> None:
    heavy = dataclasses.replace(load_insect("hawkmoth"), name="heavy", mass=1e-2)
    with pytest.raises(ValueError, match="insect 'heavy' is not allowed: its largest weight support"):
        AdaptTask((heavy,))


def test_an_insect_that_is_too_light_for_problem_a_flies_at_its_lowest_frequency() -> None:
    feather = dataclasses.replace(load_insect("bumblebee"), name="feather", mass=1e-5)
    task = AdaptTask((feather,))
    assert task.frequency[0] == pytest.approx(1.15 * optimum(feather).stroke.frequency, rel=1e-6)
    flight = task.flight(np.zeros(1, dtype=np.intp), NOMINAL)
    frequency = float(task.frequency[0])
    best = optimum(feather, HoverProblem(box=StrokeBox(frequency=(frequency, frequency))))
    assert best.weight_support > 1.1  # even the smallest amplitude lifts more than it has to
    assert flight.best_power[0] == pytest.approx(best.specific_power, rel=1e-6)
    assert flight.multiplier[0] == best.multiplier == 0


def test_an_insect_that_barely_hovers_in_problem_a_still_has_conditions_to_draw_from(rng: np.random.Generator) -> None:
    wing = Wing(length=0.05, mean_chord=0.015, r1_hat=0.5)
    stroke = Stroke(frequency=20.0, flap_amplitude=1.0, pitch_amplitude=1.0)
    factors = WingFactors(k_ind=1.15, k_tip=1.1)  # whatever the mass
    light = Insect(name="light", mass=1e-3, wing=wing, stroke=stroke, k_table=factors)
    barely = dataclasses.replace(light, name="barely", mass=1e-3 * optimum(light).max_weight_support / 1.02)
    assert 1 < optimum(barely).max_weight_support < 1.03
    task, index = AdaptTask((barely,)), np.zeros(ROWS, dtype=np.intp)
    assert task.frequency[0] == pytest.approx(1.15 * optimum(barely).stroke.frequency, rel=1e-6)
    assert task.flight(index[:1], NOMINAL).max_weight_support[0] > 1.15**2
    assert task.acceptance(rng, index) > 0.03
