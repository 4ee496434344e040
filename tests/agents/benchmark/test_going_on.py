"""Runs of a benchmark that were under way when it ended: they go on where that can be, and else begin anew."""

import json
import os
import shutil
import signal
import subprocess
import sys
import time
from collections.abc import Callable
from pathlib import Path

import pytest
from pretended_runs import change, config, diary, faked, hover_preset

import agents.presets
from agents.benchmark.run_queue import train_all
from agents.benchmark.runner import run_benchmark
from agents.benchmark.training_run import COMMAND, Run, clear, goes_on, run_command
from agents.checkpoint import STATE
from agents.folder_lock import LOCK, locked
from agents.run_folder import CHECKPOINT, CONFIG, CURVE, POLICY_TENSORS, RESULTS

NAME = "hover-ppo-seed0"
RUN = Run(preset="hover-ppo", seed=0)


@pytest.fixture
def few(monkeypatch: pytest.MonkeyPatch) -> None:
    """A registry of one preset."""
    monkeypatch.setattr(agents.presets, "PRESETS", {"hover-ppo": hover_preset()})


@pytest.fixture
def part(few: None, tmp_path: Path) -> Path:
    """The folder of a run that was killed."""
    died = run_benchmark(config("hover-ppo", seeds=1), tmp_path, command=faked(hover_ppo_seed0="die"), progress=False)
    assert list(died.failed) == [NAME]
    (tmp_path / "diary").unlink()
    return tmp_path / f"{NAME}.part"


def again(root: Path, **what: str) -> dict[str, str]:
    """What fails when the same is asked for once more."""
    return dict(run_benchmark(config("hover-ppo", seeds=1), root, command=faked(**what), progress=False).failed)


def test_a_run_under_way_goes_on_in_its_folder(part: Path) -> None:
    (part / "checkpoint").mkdir()
    (part / "checkpoint" / "half").touch()
    assert again(part.parent) == {}
    assert diary(part.parent) == [f"go on {NAME}", f"end {NAME}"]
    assert (part.parent / NAME / "checkpoint" / "half").exists()
    assert not part.exists()


@pytest.mark.parametrize("content", ["", "[]", None])
def test_a_run_begins_anew_that_has_no_config_to_go_on_with(content: str | None, part: Path) -> None:
    (part / CONFIG).unlink()
    if content is not None:
        (part / CONFIG).write_text(content)
    (part / "half").touch()
    assert again(part.parent) == {}
    assert diary(part.parent) == [f"begin {NAME}", f"end {NAME}"]
    assert not (part.parent / NAME / "half").exists()


def test_a_run_begins_anew_whose_settings_are_others_now(part: Path) -> None:
    change(part / CONFIG, seed=7)
    (part / "half").touch()
    assert again(part.parent) == {}
    assert diary(part.parent)[0] == f"begin {NAME}"
    assert not (part.parent / NAME / "half").exists()


@pytest.mark.parametrize(
    ("results", "goes"),
    [
        ({"wingbeats": 5, "interrupted": True}, True),
        ({"wingbeats": 20, "interrupted": False}, True),  # killed before it got its name
        ({"wingbeats": 5, "interrupted": False}, False),
        ({"wingbeats": "many", "interrupted": False}, False),
    ],
)
def test_a_run_with_results_goes_on_unless_they_are_wrong(results: dict[str, object], goes: bool, part: Path) -> None:
    (part / RESULTS).write_text(json.dumps(results))
    assert goes_on(part, RUN) is goes
    assert again(part.parent) == {}
    assert diary(part.parent)[0] == f"{'go on' if goes else 'begin'} {NAME}"


def test_what_is_left_beside_a_run_goes_on_only_where_that_was_cut_short(part: Path) -> None:
    root, folder = part.parent, part.parent / NAME
    shutil.copytree(part, root / "copy")
    assert again(root) == {}
    (root / "diary").unlink()
    shutil.copytree(root / "copy", part)
    assert again(root) == {}
    assert not (root / "diary").exists()
    assert not part.exists()
    shutil.copytree(root / "copy", part)
    change(folder / RESULTS, interrupted=True)
    (part / "newer").touch()
    assert again(root) == {}
    assert diary(root) == [f"go on {NAME}", f"end {NAME}"]
    assert (folder / "newer").exists()
    assert not part.exists()


def test_a_run_in_anothers_folder_does_not_go_on(part: Path) -> None:
    (part / COMMAND).unlink()
    with pytest.raises(FileExistsError, match=f"holds no {COMMAND}, so we did not make it"):
        again(part.parent)
    assert (part / CONFIG).exists()


