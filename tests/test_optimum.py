"""The proven bound and the best stroke of the box."""

import dataclasses
import math

import numpy as np
import pytest
from conftest import strokes
from hypothesis import given
from hypothesis import strategies as st
from scipy.optimize import OptimizeResult

from flapenv import HoverModel, HoverProblem, Insect, Stroke, evaluate, load_insect, optimum
from flapenv.aero.blade_element import blade_element
from flapenv.aero.force_laws import PlateLaw
from flapenv.case import hover_case, lift_constant
from flapenv.optimum import lower_bound

HAWKMOTH = load_insect("hawkmoth")
OPEN_BOX = {"flap_shape": (0.01, 0.9999), "pitch_shape": (0.1, 100.0)}
IN_BOX_OPTIMA = {  # W/kg, physics of the default box: an independent solution of the same problem
    "fruitfly": 11.63,
    "bumblebee": 29.57,
    "hawkmoth": 22.85,
    "honeybee": 29.92,
    "cranefly": 8.56,
    "hoverfly": 17.39,
    "dronefly": 21.89,
    "ladybird": 15.98,
}


def bound_of(problem: HoverProblem) -> float:
    return float(lower_bound(hover_case(HAWKMOTH, problem.model), problem))


def test_the_default_optimum_is_the_known_one_and_lies_4_to_5_percent_above_the_bound(insect: Insect) -> None:
    best = optimum(insect)
    assert best.specific_power == pytest.approx(IN_BOX_OPTIMA[insect.name], abs=0.006)
    assert 0.04 < best.gap_to_bound < 0.05
    assert best.feasible
    assert best.weight_support == pytest.approx(1, abs=1e-7)


def test_the_default_optimum_is_at_the_corner_the_proof_names_with_symmetric_rotation(insect: Insect) -> None:
    best = optimum(insect)
    corner = ("flap_amplitude", "flap_shape", "pitch_shape", "pitch_amplitude")
    assert best.active_bounds == tuple((name, "upper") for name in corner)
    assert best.stroke.pitch_phase == pytest.approx(math.pi / 2, abs=1e-4)
    assert 0.53 < best.stroke.frequency / insect.stroke.frequency < 1.26


def test_opening_the_box_closes_the_gap_to_the_bound() -> None:
    gaps = [
        optimum(HAWKMOTH, HoverProblem(box={"flap_shape": (0.01, flap), "pitch_shape": (0.1, pitch)})).gap_to_bound
        for flap, pitch in ((0.99, 10), (0.99, 20), (0.999, 50), (0.9999, 100))
    ]
    assert gaps == sorted(gaps, reverse=True)
    np.testing.assert_allclose(gaps, (0.0453, 0.032, 0.011, 0.004), atol=6e-4)
    assert gaps[-1] < 0.005


def test_the_optimum_is_confirmed_by_the_refined_oracle(insect: Insect) -> None:
    for problem in (HoverProblem(), HoverProblem(box=OPEN_BOX)):
        best = optimum(insect, problem)
        assert best.oracle_specific_power == pytest.approx(best.specific_power, rel=1e-8)
        assert best.oracle_weight_support == pytest.approx(best.weight_support, rel=1e-8)


def test_the_multiplier_is_what_the_scaling_of_problem_a_says(insect: Insect) -> None:
    best = optimum(insect)  # P* ∝ Λ^1.5 along the frequency
    assert best.multiplier == pytest.approx(1.5 * best.specific_power, rel=1e-4)


@given(strokes(sharpest_flap=1.0, sharpest_pitch=1000))
def test_no_stroke_of_the_family_beats_the_bound(stroke: Stroke) -> None:
    # scaled by its frequency to just carry the weight
    lift = evaluate(HAWKMOTH, stroke).weight_support
    hovering = dataclasses.replace(stroke, frequency=stroke.frequency / math.sqrt(lift))
    result = evaluate(HAWKMOTH, hovering)
    assert result.weight_support == pytest.approx(1, rel=1e-9)
    assert result.specific_power >= bound_of(HoverProblem()) * (1 - 1e-9)


