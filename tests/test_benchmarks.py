"""The benchmark runs; what it measures is never asserted."""

from pathlib import Path

import pytest

from benchmarks import checkpoints, kills, learning, profile, speed, sweep


def test_every_case_runs_and_the_table_has_both_ratios(
    monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.setattr(speed, "SECONDS", 1e-3)
    monkeypatch.setattr(speed, "REPETITIONS", 1)
    monkeypatch.setattr(speed, "MILLION", 200_000)
    speed.main()
    out = capsys.readouterr().out
    for word in (
        "baseline",
        "oracle",
        "fast path",
        "two threads",
        "Hover-v0",
        "Waveform-v0",
        "Heave-v0",
        "gym.make",
        "x oracle",
    ):
        assert word in out


@pytest.mark.parametrize("page", ["README.md", "docs/performance.md"])
def test_the_pages_show_every_case(page: str) -> None:
    text = (Path(__file__).parents[1] / page).read_text(encoding="utf-8")
    for name, _, _ in speed.cases():
        assert name.split(", error")[0] in text, "make bench"


def test_the_profile_has_the_floor_and_the_parts_of_a_step(
    monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.setattr(profile, "REPETITIONS", 1)
    profile.main()
    out = capsys.readouterr().out
    for word in ("floor", "sin", "tanh", "numba", "actions to strokes", "in all"):
        assert word in out


def test_learning_is_measured_from_the_environment_to_the_whole_learner(
    monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.setattr(speed, "SECONDS", 1e-3)
    monkeypatch.setattr(speed, "REPETITIONS", 1)
    monkeypatch.setattr(learning, "SHARE", 0.002)
    learning.main()
    out = capsys.readouterr().out
    for word in ("environment's step", "adapter", "collection", "PPO", "backward", "Adam"):
        assert word in out


def test_the_cost_of_a_sweep_is_told_beside_plain_processes(
    monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    asked: list[tuple[str, int, int]] = []
    for name in ("plain", "sweep"):
        monkeypatch.setattr(sweep, name, lambda _, runs, wingbeats, name=name: asked.append((name, runs, wingbeats)))
    sweep.main(["--runs", "3", "--wingbeats", "5000"])
    out = capsys.readouterr().out
    assert "3 runs of hover-ppo, 5,000 wingbeats, 2 at a time" in out
    assert "overhead of the sweep: " in out
    assert asked == [(name, 3, 5000) for name in ("plain", "sweep", "sweep", "plain")]


@pytest.mark.slow
def test_what_checkpoints_cost_is_told_of_every_kind_of_learner(capsys: pytest.CaptureFixture[str]) -> None:
    checkpoints.main(["--share", "0.03"])
    out = capsys.readouterr().out
    for word in ("hover-ppo", "hover-sac", "adapt-recurrentppo", "share of the time", "MB", "cores"):
        assert word in out


@pytest.mark.slow
@pytest.mark.parametrize("preset", kills.LEARNERS)
def test_runs_killed_at_random_moments_end_as_if_nothing_had_happened(
    preset: str, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    short = {"hover-ppo": ("60000", "rows=256"), "hover-sac": ("12000", "buffer=5000")}
    wingbeats, setting = short[preset]
    monkeypatch.setitem(kills.LEARNERS, preset, ("--wingbeats", wingbeats, "--set", setting))
    assert kills.main(["--moments", "3", "--presets", preset]) == 0
    assert "3 of 3 ended equal" in capsys.readouterr().out


def test_a_run_that_ends_otherwise_is_told(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    found = iter((1, 1, 2))
    monkeypatch.setattr(kills, "learned", lambda _: next(found))
    monkeypatch.setattr(kills, "started", lambda *_: None)
    monkeypatch.setattr(kills, "ended", lambda _: None)
    monkeypatch.setattr(kills, "killed", lambda *_: "no checkpoint yet")
    assert kills.main(["--moments", "2", "--presets", "hover-ppo"]) == 1
    assert "1 of 2 ended equal" in capsys.readouterr().out
