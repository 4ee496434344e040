"""Boxes and problems."""

import json
import math
import pickle
from typing import Any

import numpy as np
import pytest

from flapenv import HoverProblem, StrokeBox
from flapenv.aero.parameters import STROKE_PARAMETERS, StrokeReference
from flapenv.aero.wingbeat import TimeRule, speed_averages
from flapenv.problem import as_problem


def test_the_default_is_problem_a_with_the_box_of_the_documentation() -> None:
    box = HoverProblem().box
    assert HoverProblem().name == "free-frequency"
    assert box.frequency_ratio == (0.5, 1.5)
    assert tuple(map(math.degrees, box.flap_amplitude)) == pytest.approx((40, 90))
    assert box.flap_shape == (0.01, 0.99)
    assert box.pitch_shape == (0.1, 10)
    assert tuple(map(math.degrees, box.pitch_amplitude)) == pytest.approx((45, 65))
    assert tuple(map(math.degrees, box.pitch_phase)) == pytest.approx((60, 120))
    assert math.degrees(HoverProblem().min_angle_of_attack) == pytest.approx(25)
    assert box.free == tuple(STROKE_PARAMETERS)


def test_frequency_bounds_are_relative_unless_given_in_hertz() -> None:
    assert StrokeBox().bounds("frequency", StrokeReference(20.0, 1.0)) == (10, 30)
    assert StrokeBox(frequency=(15, 25)).bounds("frequency", StrokeReference(20.0, 1.0)) == (15, 25)


def test_a_box_that_reaches_the_triangle_gets_nodes_for_its_sharpest_neighbours() -> None:
    rest = {"pitch_shape": (0.1, 1.0)}
    opened, shut, triangle = (StrokeBox(flap_shape=bounds, **rest) for bounds in ((0.0, 1.0), (0.0, 0.9999), 1.0))
    rule = opened.time_rule(tolerance=1e-6)
    assert rule > shut.time_rule(tolerance=1e-6) > triangle.time_rule(tolerance=1e-6)
    shapes = 1 - 10.0 ** -np.arange(2, 15)
    waveform = (shapes, 1.1, 0.5, 1.3)
    np.testing.assert_allclose(
        speed_averages(*waveform, rule=rule), speed_averages(*waveform, rule=TimeRule(1500, 3.0)), rtol=1e-5
    )


def test_one_number_fixes_a_parameter() -> None:
    box = StrokeBox(pitch_phase=math.pi / 2, flap_shape=[0.5, 0.5])
    assert box.pitch_phase == (math.pi / 2, math.pi / 2)
    assert box.free == ("frequency", "flap_amplitude", "pitch_shape", "pitch_amplitude")


def test_a_dict_overrides_single_bounds_and_options() -> None:
    problem = HoverProblem(box={"flap_shape": (0.2, 0.9999)}, model={"air_density": 1.0})
    assert problem.box.flap_shape == (0.2, 0.9999)
    assert problem.box.pitch_shape == (0.1, 10)
    assert problem.model.air_density == 1.0


def test_problems_are_hashable_pickle_and_survive_json() -> None:
    problem = HoverProblem(name="own", box={"flap_shape": (0.2, 0.9)}, lift_penalty=5)
    assert hash(problem) == hash(HoverProblem(name="own", box={"flap_shape": [0.2, 0.9]}, lift_penalty=5))
    assert pickle.loads(pickle.dumps(problem)) == problem
    assert as_problem(json.loads(json.dumps(problem.to_dict()))) == problem
    assert as_problem(None) == as_problem("free-frequency") == HoverProblem()