@dataclasses.dataclass(frozen=True)
class FreeMotion:
    """Any periodic motion, flapping speed and pitch by their values at equal times: no family, no symmetry."""

    frequency: float
    flap_amplitude: float
    speed: np.ndarray
    pitch: np.ndarray

    def _at(self, values: np.ndarray, phase: np.ndarray) -> np.ndarray:
        return values[np.floor(phase / (2 * math.pi) * len(values)).astype(int) % len(values)]

    def flap_angle(self, phase: np.ndarray) -> np.ndarray:
        return np.zeros_like(phase)  # enters no force

    def flap_rate(self, phase: np.ndarray) -> np.ndarray:
        return self._at(self.speed, phase)

    def flap_acceleration(self, phase: np.ndarray) -> np.ndarray:
        return np.zeros_like(phase)  # nor do these

    pitch_rate = pitch_acceleration = flap_acceleration

    def pitch_angle(self, phase: np.ndarray) -> np.ndarray:
        return self._at(self.pitch, phase)


@given(
    seed=st.integers(0, 2**32 - 1),
    pieces=st.integers(2, 64),
    order=st.floats(0.0, 1.0),
    amplitude=st.floats(math.radians(40), math.radians(90)),
)
def test_no_free_waveform_within_the_pitch_limit_beats_the_bound(
    seed: int, pieces: int, order: float, amplitude: float
) -> None:
    """Piecewise constant speed and pitch, from random to nearly optimal (order = 1)."""
    rng = np.random.default_rng(seed)
    limit = math.pi / 2 - HoverProblem().min_angle_of_attack
    speed = rng.normal(size=2 * pieces)
    speed[:pieces] = order * 1 + (1 - order) * speed[:pieces]
    speed[pieces:] = -order * 1 + (1 - order) * speed[pieces:]
    speed -= np.mean(speed)  # it comes back to where it began
    pitch = np.clip(order * limit * np.sign(speed) + (1 - order) * rng.normal(size=2 * pieces), -limit, limit)
    motion = FreeMotion(frequency=1.0, flap_amplitude=amplitude, speed=speed, pitch=pitch)
    constant = lift_constant(hover_case(HAWKMOTH, HoverModel()), HoverModel(), 1.0, amplitude)
    history = blade_element(
        HAWKMOTH.wing,
        motion,
        PlateLaw(constant=constant),
        air_density=1.225,
        strips=4,
        steps=2 * pieces,
        spacing="gauss",
    )
    support = history.mean_lift / (HAWKMOTH.mass * 9.81)
    if support > 1e-12:
        needed = history.mean_power() / HAWKMOTH.mass / support**1.5  # sped up until it hovers
        assert needed >= bound_of(HoverProblem()) * (1 - 1e-9)


def test_the_bound_is_attained_by_the_triangle_and_the_square_wave() -> None:
    stroke = Stroke(
        frequency=20.0,
        flap_amplitude=math.pi / 2,
        pitch_amplitude=math.radians(65),
        flap_shape=1.0,
        pitch_shape=1e9,
    )
    result = evaluate(HAWKMOTH, stroke)
    assert result.specific_power / result.weight_support**1.5 == pytest.approx(bound_of(HoverProblem()), rel=1e-5)


@given(strokes(sharpest_flap=1.0, sharpest_pitch=1000))
def test_the_bound_holds_too_where_tip_loss_follows_the_stroke(stroke: Stroke) -> None:
    problem = HoverProblem(model={"tip_loss": "stroke"})
    reference = HAWKMOTH.stroke.frequency
    inside = dataclasses.replace(stroke, frequency=min(max(stroke.frequency, 0.5 * reference), 1.5 * reference))
    result = evaluate(HAWKMOTH, inside, tip_loss="stroke")
    if result.weight_support >= 1:
        assert result.specific_power >= bound_of(problem) * (1 - 1e-9)
    assert optimum(HAWKMOTH, problem).specific_power >= bound_of(problem)


