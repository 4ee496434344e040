"""What the benchmark makes of the folders that it finds: cut short, tampered with, or of other settings."""

import os
from collections.abc import Sequence
from pathlib import Path
from typing import Any

import pytest
from pretended_runs import change, config, diary, faked, hover_preset

import agents.presets
from agents.benchmark.command import benchmark_command
from agents.benchmark.runner import finished_runs, run_benchmark
from agents.benchmark.training_run import Run
from agents.presets import Preset
from agents.run_folder import RESULTS


@pytest.fixture(autouse=True)
def presets(monkeypatch: pytest.MonkeyPatch) -> dict[str, Preset]:
    """A registry of three presets."""
    registry = {name: hover_preset() for name in ("hover-ppo", "hover-sac", "heave-ppo")}
    monkeypatch.setattr(agents.presets, "PRESETS", registry)
    return registry


@pytest.mark.parametrize(
    ("values", "said", "how"),
    [
        ({"interrupted": True}, "was interrupted after 20", "go on"),
        ({"wingbeats": 19}, "ended after 19 of 20 wingbeats", "begin"),  # with the seconds of a run that is over
    ],
)
def test_a_run_that_was_cut_short_goes_on_or_is_redone_if_it_is_our_own_and_else_refused(
    values: dict[str, Any], said: str, how: str, tmp_path: Path
) -> None:
    run_benchmark(config(seeds=1), tmp_path, command=faked(), progress=False)
    (tmp_path / "diary").unlink()
    folder = tmp_path / "hover-sac-seed0"
    change(folder / RESULTS, **values)
    assert finished_runs(tmp_path)[1] == {"hover-sac-seed0": f"{folder} was cut short"}
    outcome = run_benchmark(config(seeds=1), tmp_path, command=faked(), progress=False)
    assert diary(tmp_path) == [f"{how} hover-sac-seed0", "end hover-sac-seed0"]
    assert len(outcome.finished) == 2
    assert finished_runs(tmp_path)[0] == config(seeds=1).runs()
    change(folder / RESULTS, **values)
    (folder / "command.json").unlink()
    with pytest.raises(ValueError, match=f"hover-sac-seed0 is in the way: its run {said}"):
        run_benchmark(config(seeds=1), tmp_path, command=faked(), progress=False)
    assert folder.exists()


def test_a_run_that_says_itself_that_it_was_interrupted_has_failed(tmp_path: Path) -> None:
    stopped = faked(hover_ppo_seed0="stopped")
    outcome = run_benchmark(config(seeds=1), tmp_path, command=stopped, progress=False)
    assert "it was interrupted after 20 wingbeats; see" in outcome.failed["hover-ppo-seed0"]
    assert not (tmp_path / "hover-ppo-seed0").exists()


def test_the_folder_to_be_redone_is_kept_until_then_and_never_anothers(tmp_path: Path) -> None:
    run_benchmark(config("hover-ppo", seeds=1), tmp_path, command=faked(), progress=False)
    folder = tmp_path / "hover-ppo-seed0"
    change(folder / RESULTS, wingbeats=19)
    broken = faked(hover_ppo_seed0="fail")
    assert run_benchmark(config("hover-ppo", seeds=1), tmp_path, command=broken, progress=False).failed
    assert (folder / RESULTS).exists()

    def swapped(run: Run, out: Path) -> Sequence[str]:
        (folder / "command.json").unlink()
        return faked()(run, out)

    outcome = run_benchmark(config("hover-ppo", seeds=1), tmp_path, command=swapped, progress=False)
    assert "cannot be put in place" in outcome.failed["hover-ppo-seed0"]
    assert (folder / RESULTS).exists()


def test_tables_are_of_all_finished_runs_in_the_root(
    tmp_path: Path, presets: dict[str, Preset], capsys: pytest.CaptureFixture[str]
) -> None:
    run_benchmark(config("heave-ppo", "hover-sac"), tmp_path, command=faked(), progress=False)
    (tmp_path / "hover-sac-seed01").mkdir()
    (tmp_path / "hover-trpo-seed0").mkdir()
    (tmp_path / "hover-sac-seed7").mkdir()
    presets["heave-ppo"] = hover_preset(learning_rate=0.3)
    arguments = ["--presets", "hover-ppo", "--seeds", "1", "--root", str(tmp_path), "--quiet"]
    assert benchmark_command(arguments, command=faked()) == 0
    lines = [line.split(",")[:2] for line in (tmp_path / "runs.csv").read_text().splitlines()]
    assert lines[1:] == [["hover-ppo", "0"], ["hover-sac", "0"], ["hover-sac", "1"]]
    said = capsys.readouterr().err
    for seed in (0, 1):
        assert f"left out of the tables: {tmp_path / f'heave-ppo-seed{seed}'} was made with other settings" in said
    assert "hover-sac-seed7 is in the way: it holds no config.json" in said
    assert said.count("\n") == 3


@pytest.mark.parametrize("content", ["[]", "3", "{", '{"a": NaN}', "[" * 100_000])
@pytest.mark.parametrize("name", ["config.json", RESULTS])
def test_files_that_are_no_objects_are_named(
    name: str, content: str, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    arguments = ["--presets", "hover-ppo", "--seeds", "1", "--root", str(tmp_path), "--quiet"]
    run_benchmark(config("hover-ppo", seeds=1), tmp_path, command=faked(), progress=False)
    (tmp_path / "hover-ppo-seed0" / name).write_text(content)
    assert benchmark_command(arguments, command=faked()) == 2
    said = capsys.readouterr().err
    assert f"hover-ppo-seed0/{name} " in said
    assert said.count("\n") == 1


def test_help_says_how_long_it_takes(capsys: pytest.CaptureFixture[str]) -> None:
    with pytest.raises(SystemExit):
        benchmark_command(["--help"])
    said = " ".join(capsys.readouterr().out.split())
    assert "one to two hours on two cores" in said
    assert f"at most one a core, of which this computer has {os.cpu_count()}" in said
