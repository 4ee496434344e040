"""What happens beside the updates, seen from a run."""

from pathlib import Path

import pytest
from stable_baselines3 import PPO

from agents.callbacks import CHECKPOINTS, Annealing, Checkpoints
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


def test_a_run_lowers_the_floor_saves_midway_and_keeps_the_last_policy(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    saved, floors = [], []
    save = Checkpoints.save

    def watch(self: Checkpoints) -> None:
        saved.append(self.num_timesteps)
        floors.append(self.model.policy.noise_floor)
        save(self)
        assert PPO.load(tmp_path / POLICY, device="cpu").num_timesteps == self.model.num_timesteps

    monkeypatch.setattr(Checkpoints, "save", watch)
    train(TrainingConfig(preset=PRESET), tmp_path, progress=False, report=False)
    assert len(saved) >= CHECKPOINTS // 2
    assert 0 < saved[0] < SMALL.wingbeats
    assert floors[-1] < floors[0] < 0


def test_the_learning_curve_watches_and_changes_nothing(tmp_path: Path) -> None:
    config = TrainingConfig(preset=PRESET)
    train(config, tmp_path / "watched", progress=False, report=False)
    alone = make_model(PRESET, PRESET.make_task(), config.seed)
    alone.learn(SMALL.wingbeats, callback=Annealing(SMALL))
    watched = PPO.load(tmp_path / "watched" / POLICY, device="cpu")
    for one, other in zip(alone.policy.parameters(), watched.policy.parameters(), strict=True):
        assert (one == other).all()