def test_a_fixed_frequency_has_the_bound_of_the_mean_speed() -> None:
    pitch = (math.radians(30), math.radians(85))
    problem = HoverProblem(box={"frequency_ratio": 1.0, "flap_amplitude": 1.0, "pitch_amplitude": pitch})
    best = optimum("dronefly", problem)
    assert best.feasible
    assert 0.1 < best.gap_to_bound < 0.2  # loose: only impulsive strokes approach it


def test_a_box_without_angle_limit_still_has_a_positive_bound() -> None:
    problem = HoverProblem(box={"pitch_amplitude": (math.radians(30), math.radians(90))})
    best = optimum("dronefly", problem)
    assert 0 < best.lower_bound < best.specific_power < optimum("dronefly").specific_power


def test_an_infeasible_box_is_reported_with_its_largest_lift() -> None:
    problem = HoverProblem(box={"frequency_ratio": (0.1, 0.2)})
    best = optimum("ladybird", problem)
    assert not best.feasible
    assert 0 < best.max_weight_support < 1
    assert best.weight_support == pytest.approx(best.max_weight_support)
    assert best.multiplier == math.inf
    assert evaluate("ladybird", best.stroke).weight_support == pytest.approx(best.max_weight_support, rel=1e-8)


def test_a_box_that_lifts_nothing_and_boxes_of_the_sharpest_waveforms_are_answered() -> None:
    still = optimum("hawkmoth", HoverProblem(box={"pitch_phase": 0.0}))
    assert not still.feasible
    assert still.max_weight_support == pytest.approx(0, abs=1e-9)
    for pitch_shape in (1e5, 1e9):
        sharp = HoverProblem(box={"flap_shape": (0.01, 1.0), "pitch_shape": (0.1, pitch_shape)})
        best = optimum("hawkmoth", sharp)
        assert best.gap_to_bound == pytest.approx(0, abs=1e-3)


def test_at_the_very_limit_of_lift_the_optimum_still_carries_the_weight() -> None:
    box = {"flap_amplitude": 1.2, "pitch_phase": math.pi / 2, "pitch_amplitude": (math.radians(20), math.radians(80))}
    largest = optimum("hawkmoth", HoverProblem(box={**box, "frequency": 26.3})).max_weight_support
    for margin in (1 + 1e-6, 1 + 1e-3):
        best = optimum("hawkmoth", HoverProblem(box={**box, "frequency": 26.3 * math.sqrt(margin / largest)}))
        assert best.feasible
        assert best.weight_support >= 1 - 1e-7
        assert best.max_weight_support == pytest.approx(margin, abs=1e-6)


def test_a_search_that_ends_nowhere_still_answers_with_a_stroke_that_carries(monkeypatch: pytest.MonkeyPatch) -> None:
    def nowhere(function: object, start: np.ndarray, **_: object) -> OptimizeResult:
        return OptimizeResult(x=-np.ones_like(start))  # the slowest stroke of the box, far under weight

    monkeypatch.setattr("scipy.optimize.minimize", nowhere)
    best = optimum("hawkmoth", HoverProblem(name="nowhere"))
    assert best.feasible
    assert best.weight_support >= 1 - 1e-7


def test_weight_that_does_not_bind_costs_nothing() -> None:
    best = optimum("ladybird", HoverProblem(box={"frequency_ratio": (8.0, 9.0)}))
    assert best.feasible
    assert best.weight_support > 1
    assert best.multiplier == 0


def test_a_box_of_one_stroke_is_its_own_optimum() -> None:
    one = {"flap_amplitude": 1.2, "flap_shape": 0.5, "pitch_shape": 5.0, "pitch_amplitude": 1.0, "pitch_phase": 1.5}
    best = optimum("hawkmoth", HoverProblem(box={**one, "frequency": 40.0}))
    assert vars(best.stroke) == {**one, "frequency": 40.0}
    assert best.feasible


