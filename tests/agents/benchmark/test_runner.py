"""The benchmark's runner: commands that only pretend to train, with all that can go wrong with processes."""

import fcntl
import json
import os
import re
import sys
import time
from pathlib import Path

import pytest
from pretended_runs import config, diary, faked, hover_preset

import agents.presets
from agents.benchmark import subprocesses, training_run
from agents.benchmark.command import benchmark_command
from agents.benchmark.runner import BenchmarkConfig, run_benchmark
from agents.benchmark.subprocesses import ERRORS, PRINTED
from agents.benchmark.training_run import Run, differences, run_command
from agents.folder_lock import LOCK, locked
from agents.presets import Preset
from agents.run_folder import RESULTS
from agents.training import TrainingConfig


@pytest.fixture(autouse=True)
def presets(monkeypatch: pytest.MonkeyPatch) -> dict[str, Preset]:
    """A registry of three presets."""
    registry = {name: hover_preset() for name in ("hover-ppo", "hover-sac", "heave-ppo")}
    monkeypatch.setattr(agents.presets, "PRESETS", registry)
    return registry


def test_runs_go_two_at_a_time_with_seeds_outside_on_one_thread_each(tmp_path: Path) -> None:
    outcome = run_benchmark(config(), tmp_path, command=faked(), progress=False)
    names = ["hover-ppo-seed0", "hover-sac-seed0", "hover-ppo-seed1", "hover-sac-seed1"]
    assert [run.name for run in outcome.finished] == names
    assert not outcome.failed
    assert not outcome.interrupted
    lines = diary(tmp_path)
    running, most = 0, 0
    for line in lines:
        running += 1 if line.startswith("begin") else -1
        most = max(most, running)
    assert most == 2
    assert {line.removeprefix("begin ") for line in lines[:2]} == set(names[:2])
    for name in names:
        assert (tmp_path / name / RESULTS).is_file()
        assert (tmp_path / name / PRINTED).read_text() == "trained 1\n"
    assert not list(tmp_path.glob("*.part"))


def test_finished_runs_are_skipped_and_those_that_came_to_nothing_redone(tmp_path: Path) -> None:
    run_benchmark(config(seeds=1), tmp_path, command=faked(), progress=False)
    part = tmp_path / "hover-ppo-seed1.part"
    part.mkdir()
    (part / "command.json").write_text("{}")
    (part / "half").touch()
    (tmp_path / "diary").unlink()
    outcome = run_benchmark(config(), tmp_path, command=faked(), progress=False)
    assert len(outcome.finished) == 4
    assert sorted(line for line in diary(tmp_path) if line.startswith("begin")) == [
        "begin hover-ppo-seed1",
        "begin hover-sac-seed1",
    ]
    assert not (tmp_path / "hover-ppo-seed1" / "half").exists()


