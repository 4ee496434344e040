"""Runs that are stopped at a checkpoint and go on end as if nothing had happened: every learner, every task."""

import pickle
import signal
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import torch
from killed_runs import OFF_POLICY, SMALL, KilledError, config, learned, quietly

import agents.learning
import agents.training
from agents.checkpoint import Checkpoint, read_checkpoint
from agents.predictor import Predictor
from agents.run_folder import CHECKPOINT
from agents.tasks.task import Task, Verdict
from agents.training import train
from agents.vec_env import GymnasiumVecEnv


def glanced(task: Task, policy: Predictor) -> tuple[float, float]:
    """In place of a glance that flies for seconds: anything that tells one policy from another."""
    getattr(policy, "start", lambda: None)()
    seen = task.vector_env(1).single_observation_space
    actions, _ = policy.predict(np.full((1, *seen.shape), 0.3, dtype=np.float32), deterministic=True)
    return float(actions.sum()), 0.0


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
