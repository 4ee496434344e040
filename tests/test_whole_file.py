"""Files are replaced whole, where they lie and as who may read them, or not at all."""

import errno
import json
import os
import stat
from pathlib import Path

import pytest

from flapenv.whole_file import PARTIAL, json_text, remove_partial, whole_file, write_json, write_text


def test_a_mistake_leaves_the_old_file_and_nothing_beside_it(tmp_path: Path) -> None:
    path = tmp_path / "a.json"
    path.write_text("old")

    def write_half() -> None:
        with whole_file(path) as beside:
            beside.write_text("new")
            raise ValueError("half way")

    with pytest.raises(ValueError, match="half way"):
        write_half()
    assert path.read_text() == "old"
    assert list(tmp_path.iterdir()) == [path]


def test_a_link_stays_one_and_its_target_is_replaced(tmp_path: Path) -> None:
    (tmp_path / "kept").mkdir()
    target, link = tmp_path / "kept" / "a.json", tmp_path / "link.json"
    target.write_text("old")
    link.symlink_to(target)
    write_text(link, "new")
    assert link.is_symlink()
    assert target.read_text() == "new"
    assert sorted(tmp_path.rglob("*.json")) == [target, link]


@pytest.mark.parametrize("mode", [0o600, 0o640, 0o444])
def test_what_a_file_allows_stays_as_it_was(mode: int, tmp_path: Path) -> None:
    path = tmp_path / "a.json"
    path.touch()
    path.chmod(mode)
    write_text(path, "new")
    assert stat.S_IMODE(path.stat().st_mode) == mode
    assert path.read_text() == "new"


def test_the_longest_name_a_file_system_knows_can_be_written(tmp_path: Path) -> None:
    path = tmp_path / f"{'a' * 250}.json"
    write_text(path, "new")
    assert path.read_text() == "new"


def test_a_folder_that_is_not_there_is_named(tmp_path: Path) -> None:
    with pytest.raises(FileNotFoundError, match=r"path = '.*nowhere/a.json' cannot be written"):
        write_text(tmp_path / "nowhere" / "a.json", "new")


def test_a_disk_that_fills_up_while_writing_is_told_with_the_file_and_what_helps(tmp_path: Path) -> None:
    path = tmp_path / "a.json"
    path.write_text("old")

    def fill() -> None:
        with whole_file(path):
            raise OSError(errno.ENOSPC, "No space left on device")

    with pytest.raises(OSError, match=r"path = '.*a.json' cannot be written .*No space.*; allowed: a disk with room"):
        fill()
    assert path.read_text() == "old"
    assert list(tmp_path.iterdir()) == [path]


def test_json_is_readable_and_refuses_nan(tmp_path: Path) -> None:
    path = tmp_path / "a.json"
    write_json(path, {"Λ": 0.1, "gap": None})
    assert path.read_text(encoding="utf-8") == json_text({"Λ": 0.1, "gap": None})
    assert json.loads(path.read_text(encoding="utf-8")) == {"Λ": 0.1, "gap": None}
    assert "Λ" in path.read_text(encoding="utf-8")
    with pytest.raises(ValueError, match="JSON"):
        write_json(path, {"gap": float("nan")})
    assert json.loads(path.read_text(encoding="utf-8"))["gap"] is None


def test_a_file_is_on_the_disk_before_it_takes_its_place_and_its_name_after(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    done: list[str] = []
    replace, fsync = Path.replace, os.fsync

    def watched(descriptor: int) -> None:
        done.append(Path(f"/proc/self/fd/{descriptor}").readlink().name)
        fsync(descriptor)

    def moved(self: Path, target: Path) -> Path:
        done.append("in place")
        return replace(self, target)

    monkeypatch.setattr(os, "fsync", watched)
    monkeypatch.setattr(Path, "replace", moved)
    write_text(tmp_path / "a.json", "new")
    partial, *rest = done
    assert partial.startswith(PARTIAL)
    assert rest == ["in place", tmp_path.name]


def test_half_written_files_are_removed_and_nothing_else(tmp_path: Path) -> None:
    for name in (f"{PARTIAL}a.json", "kept.json", ".hidden"):
        (tmp_path / name).touch()
    (tmp_path / f"{PARTIAL}folder").mkdir()
    remove_partial(tmp_path)
    assert {path.name for path in tmp_path.iterdir()} == {"kept.json", ".hidden", f"{PARTIAL}folder"}
