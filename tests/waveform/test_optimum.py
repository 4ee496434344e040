"""The best free waveforms: found again, confirmed, never better than the bound, better with more knots."""

import math

import numpy as np
import pytest

from flapenv import INSECTS, HoverProblem, Insect, load_insect, optimum, simulate
from flapenv.case import hover_case
from flapenv.envs import WaveformVectorEnv
from flapenv.optimum import lower_bound
from flapenv.problem import PROBLEMS
from flapenv.waveform import WaveformCoordinates, evaluate_waveform, spline_optimum, waveform_performance
from flapenv.waveform.coordinates import Waveform
from flapenv.waveform.largest_lift import largest_weight_support
from flapenv.waveform.search_all import STARTS, refined_motion
from flapenv.waveform.shipped import known_optimum, shipped_waveforms

SHIPPED = ("free-frequency", "fixed-frequency", "profile-drag")


def known_power(insect: str, problem: str, knots: int) -> float:
    found = known_optimum(hover_case(load_insect(insect), PROBLEMS[problem].model), PROBLEMS[problem], knots)
    assert found is not None
    return found.specific_power


@pytest.mark.parametrize(
    ("insect", "problem", "knots"),
    [
        ("hawkmoth", "free-frequency", 8),
        ("hoverfly", "free-frequency", 16),
        ("bumblebee", "fixed-frequency", 8),
        ("hawkmoth", "fixed-frequency", 4),
        ("cranefly", "profile-drag", 8),
    ],
)
def test_a_search_finds_the_shipped_waveforms_power_again_and_no_less(insect: str, problem: str, knots: int) -> None:
    best = spline_optimum(insect, problem, knots=knots, seed=5)
    assert best.feasible
    assert best.starts >= 8
    assert best.weight_support == pytest.approx(1, abs=1e-6)
    near = 1e-5 if problem != "fixed-frequency" else 1e-2  # where f is fixed there are many local minima
    assert best.specific_power == pytest.approx(known_power(insect, problem, knots), rel=near)
    assert best.specific_power > known_power(insect, problem, knots) * (1 - 1e-5)
    assert best.specific_power > best.lower_bound
    if problem == "free-frequency":
        assert best.agreeing >= 4
        assert best.multiplier == pytest.approx(1.5 * best.specific_power, rel=1e-4)


@pytest.mark.parametrize("problem", SHIPPED)
def test_more_knots_never_need_more_power_and_none_goes_below_the_bound(problem: str) -> None:
    for name in INSECTS:
        case = hover_case(load_insect(name), PROBLEMS[problem].model)
        found = [known_optimum(case, PROBLEMS[problem], knots) for knots in STARTS]
        powers = [one.specific_power for one in found if one is not None]
        assert len(powers) >= 2
        assert np.all(np.diff(powers) < 0)
        assert powers[-1] > lower_bound(case, PROBLEMS[problem])


def test_knots_close_the_gap_to_the_bound_of_a_in_proportion() -> None:
    bound = lower_bound(hover_case(load_insect("hawkmoth"), PROBLEMS["free-frequency"].model), HoverProblem())
    gaps = [known_power("hawkmoth", "free-frequency", knots) / bound - 1 for knots in STARTS]
    assert gaps == pytest.approx([0.2477, 0.1029, 0.0477, 0.0230], abs=2e-4)
    assert [knots * gap for knots, gap in zip(STARTS, gaps, strict=True)][1:] == pytest.approx([0.78] * 3, abs=0.05)


def test_fewer_knots_are_a_start_for_more_that_loses_little_to_the_floor() -> None:
    coarse = spline_optimum("hawkmoth", knots=4)
    fine = refined_motion(coarse.motion)
    own = evaluate_waveform("hawkmoth", fine)
    lost = own.specific_power / own.weight_support**1.5 / coarse.specific_power - 1
    assert abs(lost) < 0.02  # the coefficient at the reversal came out zero and was lifted to the floor
    better = spline_optimum("hawkmoth", knots=8, guesses=(fine,))
    assert better.specific_power < min(coarse.specific_power, own.specific_power)
    assert better.starts == 9


