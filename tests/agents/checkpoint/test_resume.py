"""Runs that are stopped at a checkpoint and go on end as if nothing had happened: every learner, every task."""

import json
import pickle
import signal
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import torch

import agents.learning
import agents.training
from agents.checkpoint import Checkpoint, Checkpoints, read_checkpoint, write_checkpoint
from agents.predictor import Predictor
from agents.presets import PRESETS
from agents.run_folder import CHECKPOINT
from agents.tasks.task import Task, Verdict
from agents.training import TrainingConfig, train
from agents.vec_env import GymnasiumVecEnv

OFF_POLICY = {"wingbeats": 640, "rows": 16, "learning_starts": 128, "buffer": 400, "gradient_steps": 1, "batch": 32}
"""The buffer is full, and overwritten, before the end."""
SMALL: dict[str, dict[str, Any]] = {
    "hover-ppo": {"wingbeats": 1280, "rows": 128, "minibatch": 64},
    "random-wings-ppo": {"wingbeats": 1280, "rows": 128, "minibatch": 64},
    "waveform-ppo": {"wingbeats": 1280, "rows": 128, "minibatch": 64},
    "adapt-ppo": {"wingbeats": 1280, "rows": 16, "steps": 8, "minibatch": 64},
    "heave-ppo": {"wingbeats": 1280, "rows": 16, "steps": 8, "minibatch": 64},
    "adapt-recurrentppo": {"wingbeats": 1280, "rows": 16, "steps": 8},
    "hover-gradient": {"wingbeats": 1920},
    **{f"hover-{name}": OFF_POLICY for name in ("sac", "td3", "tqc", "crossq")},
}


class KilledError(Exception):
    """In place of a signal: nothing after it is run."""


@pytest.fixture
def killed_at(monkeypatch: pytest.MonkeyPatch) -> Callable[[int | None], None]:
    """Make a checkpoint before every rollout, and let training end at the one of this number."""
    often = Checkpoints.__init__

    def init(self: Checkpoints, make: Callable[[], object], **_: Any) -> None:
        often(self, make, seconds=0.0, share=1.0)

    monkeypatch.setattr(Checkpoints, "__init__", init)

    def set_end(last: int | None) -> None:
        made = 0

        def write(folder: Path, checkpoint: Checkpoint) -> None:
            nonlocal made
            write_checkpoint(folder, checkpoint)
            made += 1
            if made == last:
                raise KilledError

        monkeypatch.setattr(agents.learning, "write_checkpoint", write)

    return set_end


def config(name: str) -> TrainingConfig:
    return TrainingConfig(preset=PRESETS[name].changed({}, SMALL[name]), name=name, seed=5)


def learned(folder: Path) -> tuple[bytes, dict[str, Any], list[list[str]]]:
    """Weights, results without seconds, the curve without its seconds."""
    results = json.loads((folder / "results.json").read_text(encoding="utf-8"))
    assert results.pop("seconds") > 0
    rows = [row.split(",") for row in (folder / "curve.csv").read_text(encoding="utf-8").splitlines()]
    return (folder / "policy.safetensors").read_bytes(), results, [row[:1] + row[2:] for row in rows]


def glanced(task: Task, policy: Predictor) -> tuple[float, float]:
    """In place of a glance that flies for seconds: anything that tells one policy from another."""
    getattr(policy, "start", lambda: None)()
    seen = task.vector_env(1).single_observation_space
    actions, _ = policy.predict(np.full((1, *seen.shape), 0.3, dtype=np.float32), deterministic=True)
    return float(actions.sum()), 0.0


def quietly(config: TrainingConfig, out: Path, **how: Any) -> None:
    train(config, out, progress=False, report=False, **how)


