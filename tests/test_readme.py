"""The README's code runs, its pictures are there, and it names every make target."""

import re
from pathlib import Path

import pytest

import train

ROOT = Path(__file__).parents[1]
README = (ROOT / "README.md").read_text(encoding="utf-8")


def test_every_code_block_runs_in_order(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)
    blocks = re.findall(r"```python\n(.*?)```", README, flags=re.DOTALL)
    assert len(blocks) >= 3
    names: dict[str, object] = {}
    for block in blocks:
        exec(compile(block, "README.md", "exec"), names)
    assert (tmp_path / "robot.png").exists()


def test_the_table_of_results_is_what_the_shipped_policy_gives(capsys: pytest.CaptureFixture[str]) -> None:
    assert train.main(["evaluate", "hover"]) == 0
    printed = capsys.readouterr().out.splitlines()[1:]
    assert len(printed) > 30
    for line in printed:
        assert f"    {line}\n" in README or not line


def test_every_picture_and_link_leads_somewhere() -> None:
    for target in re.findall(r"\]\((?!http)([^)#]+)\)", README):
        assert (ROOT / target).exists(), target


def test_every_make_target_a_reader_needs_is_named() -> None:
    for target in (
        "train",
        "test",
        "test-fast",
        "test-floor",
        "test-browser",
        "docs",
        "fuzz",
        "audit",
        "clients",
        "lint",
        "bench",
        "validate",
        "help",
    ):
        assert f"make {target}" in README
