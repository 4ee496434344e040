"""Trains on a disk of its own that fills up, then cannot be written; run by the tests within a namespace of its own.

`unshare --map-root-user --mount python small_disk.py FOLDER WORD...` prints what happened as JSON. Nothing that it
mounts is seen outside, or outlives it.
"""

import contextlib
import json
import subprocess
import sys
import time
from pathlib import Path
from typing import Any

TRAIN = Path(__file__).parents[1] / "train.py"
MOST = 120.0
"""Seconds to wait for what must come."""


def mounted(folder: Path, how: str) -> None:
    """Mount a disk of a megabyte, or mount it again in another way."""
    subprocess.run(["mount", "-t", "tmpfs", "-o", how, "tmpfs", str(folder)], check=True)


def filled(path: Path) -> None:
    """Leave no byte of room on the disk on which a file is made."""
    with path.open("wb", buffering=0) as file, contextlib.suppress(OSError):
        while True:
            file.write(b"0" * 512)


def train(*words: str) -> subprocess.Popen[str]:
    """A process that trains."""
    command = [sys.executable, str(TRAIN), *words, "--quiet", "--no-report", "--checkpoint-seconds", "0.05"]
    return subprocess.Popen(command, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)


def ended(process: subprocess.Popen[str]) -> dict[str, Any]:
    """How a process ended and what it complained of."""
    _, errors = process.communicate(timeout=MOST)
    return {"code": process.returncode, "errors": errors}


def tree(folder: Path) -> dict[str, str]:
    """Every file in a folder with its content, as text that stands for it."""
    return {str(path.relative_to(folder)): path.read_bytes().hex() for path in folder.rglob("*") if path.is_file()}


def main(folder: Path, words: list[str]) -> dict[str, Any]:
    """Fill the disk while a run is under way, make room and go on; then forbid writing and try again."""
    mounted(folder, "size=1m")
    run, found = folder / "run", {}
    process, began = train(*words, "--out", str(run)), time.monotonic()
    while not (run / "checkpoint" / "state.json").exists() and time.monotonic() - began < MOST:
        time.sleep(0.01)
    filled(folder / "filler")
    found["full"] = ended(process)
    before = tree(run)
    found["full again"] = ended(train("--resume", str(run)))
    found["harmed"] = [name for name, content in before.items() if name != ".lock" and tree(run).get(name) != content]
    found["left"] = sorted(before)
    (folder / "filler").unlink()
    found["room"] = ended(train("--resume", str(run)))
    found["learned"] = (run / "policy.safetensors").read_bytes().hex()

    before = tree(folder)
    subprocess.run(["mount", "-o", "remount,ro", str(folder)], check=True)
    found["unwritable"] = ended(train(*words, "--out", str(folder / "other")))
    found["unwritable again"] = ended(train("--resume", str(run)))
    found["changed"] = tree(folder) != before
    return found


if __name__ == "__main__":
    print(json.dumps(main(Path(sys.argv[1]), sys.argv[2:])))