@pytest.mark.filterwarnings("ignore:You have specified a mini-batch size:UserWarning:stable_baselines3.ppo.ppo")
@pytest.mark.parametrize("name", SMALL)
def test_every_learner_goes_on_bit_for_bit(
    name: str, killed_at: Callable[[int | None], None], tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    asked = config(name)
    task = type(asked.preset.make_task())
    monkeypatch.setattr(task, "glance", glanced)
    monkeypatch.setattr(task, "judge", lambda *_: Verdict(mean=0, worst=0, text="", results={}))
    monkeypatch.setattr(agents.training, "draw_pictures", lambda *_: None)
    quietly(asked, tmp_path / "whole")
    for last in (1, 30 if SMALL[name] is OFF_POLICY else 7):  # the replay buffer is full at 25
        killed_at(last)
        with pytest.raises(KilledError):
            quietly(asked, tmp_path / f"cut{last}")
        torch.manual_seed(123)  # what another process would stand at
        killed_at(3)  # and once more, after it has gone on
        with pytest.raises(KilledError):
            quietly(asked, tmp_path / f"cut{last}", resume=True)
        killed_at(None)
        quietly(asked, tmp_path / f"cut{last}", resume=True)
        assert learned(tmp_path / f"cut{last}") == learned(tmp_path / "whole")
        assert not (tmp_path / f"cut{last}" / CHECKPOINT).exists()


def test_ctrl_c_keeps_the_policy_and_the_checkpoint_and_the_run_goes_on_to_its_end(
    killed_at: Callable[[int | None], None], tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    asked = config("hover-ppo")
    quietly(asked, tmp_path / "whole")
    killed_at(None)
    write, made = agents.learning.write_checkpoint, []

    def interrupt(folder: Path, checkpoint: Checkpoint) -> None:
        write(folder, checkpoint)
        made.append(folder)
        if len(made) == 6:
            raise KeyboardInterrupt

    monkeypatch.setattr(agents.learning, "write_checkpoint", interrupt)
    stopped = train(asked, tmp_path / "cut", progress=False, report=False)
    assert stopped.interrupted
    assert (tmp_path / "cut" / "policy.safetensors").exists()
    killed_at(None)
    ended = train(asked, tmp_path / "cut", progress=False, report=False, resume=True)
    assert not ended.interrupted
    assert learned(tmp_path / "cut") == learned(tmp_path / "whole")


@pytest.mark.parametrize("step", ["save_results", "draw_pictures", "remove_checkpoint"])
def test_a_run_killed_while_it_is_judged_and_written_is_judged_and_written_again(
    step: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    asked = config("hover-ppo")
    quietly(asked, tmp_path / "whole")

    def die(*_: object, **__: object) -> None:
        raise KilledError

    with monkeypatch.context() as patch:
        patch.setattr(agents.training, step, die)
        with pytest.raises(KilledError):
            quietly(asked, tmp_path / "cut")
    quietly(asked, tmp_path / "cut", resume=True)
    assert learned(tmp_path / "cut") == learned(tmp_path / "whole")
    assert {path.name for path in (tmp_path / "cut").iterdir()} == {
        path.name for path in (tmp_path / "whole").iterdir()
    }


def test_a_finished_run_is_left_as_it_is_and_judged_again(tmp_path: Path) -> None:
    asked = config("hover-ppo")
    first = train(asked, tmp_path, progress=False, report=False)
    before = {path: (path.stat().st_mtime_ns, path.stat().st_ino) for path in tmp_path.rglob("*") if path.is_file()}
    again = train(asked, tmp_path, progress=False, report=False, resume=True)
    after = {path: (path.stat().st_mtime_ns, path.stat().st_ino) for path in tmp_path.rglob("*") if path.is_file()}
    assert {path: one for path, one in after.items() if path.name != ".lock"} == {
        path: one for path, one in before.items() if path.name != ".lock"
    }
    assert again.verdict.mean == pytest.approx(first.verdict.mean, rel=1e-4)
    assert (again.wingbeats, again.seconds, again.interrupted) == (first.wingbeats, first.seconds, False)
    assert not (tmp_path / CHECKPOINT).exists()


def test_a_run_killed_before_its_first_checkpoint_begins_again(tmp_path: Path) -> None:
    asked = config("hover-ppo")
    quietly(asked, tmp_path / "whole")
    quietly(asked, tmp_path / "nothing", resume=True)
    assert learned(tmp_path / "nothing") == learned(tmp_path / "whole")


def test_nothing_on_the_way_back_unpickles(
    killed_at: Callable[[int | None], None], tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    for name in ("hover-ppo", "hover-sac"):
        killed_at(3)
        with pytest.raises(KilledError):
            quietly(config(name), tmp_path / name)
    killed_at(None)

    def refuse(*_: object, **__: object) -> None:
        raise AssertionError("something is unpickled")

    for owner, loads in ((pickle, "load"), (pickle, "loads"), (pickle, "Unpickler"), (torch, "load")):
        monkeypatch.setattr(owner, loads, refuse)
    for name in ("hover-ppo", "hover-sac"):
        quietly(config(name), tmp_path / name, resume=True)


def test_a_checkpoint_is_as_old_as_the_rollout_that_follows_it(
    killed_at: Callable[[int | None], None], tmp_path: Path
) -> None:
    killed_at(4)
    with pytest.raises(KilledError):
        quietly(config("hover-sac"), tmp_path)
    found = read_checkpoint(tmp_path / CHECKPOINT)
    assert found is not None
    learner = found.numbers["learner"]
    assert learner["counters"]["num_timesteps"] == 3 * 16
    assert learner["replay"] == {"next": 3, "full": False}
    assert len(found.arrays["replay/rewards"]) == 3


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


def test_a_full_disk_for_the_report_keeps_the_checkpoint_and_another_mistake_in_it_does_not(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
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
    killed_at: Callable[[int | None], None], tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    asked = config("hover-ppo")
    killed_at(3)
    with pytest.raises(KilledError):
        quietly(asked, tmp_path)
    killed_at(None)
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


def test_an_older_config_that_tells_less_goes_on(killed_at: Callable[[int | None], None], tmp_path: Path) -> None:
    asked = config("hover-ppo")
    killed_at(3)
    with pytest.raises(KilledError):
        quietly(asked, tmp_path)
    killed_at(None)
    path = tmp_path / "config.json"
    content = json.loads(path.read_text(encoding="utf-8"))
    path.write_text(json.dumps({key: content[key] for key in ("task", "algorithm", "settings")}), encoding="utf-8")
    quietly(asked, tmp_path, resume=True)


def test_one_ctrl_c_makes_a_checkpoint_of_what_it_keeps(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    asked = config("hover-ppo")
    quietly(asked, tmp_path / "whole")
    step, seen = GymnasiumVecEnv.step_wait, []

    def interrupt(self: GymnasiumVecEnv) -> Any:
        seen.append(signal.raise_signal(signal.SIGINT) if len(seen) == 4 else None)
        return step(self)

    with monkeypatch.context() as patch:
        patch.setattr(GymnasiumVecEnv, "step_wait", interrupt)
        stopped = train(asked, tmp_path / "cut", progress=False, report=False)
    assert stopped.interrupted
    assert stopped.wingbeats == 5 * 128
    found = read_checkpoint(tmp_path / "cut" / CHECKPOINT)
    assert found is not None
    assert found.numbers["learner"]["counters"]["num_timesteps"] == stopped.wingbeats
    quietly(asked, tmp_path / "cut", resume=True)
    assert learned(tmp_path / "cut") == learned(tmp_path / "whole")
