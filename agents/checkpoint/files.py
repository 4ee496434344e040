"""A checkpoint on disk: arrays as safetensors, all else as JSON that names them; what is there is whole."""

import hashlib
from collections.abc import Mapping
from pathlib import Path
from typing import Any

import numpy as np
from safetensors import SafetensorError
from safetensors.numpy import load as load_arrays
from safetensors.numpy import save as arrays_as_bytes

from agents.run_folder import write_atomically
from flapenv.aero.checks import one_line, record, shown
from flapenv.read_json import read_object, require_file
from flapenv.whole_file import json_text, remove_partial, to_the_disk, write_text

STATE = "state.json"
"""What makes a checkpoint: with this file's replacement it is the next one."""
ARRAYS = "arrays-*.safetensors"
FORMAT = "flapenv checkpoint 1"
LARGEST_STATE = 2**26
"""A larger `STATE` is not read [bytes]."""
MEND = "a checkpoint as training wrote it, unchanged"


@record
class Checkpoint:
    """All that training goes on from.

    Attributes:
        numbers: what JSON holds, by name.
        arrays: NumPy arrays of numbers, by name.
    """

    numbers: Mapping[str, Any]
    arrays: Mapping[str, np.ndarray]


def write_checkpoint(folder: Path, checkpoint: Checkpoint) -> None:
    """Put a checkpoint in the place of the last one, which stays whole until this one is on the disk.

    The arrays go into a file that is called by its content. Then `STATE` is replaced, which names that file, its size
    and its sha256, and carries a sha256 of its own. Then the older arrays are removed.

    Args:
        folder: of the checkpoint; made where it is not there.
        checkpoint: with NumPy arrays that lie one after the other in memory.

    Raises:
        OSError: if it cannot be written.
        ValueError: for NaN or inf among the numbers.
    """
    if not folder.is_dir():
        folder.mkdir(mode=0o755, parents=True)
        to_the_disk(folder.parent)
    content = arrays_as_bytes(dict(checkpoint.arrays))
    digest = hashlib.sha256(content).hexdigest()
    name = f"arrays-{digest[:16]}.safetensors"
    if not (folder / name).is_file():
        write_atomically(folder / name, lambda part: part.write_bytes(content))
    arrays = {"file": name, "bytes": len(content), "sha256": digest}
    state = {"format": FORMAT, "arrays": arrays, **checkpoint.numbers}
    write_text(folder / STATE, json_text({**state, "sha256": _digest(state)}))
    remove_partial(folder)
    for other in folder.glob(ARRAYS):
        if other.name != name:
            other.unlink()


def read_checkpoint(folder: Path) -> Checkpoint | None:
    """The checkpoint in a folder, None where there is none yet; nothing in it is ever executed.

    The sha256 find files that were cut short, damaged or mixed up. They are no signatures.

    Raises:
        ValueError: for files that are not what they say.
        OSError: if they cannot be read.
    """
    if not (folder / STATE).exists():
        return None
    path = folder / STATE
    state = read_object(path, mend=MEND, largest=LARGEST_STATE)
    if state.get("format") != FORMAT:
        raise ValueError(f"{path}: format = {shown(state.get('format'))} is not known; allowed: {FORMAT!r}")
    if state.pop("sha256", None) != _digest(state):
        raise ValueError(f"{path} was changed since it was written: its sha256 is not its own; allowed: {MEND}")
    arrays = state.pop("arrays", None)
    wanted = {"file": str, "bytes": int, "sha256": str}
    if not isinstance(arrays, dict) or {name: type(value) for name, value in arrays.items()} != wanted:
        raise ValueError(f"{path}: arrays does not name a file, its bytes and its sha256; allowed: {MEND}")
    del state["format"]
    return Checkpoint(numbers=state, arrays=_read_arrays(folder, arrays["file"], arrays["bytes"], arrays["sha256"]))


def _read_arrays(folder: Path, file: str, size: int, sha256: str) -> dict[str, np.ndarray]:
    """The arrays of a file of this name, size and sha256."""
    path = folder / file
    if path.parent != folder or path.suffix != ".safetensors":
        raise ValueError(f"{folder / STATE}: arrays in file {shown(file)} are not allowed; allowed: one beside it")
    require_file(path, str(path), MEND)
    found = path.stat().st_size
    if found != size:
        raise ValueError(f"{path} has {found:,} bytes, not the {size:,} that were written; allowed: {MEND}")
    content = path.read_bytes()
    if hashlib.sha256(content).hexdigest() != sha256:
        raise ValueError(f"{path} was changed since it was written: its sha256 is another; allowed: {MEND}")
    try:
        return dict(load_arrays(content))
    except (SafetensorError, TypeError, KeyError, ValueError) as problem:  # KeyError: a dtype that NumPy does not have
        raise ValueError(f"{path} holds no arrays: {one_line(problem)}; allowed: {MEND}") from None


def remove_checkpoint(folder: Path) -> None:
    """Remove a checkpoint that nobody goes on from any more: first what makes it one.

    Raises:
        OSError: if it cannot be removed.
    """
    (folder / STATE).unlink(missing_ok=True)
    if not folder.is_dir():
        return
    for left in folder.glob(ARRAYS):
        left.unlink()
    remove_partial(folder)
    if not folder.is_symlink() and not any(folder.iterdir()):  # what others put there stays
        folder.rmdir()


def _digest(state: Mapping[str, Any]) -> str:
    """The sha256 of what a `STATE` says."""
    return hashlib.sha256(json_text(state).encode()).hexdigest()
