"""Settings of a policy with memory, and a short run of its preset."""

import csv
from pathlib import Path

import numpy as np
import pytest
from sb3_contrib import RecurrentPPO

from agents.policy_file import load_policy
from agents.presets import PRESETS, RecurrentPPOSettings
from agents.remembering import flown
from agents.tasks import adapt
from agents.training import TrainingConfig, make_model, train


def test_the_learning_rate_falls_linearly_towards_zero() -> None:
    settings = RecurrentPPOSettings(wingbeats=10**9)
    assert [settings.learning_rate_at(left) for left in (1.0, 0.5)] == pytest.approx([1.5e-3, 0.75e-3], rel=1e-4)
    last = settings.learning_rate_at(0.0)
    assert 0 < last < 1e-4 * settings.learning_rate
    assert settings.learning_rate_at(-0.01) == last  # the last rollout may pass the budget
    assert RecurrentPPOSettings(wingbeats=5_120).learning_rate_at(0.0) == settings.learning_rate


@pytest.mark.parametrize(
    ("field", "value", "kind"),
    [
        ("wingbeats", 0, ValueError),
        ("memory", 1.5, TypeError),
        ("learning_rate", 0.0, ValueError),
        ("gradient_norm", float("inf"), ValueError),
        ("log_std", 1.0, ValueError),
        ("gamma", 1.1, ValueError),
        ("lstm", 64, TypeError),
    ],
)
def test_bad_settings_are_named(field: str, value: object, kind: type[Exception]) -> None:
    with pytest.raises(kind, match=field):
        RecurrentPPOSettings(**{field: value})


def test_settings_reach_the_learner() -> None:
    preset = PRESETS["adapt-recurrentppo"].changed({"insects": ["hawkmoth"]}, {"rows": 4, "memory": 8, "layers": 1})
    model = make_model(preset, preset.make_task(), 0)
    assert isinstance(model, RecurrentPPO)
    assert model.policy.lstm_actor.hidden_size == 8
    assert model.policy.lstm_critic is None
    assert (model.gamma, model.n_steps, model.batch_size, model.policy.net_arch) == (0, 20, 80, [64])
    assert model.policy.log_std.detach().numpy() == pytest.approx(-1)


def test_a_run_is_judged_alike_with_its_learner_and_from_its_file(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(adapt, "DRAWS", 16)
    few = {"wingbeats": 640, "rows": 16, "memory": 8, "epochs": 1}
    preset = PRESETS["adapt-recurrentppo"].changed({"insects": ["hawkmoth", "cranefly"]}, few)
    result = train(TrainingConfig(preset=preset, seed=1), tmp_path, progress=False, report=False)
    task = preset.make_task()
    actor, card = load_policy(tmp_path)
    assert (card.algorithm, card.memory) == ("RecurrentPPO", 8)
    model = flown(RecurrentPPO.load(tmp_path / "policy.zip", device="cpu"))
    for policy in (actor, model):
        assert task.judge(policy).mean == pytest.approx(result.verdict.mean, rel=1e-5)
    with (tmp_path / "curve.csv").open(encoding="utf-8") as file:
        last = list(csv.DictReader(file))[-1]
    glance = task.glance(actor)
    assert glance == task.glance(actor)  # it forgot in between
    assert np.allclose([float(last["mean_gap"]), float(last["worst_gap"])], glance, rtol=1e-4)
