"""Waveform-v0 as a task: the best splines score nothing, missing weight is charged."""

import json
from collections.abc import Callable

import numpy as np
import pytest

from agents.tasks.waveform import WaveformTask
from flapenv.insects import INSECTS, Insect, load_insect
from flapenv.problem import HoverProblem


def best_actions(task: WaveformTask) -> np.ndarray:
    """The best splines of every insect as actions."""
    env = task.vector_env(1)
    return np.stack(
        [
            env.coordinates.encode(best.waveform, insect.reference)
            for best, insect in zip(env.objective.known, env.insects, strict=True)
            if best is not None
        ]
    )


@pytest.mark.parametrize("problem", ["free-frequency", "fixed-frequency"])
def test_the_best_splines_have_no_gap(problem: str, constant: Callable) -> None:
    task = WaveformTask(problem=problem)
    verdict = task.judge(constant(best_actions(task)))
    assert list(verdict.results["insects"]) == list(INSECTS)
    assert abs(verdict.mean) < 1e-5
    assert 0 <= verdict.worst < 1e-4  # actions are float32, missing weight is charged tenfold
    assert task.glance(constant(best_actions(task))) == (verdict.mean, verdict.worst)


def test_weight_that_is_missing_is_charged(constant: Callable) -> None:
    task = WaveformTask(insects=["hawkmoth", "fruitfly"])
    actions = best_actions(task)
    actions[0, 0] -= 0.05  # less tip speed
    verdict = task.judge(constant(actions))
    hawkmoth, fruitfly = verdict.results["insects"].values()
    missing = 1 - hawkmoth["weight_support"]
    assert missing > 0.01
    cheaper = hawkmoth["specific_power"] / hawkmoth["optimum_specific_power"] - 1
    assert cheaper < 0
    assert hawkmoth["gap_percent"] == pytest.approx(100 * (cheaper + 10 * missing), rel=1e-5)
    assert verdict.worst == pytest.approx(hawkmoth["gap_percent"] / 100)
    assert verdict.mean == pytest.approx((hawkmoth["gap_percent"] + fruitfly["gap_percent"]) / 200)
    assert "worst" in verdict.text.splitlines()[-1]
    json.dumps(verdict.results, allow_nan=False)


def test_an_optimum_that_nobody_knows_is_refused() -> None:
    with pytest.raises(ValueError, match=r"no best splines of 5 knots are known of hawkmoth"):
        WaveformTask(insects="hawkmoth", knots=5)
    with pytest.raises(ValueError, match="knots"):
        WaveformTask(knots=0)


def test_its_arguments_come_back_from_json_and_its_environment_trains() -> None:
    own = Insect(**load_insect("hawkmoth").to_dict() | {"name": "mine", "mass": 1.5e-3})
    task = WaveformTask(insects=[own, "fruitfly"], problem=HoverProblem(), knots=4)
    again = WaveformTask(**json.loads(json.dumps(task.to_dict())))
    assert again == task
    env = again.vector_env(3)
    env.reset(seed=0)
    *_, terminated, _, infos = env.step(np.zeros((3, 10)))
    assert terminated.all()
    assert set(infos) <= {"final_obs", "_final_obs", "final_info", "_final_info"}


def test_the_picture_has_both_waveforms_of_every_insect(constant: Callable) -> None:
    task = WaveformTask(insects=list(INSECTS[:5]))
    panels = task.draw(constant(best_actions(task))).axes
    assert len(panels) == 16
    drawn = [axes for axes in panels if axes.lines]
    assert len(drawn) == 10
    for axes in drawn:
        best, learned = (line.get_ydata() for line in axes.lines)
        np.testing.assert_allclose(best, learned, atol=2e-2 * np.ptp(best))
