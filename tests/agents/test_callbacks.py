"""What happens beside the updates, seen from a run."""

import json
import math
from itertools import pairwise
from pathlib import Path

import pytest
from stable_baselines3 import PPO
from stable_baselines3.common.logger import configure

from agents.callbacks import Annealing, LearningCurve
from agents.checkpoint import Checkpoints
from agents.presets import PPOSettings, Preset
from agents.run_folder import POLICY
from agents.training import TrainingConfig, make_model, train

SMALL = PPOSettings(wingbeats=2048, rows=256, minibatch=128, epochs=1, noise_floor=-2.0, last_noise_floor=-6.0)
PRESET = Preset(task="hover", settings=SMALL)


def test_the_noise_floor_reaches_the_policy_as_the_budget_is_spent() -> None:
    model = make_model(PRESET, PRESET.make_task(), 0)
    seen = []
    original = model.train
    model.train = lambda: (seen.append(model.policy.noise_floor), original())[1]
    model.learn(SMALL.wingbeats, callback=Annealing(SMALL))
    spent = [i * SMALL.rows / SMALL.wingbeats for i in range(8)]
    assert seen == pytest.approx([SMALL.noise_floor_at(1 - done) for done in spent])
    assert seen[0] == -2
    assert seen[-1] < -5


class Clock:
    """A monotonic clock that is told how late it is."""

    def __init__(self) -> None:
        self.now = 100.0

    def monotonic(self) -> float:
        return self.now


@pytest.mark.parametrize(("cost", "apart"), [(0.0, 5.0), (0.01, 5.0), (0.1, 9.9), (1.0, 99.0)])
def test_checkpoints_are_seconds_apart_and_take_no_more_than_a_hundredth_of_the_time(
    cost: float, apart: float, monkeypatch: pytest.MonkeyPatch
) -> None:
    clock, made = Clock(), []
    monkeypatch.setattr("agents.checkpoint.callback.time", clock)

    def make() -> None:
        made.append(clock.now)
        clock.now += cost

    checkpoints = Checkpoints(make)
    checkpoints.init_callback(make_model(PRESET, PRESET.make_task(), 0))
    checkpoints.on_training_start({}, {})
    for _ in range(4000):
        checkpoints.on_rollout_start()
        clock.now += 0.125
    gaps = [later - earlier - cost for earlier, later in pairwise(made)]
    assert made[0] == 105
    assert len(gaps) > 2
    assert all(apart - 1e-6 < gap < apart + 0.126 for gap in gaps)
    assert sum(cost for _ in gaps) <= 0.01 * (made[-1] - made[0]) + 1e-9


def test_seconds_of_training_go_on_from_those_before_and_leave_out_watching(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    clock = Clock()
    monkeypatch.setattr("agents.callbacks.time", clock)

    class Slow:
        def glance(self, _: object) -> tuple[float, float]:
            clock.now += 7
            return 0.25, math.nan

    model = make_model(PRESET, PRESET.make_task(), 0)
    model.set_logger(configure(None, []))
    curve = LearningCurve(tmp_path, Slow(), 1000)
    curve.init_callback(model)
    curve.on_training_start({}, {})
    clock.now += 2
    curve._rewards.append(-1.0)
    curve.measure()
    clock.now += 1
    assert curve.seconds == 3
    curve.next = 123.0
    state = json.loads(json.dumps(curve.state(), allow_nan=False))
    text = (tmp_path / "curve.csv").read_text()

    (tmp_path / "curve.csv").write_text(text + "half a li")
    after = LearningCurve(tmp_path, Slow(), 1000, state)
    assert (tmp_path / "curve.csv").read_text() == text
    assert after.next == 123
    clock.now += 40
    after.init_callback(model)
    after.on_training_start({}, {})
    clock.now += 2
    after.end()
    clock.now += 30
    assert after.seconds == 5
    after._rewards.append(-1.0)
    after.measure()
    assert after.seconds == 5
    assert math.isnan(after.rows[0][-1])


@pytest.mark.parametrize(
    "state",
    [
        3,
        {},
        {"seconds": 1, "next": 2, "rows": [[1]], "rewards": []},
        {"seconds": "1", "next": 2, "rows": [], "rewards": []},
    ],
)
def test_a_curve_that_goes_on_from_nonsense_is_refused_and_leaves_the_file(state: object, tmp_path: Path) -> None:
    (tmp_path / "curve.csv").write_text("old")
    with pytest.raises(ValueError, match="; allowed: seconds, next, rows and rewards"):
        LearningCurve(tmp_path, PRESET.make_task(), 1000, state)
    assert (tmp_path / "curve.csv").read_text() == "old"


def test_the_learning_curve_watches_and_changes_nothing(tmp_path: Path) -> None:
    config = TrainingConfig(preset=PRESET)
    train(config, tmp_path / "watched", progress=False, report=False)
    alone = make_model(PRESET, PRESET.make_task(), config.seed)
    alone.learn(SMALL.wingbeats, callback=Annealing(SMALL))
    watched = PPO.load(tmp_path / "watched" / POLICY, device="cpu")
    for one, other in zip(alone.policy.parameters(), watched.policy.parameters(), strict=True):
        assert (one == other).all()
