"""The benchmark runs; what it measures is never asserted."""

import pytest

from benchmarks import speed, waveform


def test_every_case_runs_and_the_table_has_both_ratios(
    monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.setattr(speed, "SECONDS", 1e-3)
    monkeypatch.setattr(speed, "REPETITIONS", 1)
    monkeypatch.setattr(speed, "MILLION", 200_000)
    speed.main()
    out = capsys.readouterr().out
    for word in ("baseline", "oracle", "fast path", "two threads", "Hover-v0", "gym.make", "x baseline", "x oracle"):
        assert word in out


def test_the_cases_of_free_waveforms_run_beside_the_baseline(
    monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.setattr(speed, "SECONDS", 1e-3)
    monkeypatch.setattr(speed, "REPETITIONS", 1)
    waveform.main()
    out = capsys.readouterr().out
    for word in ("baseline", "free waveforms", "Waveform vector env", "gym.make", "x baseline"):
        assert word in out
