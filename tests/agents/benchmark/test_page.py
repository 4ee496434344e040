"""What docs/benchmark says is made of the numbers beside it, and the shipped policies are runs of it."""

from pathlib import Path

import pytest

from agents.benchmark.data import load
from agents.benchmark.machine import machine_text, read_machines
from agents.benchmark.report import PAGE, markdown_report
from agents.policy_file import load_policy, shipped_policies

FOLDER = Path(__file__).parents[3] / "docs" / "benchmark"


def test_the_page_is_what_the_kept_numbers_make() -> None:
    page = markdown_report(load(FOLDER), machine_text(read_machines(FOLDER)))
    assert (FOLDER / PAGE).read_text(encoding="utf-8") == f"{page}\n"


@pytest.mark.parametrize("name", shipped_policies())
def test_a_shipped_policy_is_the_run_of_seed_0(name: str) -> None:
    _, card = load_policy(name)
    (run,) = (run for run in load(FOLDER).runs_of(card.preset) if run.seed == card.seed)
    assert card.seed == 0
    assert run.mean == pytest.approx(card.result["mean"], rel=1e-5)
    assert run.wingbeats == card.wingbeats
