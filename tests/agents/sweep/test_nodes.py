"""What a node answers, and which answers are refused."""

from pathlib import Path

import pytest

from agents.sweep import nodes
from agents.sweep.nodes import installed, look, require_fit


def test_this_machine_is_fit_and_its_probe_is_seen(tmp_path: Path) -> None:
    answer = look(str(tmp_path), "probe")
    assert answer["cannot"] is None
    require_fit("node a", answer, installed(), tmp_path / "probe")


def test_other_versions_and_other_code_are_refused_with_both(tmp_path: Path) -> None:
    answer = look(str(tmp_path), "probe")
    answer["installed"] |= {"torch": "1.0", "source": "feedbeef"}
    with pytest.raises(
        RuntimeError, match=r"node a has torch 1\.0, here .*; source feedbeef, here \w+; allowed: the same"
    ):
        require_fit("node a", answer, installed(), tmp_path / "probe")


def test_a_storage_that_a_node_cannot_write_or_does_not_share_is_refused(tmp_path: Path) -> None:
    answer = look(str(tmp_path / "missing"), "probe")
    with pytest.raises(OSError, match=r"node a cannot write into --storage .*missing.*; allowed: a shared folder"):
        require_fit("node a", answer, installed(), tmp_path / "missing" / "probe")
    elsewhere = tmp_path / "elsewhere"
    elsewhere.mkdir()
    answer = look(str(tmp_path), "probe")
    with pytest.raises(FileNotFoundError, match=r"what node a writes into --storage .* is not seen here; allowed"):
        require_fit("node a", answer, installed(), elsewhere / "probe")


def test_the_digest_is_of_the_code_its_names_and_its_content(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    assert len(installed()["source"]) == 12
    assert installed() == installed()
    monkeypatch.setattr(nodes, "ROOT", tmp_path)
    seen = [installed()["source"]]
    for name in ("flapenv/deep/a.py", "agents/b.py"):
        path = tmp_path / name
        path.parent.mkdir(parents=True)
        for text in ("x = 1", "x = 2"):
            path.write_text(text)
            seen.append(installed()["source"])
    (tmp_path / "agents" / "b.py").rename(tmp_path / "agents" / "c.py")
    seen.append(installed()["source"])
    assert len(set(seen)) == len(seen)
    (tmp_path / "agents" / "notes.txt").write_text("no code")
    assert installed()["source"] == seen[-1]