def test_ctrl_c_ends_what_runs_and_the_same_command_goes_on(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    arguments = [
        "--presets",
        "hover-ppo",
        "hover-sac",
        "--seeds",
        "2",
        "--jobs",
        "1",
        "--root",
        str(tmp_path),
        "--quiet",
    ]
    assert benchmark_command(arguments, command=faked(hover_sac_seed0="interrupt")) == 130
    printed = capsys.readouterr()
    assert "hover-ppo     1" in printed.out
    assert "stopped with 1 of 4 runs" in printed.err
    assert not (tmp_path / "runs.csv").exists()
    with pytest.raises(ChildProcessError):
        os.waitpid(-1, os.WNOHANG)  # no child is left
    assert benchmark_command(arguments, command=faked()) == 0
    assert diary(tmp_path).count("begin hover-ppo-seed0") == 1
    assert diary(tmp_path).count("begin hover-sac-seed0") == 1
    assert "go on hover-sac-seed0" in diary(tmp_path)
    assert (tmp_path / "runs.csv").read_text().count("\n") == 5
    assert f"kept in {tmp_path}" in capsys.readouterr().out


def test_a_run_that_will_not_end_is_killed(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(subprocesses, "PATIENCE", 0.2)
    stubborn = "import os, signal, time; signal.signal(15, signal.SIG_IGN); os.kill(os.getppid(), 2); time.sleep(60)"

    def command(_: Run, __: Path) -> list[str]:
        return [sys.executable, "-I", "-S", "-c", stubborn]

    started = time.monotonic()
    outcome = run_benchmark(config("hover-ppo", seeds=1), tmp_path, command=command, progress=False)
    assert outcome.interrupted
    assert not outcome.finished
    assert time.monotonic() - started < 20
    with pytest.raises(ChildProcessError):
        os.waitpid(-1, os.WNOHANG)


def test_a_failed_run_is_named_with_its_last_words_and_the_others_go_on(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    broken = faked(hover_ppo_seed0="fail", hover_sac_seed0="die", hover_ppo_seed1="silent")
    arguments = ["--presets", "hover-ppo", "hover-sac", "--seeds", "2", "--root", str(tmp_path), "--quiet"]
    assert benchmark_command(arguments, command=broken) == 1
    said = capsys.readouterr().err
    assert "hover-ppo-seed0 failed: the wing fell off (exit code 1; see " in said
    assert "hover-sac-seed0 failed: it said nothing (killed by SIGKILL; see " in said
    assert f"hover-ppo-seed1 failed: it ended without {RESULTS}" in said
    failed = "hover-ppo-seed0, hover-sac-seed0, hover-ppo-seed1"
    assert re.search(rf"ended with 1 of 4 runs in .* \(failed: {failed}\); the same command goes on\n", said)
    assert (tmp_path / "hover-ppo-seed0.part" / ERRORS).read_text() == "first line\nthe wing fell off\n"
    assert (tmp_path / "runs.csv").read_text().count("\n") == 2
    assert not run_benchmark(config(), tmp_path, command=faked(), progress=False).failed


def test_a_run_made_with_other_settings_is_refused(tmp_path: Path, presets: dict[str, Preset]) -> None:
    run_benchmark(config(seeds=1), tmp_path, command=faked(), progress=False)
    presets["hover-sac"] = hover_preset(learning_rate=0.2)
    with pytest.raises(
        ValueError, match=r"hover-sac-seed0 was made .* settings.learning_rate = 0.1 there, wanted 0.2;"
    ):
        run_benchmark(config(), tmp_path, command=faked(), progress=False)
    shorter = BenchmarkConfig(presets=["hover-ppo"], seeds=1, wingbeats=5)
    with pytest.raises(ValueError, match=r"settings.wingbeats = 20 there, wanted 5; allowed: the same"):
        run_benchmark(shorter, tmp_path, command=faked(), progress=False)
    assert differences({"a": {"b": 1}, "c": 2}, {"a": {}}) == [
        "a.b is missing there, wanted 1",
        "c is missing there, wanted 2",
    ]


def test_folders_of_others_are_never_removed(tmp_path: Path) -> None:
    for name, said in (
        ("hover-ppo-seed0", "holds no config.json and no results.json"),
        ("hover-ppo-seed0.part", "holds no command.json"),
    ):
        (tmp_path / name).mkdir()
        (tmp_path / name / "thesis.txt").touch()
        with pytest.raises(FileExistsError, match=f"{re.escape(name)} is in the way.*{said}"):
            run_benchmark(config(), tmp_path, command=faked(), progress=False)
        (tmp_path / name / "thesis.txt").unlink()
        (tmp_path / name).rmdir()


def test_a_second_benchmark_into_the_same_folder_is_refused_until_the_first_is_gone(tmp_path: Path) -> None:
    with locked(tmp_path) as lock:
        left_behind = os.dup(lock)  # as a child that outlives a killed benchmark has it
        with pytest.raises(BlockingIOError, match=f"in use by process {os.getpid()}"):
            run_benchmark(config(), tmp_path, command=faked(), progress=False)
    with pytest.raises(BlockingIOError, match="or by what it started"), locked(tmp_path):
        pass
    os.close(left_behind)
    (tmp_path / LOCK).write_text("4194304")  # of a process that is no more
    with locked(tmp_path) as lock:
        assert (tmp_path / LOCK).read_text() == str(os.getpid())
        assert fcntl.fcntl(lock, fcntl.F_GETFD) & fcntl.FD_CLOEXEC  # only those told to inherit it do


def test_the_command_of_a_run_is_the_one_a_reader_would_type(tmp_path: Path) -> None:
    words = run_command(Run(preset="hover-ppo", seed=3, wingbeats=100), tmp_path)
    assert words[0] == sys.executable
    assert Path(words[1]).name == "train.py"
    assert Path(words[1]).is_file()
    said = f"--preset hover-ppo --seed 3 --wingbeats 100 --out {tmp_path} --quiet --no-report"
    assert " ".join(words[2:]) == said
    assert "--wingbeats" not in run_command(Run(preset="hover-ppo", seed=3), tmp_path)


def test_a_run_is_described_as_its_config_file_describes_it() -> None:
    described = Run(preset="hover-ppo", seed=1, wingbeats=7).described()
    config = TrainingConfig(preset=hover_preset(wingbeats=7), seed=1, name="hover-ppo")
    assert described == json.loads(json.dumps(config.to_dict()))
    assert described["settings"]["wingbeats"] == 7


@pytest.mark.parametrize(
    ("arguments", "said"),
    [
        (["--presets", "hover-pqo"], "presets = 'hover-pqo' is unknown; .*did you mean 'hover-ppo'"),
        (["--presets", "hover-ppo", "hover-ppo"], "presets name hover-ppo more than once"),
        (["--presets", "hover-ppo", "--seeds", "0"], "seeds = 0 is not allowed; allowed: whole numbers from 1"),
        (["--presets", "hover-ppo", "--jobs", "0"], "jobs = 0 is not allowed"),
        (["--presets", "hover-ppo", "--wingbeats", "0"], "wingbeats = 0 is not allowed"),
        (["--presets", "hover-ppo", "--root", "FILE"], "--root FILE is a file; allowed: a folder"),
        (["--presets", "hover-ppo", "--out", "FILE"], "--out FILE is a file; allowed: a folder"),
        (["--report", "NOWHERE"], "NOWHERE holds no runs.csv, no insects.csv, no curves.csv; allowed"),
        (["--report", "NOWHERE", "--seeds", "2", "--root", "x"], "--report goes alone, not with --seeds, --root"),
    ],
)
def test_bad_input_is_one_line_and_exit_code_2(
    arguments: list[str], said: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.chdir(tmp_path)
    Path("FILE").touch()
    assert benchmark_command([*arguments, "--quiet"], command=faked()) == 2
    printed = capsys.readouterr()
    assert not printed.out
    assert re.fullmatch(f"train.py benchmark: .*({said}).*\n", printed.err)


def test_the_registry_is_that_of_the_learners(presets: dict[str, Preset]) -> None:
    assert training_run.registered() is presets
