"""A benchmark's statistics, tables and pictures, from invented numbers."""

import csv
import json
import math
from pathlib import Path

import numpy as np
import pytest
import scipy.stats

from agents.benchmark_command import benchmark_command
from agents.benchmark_data import (
    CURVE_POINTS,
    CURVES_TABLE,
    RUNS_TABLE,
    THRESHOLDS,
    BenchmarkData,
    CurvePoint,
    RunRow,
    collect,
    load,
    save,
    thinned,
)
from agents.benchmark_pictures import CURVES_PICTURE, FINAL_PICTURE, OTHERS_PICTURE, PROFILE_PICTURE, draw_final
from agents.benchmark_report import PAGE, TABLE, percent, reached_rows, spent_rows, text_report
from agents.benchmark_statistics import (
    first_below,
    interquartile_mean,
    interval,
    last_known,
    median_of_reached,
    profile,
)
from agents.machine import MACHINE, machine_text, note_machine, read_machines

PRESETS = {"hover-ppo": 0.001, "hover-gradient": 1e-8, "random-wings-ppo": 0.002, "heave-ppo": -0.01}
FULL_POINTS = 200


def make_run(folder: Path, preset: str, seed: int) -> None:
    """Write a run folder as a training run leaves it."""
    rng = np.random.default_rng([seed, len(preset)])
    folder.mkdir(parents=True)
    final = PRESETS[preset] * (1 + rng.uniform(0, 1))
    with (folder / "curve.csv").open("w", encoding="utf-8", newline="") as file:
        writer = csv.writer(file)
        writer.writerow(("wingbeats", "seconds", "mean_reward", "mean_gap", "worst_gap"))
        for number in range(1, FULL_POINTS + 1):
            gap = final + 0.5 * math.exp(-number / 20)
            writer.writerow((1000 * number, 0.5 * number, -1.0 - gap, gap, 2 * gap))
    results = {
        "preset": preset,
        "environment": "flapenv/Heave-v0" if preset == "heave-ppo" else "flapenv/Hover-v0",
        "seed": seed,
        "verdict": {"mean": final, "worst": 3 * abs(final), "distance": "gap to the optimum"},
        "wingbeats": 1000 * FULL_POINTS,
        "seconds": 100.0,
    }
    if preset.startswith("hover"):
        results["insects"] = {
            "hawkmoth": {"gap_percent": 100 * final},
            "fruitfly": {"gap_percent": 300 * final},
            "cranefly": {"gap_percent": None},
        }
    (folder / "results.json").write_text(json.dumps(results), encoding="utf-8")


@pytest.fixture
def data(tmp_path: Path) -> BenchmarkData:
    """Five seeds of each of four presets."""
    folders = {(preset, seed): tmp_path / "runs" / f"{preset}-{seed}" for seed in range(5) for preset in PRESETS}
    for (preset, seed), folder in folders.items():
        make_run(folder, preset, seed)
    return collect(folders)


def test_the_interquartile_mean_is_the_mean_of_the_middle() -> None:
    assert interquartile_mean(np.array([5.0, 1, 100, 2, 3])) == pytest.approx((2 + 3 + 5) / 3)
    assert interquartile_mean(np.array([8.0, 1, 2, 3, 4, 5, 6, 7])) == pytest.approx((3 + 4 + 5 + 6) / 4)
    assert interquartile_mean(np.array([1.0, 2, 6])) == pytest.approx(3)
    assert interquartile_mean(np.array([[1.0, 5], [2, 6], [3, 7], [4, 80]]), axis=0) == pytest.approx([2.5, 6.5])


def test_the_interval_holds_the_interquartile_mean_and_needs_two_runs(rng: np.random.Generator) -> None:
    for size in (2, 5, 12):
        values = rng.lognormal(size=size)
        found = interval(values)
        assert found is not None
        assert values.min() <= found[0] <= interquartile_mean(values) <= found[1] <= values.max()
        assert interval(values) == found
    assert interval(np.array([1.0])) is None
    assert interval(np.full(5, 0.25)) == (0.25, 0.25)


def test_the_interval_covers_the_truth_nearly_as_often_as_it_says(rng: np.random.Generator) -> None:
    found = [interval(rng.normal(size=40)) for _ in range(20)]
    assert sum(one is not None and one[0] <= 0 <= one[1] for one in found) >= 17