def test_shipped_waveforms_serve_the_insects_and_the_oracle_confirms_them(insect: Insect) -> None:
    for problem in ("free-frequency", "fixed-frequency"):
        best = known_optimum(hover_case(insect, PROBLEMS[problem].model), PROBLEMS[problem], 8)
        assert best is not None
        motion = best.waveform.motion()
        history = simulate(insect, motion, strips=4, steps=4000, spacing="gauss")
        assert history.mean_lift == pytest.approx(insect.mass * 9.81, rel=1e-5)
        assert history.mean_power() / insect.mass == pytest.approx(best.specific_power, rel=1e-5)
        assert np.max(np.abs(history.kinematics.pitch)) <= PROBLEMS[problem].box.pitch_amplitude[1] + 1e-9
        assert evaluate_waveform(insect, motion).specific_power == pytest.approx(best.specific_power, rel=1e-6)


def test_in_a_the_waveform_is_nearly_a_triangle_and_in_b_a_short_beat_with_small_angles() -> None:
    time = 2 * math.pi * (np.arange(2000) + 0.5) / 2000
    for problem, constant in (("free-frequency", True), ("fixed-frequency", False)):
        case = hover_case(load_insect("bumblebee"), PROBLEMS[problem].model)
        best = known_optimum(case, PROBLEMS[problem], 16)
        assert best is not None
        motion = best.waveform.motion()
        speed = np.abs(motion.flap_rate(time)) / motion.mean_flap_speed
        moving = np.mean(speed > 0.5)
        assert (moving > 0.9) if constant else (moving < 0.35)
        assert (np.max(speed) < 1.2) if constant else (np.max(speed) > 3)
        attack = 90 - np.degrees(np.abs(motion.pitch_angle(time)[speed > 0.9 * np.max(speed)]))
        assert np.median(attack) == pytest.approx(25 if constant else 7.3, abs=1)


def test_free_waveforms_need_less_than_strokes_in_b_and_lift_every_insect() -> None:
    for name in INSECTS:
        stroke, power = optimum(name, "fixed-frequency"), known_power(name, "fixed-frequency", 8)
        assert stroke.lower_bound < power < (stroke.specific_power if stroke.feasible else math.inf)


@pytest.mark.parametrize("problem", SHIPPED)
def test_no_coefficients_that_lift_the_weight_go_below_the_bound(problem: str, rng: np.random.Generator) -> None:
    chosen = PROBLEMS[problem]
    case = hover_case(load_insect("honeybee"), chosen.model)
    bound = lower_bound(case, chosen)
    for knots in (4, 8, 16):
        coordinates = WaveformCoordinates(chosen, knots)
        points = rng.uniform(-1, 1, (20_000, len(coordinates)))
        points[:, -knots:] = np.abs(points[:, -knots:]) ** 0.3
        waveform, _ = coordinates.decode(points, case.reference)
        weight, power, _ = waveform_performance(case, chosen.model, waveform)
        hovers = weight >= 1
        assert np.mean(hovers) > 0.1
        assert np.min(power[hovers]) > bound
        if problem == "free-frequency":  # where P* >= bound Λ^1.5 for all that lift
            lifts = weight > 0
            assert np.min(power[lifts] / weight[lifts] ** 1.5) > bound


def test_the_waveform_of_the_largest_lift_is_hardly_beaten(rng: np.random.Generator) -> None:
    chosen, case = PROBLEMS["fixed-frequency"], hover_case(load_insect("hawkmoth"), PROBLEMS["fixed-frequency"].model)
    for knots in (4, 8, 16):
        coordinates = WaveformCoordinates(chosen, knots)
        largest = float(largest_weight_support(case, chosen, coordinates))
        points = np.sign(rng.normal(size=(20_000, len(coordinates))))
        points[:, -knots:] = rng.uniform(0.3, 0.7, (20_000, knots))
        waveform, _ = coordinates.decode(points, case.reference)
        assert np.max(waveform_performance(case, chosen.model, waveform)[0]) < largest * 1.01


def test_where_nothing_lifts_the_weight_the_largest_lift_is_reported() -> None:
    problem = HoverProblem(box={"frequency_ratio": (0.1, 0.2)})
    best = spline_optimum("ladybird", problem, knots=4)
    assert not best.feasible
    assert best.weight_support == pytest.approx(best.max_weight_support)
    assert best.weight_support < 1
    assert math.isinf(best.multiplier)


