"""The competitor in Heave-v0, and the comparison of any policy with it."""

import csv
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from agents import lqg as module
from agents.heave_flights import Flights, compare_with_front, fly
from agents.lqg import fly_front, main
from agents.lqg_controller import Lqg, design, lqg, proportional_derivative
from flapenv.envs.heave_batch import HeaveVectorEnv

EPISODES = 48


def hold_still(observations: np.ndarray) -> np.ndarray:
    return np.tile(np.array([0.4, 1, 1, 1, 0], dtype=np.float32), (len(observations), 1))


@pytest.fixture(scope="module")
def front() -> module.Front:
    return fly_front("hawkmoth", ratios=(100.0, 10.0, 1.0, 0.1), episodes=EPISODES)


@pytest.mark.parametrize("ratio", [1000.0, 1.0, 0.03])
@pytest.mark.parametrize("insect", ["hawkmoth", "honeybee", "cranefly"])
def test_both_loops_are_stable(insect: str, ratio: float) -> None:
    made = design(insect, ratio)
    seen = np.eye(4)[[0, 1, 3]]
    estimator = made.transition - made.transition @ made.filter_gain @ seen
    assert np.max(np.abs(np.linalg.eigvals(estimator))) < 1
    steered = np.zeros((4, 4))
    steered[:3, :3] = made.transition[:3, :3]
    steered[3, [0, 3]] = 1
    loop = steered - np.outer([*made.entry[:2], 0, 0], made.feedback)
    assert np.max(np.abs(np.linalg.eigvals(loop))) < 1


def test_it_holds_height_where_the_open_loop_is_lost() -> None:
    flown = fly(lqg("hawkmoth", 1.0), insect="hawkmoth", episodes=EPISODES)
    left = fly(hold_still, insect="hawkmoth", episodes=EPISODES)
    assert not flown.lost.any()
    assert np.all(flown.beats == 200)
    assert flown.rms_height < 0.1
    assert left.lost.mean() > 0.5
    assert np.all((left.beats < 200) == left.lost)
    assert np.all(left.returns <= -25 * (200 - left.beats))
    assert np.all(left.returns[left.lost] > -25 * 200)
    assert np.mean(flown.returns) > -2 > np.mean(left.returns)


def test_its_filter_finds_the_gust_that_nobody_shows_it() -> None:
    env = HeaveVectorEnv(32, insect="hawkmoth")
    controller = lqg("hawkmoth", 1.0)
    observations, _ = env.reset(seed=5)
    found, gusts = [], []
    for _ in range(40):
        observations, *_, info = env.step(controller(observations))
        gusts.append(info["gust_ratio"])
        found.append(controller._state[:, 2].copy())
    correlation = np.corrcoef(np.ravel(found[10:-1]), np.ravel(gusts[10:-1]))[0, 1]
    assert correlation > 0.9


def test_the_integral_takes_away_what_the_linear_model_does_not_know() -> None:
    made = design("hawkmoth", 1.0)
    mistaken = made.beat.hover - 0.1 * np.eye(5)[made.axis]
    off = replace(made, beat=replace(made.beat, hover=mistaken))

    def drift(controller: Lqg) -> float:
        env = HeaveVectorEnv(1, insect="hawkmoth", gusts={"strength": 0.0}, beats=600)
        observations, _ = env.reset(seed=0, options={"height": 0.0, "velocity": 0.0})
        for _ in range(600):
            observations, *_, info = env.step(controller(observations))
        return abs(float(info["height_ratio"][0]))

    assert drift(Lqg(off)) < 0.1 * drift(Lqg(replace(off, feedback=off.feedback * [1, 1, 1, 0])))


def test_actions_stay_in_the_box_and_leave_the_other_inputs_alone() -> None:
    controller = lqg("hawkmoth", 0.03)
    for height in (-5.0, 5.0, 4.0):
        observations = np.zeros((2, 11), dtype=np.float32)
        observations[:, 0] = height
        actions = controller(observations)
        assert np.abs(actions).max() <= 1
        np.testing.assert_allclose(actions[:, 1:], [[1, 1, 1, 0]] * 2, atol=1e-6)
    assert np.all(np.isfinite(actions))


def test_a_start_forgets_the_last_episode() -> None:
    controller = lqg("hawkmoth", 1.0)
    one, again = (fly(controller, insect="hawkmoth", episodes=4) for _ in range(2))
    np.testing.assert_array_equal(one.returns, again.returns)


def test_eager_controllers_hold_height_better_and_pay_for_it(front: module.Front) -> None:
    heights = [one.rms_height for one in front.lqg]
    assert heights == sorted(heights, reverse=True)
    dearest, cheapest = front.lqg[-1].power_excess, front.lqg[0].power_excess
    assert np.mean(dearest - cheapest) > 0
    for ours, pd in zip(front.lqg, front.pd, strict=True):
        assert ours.rms_height < pd.rms_height  # of the same gains, but blind to the gust


