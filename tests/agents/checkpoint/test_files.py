"""Checkpoints that were cut short or changed are refused, and nothing in them is executed."""

import hashlib
import json
import pickle
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from checkpoints import equal

from agents.checkpoint import STATE, Checkpoint, read_checkpoint, remove_checkpoint, write_checkpoint
from flapenv.whole_file import json_text

SAMPLE = Checkpoint(numbers={"a": 1.5, "b": [1, None]}, arrays={"x": np.arange(6.0).reshape(2, 3), "n": np.array(3)})


def signed(folder: Path, **changed: Any) -> None:
    """Change what a state says, and its checksum with it, as somebody with bad intentions would."""
    content = json.loads((folder / STATE).read_text(encoding="utf-8"))
    content.pop("sha256")
    content |= changed
    content["sha256"] = hashlib.sha256(json_text(content).encode()).hexdigest()
    (folder / STATE).write_text(json_text(content), encoding="utf-8")


def arrays_of(folder: Path) -> Path:
    [path] = folder.glob("arrays-*.safetensors")
    return path


def test_what_is_written_is_read_and_takes_the_place_of_the_last(tmp_path: Path) -> None:
    folder = tmp_path / "checkpoint"
    assert read_checkpoint(folder) is None
    write_checkpoint(folder, SAMPLE)
    found = read_checkpoint(folder)
    assert found is not None
    assert equal(found, SAMPLE)
    following = Checkpoint(numbers={"a": 2}, arrays={"x": np.zeros(3, dtype=np.uint64)})
    write_checkpoint(folder, following)
    found = read_checkpoint(folder)
    assert found is not None
    assert equal(found, following)
    assert len(list(folder.iterdir())) == 2
    remove_checkpoint(folder)
    assert not folder.exists()
    remove_checkpoint(folder)