@pytest.mark.parametrize(
    ("box", "kind", "said"),
    [
        ({"flap_shape": (0.9, 0.1)}, ValueError, "flap_shape: lower = 0.9 > upper = 0.1"),
        ({"flap_shape": (0.1, 1.5)}, ValueError, r"upper bound of flap_shape = 1.5 .*\[0, 1\]"),
        ({"frequency": (0.0, 20)}, ValueError, r"lower bound of frequency = 0 .*\[1e-15, 1e\+15\] Hz"),
        ({"frequency_ratio": (0.5, float("inf"))}, ValueError, "upper bound of frequency_ratio = inf"),
        ({"pitch_phase": (float("nan"), 1)}, ValueError, "lower bound of pitch_phase = nan"),
        ({"pitch_shape": (1, 2, 3)}, TypeError, "bounds of pitch_shape"),
        ({"pitch_shape": "wide"}, TypeError, "bound of pitch_shape = 'wide'"),
        ({"pitch_shape": ([0.1, 0.2], [0.3, 0.4])}, TypeError, "bounds of pitch_shape"),
        ({"pitch_shape": None}, TypeError, "bounds of pitch_shape = None"),
        ({"frequency": (10, 20), "frequency_ratio": (0.5, 1)}, ValueError, "both bound the frequency"),
        ({"flap_shap": (0, 1)}, TypeError, "did you mean 'flap_shape'"),
    ],
)
def test_bad_bounds_are_named(box: dict[str, object], kind: type[Exception], said: str) -> None:
    with pytest.raises(kind, match=said):
        HoverProblem(box=box)


@pytest.mark.parametrize(
    ("fields", "kind", "said"),
    [
        ({"lift_penalty": 0.0}, ValueError, "lift_penalty = 0 "),
        ({"lift_penalty": "much"}, ValueError, "lift_penalty = 'much' is unknown; allowed: auto"),
        ({"lift_penalty": [3.0]}, TypeError, "lift_penalty = .* one number"),
        ({"model": {"air_density": [1.0, 2.0]}}, TypeError, "air_density = .* one number"),
        ({"reward_floor": 1.0}, ValueError, "reward_floor = 1 "),
        ({"box": 3}, TypeError, "box = 3"),
        ({"name": 3}, TypeError, "name = 3"),
        ({"penalty": 3}, TypeError, "no field 'penalty'"),
        ({"box": {"flap_amplitude": (1.0, 2.0)}}, ValueError, "upper bound of flap_amplitude = 2 .*k_flap"),
    ],
)
def test_bad_problems_are_named(fields: dict[str, object], kind: type[Exception], said: str) -> None:
    with pytest.raises(kind, match=said):
        HoverProblem(**fields)


def test_a_problem_of_ones_own_is_not_called_by_the_presets_name() -> None:
    assert HoverProblem(box={"flap_shape": 0.5}).name == "custom"
    assert HoverProblem(lift_penalty=np.float32(5)).name == "custom"
    assert HoverProblem(reward_floor=-20).name == "free-frequency"
    assert HoverProblem(name="mine", box={"flap_shape": np.array(0.5)}).name == "mine"


def test_unknown_problems_are_refused() -> None:
    with pytest.raises(ValueError, match="problem = 'free' is unknown; allowed: free-frequency"):
        as_problem("free")
    with pytest.raises(TypeError, match="problem = 3"):
        as_problem(3)


@pytest.mark.parametrize(
    ("fields", "said"),
    [
        (
            {"box": {"frequency": "\n" * 2000, "frequency_ratio": (1, 1)}},
            "both bound the frequency; allowed: one of them",
        ),
        ({"box": {"pitch_shape": [1.0, [1.0, [2.0]]]}}, "bounds of pitch_shape = .* are not allowed"),
        ({"box": {"pitch_shape": [1.0, ["a", [2.0] * 4000]]}}, "bounds of pitch_shape = .* are not allowed"),
        ({"name": ["x"] * 4000}, "name = .* is not allowed; allowed: a non-empty string"),
    ],
)
def test_odd_values_of_any_length_are_told_in_one_short_line(fields: dict[str, Any], said: str) -> None:
    with pytest.raises((TypeError, ValueError), match=said) as caught:
        HoverProblem(**fields)
    assert str(caught.value).isprintable()
    assert len(str(caught.value)) < 400


@pytest.mark.parametrize("kind", [{"air_density": 1e16}, {"gravity": 1e-16}, {"section_lift_slope": 1e300}])
def test_air_of_numbers_only_is_refused(kind: dict[str, float]) -> None:
    with pytest.raises(ValueError, match=r"is not allowed; allowed: finite, in \[1e-15, 1e\+15\]"):
        HoverProblem(model=kind)
