"""Run folders lose nothing."""

from pathlib import Path

import pytest

from agents.run_folder import FILES, open_run_folder, real_name, require_free_folder, versions, write_atomically


def test_an_unnamed_run_gets_the_next_free_folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)
    assert [str(open_run_folder(None, "hover")) for _ in range(3)] == ["runs/hover", "runs/hover-2", "runs/hover-3"]


def test_a_folder_that_holds_a_run_is_refused_and_any_other_taken(tmp_path: Path) -> None:
    assert open_run_folder(tmp_path / "a" / "b", "hover").is_dir()
    (tmp_path / "a" / "b" / "notes.txt").touch()
    assert open_run_folder(tmp_path / "a" / "b", "hover").is_dir()
    for name in FILES:
        (tmp_path / name).touch()
        with pytest.raises(FileExistsError, match=f"holds {name} already; allowed: a folder without a run"):
            open_run_folder(tmp_path, "hover")
        (tmp_path / name).unlink()
    with pytest.raises(NotADirectoryError, match="is a file; allowed: a folder"):
        open_run_folder(tmp_path / "a" / "b" / "notes.txt", "hover")


def test_asking_whether_a_folder_is_free_makes_none(tmp_path: Path) -> None:
    require_free_folder(tmp_path / "a" / "b")
    (tmp_path / "file").touch()
    with pytest.raises(NotADirectoryError, match="file is a file; allowed: a folder"):
        require_free_folder(tmp_path / "file" / "b")
    assert [path.name for path in tmp_path.iterdir()] == ["file"]


def test_a_path_is_called_by_its_last_part_wherever_it_lies(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    (tmp_path / "run" / "deep").mkdir(parents=True)
    monkeypatch.chdir(tmp_path / "run" / "deep")
    for path, name in (("..", "run"), (".", "deep"), ("../deep/", "deep"), ("hover", "hover"), ("a/b.json", "b.json")):
        assert real_name(path) == name
    assert real_name("a\nb") == r"a\nb"


def test_a_failed_write_leaves_the_old_file(tmp_path: Path) -> None:
    path = tmp_path / "policy.zip"
    path.write_text("old")

    def fail(part: Path) -> None:
        part.write_text("half")
        raise OSError("disk full")

    with pytest.raises(OSError, match="disk full"):
        write_atomically(path, fail)
    assert path.read_text() == "old"
    assert list(tmp_path.iterdir()) == [path]


def test_versions_name_all_a_result_depends_on() -> None:
    assert set(versions()) == {
        "python",
        "flapenv",
        "gymnasium",
        "numpy",
        "scipy",
        "sb3-contrib",
        "stable-baselines3",
        "torch",
    }