def test_the_interval_of_many_runs_is_1_96_standard_errors_either_side() -> None:
    """Of n normal numbers the interquartile mean scatters by 1.0932/sqrt(n).

    Source: Huber & Ronchetti (2009), Robust Statistics, section 3.3: the variance of a trimmed mean, here of a quarter.
    """
    quantiles = scipy.stats.norm.ppf((np.arange(100) + 0.5) / 100)
    low, high = interval(quantiles) or (0.0, 0.0)
    assert high - low == pytest.approx(2 * 1.96 * 1.0932 / 10, rel=0.03)
    assert low + high == pytest.approx(0, abs=0.02)


def test_a_profile_rises_from_none_to_all(rng: np.random.Generator) -> None:
    values = rng.lognormal(size=30)
    shares = profile(values, np.geomspace(values.min() / 2, values.max(), 100))
    assert shares[0] == 0
    assert shares[-1] == 1
    assert np.all(np.diff(shares) >= 0)
    assert profile(np.array([1.0, 2, 2, 4]), np.array([2.0, 1.999])).tolist() == [0.75, 0.25]


def test_the_first_point_below_is_a_point_and_nothing_is_interpolated() -> None:
    values = np.array([0.5, 0.06, 0.05, 0.2, 0.001])
    assert [first_below(values, one) for one in (0.05, 0.01, 1e-4)] == [2, 4, None]
    assert first_below(np.array([]), 1.0) is None
    assert median_of_reached([3.0, None, 1.0, 2.0, None]) == 3.0
    assert median_of_reached([3.0, None, None]) is None
    steps = last_known(np.array([10.0, 20.0]), np.array([1.0, 2.0]), np.array([9.0, 10.0, 19.9, 20.0, 99.0]))
    np.testing.assert_array_equal(steps, [np.nan, 1, 1, 2, 2])


def test_a_thinned_curve_keeps_its_ends_and_when_each_threshold_was_first_reached(rng: np.random.Generator) -> None:
    gaps = 2 * np.exp(-np.arange(5000) / 500) * rng.lognormal(sigma=0.5, size=5000)
    points = [
        CurvePoint(preset="p", seed=0, wingbeats=100 * i, seconds=i / 7, mean=float(gap), worst=float(gap))
        for i, gap in enumerate(gaps)
    ]
    kept = thinned(points)
    assert len(kept) <= CURVE_POINTS
    assert kept[0] is points[0]
    assert kept[-1] is points[-1]
    for threshold in THRESHOLDS:
        first = first_below(np.array([point.mean for point in kept]), threshold)
        assert first is not None
        assert kept[first] is points[first_below(gaps, threshold) or 0]
    assert thinned(points[:20]) == points[:20]


def test_what_is_saved_is_what_was_collected(data: BenchmarkData, tmp_path: Path) -> None:
    assert len(data.runs) == 20
    assert len(data.insects) == 20
    assert all(len(curve) <= CURVE_POINTS for preset in PRESETS for curve in data.curves_of(preset))
    save(data, tmp_path)
    again = load(tmp_path)
    assert [run.preset for run in again.runs] == [run.preset for run in data.runs]
    for kept, collected in zip(again.runs, data.runs, strict=True):
        assert kept.mean == pytest.approx(collected.mean, rel=1e-5)
        assert (kept.wingbeats, kept.distance, kept.seed) == (collected.wingbeats, collected.distance, collected.seed)
    assert spent_rows(again) == spent_rows(data)
    assert again.gaps_of("hover-ppo") == pytest.approx(data.gaps_of("hover-ppo"), rel=1e-5)


def test_the_tables_say_what_was_reached_and_what_it_took(data: BenchmarkData) -> None:
    means = [run.mean for run in data.runs_of("hover-ppo")]
    row = dict(zip(*reached_rows(data)[:2], strict=True))
    assert row["preset"] == "hover-ppo"
    assert row["runs"] == "5"
    assert float(row["IQM [%]"]) == pytest.approx(100 * np.mean(sorted(means)[1:4]), rel=5e-3)
    assert float(row["worst [%]"]) == pytest.approx(300 * max(means), rel=5e-3)
    assert (row["wingbeats"], row["seconds"]) == ("200,000", "100")
    spent = spent_rows(data)
    assert spent[0] == [
        "preset",
        "to 5 %",
        "seconds",
        "runs",
        "to 1 %",
        "seconds",
        "runs",
        "to 0.1 %",
        "seconds",
        "runs",
    ]
    firsts = [next(n for n in range(1, 201) if mean + 0.5 * math.exp(-n / 20) <= 0.05) for mean in means]
    assert spent[1][:4] == ["hover-ppo", f"{1000 * sorted(firsts)[2]:,}", f"{0.5 * sorted(firsts)[2]:.0f}", "5/5"]
    assert spent[1][-3:] == ["-", "-", "0/5"]
    text = text_report(data, "one machine")
    assert "of 5 runs it is rough" in text
    assert "one machine" in text
    assert max(map(len, text.splitlines())) <= 120