def test_a_policy_on_the_front_has_no_difference_and_one_that_saves_has_one(front: module.Front) -> None:
    own = compare_with_front(front.lqg[1], front.lqg)
    assert own.inside
    assert own.difference == pytest.approx(0, abs=1e-12)
    assert own.interval == pytest.approx((0, 0), abs=1e-3)

    flown = front.lqg[1]
    frugal = Flights(**{**vars(flown), "power_excess": flown.power_excess - 0.01})
    found = compare_with_front(frugal, front.lqg)
    assert found.difference == pytest.approx(-0.01, abs=1e-12)
    assert found.interval[0] <= found.difference <= found.interval[1] < 0

    between = fly(lqg("hawkmoth", 3.0), insect="hawkmoth", episodes=EPISODES)
    near = compare_with_front(between, front.lqg)
    assert near.inside
    assert abs(near.difference) < 3e-4


def test_a_policy_beyond_the_front_is_said_to_be(front: module.Front) -> None:
    left = fly(hold_still, insect="hawkmoth", episodes=EPISODES)
    assert not compare_with_front(left, front.lqg).inside


def test_pd_at_equal_height_needs_more_power(front: module.Front) -> None:
    found = compare_with_front(front.pd[-1], front.lqg)
    assert found.difference > 0


class LetsGo:
    """LQG that drops the insect in the last beats of an episode, counting them."""

    def __init__(self, insect: str, beats: int) -> None:
        self.controller, self.fall, self.beat = lqg(insect, 0.208), 200 - beats, 0

    def start(self) -> None:
        self.controller.start()
        self.beat = 0

    def __call__(self, observations: np.ndarray) -> np.ndarray:
        actions = self.controller(observations).copy()
        self.beat += 1
        if self.beat > self.fall:
            actions[:, self.controller.design.axis] = -1
        return actions


@pytest.mark.parametrize(("insect", "beats"), [("hawkmoth", 3), ("honeybee", 10)])
def test_letting_go_at_the_end_wins_nothing_over_the_controller_that_holds_on(insect: str, beats: int) -> None:
    held, dropped = (
        fly(policy, insect=insect, episodes=EPISODES) for policy in (lqg(insect, 0.208), LetsGo(insect, beats))
    )
    assert not dropped.lost.any()
    assert np.mean(dropped.returns) < np.mean(held.returns)
    assert dropped.mean_power_excess > held.mean_power_excess


def test_flights_have_infos_of_their_own() -> None:
    with pytest.raises(TypeError, match="infos = 'none' is not an argument here"):
        fly(hold_still, insect="hawkmoth", episodes=2, infos="none")


def test_unlike_flights_are_not_compared(front: module.Front) -> None:
    short = fly(proportional_derivative("hawkmoth", 1.0), insect="hawkmoth", episodes=3)
    with pytest.raises(ValueError, match="allowed: two or more of 3 each"):
        compare_with_front(short, front.lqg)
    with pytest.raises(ValueError, match="two or more"):
        compare_with_front(front.lqg[0], front.lqg[:1])
    with pytest.raises(ValueError, match="episodes = 0"):
        fly(hold_still, episodes=0)


@pytest.mark.parametrize("insect", ["hawkmoth", "honeybee"])
def test_the_page_has_what_the_controller_does(insect: str) -> None:
    page = (Path(module.__file__).parents[1] / "docs" / "heave.md").read_text(encoding="utf-8")
    (row,) = [line for line in page.splitlines() if line.startswith(f"| {insect} |")]
    _, weight, height, power, *_ = [cell.strip() for cell in row.strip("|").split("|")]
    ratio = min(module.RATIOS, key=lambda one: abs(one - float(weight)))
    flown = fly(lqg(insect, ratio), insect=insect)
    assert flown.rms_height == pytest.approx(float(height), rel=5e-3)
    assert 100 * flown.mean_power_excess == pytest.approx(float(power.split()[0]), abs=5e-3)


def test_the_command_prints_the_front_and_keeps_table_and_picture(
    tmp_path: Path, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(module, "RATIOS", (10.0, 1.0))
    out = tmp_path / "front"
    assert main(["--insect", "fruitfly", "--episodes", "8", "--out", str(out)]) == 0
    printed = capsys.readouterr().out
    assert "rms z/R" in printed
    with (out / module.TABLE).open(encoding="utf-8", newline="") as file:
        rows = list(csv.reader(file))
    assert [row[0] for row in rows] == ["controller", "LQG", "LQG", "PD", "PD"]
    assert (out / module.PICTURE).stat().st_size > 5000


@pytest.mark.parametrize("arguments", [["--insect", "moth"], ["--episodes", "0"], ["--seed", "-1"]])
def test_bad_input_ends_with_two_and_a_word(
    arguments: list[str], tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    assert main([*arguments, "--out", str(tmp_path / "out")]) == 2
    assert "error:" in capsys.readouterr().err
