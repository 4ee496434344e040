"""The lift ladder: its rungs are optimal, and what it calls the optimum is one."""

import numpy as np
import pytest

from flapenv import HoverModel, HoverProblem, StrokeBox, load_insect, optimum
from flapenv.adapt import NOMINAL, AdaptTask, Condition, flown
from flapenv.adapt.ladder import BOX, lift_ladder
from flapenv.adapt.rungs import solve_rungs
from flapenv.aero.wingbeat import speed_averages
from flapenv.case import HoverCase
from flapenv.performance import hover_averages
from flapenv.shape_curve import shapes_of

CONDITIONS = (
    NOMINAL,
    Condition(payload=1.1, density_ratio=1.05),
    Condition(payload=1.25, density_ratio=0.9),
    Condition(payload=1.1, density_ratio=0.85, span_lost=0.06),
    Condition(payload=1.05, density_ratio=0.95, span_lost=0.15),
)


def _case() -> HoverCase:
    """Any wing; waveforms do not depend on it."""
    task = AdaptTask((load_insect("bumblebee"),))
    return task.cases(np.zeros(1, dtype=np.intp), NOMINAL)


@pytest.fixture(scope="module")
def task() -> AdaptTask:
    return AdaptTask((load_insect("bumblebee"), load_insect("cranefly")))


def test_the_shipped_rungs_are_what_solving_gives() -> None:
    ladder = lift_ladder()
    lift, power = shapes_of(BOX).numbers(solve_rungs(17))
    assert (lift[0], lift[-1]) == pytest.approx((ladder.lift[0], ladder.largest_lift), rel=1e-7)
    np.testing.assert_allclose(ladder.rung(_case(), HoverModel(), lift).power, power, rtol=2e-6)


def test_no_waveform_gives_a_lift_for_less_than_its_rung(rng: np.random.Generator) -> None:
    ladder, shapes = lift_ladder(), shapes_of(BOX)
    points = np.concatenate([rng.uniform(-1, 1, (20000, 4)), rng.choice([-1.0, 1.0], (2000, 4))])
    lift, power = shapes.numbers(points)
    assert np.max(lift) <= ladder.largest_lift * (1 + 1e-9)
    useful = lift > ladder.lift[0]
    rung = ladder.rung(_case(), HoverModel(), lift[useful])
    assert np.all(power[useful] >= rung.power * (1 - 1e-6))
    worst = power[lift > 0.1] / lift[lift > 0.1] ** 1.5
    assert np.min(worst) >= ladder.power[0] / ladder.lift[0] ** 1.5 * (1 - 1e-9)


def test_climbing_costs_ever_more() -> None:
    ladder = lift_ladder()
    assert np.all(np.diff(ladder.lift) > 0)
    assert np.all(np.diff(ladder.power / ladder.lift**1.5) > 0)  # so φmax comes first, then the waveform
    assert np.all(np.diff(np.diff(ladder.power) / np.diff(ladder.lift)) > -1e-4)  # convex, so the penalty is exact


def test_waveforms_between_the_rungs_give_the_lift_they_are_asked_for(rng: np.random.Generator) -> None:
    ladder = lift_ladder()
    wanted = rng.uniform(ladder.lift[0], ladder.largest_lift / 1.05, 200)
    lift, power = speed_averages(**ladder.waveform(wanted), rule=BOX.time_rule(tolerance=1e-9))
    np.testing.assert_allclose(lift, wanted, rtol=1e-4)
    np.testing.assert_allclose(power, ladder.rung(_case(), HoverModel(), wanted).power, rtol=3e-4)


@pytest.mark.parametrize("number", range(len(CONDITIONS)))
@pytest.mark.parametrize("insect", [0, 1])
@pytest.mark.filterwarnings("ignore:.*aspect ratio:UserWarning")
def test_full_knowledge_is_the_optimum_of_the_equivalent_insect(task: AdaptTask, insect: int, number: int) -> None:
    condition = CONDITIONS[number]
    flight = task.flight(np.array([insect]), condition)
    changed, air = flown(task.insects[insect], condition, task.model)
    frequency = float(task.frequency[insect])
    best = optimum(changed, HoverProblem(box=StrokeBox(frequency=(frequency, frequency)), model=air))
    assert flight.best_power[0] == pytest.approx(best.specific_power, rel=1e-5)
    assert flight.reference_power[0] == pytest.approx(best.lower_bound, rel=1e-8)
    assert flight.max_weight_support[0] == pytest.approx(best.max_weight_support, rel=1e-7)
    assert flight.multiplier[0] == pytest.approx(best.multiplier, rel=1e-3)
    rung = task.ladder.rung(flight.case, task.model, 1 / task.ladder.full_lift(flight.case, task.model))
    assert rung.flap_amplitude[0] == pytest.approx(best.stroke.flap_amplitude, rel=1e-4)


def test_no_stroke_tried_hovers_with_less(task: AdaptTask, rng: np.random.Generator) -> None:
    rows = 20000
    index = np.repeat([0, 1], rows // 2)
    draws = task.draw(rng, index)
    flight = task.flight(index, draws.before)
    span = {name: BOX.bounds(name, flight.case.reference) for name in ("flap_amplitude", "flap_shape", "pitch_shape")}
    span |= {name: getattr(BOX, name) for name in ("pitch_amplitude", "pitch_phase")}
    strokes = {name: rng.uniform(low, high, rows) for name, (low, high) in span.items()}
    strokes["frequency"] = task.frequency[index]
    weight_support, power = hover_averages(flight.case, task.model, **strokes, rule=BOX.time_rule(tolerance=1e-9))
    hovers = weight_support >= 1
    assert np.sum(hovers) > 1000
    assert np.all(power[hovers] > flight.best_power[hovers])
    assert np.all(weight_support <= flight.max_weight_support)


def test_the_multiplier_is_the_price_of_more_lift(task: AdaptTask, rng: np.random.Generator) -> None:
    index = np.zeros(300, dtype=np.intp)
    flight = task.flight(index, task.draw(rng, index).before)
    full, ladder = task.ladder.full_lift(flight.case, task.model), task.ladder

    def power(wanted: float) -> np.ndarray:
        rung = ladder.rung(flight.case, task.model, wanted / full)
        weight_support, power, _ = task.loads(flight.case, rung.flap_amplitude, rung.lift, rung.power)
        np.testing.assert_allclose(weight_support, wanted, rtol=1e-9)
        return power

    step = 1e-5
    slope = (power(1 + step) - power(1 - step)) / (2 * step)
    away = np.abs(full * ladder.lift[0] - 1) > 1e-3  # not at the corner, where the price jumps
    np.testing.assert_allclose(slope[away], flight.multiplier[away], rtol=2e-2)
    assert np.median(np.abs(slope / flight.multiplier - 1)) < 1e-4