def test_one_run_has_a_table_too() -> None:
    run = RunRow(
        preset="hover-ppo", seed=0, environment="e", distance="d", mean=0.0, worst=0.0, wingbeats=10, seconds=0.5
    )
    data = BenchmarkData(runs=[run], insects=[], curves=[])
    assert reached_rows(data)[1] == ["hover-ppo", "1", "0", "-", "0", "10", "0"]
    assert spent_rows(data)[1][1:4] == ["-", "-", "0/1"]
    assert "one run is not enough" in text_report(data, "")
    assert [percent(x) for x in (12.345, 0.012345, 1.2345e-6, 1.2e-8, -0.02)] == [
        "1234",
        "1.23",
        "0.000123",
        "1e-06",
        "-2",
    ]


def test_the_report_is_redrawn_from_the_kept_numbers_alone(
    data: BenchmarkData, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    save(data, tmp_path)
    note_machine(tmp_path, 2)
    assert benchmark_command(["--report", str(tmp_path)]) == 0
    assert (tmp_path / TABLE).read_text(encoding="utf-8") in capsys.readouterr().out
    assert f"- {machine_text(read_machines(tmp_path))}" in (tmp_path / PAGE).read_text(encoding="utf-8")
    for name in (FINAL_PICTURE, CURVES_PICTURE, PROFILE_PICTURE, OTHERS_PICTURE):
        assert 10_000 < (tmp_path / name).stat().st_size < 150_000
    again = draw_final(load(tmp_path), ["hover-ppo", "hover-gradient"])
    again.savefig(tmp_path / "again.png", metadata={"Software": None})
    assert (tmp_path / "again.png").read_bytes() == (tmp_path / FINAL_PICTURE).read_bytes()


def test_numbers_that_were_tampered_with_are_refused_with_file_and_line(data: BenchmarkData, tmp_path: Path) -> None:
    save(data, tmp_path)
    runs = (tmp_path / RUNS_TABLE).read_text(encoding="utf-8")
    (tmp_path / RUNS_TABLE).write_text(runs.replace("200000", "many", 1), encoding="utf-8")
    with pytest.raises(ValueError, match=r"runs.csv, line 2: .*'many'"):
        load(tmp_path)
    (tmp_path / RUNS_TABLE).write_text(runs.replace("worst", "best", 1), encoding="utf-8")
    with pytest.raises(ValueError, match=r"runs.csv has columns .*'best'.*; allowed: preset, seed, environment"):
        load(tmp_path)
    (tmp_path / RUNS_TABLE).write_text("\n".join(runs.splitlines()[:-1]), encoding="utf-8")
    with pytest.raises(ValueError, match=rf"{CURVES_TABLE} has heave-ppo, seed 4, which runs.csv lacks"):
        load(tmp_path)


def test_results_without_a_verdict_are_named(tmp_path: Path) -> None:
    make_run(tmp_path / "run", "hover-ppo", 0)
    (tmp_path / "run" / "results.json").write_text('{"wingbeats": 3}', encoding="utf-8")
    with pytest.raises(ValueError, match=r"results.json is not a run's: KeyError 'verdict'"):
        collect({("hover-ppo", 0): tmp_path / "run"})


def test_every_machine_that_ran_some_of_it_is_told(tmp_path: Path) -> None:
    assert read_machines(tmp_path) == []
    for jobs in (2, 2, 1):
        note_machine(tmp_path, jobs)
    machines = json.loads((tmp_path / MACHINE).read_text(encoding="utf-8"))["machines"]
    assert [one["runs_at_a_time"] for one in machines] == [2, 1]
    first, second = machine_text(read_machines(tmp_path)).splitlines()
    assert "2 runs at a time, one thread each; python 3." in first
    assert "1 run at a time" in second