def test_a_wing_of_ones_own_has_a_known_optimum_in_a_and_none_in_b_unless_it_wants_the_same_lift() -> None:
    import dataclasses

    heavier = dataclasses.replace(load_insect("hawkmoth"), name="loaded", mass=1.2 * load_insect("hawkmoth").mass)
    for problem, expected in (("free-frequency", True), ("fixed-frequency", False)):
        case = hover_case(heavier, PROBLEMS[problem].model)
        assert (known_optimum(case, PROBLEMS[problem], 8) is not None) is expected
    found = known_optimum(hover_case(heavier, HoverProblem().model), HoverProblem(), 8)
    assert spline_optimum(heavier, knots=8).specific_power == pytest.approx(found.specific_power, rel=1e-6)
    follows = HoverProblem(model={"tip_loss": "stroke"})
    assert known_optimum(hover_case(heavier, follows.model), follows, 8) is None


def test_every_shipped_row_keeps_to_its_limits() -> None:
    rows = shipped_waveforms()
    assert {row.problem for row in rows} == set(SHIPPED)
    for row in rows:
        speed, pitch = np.array(row.speed_coefficients), np.array(row.pitch_coefficients)
        assert len(speed) == len(pitch) == row.knots
        assert np.min(speed) >= 0.01 * np.max(speed) * (1 - 1e-6)
        assert np.max(np.abs(pitch)) <= row.pitch_limit * (1 + 1e-8)
        if row.kind == "fixed":
            assert row.numbers[0] == pytest.approx(row.needed_lift, rel=1e-6)


def test_without_torch_the_extra_to_install_is_named(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("importlib.util.find_spec", lambda _: None)
    with pytest.raises(ImportError, match=r"pip install 'flapenv\[train\]'"):
        spline_optimum("hawkmoth")


@pytest.mark.parametrize(
    ("arguments", "kind", "said"),
    [
        ({"starts": 7}, ValueError, "starts = 7 is not allowed; allowed: whole numbers from 8"),
        ({"knots": 3}, ValueError, "knots = 3 is not allowed; allowed: whole numbers from 4"),
        ({"knots": 1000}, ValueError, "knots = 1000 is not allowed; allowed: whole numbers up to 256"),
        ({"problem": "inertial"}, ValueError, "accounting = 'positive' is not served by free waveforms"),
        (
            {"problem": HoverProblem(model={"coefficients": "robofly"})},
            ValueError,
            "coefficients = 'robofly' are not served by free waveforms; allowed: lifting-line",
        ),
    ],
)
def test_what_cannot_be_served_is_named(arguments: dict, kind: type[Exception], said: str) -> None:
    with pytest.raises(kind, match=said):
        spline_optimum("hawkmoth", **arguments)


def test_only_spline_motions_are_evaluated() -> None:
    with pytest.raises(TypeError, match="allowed: a SplineMotion"):
        evaluate_waveform("hawkmoth", load_insect("hawkmoth").stroke)


def test_coordinates_come_back_from_their_waveform(rng: np.random.Generator) -> None:
    for problem in SHIPPED:
        coordinates = WaveformCoordinates(PROBLEMS[problem], 6)
        assert len(coordinates.axis_names) == len(coordinates)
        points = rng.uniform(-0.3, 0.3, (50, len(coordinates)))
        points[:, len(coordinates.beat)] = 1.0  # the largest speed coefficient
        own = load_insect("honeybee").reference
        waveform, clipped = coordinates.decode(points, own)
        assert not clipped.any()
        assert isinstance(waveform, Waveform)
        assert coordinates.encode(waveform, own) == pytest.approx(points)
        assert coordinates.decode(points + 1.5, own)[1].all()


def test_the_reference_of_the_environment_is_the_search_of_its_own_problem(hawkmoth: Insect) -> None:
    env = WaveformVectorEnv(1, insect=hawkmoth, knots=4)
    found = spline_optimum(hawkmoth, env.problem, knots=4)
    assert env.objective.known[0].specific_power == pytest.approx(found.specific_power, rel=1e-6)
    assert found.lower_bound == pytest.approx(env.objective.bound[0])
    assert found.lower_bound == pytest.approx(optimum(hawkmoth).lower_bound)
