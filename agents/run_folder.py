"""Where a run keeps what it learned: names of its files, written so that a crash leaves the old file or the new one."""

import contextlib
import os
import platform
from collections.abc import Callable, Iterator
from importlib import metadata
from pathlib import Path

from agents.folder_lock import locked
from flapenv.aero.checks import one_line
from flapenv.whole_file import remove_partial, whole_file

CONFIG, RESULTS, POLICY, CURVE = "config.json", "results.json", "policy.zip", "curve.csv"
CHECKPOINT = "checkpoint"
POLICY_TENSORS, POLICY_CARD = "policy.safetensors", "policy.json"
CURVE_PICTURE, RESULT_PICTURE, REPORT, TENSORBOARD = "learning_curve.png", "learned.png", "report.html", "tensorboard"
PICTURES = (CURVE_PICTURE, RESULT_PICTURE, REPORT)
FILES = (CONFIG, RESULTS, CHECKPOINT, POLICY, POLICY_TENSORS, POLICY_CARD, CURVE, *PICTURES, TENSORBOARD)
RECIPE = ("task", "algorithm", "settings")
"""Keys of config.json that make a preset."""
RUNS = Path("runs")
PACKAGES = ("flapenv", "gymnasium", "numpy", "scipy", "sb3-contrib", "stable-baselines3", "torch")


def open_run_folder(out: Path | None, name: str) -> Path:
    """Make the folder of a new run.

    Args:
        out: the folder asked for; `runs/<name>`, or `runs/<name>-2` and so on where that is taken, if None.
        name: of the run.

    Raises:
        FileExistsError: if `out` holds a file that a run writes, which would be lost.
        NotADirectoryError: if `out` is a file.
        OSError: if it cannot be made or written.
    """
    if out is None:
        out, number = RUNS / name, 2
        while out.exists():
            out, number = RUNS / f"{name}-{number}", number + 1
    require_free_folder(out)
    out.mkdir(parents=True, exist_ok=True)
    return out


@contextlib.contextmanager
def locked_run_folder(out: Path | None, name: str, *, resume: bool = False) -> Iterator[Path]:
    """A run's folder that no other run can write into meanwhile.

    Args:
        out: as `open_run_folder`.
        name: of the run.
        resume: whether it may hold a run, which will go on; what that left half-written is removed.

    Raises:
        BlockingIOError: if another process trains into it.
        FileExistsError: if it holds a run that is not to go on.
        OSError: if it cannot be made or written.
    """
    if resume and out is None:
        raise ValueError("out = None is not allowed with resume; allowed: the folder of the run")
    folder = out if resume and out is not None else open_run_folder(out, name)
    require_writable(folder, f"--resume {folder}" if resume else f"--out {folder}")
    folder.mkdir(parents=True, exist_ok=True)
    with locked(folder):
        if not resume:
            require_free_folder(folder)  # another may have come first
        remove_partial(folder)
        yield folder


def require_free_folder(out: Path) -> None:
    """Refuse a folder that could not be made or written, or holds a run; nothing is made.

    Raises:
        FileExistsError: if it holds a file that a run writes, which would be lost.
        NotADirectoryError: if it is a file, or lies in one.
        OSError: if it cannot be written.
    """
    taken = [name for name in FILES if (out / name).exists()]
    if taken:
        raise FileExistsError(f"--out {out} holds {', '.join(taken)} already; allowed: a folder without a run in it")
    require_writable(out, f"--out {out}")


def require_no_file(folder: Path) -> None:
    """Refuse what is in the way of a folder.

    Raises:
        NotADirectoryError: if something else is there.
    """
    if (folder.exists() or folder.is_symlink()) and not folder.is_dir():
        raise NotADirectoryError(f"{folder} is in the way; allowed: a folder, or nothing there")


def require_writable(out: Path, called: str) -> None:
    """Refuse a folder that could not be made or written.

    Args:
        out: the folder.
        called: how errors call it.

    Raises:
        NotADirectoryError: if it is a file, or lies in one.
        OSError: if it cannot be written.
    """
    nearest = next((one for one in (out, *out.absolute().parents) if one.exists()), Path.cwd())
    if not nearest.is_dir():
        raise NotADirectoryError(f"{called}: {nearest} is a file; allowed: a folder")
    if not os.access(nearest, os.W_OK | os.X_OK):
        raise PermissionError(f"{called}: {nearest} cannot be written; allowed: a folder that can")


def real_name(path: str | os.PathLike[str]) -> str:
    """The last part of a path without where on this machine it lies: also of `.`, `..` and a path that ends in `/`."""
    told = os.fspath(path)
    plain = Path(told).name
    return one_line(plain if plain == told != ".." else Path(os.path.realpath(told)).name)


def write_atomically(path: Path, write: Callable[[Path], object]) -> None:
    """Let `write` fill a file beside `path`, then put it in place in one step."""
    with whole_file(path) as beside:
        write(beside)


def versions() -> dict[str, str]:
    """Versions of everything a result depends on."""
    return {"python": platform.python_version(), **{package: metadata.version(package) for package in PACKAGES}}
