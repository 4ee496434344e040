"""A benchmark's tables and pictures, from invented numbers."""

import csv
import json
import math
import re
from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest

from agents.benchmark.command import benchmark_command
from agents.benchmark.data import (
    CURVE_POINTS,
    CURVES_TABLE,
    INSECTS_TABLE,
    RUNS_TABLE,
    BenchmarkData,
    RunRow,
    collect,
    load,
    save,
)
from agents.benchmark.machine import MACHINE, machine_text, note_machine, read_machines
from agents.benchmark.pictures import CURVES_PICTURE, FINAL_PICTURE, OTHERS_PICTURE, PROFILE_PICTURE, draw_final
from agents.benchmark.report import PAGE, TABLE, percent, reached_rows, spent_rows, text_report

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
        "interrupted": False,
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


@pytest.mark.parametrize(
    "content",
    [
        "{}",
        "[]",
        "3",
        '{"machines": 3}',
        '{"machines": [{}]}',
        '{"machines": [3]}',
        '{"machines": [{"cpu": "", "architecture": "", "system": "", "cores": 1, "runs_at_a_time": 2, "versions": 3}]}',
    ],
)
def test_a_file_of_machines_that_was_tampered_with_is_named(
    content: str, data: BenchmarkData, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    save(data, tmp_path)
    (tmp_path / MACHINE).write_text(content, encoding="utf-8")
    assert benchmark_command(["--report", str(tmp_path)]) == 2
    said = capsys.readouterr().err
    assert str(tmp_path / MACHINE) in said
    assert said.count("\n") == 1


@pytest.mark.parametrize(
    "insects",
    [[], 3, {"a": 3}, {"a": {"gap_percent": "much"}}, {"a": {"gap_percent": []}}],
)
def test_results_with_other_insects_are_named(insects: object, tmp_path: Path) -> None:
    make_run(tmp_path / "run", "hover-ppo", 0)
    path = tmp_path / "run" / "results.json"
    path.write_text(json.dumps({**json.loads(path.read_text(encoding="utf-8")), "insects": insects}), encoding="utf-8")
    with pytest.raises(ValueError, match=r"results.json is not a run's: "):
        collect({("hover-ppo", 0): tmp_path / "run"})


def test_a_curve_that_was_tampered_with_is_named(tmp_path: Path) -> None:
    make_run(tmp_path / "run", "hover-ppo", 0)
    path = tmp_path / "run" / "curve.csv"
    text = path.read_text(encoding="utf-8")
    for changed in (text.replace("mean_gap", "gap"), text.replace("2000,1.0", "2000,soon"), text[:-5] + "nan"):
        assert changed != text
        path.write_text(changed, encoding="utf-8")
        with pytest.raises(ValueError, match=r"curve.csv, line \d+: "):
            collect({("hover-ppo", 0): tmp_path / "run"})


@pytest.mark.parametrize(
    ("table", "change", "said"),
    [
        (RUNS_TABLE, lambda text: "", "runs.csv has columns None"),
        (RUNS_TABLE, lambda text: text.splitlines()[0], "runs.csv has no run"),
        (RUNS_TABLE, lambda text: text.replace(text.splitlines()[1].split(",")[4], "nan"), "line 2: .*mean = nan"),
        (RUNS_TABLE, lambda text: text + text.splitlines()[1], "runs.csv has hover-ppo, seed 0, more than once"),
        (RUNS_TABLE, lambda text: text.replace("hover-ppo,0,", "hover-ppo,-1,"), "line 2: .*seed = -1"),
        (RUNS_TABLE, lambda text: text.replace("\n", ",more\n").replace(",more", "", 1), "runs.csv, line 2: "),
        (INSECTS_TABLE, lambda text: text.replace("hawkmoth,", "hawkmoth,inf\n", 1), "line 2: .*gap = inf"),
        (CURVES_TABLE, lambda text: text.replace(",1000,", ",1e9999,", 1), "curves.csv, line 2: "),
        (CURVES_TABLE, lambda text: "\xff" + text, "curves.csv is no table: "),
    ],
)
def test_kept_tables_that_were_tampered_with_are_one_line(
    table: str,
    change: Callable[[str], str],
    said: str,
    data: BenchmarkData,
    tmp_path: Path,
    capsys: pytest.CaptureFixture[str],
) -> None:
    save(data, tmp_path)
    text = (tmp_path / table).read_text(encoding="utf-8")
    (tmp_path / table).write_text(change(text), encoding="latin-1")
    assert benchmark_command(["--report", str(tmp_path)]) == 2
    assert re.fullmatch(f"train.py benchmark: .*{said}.*\n", capsys.readouterr().err)


def test_insects_of_tasks_without_a_gap_have_no_line(tmp_path: Path) -> None:
    make_run(tmp_path / "run", "hover-ppo", 0)
    path = tmp_path / "run" / "results.json"
    results = {**json.loads(path.read_text(encoding="utf-8")), "insects": {"hawkmoth": {"mean_extra_power": 0.1}}}
    path.write_text(json.dumps(results), encoding="utf-8")
    assert collect({("adapt-ppo", 0): tmp_path / "run"}).insects == []
