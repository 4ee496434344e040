"""Folders of runs that go on: what is in the way is told, what a kill left goes, what was kept is not lost."""

import json
from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest
import torch
from killed_runs import KilledError, config, quietly

from agents.checkpoint import STATE
from agents.learning import Learning
from agents.run_folder import CHECKPOINT
from agents.training import DivergedError, TrainingConfig, make_model, train


@pytest.fixture
def killed(killed_at: Callable[[int | None], None], tmp_path: Path) -> TrainingConfig:
    """A run that was killed at its third checkpoint, after 256 wingbeats."""
    asked = config("hover-ppo")
    killed_at(3)
    with pytest.raises(KilledError):
        quietly(asked, tmp_path)
    killed_at(None)
    return asked


def test_what_a_kill_leaves_of_a_checkpoint_goes_when_the_run_is_asked_for_again(tmp_path: Path) -> None:
    asked = config("hover-ppo")
    quietly(asked, tmp_path)
    (tmp_path / CHECKPOINT).mkdir()
    (tmp_path / CHECKPOINT / "arrays-0123456789abcdef.safetensors").write_bytes(b"large")
    quietly(asked, tmp_path, resume=True)
    assert not (tmp_path / CHECKPOINT).exists()


def test_half_written_files_of_a_killed_process_are_removed(tmp_path: Path) -> None:
    (tmp_path / CHECKPOINT).mkdir(parents=True)
    left = [tmp_path / ".partial-01.json", tmp_path / CHECKPOINT / ".partial-02.safetensors"]
    for path in left:
        path.touch()
    (tmp_path / ".partial-mine").mkdir()
    quietly(config("hover-ppo"), tmp_path, resume=True)
    assert not any(path.exists() for path in left)
    assert (tmp_path / ".partial-mine").is_dir()


def test_a_policy_that_was_kept_is_not_trained_over_from_the_beginning(tmp_path: Path) -> None:
    asked = config("hover-ppo")
    quietly(asked, tmp_path)
    results = json.loads((tmp_path / "results.json").read_text(encoding="utf-8"))
    (tmp_path / "results.json").write_text(json.dumps({**results, "interrupted": True}), encoding="utf-8")
    with pytest.raises(FileExistsError, match="holds the policy of 1280 wingbeats and no checkpoint to go on from"):
        quietly(asked, tmp_path, resume=True)


def test_a_checkpoint_on_another_disk_goes_and_its_link_stays(tmp_path: Path) -> None:
    (tmp_path / "large").mkdir()
    (tmp_path / "run").mkdir()
    (tmp_path / "run" / CHECKPOINT).symlink_to(tmp_path / "large")
    quietly(config("hover-ppo"), tmp_path / "run", resume=True)
    assert (tmp_path / "run" / CHECKPOINT).is_symlink()
    assert not list((tmp_path / "large").iterdir())


@pytest.mark.parametrize("name", [CHECKPOINT, "tensorboard"])
def test_what_is_in_the_way_is_told_before_anything_is_trained(name: str, tmp_path: Path) -> None:
    (tmp_path / name).touch()
    with pytest.raises(NotADirectoryError, match=f"{name} is in the way; allowed: a folder, or nothing there"):
        quietly(config("hover-ppo"), tmp_path, resume=True)


def test_a_full_disk_for_the_report_keeps_the_checkpoint_until_there_is_room(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    asked = config("hover-ppo")

    def full(*_: object) -> None:
        raise OSError("path = 'report.html' cannot be written; allowed: a disk with room for it")

    with monkeypatch.context() as patch:
        patch.setattr("agents.report.of_run.report_of_run", full)
        with pytest.raises(OSError, match=r"a disk with room for it; then --resume .* goes on"):
            train(asked, tmp_path, progress=False)
    assert (tmp_path / CHECKPOINT).is_dir()
    assert train(asked, tmp_path, progress=False, resume=True).report == tmp_path / "report.html"
    assert not (tmp_path / CHECKPOINT).exists()


def test_a_run_that_goes_on_with_other_versions_or_another_config_is_told(
    killed: TrainingConfig, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    asked = killed
    path = tmp_path / "config.json"
    content = json.loads(path.read_text(encoding="utf-8"))
    content["versions"]["torch"] = "1.0"
    path.write_text(json.dumps(content), encoding="utf-8")
    other = TrainingConfig(preset=asked.preset.changed({}, {"epochs": 2}), name=asked.name, seed=asked.seed)
    with pytest.raises(ValueError, match=r"config.json has settings = .* as the run that goes on"):
        quietly(other, tmp_path, resume=True)
    with pytest.raises(ValueError, match=r"config.json has seed = 5; allowed: 6, as the run that goes on"):
        quietly(TrainingConfig(preset=asked.preset, name=asked.name, seed=6), tmp_path, resume=True)
    train(asked, tmp_path, progress=True, report=False, resume=True)
    said = capsys.readouterr().err
    assert "was begun with torch 1.0, now" in said
    assert "goes on from 256 wingbeats" in said


def test_an_older_config_that_tells_less_goes_on(killed: TrainingConfig, tmp_path: Path) -> None:
    asked = killed
    path = tmp_path / "config.json"
    content = json.loads(path.read_text(encoding="utf-8"))
    path.write_text(json.dumps({key: content[key] for key in ("task", "algorithm", "settings")}), encoding="utf-8")
    quietly(asked, tmp_path, resume=True)


def test_weights_that_are_destroyed_do_not_take_the_place_of_the_last_checkpoint(
    killed: TrainingConfig, tmp_path: Path
) -> None:
    asked = killed
    before = (tmp_path / CHECKPOINT / STATE).read_bytes()
    task = asked.preset.make_task()
    run = Learning(asked, task, make_model(asked.preset, task, asked.seed), tmp_path)
    with torch.no_grad():
        next(iter(run.model.policy.parameters())).fill_(np.nan)
    with pytest.raises(DivergedError, match="after 256 wingbeats weights are not finite"):
        run.make_checkpoint()
    assert (tmp_path / CHECKPOINT / STATE).read_bytes() == before
