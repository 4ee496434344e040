"""Reports beside the results of runs and evaluations."""

import json
import os
import platform
import shutil
from collections.abc import Callable
from importlib import metadata
from pathlib import Path
from typing import Any

import pytest

import train
from agents.benchmark.training_run import Run, run_command
from agents.policy_file import load_policy

Take = Callable[[str], Any]
TINY = ["--insects", "hawkmoth", "bumblebee", "--wingbeats", "2048", "--set", "rows=512", "--set", "minibatch=128"]


def read(folder: Path) -> tuple[str, dict[str, Any]]:
    html = (folder / "report.html").read_text(encoding="utf-8")
    return html, json.loads((folder / "results.json").read_text(encoding="utf-8"))


@pytest.fixture(scope="module")
def run(tmp_path_factory: pytest.TempPathFactory) -> Path:
    out = tmp_path_factory.mktemp("trained") / "run"
    assert train.main([*TINY, "--seed", "7", "--quiet", "--out", str(out)]) == 0
    return out


def test_a_run_tells_what_it_was_made_with_and_what_came_out(run: Path, page_of: Take) -> None:
    html, results = read(run)
    page = page_of(html)
    facts = dict(page.tables["None"])
    assert facts["command"] == f"python train.py {' '.join(TINY)} --seed 7"
    assert facts["seed"] == "7"
    assert load_policy(run)[1].sha256 in facts["policy"]
    assert facts["trained for"].startswith(f"{results['wingbeats']:,} wingbeats in ")
    assert f"torch {results['versions']['torch']}" in facts["versions"]
    assert '"minibatch": 128' in page.text
    assert [row[0] for row in page.tables["results"][1:]] == list(results["insects"])
    assert page.data("learning-curve-data")["data"]


def test_an_evaluation_of_a_run_says_the_same_and_shows_its_learning_curve(
    run: Path, tmp_path: Path, page_of: Take, capsys: pytest.CaptureFixture[str]
) -> None:
    assert train.main(["evaluate", str(run), "--out", str(tmp_path)]) == 0
    assert "kept in" in capsys.readouterr().out
    trained, evaluated = page_of(read(run)[0]), page_of(read(tmp_path / "run")[0])
    assert evaluated.tables["results"] == trained.tables["results"]
    assert evaluated.data("learning-curve-data") == trained.data("learning-curve-data")
    facts = dict(evaluated.tables["None"])
    assert facts["sha256"] == load_policy(run)[1].sha256
    assert facts["trained by"].endswith("--seed 7")


@pytest.mark.parametrize(
    ("change", "said"),
    [
        (lambda text: text.replace("mean_gap", "gap", 1), "has no column mean_gap"),
        (lambda text: text + "1,2\n", "has 2 cells; allowed: "),
        (lambda text: text + text.splitlines()[1].replace(text.splitlines()[1].split(",")[0], "soon", 1), "'soon'"),
        (lambda text: "", "is not a learning curve"),
        (lambda text: text + "\xff", "is not a learning curve"),
    ],
)
def test_a_damaged_learning_curve_costs_the_curve_and_not_the_report(
    change: Callable[[str], str],
    said: str,
    run: Path,
    tmp_path: Path,
    page_of: Take,
    capsys: pytest.CaptureFixture[str],
) -> None:
    damaged = tmp_path / "damaged"
    shutil.copytree(run, damaged)
    text = (damaged / "curve.csv").read_text(encoding="utf-8")
    (damaged / "curve.csv").write_text(change(text), encoding="latin-1")
    assert train.main(["evaluate", str(damaged), "--out", str(tmp_path / "out")]) == 0
    told = capsys.readouterr().err
    assert f"The learning curve is left out: {damaged / 'curve.csv'}" in told
    assert said in told
    assert told.count("\n") == 1
    page = page_of(read(tmp_path / "out" / "damaged")[0])
    assert "The learning curve is left out" in page.text
    assert page.tables["results"]
    assert not [a for _, a in page.tags if a.get("id") == "learning-curve"]


def test_the_machine_is_told_as_far_as_a_result_may_hang_on_it(run: Path, page_of: Take) -> None:
    facts = dict(page_of(read(run)[0]).tables["None"])
    assert f"plotly {metadata.version('plotly')}" in facts["versions"]
    assert platform.system() in facts["system"]
    assert platform.machine() in facts["system"]
    assert f"OMP_NUM_THREADS {os.environ.get('OMP_NUM_THREADS', 'not set')}" in facts["machine"]
    assert facts["machine"].startswith(f"{os.cpu_count()} cores")


def test_a_published_stroke_gets_a_report_too(tmp_path: Path, page_of: Take) -> None:
    assert train.main(["evaluate", "hawkmoth", "--out", str(tmp_path)]) == 0
    html, results = read(tmp_path / "hawkmoth")
    page = page_of(html)
    assert page.tables["results"][1][1].startswith(f"{results['insects']['hawkmoth']['weight_support']:.4f} ± ")
    assert dict(page.tables["None"])["command"] == "python train.py evaluate hawkmoth"


def test_without_a_report_nothing_else_changes(run: Path, tmp_path: Path) -> None:
    out = tmp_path / "bare"
    assert train.main([*TINY, "--seed", "7", "--quiet", "--no-report", "--out", str(out)]) == 0
    names = {path.name for path in run.iterdir()}
    assert {path.name for path in out.iterdir()} == names - {"report.html"}
    first, second = (json.loads((folder / "results.json").read_text(encoding="utf-8")) for folder in (run, out))
    assert first["insects"] == second["insects"]
    assert load_policy(out)[1].command == load_policy(run)[1].command


def test_benchmarks_do_without_reports() -> None:
    assert "--no-report" in run_command(Run(preset="hover-ppo", seed=0), Path("out"))
