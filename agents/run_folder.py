"""Where a run keeps what it learned: names of its files, written so that a crash leaves the old file or the new one."""

import json
import os
import platform
from collections.abc import Callable
from importlib import metadata
from pathlib import Path
from typing import Any

from flapenv.whole_file import whole_file

CONFIG, RESULTS, POLICY, CURVE = "config.json", "results.json", "policy.zip", "curve.csv"
POLICY_TENSORS, POLICY_CARD = "policy.safetensors", "policy.json"
CURVE_PICTURE, RESULT_PICTURE, REPORT, TENSORBOARD = "learning_curve.png", "learned.png", "report.html", "tensorboard"
PICTURES = (CURVE_PICTURE, RESULT_PICTURE, REPORT)
FILES = (CONFIG, RESULTS, POLICY, POLICY_TENSORS, POLICY_CARD, CURVE, *PICTURES, TENSORBOARD)
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
    taken = [name for name in FILES if (out / name).exists()]
    if taken:
        raise FileExistsError(f"--out {out} holds {', '.join(taken)} already; allowed: a folder without a run in it")
    if out.exists() and not out.is_dir():
        raise NotADirectoryError(f"--out {out} is a file; allowed: a folder")
    out.mkdir(parents=True, exist_ok=True)
    if not os.access(out, os.W_OK):
        raise PermissionError(f"--out {out} cannot be written")
    return out


def write_atomically(path: Path, write: Callable[[Path], object]) -> None:
    """Let `write` fill a file beside `path`, then put it in place in one step."""
    with whole_file(path) as beside:
        write(beside)


def write_json(path: Path, content: dict[str, Any]) -> None:
    """Write JSON that people can read; NaN and inf are refused."""
    text = json.dumps(content, indent=2, ensure_ascii=False, allow_nan=False) + "\n"
    write_atomically(path, lambda part: part.write_text(text, encoding="utf-8"))


def versions() -> dict[str, str]:
    """Versions of everything a result depends on."""
    return {"python": platform.python_version(), **{package: metadata.version(package) for package in PACKAGES}}
