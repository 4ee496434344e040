"""The benchmark runs; what it measures is never asserted."""

from pathlib import Path

import pytest

from benchmarks import learning, profile, speed


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
