"""Does a run that is killed end as if nothing had happened? `python -m benchmarks.kills`.

One run of an on-policy and one of an off-policy learner is made whole. Then the same command is killed with SIGKILL at
moments spread over its whole time, from its first instruction to its last, each time in another folder, and goes on
with --resume. Weights, results (but for seconds) and learning curve (but for its seconds) must be equal to the last
digit.
"""

import argparse
import json
import os
import signal
import subprocess
import sys
import tempfile
import time
from collections.abc import Sequence
from pathlib import Path
from typing import Any

import numpy as np
from tqdm import tqdm

from agents.checkpoint import read_checkpoint
from agents.run_folder import CHECKPOINT, CONFIG, CURVE, POLICY_TENSORS, RESULTS
from flapenv.aero.checks import record
from flapenv.read_json import read_object
from flapenv.tables import text_table

TRAIN = Path(__file__).parents[1] / "train.py"
LEARNERS = {
    "hover-ppo": ("--wingbeats", "240000", "--set", "rows=256", "--set", "minibatch=128"),
    "hover-sac": ("--wingbeats", "50000", "--set", "buffer=20000"),
}
"""Presets, and what makes them short; the replay buffer runs over."""
OFTEN = ("--checkpoint-seconds", "0.2")
QUIETLY = ("--quiet", "--no-report")


@record
class Kill:
    """One kill and what came of it.

    Attributes:
        after: when, from the start of the process [s].
        found: what the run had come to, in words.
        equal: whether it ended like the run that was left alone.
    """

    after: float
    found: str
    equal: bool


def started(*words: str) -> subprocess.Popen[bytes]:
    """A process that trains."""
    threads = dict.fromkeys(("OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS", "MKL_NUM_THREADS"), "1")
    command = [sys.executable, str(TRAIN), *words, *QUIETLY, *OFTEN]
    return subprocess.Popen(command, env={**os.environ, **threads}, stdout=subprocess.PIPE, stderr=subprocess.STDOUT)


def ended(process: subprocess.Popen[bytes]) -> None:
    """Wait for a process.

    Raises:
        RuntimeError: if it fails, with what it said.
    """
    said, _ = process.communicate()
    if process.returncode != 0:
        raise RuntimeError(f"training ended with {process.returncode}: {said.decode(errors='replace').strip()}")


def learned(folder: Path) -> tuple[bytes, dict[str, Any], list[list[str]]]:
    """Weights, results and curve of a run, without seconds."""
    results = {name: value for name, value in read_object(folder / RESULTS).items() if name != "seconds"}
    rows = [row.split(",") for row in (folder / CURVE).read_text(encoding="utf-8").splitlines()]
    return (folder / POLICY_TENSORS).read_bytes(), results, [row[:1] + row[2:] for row in rows]


def found_in(folder: Path) -> str:
    """What a killed run had come to."""
    if not (folder / CONFIG).exists():
        return "nothing yet"
    checkpoint = read_checkpoint(folder / CHECKPOINT)
    if checkpoint is None:
        return "all is written" if (folder / RESULTS).exists() else "no checkpoint yet"
    return f"checkpoint at {checkpoint.numbers['learner']['counters']['num_timesteps']:,} wingbeats"


def killed(preset: str, words: Sequence[str], folder: Path, after: float) -> str:
    """Start a run, kill it and say what it had come to."""
    process = started("--preset", preset, *words, "--out", str(folder))
    time.sleep(after)
    process.send_signal(signal.SIGKILL)
    process.communicate()
    return found_in(folder)


def kills(preset: str, moments: int, seed: int, scratch: Path) -> list[Kill]:
    """Kill a preset's run at so many moments, one in each of as many equal parts of its time."""
    words = LEARNERS[preset]
    began = time.monotonic()
    ended(started("--preset", preset, *words, "--out", str(scratch / "whole")))
    whole, takes = learned(scratch / "whole"), time.monotonic() - began
    generator = np.random.default_rng(seed)
    done = []
    for number in tqdm(range(moments), desc=preset, disable=not sys.stderr.isatty()):
        after, folder = takes * (number + generator.random()) / moments, scratch / f"cut{number}"
        found = killed(preset, words, folder, after)
        again = (
            ("--resume", str(folder))
            if (folder / CONFIG).exists()
            else ("--preset", preset, *words, "--out", str(folder))
        )
        ended(started(*again))
        done.append(Kill(after=after, found=found, equal=learned(folder) == whole))
    return done


def main(arguments: list[str] | None = None) -> int:
    """Print a table of all kills; 0 where every run ended like the one that was left alone, else 1."""
    parser = argparse.ArgumentParser(prog="python -m benchmarks.kills", description=__doc__.splitlines()[0])
    parser.add_argument(
        "--moments", type=int, default=20, metavar="N", help="kills of each learner (default %(default)s)"
    )
    parser.add_argument("--presets", nargs="+", default=list(LEARNERS), choices=list(LEARNERS), help="whose runs")
    parser.add_argument("--seed", type=int, default=0, help="of the moments (default %(default)s)")
    options = parser.parse_args(arguments)
    all_equal = True
    for preset in options.presets:
        with tempfile.TemporaryDirectory() as scratch:
            done = kills(preset, options.moments, options.seed, Path(scratch))
        rows = [("killed after", "found", "ended equal")]
        rows += [(f"{one.after:.2f} s", one.found, "yes" if one.equal else "NO") for one in done]
        equal = sum(one.equal for one in done)
        print(f"{preset}\n{text_table(rows)}\n{equal} of {len(done)} ended equal\n", flush=True)
        all_equal &= equal == len(done)
    print(json.dumps({"moments": options.moments, "seed": options.seed, "cores": os.cpu_count()}))
    return 0 if all_equal else 1


if __name__ == "__main__":
    sys.exit(main())