def test_the_optimum_beats_every_random_stroke_that_hovers(rng: np.random.Generator) -> None:
    best, box = optimum(HAWKMOTH), HoverProblem().box
    values = {name: rng.uniform(*box.bounds(name, HAWKMOTH.reference), size=20_000) for name in box.free}
    result = evaluate(HAWKMOTH, Stroke(**values))
    assert np.min(result.specific_power[result.weight_support >= 1]) > best.specific_power


def test_a_larger_box_is_never_worse_however_far_its_logarithmic_axes_reach() -> None:
    pitch = {"pitch_amplitude": (0.0, math.pi / 2)}
    inner = optimum("fruitfly", HoverProblem(box={**pitch, "pitch_shape": (0.1, 100.0)}))
    outer = optimum("fruitfly", HoverProblem(box={**pitch, "pitch_shape": (0.0, 100.0), "flap_shape": (0.0, 0.99)}))
    widest = optimum("fruitfly", HoverProblem(box={**pitch, "pitch_shape": (0.0, 1e5), "flap_shape": (0.0, 1.0)}))
    assert inner.specific_power * (1 + 1e-6) >= outer.specific_power >= widest.specific_power * (1 - 1e-6)


def test_of_two_basins_the_better_is_found() -> None:
    box = {"flap_amplitude": 0.8549047, "pitch_amplitude": (0.8223994, 1.4752932)}
    best = optimum("bumblebee", HoverProblem(box=box, model={"tip_loss": "stroke"}))
    starts = [{"flap_shape": (0.9, 0.99), "pitch_shape": (8, 10)}, {"flap_shape": (0.01, 0.2), "pitch_shape": (2, 5)}]
    for start in starts:
        part = optimum("bumblebee", HoverProblem(box={**box, **start}, model={"tip_loss": "stroke"}))
        assert best.specific_power <= part.specific_power * (1 + 1e-6)


def test_the_bound_of_any_waveform_is_the_angle_bound_which_wins_in_the_default_box(insect: Insect) -> None:
    slow = HoverProblem(box={"frequency_ratio": (1e-3, 1.5)})  # its speed bound is no larger
    case = hover_case(insect, HoverModel())
    assert float(lower_bound(case, HoverProblem())) == float(lower_bound(case, slow))
    fixed = HoverProblem(box={"frequency_ratio": (0.1, 0.35)})
    assert float(lower_bound(case, fixed)) >= float(lower_bound(case, HoverProblem()))


def test_each_pair_of_insect_and_problem_is_solved_once() -> None:
    assert optimum("fruitfly") is optimum(load_insect("fruitfly"), HoverProblem())


def test_what_is_not_one_insect_is_refused() -> None:
    several = np.array([0.3, 0.5])
    for herd in (
        dataclasses.replace(HAWKMOTH, mass=several),
        dataclasses.replace(HAWKMOTH, wing=dataclasses.replace(HAWKMOTH.wing, r1_hat=several)),
        dataclasses.replace(HAWKMOTH, stroke=dataclasses.replace(HAWKMOTH.stroke, pitch_shape=several)),
    ):
        with pytest.raises(TypeError, match="insect has array fields"):
            optimum(herd)
    with pytest.raises(ValueError, match="insect = 'moth'"):
        optimum("moth")
    with pytest.raises(TypeError, match="problem = 3"):
        optimum("hawkmoth", 3)


def test_the_gap_charges_missing_weight_ten_times() -> None:
    best = optimum("hawkmoth")
    assert best.gap(1.0, 1.1 * best.specific_power) == pytest.approx(0.1)
    assert best.gap(0.99, best.specific_power) == pytest.approx(0.1)
    assert best.gap(1.5, best.specific_power) == pytest.approx(0)
    assert optimum("hawkmoth", HoverProblem(box={"frequency_ratio": (0.1, 0.2)})).gap(0.5, 10.0) is None
