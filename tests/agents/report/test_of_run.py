"""Reports beside the results of runs and evaluations."""

import json
from collections.abc import Callable
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