def test_a_folder_cleared_half_way_is_still_our_own_and_begins_anew(
    part: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    for name in ("aaa", "zzz"):
        (part / name).mkdir()

    def killed(*_: object) -> None:
        raise InterruptedError

    with monkeypatch.context() as patch:
        patch.setattr("shutil.rmtree", killed)
        with pytest.raises(InterruptedError):
            clear(part)
    assert (part / COMMAND).exists()
    assert not (part / CONFIG).exists()
    assert again(part.parent) == {}


def test_a_folder_of_a_benchmark_killed_as_it_made_it_is_cleared(few: None, tmp_path: Path) -> None:
    for left in (".partial-0123abcd.json", None):
        folder = tmp_path / f"{NAME}.part"
        folder.mkdir()
        if left is not None:
            (folder / left).touch()
        clear(folder)
        assert not folder.exists()


def test_a_run_that_cannot_go_on_fails_with_what_to_do_about_it(part: Path) -> None:
    root = part.parent
    for _ in range(2):
        said = again(root, hover_ppo_seed0="fail")[NAME]
        assert said.startswith("the wing fell off (exit code 1; see ")
        assert said.endswith(f"; the same command goes on with it, or begins it anew once {part} is removed")
    assert diary(root) == [f"go on {NAME}"] * 2
    clear(part)
    assert again(root, hover_ppo_seed0="nothing")[NAME].endswith("errors.txt)")  # nothing to go on with
    assert again(root) == {}
    assert diary(root)[2:] == [f"begin {NAME}", f"begin {NAME}", f"end {NAME}"]


def test_the_command_of_a_run_that_goes_on(part: Path) -> None:
    assert run_command(RUN, part)[2:] == ["--resume", str(part), "--quiet", "--no-report"]
    assert "--resume" not in run_command(RUN, part.parent)


def test_a_broken_checkpoint_is_named_with_what_to_do_about_it(tmp_path: Path) -> None:
    run = Run(preset="hover-ppo", seed=0, wingbeats=20_000)
    part = tmp_path / f"{NAME}.part"
    (part / CHECKPOINT).mkdir(parents=True)
    (part / COMMAND).write_text("{}")
    (part / CONFIG).write_text(json.dumps(run.described()))
    (part / CHECKPOINT / STATE).write_text("{}")
    said = train_all([run], tmp_path, 1, progress=False).failed[NAME]
    assert f"{STATE}: format = None is not known" in said
    assert said.endswith(f"; the same command goes on with it, or begins it anew once {part} is removed")


KILLED = """
import sys
from pathlib import Path
from test_going_on import SHORT, often
from agents.benchmark.run_queue import train_all

train_all([SHORT], Path(sys.argv[1]), 1, command=often)
"""
OFTEN = """
import runpy, sys
from agents.checkpoint import Checkpoints

Checkpoints.__init__.__kwdefaults__["share"] = 1.0
del sys.argv[0]
runpy.run_path(sys.argv[0], run_name="__main__")
"""
SHORT = Run(preset="hover-ppo", seed=0, wingbeats=80_000)


def often(run: Run, out: Path) -> list[str]:
    """The command of a run that makes a checkpoint before every rollout."""
    python, *words = run_command(run, out)
    return [python, "-c", OFTEN, *words, "--checkpoint-seconds", "0"]


def until(condition: Callable[[], bool]) -> None:
    """Wait for it."""
    while not condition():
        time.sleep(0.02)


def reached(part: Path) -> int:
    """Wingbeats of a run's checkpoint."""
    state = part / CHECKPOINT / STATE
    return json.loads(state.read_text())["learner"]["counters"]["num_timesteps"] if state.exists() else 0


def free(folder: Path) -> bool:
    """Whether nobody works in a folder any more."""
    try:
        with locked(folder):
            return True
    except BlockingIOError:
        return False


@pytest.mark.slow
def test_a_benchmark_that_is_killed_goes_on_and_ends_as_if_it_had_not_been(tmp_path: Path) -> None:
    assert not train_all([SHORT], tmp_path / "whole", 1, command=often, progress=False).failed
    root, part = tmp_path / "killed", tmp_path / "killed" / f"{NAME}.part"
    paths = os.pathsep.join([str(Path(__file__).parent), str(Path(__file__).parents[1]), *sys.path])
    with subprocess.Popen(
        [sys.executable, "-c", KILLED, str(root)],
        env={**os.environ, "PYTHONPATH": paths},
        stderr=subprocess.DEVNULL,
    ) as benchmark:
        until(lambda: benchmark.poll() is not None or reached(part) >= 10_000)
        assert benchmark.poll() is None
        benchmark.kill()
    os.kill(int((part / LOCK).read_text()), signal.SIGKILL)  # the run, which lives on
    until(lambda: free(root))
    assert reached(part) < SHORT.described()["settings"]["wingbeats"]
    first = (part / CURVE).read_text().splitlines()[1]

    outcome = train_all([SHORT], root, 1, command=often, progress=False)
    assert outcome.finished == [SHORT]
    learned = root / NAME
    assert (learned / POLICY_TENSORS).read_bytes() == (tmp_path / "whole" / NAME / POLICY_TENSORS).read_bytes()
    assert (learned / CURVE).read_text().splitlines()[1] == first  # with its seconds: it did not begin anew
    assert not (learned / CHECKPOINT).exists()