@pytest.mark.parametrize("moment", range(4))
def test_a_writer_that_dies_at_any_step_leaves_the_last_checkpoint(
    moment: int, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    write_checkpoint(tmp_path, SAMPLE)
    calls: list[str] = []

    def dying(name: str, call: Callable[..., Any]) -> Callable[..., Any]:
        def step(*arguments: Any, **options: Any) -> Any:
            calls.append(name)
            if len(calls) == moment + 1:
                raise OSError("dead")
            return call(*arguments, **options)

        return step

    with monkeypatch.context() as patch:
        for owner, name in ((Path, "replace"), (Path, "write_bytes"), (Path, "write_text")):
            patch.setattr(owner, name, dying(name, getattr(owner, name)))
        with pytest.raises(OSError, match="dead"):
            write_checkpoint(tmp_path, Checkpoint(numbers={"a": 2}, arrays={"x": np.zeros(3)}))
    assert len(calls) == moment + 1
    found = read_checkpoint(tmp_path)
    assert found is not None
    assert equal(found, SAMPLE)
    write_checkpoint(tmp_path, SAMPLE)
    assert len(list(tmp_path.iterdir())) == 2


@pytest.mark.parametrize("which", ["state", "arrays"])
def test_a_truncated_file_is_refused_at_every_length(which: str, tmp_path: Path) -> None:
    write_checkpoint(tmp_path, SAMPLE)
    path = tmp_path / STATE if which == "state" else arrays_of(tmp_path)
    whole = path.read_bytes()
    for length in range(len(whole) - 1):
        path.write_bytes(whole[:length])
        with pytest.raises(ValueError, match="; allowed: a checkpoint as training wrote it, unchanged"):
            read_checkpoint(tmp_path)


@pytest.mark.parametrize("which", ["state", "arrays"])
def test_every_flipped_byte_is_found(which: str, tmp_path: Path) -> None:
    write_checkpoint(tmp_path, SAMPLE)
    path = tmp_path / STATE if which == "state" else arrays_of(tmp_path)
    whole = path.read_bytes()
    for place in range(len(whole)):
        if which == "state" and chr(whole[place]).isspace():
            continue  # JSON is the same with another blank
        path.write_bytes(whole[:place] + bytes([whole[place] ^ 1]) + whole[place + 1 :])
        with pytest.raises((ValueError, OSError), match="allowed: "):
            read_checkpoint(tmp_path)


def test_arrays_that_are_not_there_are_named(tmp_path: Path) -> None:
    write_checkpoint(tmp_path, SAMPLE)
    arrays_of(tmp_path).unlink()
    with pytest.raises(FileNotFoundError, match=r"arrays-.* does not exist; allowed: a checkpoint"):
        read_checkpoint(tmp_path)


@pytest.mark.parametrize("name", ["../outside.safetensors", "/etc/passwd", "a.pkl", "b/c.safetensors", ""])
def test_a_state_cannot_send_us_to_other_files(name: str, tmp_path: Path) -> None:
    folder = tmp_path / "checkpoint"
    write_checkpoint(folder, SAMPLE)
    (tmp_path / "outside.safetensors").write_bytes(arrays_of(folder).read_bytes())
    told = json.loads((folder / STATE).read_text())["arrays"]
    signed(folder, arrays={**told, "file": name})
    with pytest.raises(ValueError, match=r"arrays in file .* are not allowed; allowed: one beside it"):
        read_checkpoint(folder)


def test_a_pickle_in_disguise_is_refused_and_does_not_run(tmp_path: Path) -> None:
    ran = tmp_path / "ran"

    class Evil:
        def __reduce__(self) -> tuple[Any, ...]:
            return (ran.touch, ())

    write_checkpoint(tmp_path, SAMPLE)
    content = pickle.dumps(Evil())
    arrays_of(tmp_path).write_bytes(content)
    told = {"file": arrays_of(tmp_path).name, "bytes": len(content), "sha256": hashlib.sha256(content).hexdigest()}
    signed(tmp_path, arrays=told)
    with pytest.raises(ValueError, match="holds no arrays"):
        read_checkpoint(tmp_path)
    assert not ran.exists()


@pytest.mark.parametrize("arrays", [None, [], {}, {"file": "a", "bytes": "3", "sha256": "b"}])
def test_a_state_that_names_no_arrays_is_refused(arrays: Any, tmp_path: Path) -> None:
    write_checkpoint(tmp_path, SAMPLE)
    signed(tmp_path, arrays=arrays)
    with pytest.raises(ValueError, match="arrays does not name a file, its bytes and its sha256"):
        read_checkpoint(tmp_path)


def test_another_format_is_refused(tmp_path: Path) -> None:
    write_checkpoint(tmp_path, SAMPLE)
    signed(tmp_path, format="flapenv checkpoint 2")
    with pytest.raises(ValueError, match="format = 'flapenv checkpoint 2' is not known; allowed: "):
        read_checkpoint(tmp_path)


def test_arrays_with_types_that_numpy_does_not_have_are_refused(tmp_path: Path) -> None:
    write_checkpoint(tmp_path, SAMPLE)
    header = json.dumps({"x": {"dtype": "F8_E4M3", "shape": [1], "data_offsets": [0, 1]}}).encode()
    content = len(header).to_bytes(8, "little") + header + b"\0"
    arrays_of(tmp_path).write_bytes(content)
    told = {"file": arrays_of(tmp_path).name, "bytes": len(content), "sha256": hashlib.sha256(content).hexdigest()}
    signed(tmp_path, arrays=told)
    with pytest.raises(ValueError, match="holds no arrays"):
        read_checkpoint(tmp_path)


def test_what_a_killed_writer_left_half_written_goes_with_the_next_checkpoint(tmp_path: Path) -> None:
    write_checkpoint(tmp_path, SAMPLE)
    (tmp_path / ".partial-0123.safetensors").write_bytes(b"half")
    write_checkpoint(tmp_path, SAMPLE)
    assert not list(tmp_path.glob(".partial-*"))
