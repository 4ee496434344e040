"""Model options: coefficients by name and by function, their ranges, and what follows from them everywhere."""

import dataclasses
import json
import math
import warnings

import gymnasium as gym
import numpy as np
import pytest
import torch
from conftest import strokes
from hypothesis import given, settings

from flapenv import (
    COEFFICIENTS,
    HoverModel,
    HoverProblem,
    Insect,
    Stroke,
    Wing,
    evaluate,
    load_insect,
    optimum,
)
from flapenv.aero.parameters import STROKE_PARAMETERS
from flapenv.case import force_law, hover_case, model_wing
from flapenv.insects import ForceConstants
from flapenv.objective import HoverObjective
from flapenv.simulation import evaluate_by_blade_element

FRUITFLY, HAWKMOTH = load_insect("fruitfly"), load_insect("hawkmoth")
QUIET = "ignore:.*outside the range of the:UserWarning"
"""Coefficients are compared here on wings that their theories are not meant for."""


def steep(alpha: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """A user's own coefficients: those of the plate with C_T = 1.5."""
    return 1.5 * np.sin(2 * alpha), 3.0 * np.sin(alpha) ** 2


@pytest.mark.filterwarnings(QUIET)
@pytest.mark.parametrize("coefficients", [*COEFFICIENTS, steep])
@given(stroke=strokes(sharpest_flap=0.9, sharpest_pitch=6.0))
@settings(max_examples=15)
def test_the_fast_path_meets_the_oracle_under_every_model(coefficients: object, stroke: Stroke) -> None:
    options = {"coefficients": coefficients, "profile_drag": 0.1}
    ours = evaluate(FRUITFLY, stroke, **options)
    oracle = evaluate_by_blade_element(FRUITFLY, stroke, strips=8, steps=4000, spacing="gauss", **options)
    tolerance = 1e-4 if coefficients == "robofly" else 1e-5  # its lift jumps at 90°, between two steps of the oracle
    np.testing.assert_allclose((ours.weight_support, ours.specific_power), oracle, rtol=tolerance)


def test_berman_and_wangs_model_gives_their_weight_support() -> None:
    """1.003, 0.95, 1.15 in Table 3; their air is 1.29 kg/m³, the kinematics Table 1's with Cθ = 5."""
    expected = {"fruitfly": 1.007, "bumblebee": 0.943, "hawkmoth": 1.173}
    for name, value in expected.items():
        ours = evaluate(name, coefficients="berman-wang", air_density=1.29).weight_support
        assert ours == pytest.approx(value, abs=0.01)
        assert ours == pytest.approx(load_insect(name).berman_wang.weight_support, abs=0.025)
    assert model_wing(FRUITFLY, HoverModel(coefficients="berman-wang")).moment(2) == pytest.approx(1 / 4)


def test_berman_and_wangs_constants_are_of_three_insects_or_ones_own() -> None:
    with pytest.raises(ValueError, match="no constants for cranefly; allowed: fruitfly, bumblebee, hawkmoth, or"):
        evaluate("cranefly", coefficients="berman-wang")
    constants = ForceConstants(lift_constant=1.2, zero_drag=0.1, normal_drag=2.5)
    own = dataclasses.replace(load_insect("cranefly"), force_constants=constants)
    assert evaluate(own, coefficients="berman-wang").lift_constant == 1.2
    with pytest.raises(ValueError, match=r"zero_drag = -0.1 "):
        dataclasses.replace(constants, zero_drag=-0.1)


def test_a_users_function_that_is_the_plate_gives_what_the_plate_gives(insect: Insect) -> None:
    own = evaluate(insect, coefficients=steep)
    scale = 1.5 / evaluate(insect).lift_constant
    assert own.weight_support == pytest.approx(scale * evaluate(insect).weight_support, rel=1e-9)
    assert own.specific_power == pytest.approx(scale * evaluate(insect).specific_power, rel=1e-9)
    assert own.lift_constant == pytest.approx(1.5)
    assert own.induced_power_factor == 1


def test_profile_drag_costs_power_and_leaves_the_lift() -> None:
    plain, rough = evaluate(HAWKMOTH), evaluate(HAWKMOTH, profile_drag=0.1)
    assert rough.weight_support == pytest.approx(plain.weight_support, rel=1e-9)
    # ρ c̄ R⁴ r̂₃³/m C_D0 ⟨|φ̇|³⟩, with ⟨|φ̇|³⟩ = (π²/6) v̄³ of a sinusoid (two wings)
    case, speed = hover_case(HAWKMOTH, HoverModel()), HAWKMOTH.stroke.mean_flap_speed
    added = case.power_scale * 0.1 * math.pi**2 / 6 * speed**3
    assert rough.specific_power - plain.specific_power == pytest.approx(added, rel=1e-9)


@pytest.mark.filterwarnings(QUIET)
def test_the_ranking_of_the_models_is_that_of_their_constants() -> None:
    lift = {name: evaluate(FRUITFLY, coefficients=name).weight_support for name in COEFFICIENTS}
    assert lift["robofly"] == pytest.approx(1.35 * lift["lifting-line"], rel=0.1)  # 35-44 % above with the full k
    assert lift["polhamus"] > lift["lifting-line"]  # (3.1) overpredicts
    k_free = evaluate(FRUITFLY, coefficients="extended-lifting-line")
    assert k_free.induced_power_factor == 1


@pytest.mark.parametrize(
    ("coefficients", "ratio", "said"),
    [
        ("lifting-line", 2.0, "robot: aspect ratio 2 .*lifting-line model, good above 2.8; .*'extended-lifting-line'"),
        ("extended-lifting-line", 4.0, "aspect ratio 4 .*extended-lifting-line model, good below 3; .*'lifting-line'"),
        ("polhamus", 4.0, "aspect ratio 4 .*polhamus model, good below 2; alternative: coefficients='lifting-line'"),
    ],
)
def test_a_wing_outside_a_theorys_range_is_warned_of(coefficients: str, ratio: float, said: str) -> None:
    wing = Wing(length=0.01, mean_chord=0.01 / ratio, r1_hat=0.5)
    robot = dataclasses.replace(HAWKMOTH, name="robot", wing=wing, k_table=None)
    with pytest.warns(UserWarning, match=said):
        evaluate(robot, coefficients=coefficients)
    with warnings.catch_warnings(record=True) as caught:
        warnings.simplefilter("always")
        evaluate("hawkmoth")
        evaluate(robot, coefficients="robofly")
    assert not caught


def test_models_without_k_take_amplitudes_beyond_90_degrees() -> None:
    wide = dataclasses.replace(FRUITFLY.stroke, flap_amplitude=2.0)
    assert evaluate(FRUITFLY, wide, coefficients="robofly").weight_support > 1
    HoverProblem(box={"flap_amplitude": (1.0, 2.0)}, model={"coefficients": "robofly"})
    with pytest.raises(ValueError, match="coefficients without k"):
        HoverProblem(box={"flap_amplitude": (1.0, 2.0)})


@pytest.mark.parametrize("coefficients", ["robofly", "berman-wang", "polhamus", steep])
@pytest.mark.filterwarnings(QUIET)
def test_no_bound_is_called_proven_outside_the_scope_of_the_proof(coefficients: object) -> None:
    best = optimum(FRUITFLY, HoverProblem(model={"coefficients": coefficients}))
    assert best.feasible
    assert best.lower_bound is None
    assert best.gap_to_bound is None
    assert best.reference_power == best.specific_power


@pytest.mark.filterwarnings(QUIET)
def test_the_environment_serves_every_model_and_says_where_no_bound_is_known() -> None:
    for coefficients in ("robofly", "extended-lifting-line"):
        env = gym.make("flapenv/Hover-v0", insect="fruitfly", problem={"model": {"coefficients": coefficients}})
        env.reset(seed=0)
        *_, info = env.step(np.zeros(6, dtype=np.float32))
        assert (info["bound_gap"] is None) == (coefficients == "robofly")
        assert info["optimality_gap"] > 0
    batch = gym.make_vec("flapenv/Hover-v0", 3, insect="fruitfly", problem={"model": {"coefficients": "berman-wang"}})
    batch.reset(seed=0)
    _, rewards, *_, infos = batch.step(np.zeros((3, 6), dtype=np.float32))
    assert np.all(np.isfinite(rewards))
    assert not np.any(infos["_bound_gap"])


def test_the_bound_with_profile_drag_holds_and_is_attained_at_its_interior_angle() -> None:
    """Physics of docs/optimum.md: cos 2α* = (3(1+e) - √(9(1+e)² - 8))/2, e = C_D0/C_T."""
    model = {"profile_drag": 0.1}
    box = {"pitch_amplitude": (math.radians(45), math.radians(85)), "frequency_ratio": (0.3, 3.0)}
    best = optimum(HAWKMOTH, HoverProblem(box=box, model=model))
    assert best.lower_bound < best.specific_power < 1.15 * best.lower_bound
    constant = evaluate(HAWKMOTH, dataclasses.replace(HAWKMOTH.stroke, flap_amplitude=math.pi / 2)).lift_constant
    e = 0.1 / constant
    alpha = math.acos((3 * (1 + e) - math.sqrt(9 * (1 + e) ** 2 - 8)) / 2) / 2
    assert 15 < math.degrees(alpha) < 22
    sharp = Stroke(
        frequency=20.0,
        flap_amplitude=math.pi / 2,
        pitch_amplitude=math.pi / 2 - alpha,
        flap_shape=1.0,
        pitch_shape=1e9,
    )
    ideal = evaluate(HAWKMOTH, sharp, **model)
    assert ideal.specific_power / ideal.weight_support**1.5 == pytest.approx(best.lower_bound, rel=1e-6)


@given(stroke=strokes(sharpest_flap=1.0, sharpest_pitch=100.0))
def test_no_stroke_beats_the_bound_with_profile_drag(stroke: Stroke) -> None:
    problem = HoverProblem(box={"pitch_amplitude": (0.5, math.radians(80))}, model={"profile_drag": 0.2})
    ours = evaluate(HAWKMOTH, stroke, profile_drag=0.2)
    if ours.weight_support > 1e-6:
        needed = ours.specific_power / ours.weight_support**1.5  # sped up until it hovers
        assert needed >= profile_bound(problem) * (1 - 1e-6)


def profile_bound(problem: HoverProblem) -> float:
    from flapenv.optimum import lower_bound

    return float(lower_bound(hover_case(HAWKMOTH, problem.model), problem))


def test_problems_with_named_coefficients_come_back_from_json_and_functions_are_refused_there() -> None:
    problem = HoverProblem(model={"coefficients": "robofly", "edge_correction": "symmetric"})
    assert HoverProblem(**json.loads(json.dumps(problem.to_dict()))) == problem
    with pytest.raises(TypeError, match=r"cannot be written to a file; allowed there: a name of lifting-line"):
        HoverProblem(model={"coefficients": steep}).to_dict()


@pytest.mark.parametrize("coefficients", COEFFICIENTS)
@pytest.mark.filterwarnings(QUIET)
def test_tensors_go_through_every_named_model_and_keep_their_gradient(coefficients: str) -> None:
    fields = {"frequency": [254.0, 200.0], "flap_amplitude": [1.2, 1.3], "pitch_shape": [3.0, 5.0]}
    options = {"coefficients": coefficients, "profile_drag": 0.05}
    arrays = evaluate(FRUITFLY, dataclasses.replace(FRUITFLY.stroke, **fields), **options)
    for chosen in (tuple(fields), ("frequency",), ("flap_amplitude",), ("pitch_shape",)):
        tensors = {name: torch.tensor(fields[name], dtype=torch.float64, requires_grad=True) for name in chosen}
        ours = evaluate(FRUITFLY, dataclasses.replace(FRUITFLY.stroke, **{**fields, **tensors}), **options)
        np.testing.assert_allclose(ours.weight_support.detach().numpy(), arrays.weight_support, rtol=1e-12)
        np.testing.assert_allclose(ours.specific_power.detach().numpy(), arrays.specific_power, rtol=1e-12)
    (slope,) = torch.autograd.grad(ours.specific_power.sum(), tensors["pitch_shape"])
    step = 1e-5
    ahead, behind = (
        evaluate(
            FRUITFLY,
            dataclasses.replace(
                FRUITFLY.stroke, **{**fields, "pitch_shape": np.array(fields["pitch_shape"]) + sign * step}
            ),
            **options,
        ).specific_power
        for sign in (1, -1)
    )
    np.testing.assert_allclose(slope.numpy(), (ahead - behind) / (2 * step), rtol=1e-5)


@pytest.mark.parametrize(
    ("options", "kind", "said"),
    [
        ({"coefficients": "robfly"}, ValueError, "coefficients = 'robfly' is unknown; .*did you mean 'robofly'"),
        ({"coefficients": 3}, TypeError, "coefficients = 3 are not allowed; allowed: a name, or a function"),
        ({"profile_drag": -0.1}, ValueError, r"profile_drag = -0.1 .*\[0, 1e\+15\]"),
        ({"edge_correction": "beta"}, ValueError, "edge_correction = 'beta' is unknown; allowed: ellipse, symmetric"),
    ],
)
def test_bad_options_are_named(options: dict[str, object], kind: type[Exception], said: str) -> None:
    with pytest.raises(kind, match=said):
        evaluate("fruitfly", **options)


def test_the_law_of_a_batch_has_the_constants_of_its_rows() -> None:
    amplitudes = np.array([0.8, 1.2])
    case = hover_case(FRUITFLY, HoverModel())
    together = force_law(case, HoverModel(), 100.0, amplitudes).lift_constant
    alone = [force_law(case, HoverModel(), 100.0, a).lift_constant for a in amplitudes]
    np.testing.assert_allclose(together, alone, rtol=1e-14)


@pytest.mark.parametrize("coefficients", ["lifting-line", "polhamus", "extended-lifting-line"])
@pytest.mark.filterwarnings(QUIET)
def test_wings_of_tensors_go_through(coefficients: str) -> None:
    length = torch.tensor([0.05, 0.06], dtype=torch.float64, requires_grad=True)
    options = {"coefficients": coefficients, "profile_drag": 0.1}
    tensors, arrays = (
        evaluate(
            dataclasses.replace(HAWKMOTH, wing=dataclasses.replace(HAWKMOTH.wing, length=value)), **options
        ).weight_support
        for value in (length, length.detach().numpy())
    )
    np.testing.assert_allclose(tensors.detach().numpy(), arrays, rtol=1e-12)


def test_a_wing_that_feathers_flat_all_the_time_lifts_nothing_under_any_model() -> None:
    flat = Stroke(frequency=254.0, flap_amplitude=1.2, pitch_amplitude=0.0)
    for coefficients in ("robofly", lambda alpha: (0 * alpha + 1.0, 0 * alpha + 1.0)):
        assert evaluate(FRUITFLY, flat, coefficients=coefficients).weight_support == 0
        assert evaluate_by_blade_element(FRUITFLY, flat, coefficients=coefficients)[0] == 0


@pytest.mark.filterwarnings("ignore:no stroke of the box carries the weight:UserWarning")
def test_a_force_that_only_drags_costs_power_and_lifts_nothing() -> None:
    drag = evaluate(FRUITFLY, coefficients=lambda alpha: (0 * alpha, 0 * alpha + 1.0))
    assert drag.weight_support == 0
    assert drag.specific_power > 0
    with pytest.raises(ValueError, match="lift nothing at an angle of attack of 35°"):
        gym.make(
            "flapenv/Hover-v0",
            insect="fruitfly",
            problem={"model": {"coefficients": lambda alpha: (-np.sin(2 * alpha), 0 * alpha + 1.0)}},
            include_infeasible=True,
        )


def test_a_measured_polar_serves_optimum_and_environment_in_single_precision() -> None:
    def polar(alpha: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        return np.interp(alpha, [0, 0.8, 1.6], [0, 1.5, 0]), np.interp(alpha, [0, 1.6], [0.1, 3])

    problem = HoverProblem(model={"coefficients": polar})
    assert optimum("hawkmoth", problem).feasible
    score = HoverObjective([HAWKMOTH], problem, np.float32)
    one = {name: np.full(1, getattr(HAWKMOTH.stroke, name), np.float32) for name in STROKE_PARAMETERS}
    assert score.score(np.zeros(1, int), one).weight_support.dtype == np.float32
    with pytest.raises(ValueError, match="C_D is zero at every angle"):
        HoverModel(coefficients=lambda alpha: (np.sin(2 * alpha), 0 * alpha))
