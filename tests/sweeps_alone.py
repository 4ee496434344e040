"""Sweeps in processes of their own, as one types them, and the same runs trained alone."""

import json
import os
import subprocess
import sys
import time
from collections.abc import Callable
from pathlib import Path
from typing import Any

from agents.run_folder import POLICY_TENSORS, RESULTS
from agents.sweep.plan import SweepPlan
from agents.sweep.runs import SweepRun
from agents.training import train

ROOT = Path(__file__).parents[1]
TINY = ("--set", "rows=256", "--set", "minibatch=256", "--insects", "hawkmoth", "fruitfly")


def begin(*arguments: str, environment: dict[str, str] | None = None) -> subprocess.Popen[str]:
    """Start `train.py sweep`."""
    # A job in the background ignores Ctrl-C, and so would what it starts: Python's own handler is put back first.
    code = "import signal, sys, train; signal.signal(2, signal.default_int_handler); sys.exit(train.main(sys.argv[1:]))"
    return subprocess.Popen(
        [sys.executable, "-c", code, "sweep", *arguments, "--quiet"],
        cwd=ROOT,
        env={**(environment or os.environ), "PYTHONPATH": str(ROOT)},
        stdout=subprocess.PIPE,
        stderr=subprocess.PIPE,
        text=True,
    )


def until(true: Callable[[], bool], process: subprocess.Popen[str]) -> None:
    """Wait for something while a process goes on."""
    while not true():
        assert process.poll() is None, process.communicate()
        time.sleep(0.05)


def finished(storage: Path) -> int:
    """Runs that have a result."""
    return len(list(storage.glob(f"*/{RESULTS}")))


def told(folder: Path) -> dict[str, Any]:
    """A run's results, but for its seconds."""
    content = json.loads((folder / RESULTS).read_text(encoding="utf-8"))
    del content["seconds"]
    return dict(content)


def require_same_as_alone(run: SweepRun, storage: Path, alone: Path) -> None:
    """Train a run alone and require the same policy and the same results."""
    train(run.config, alone / run.name, progress=False, report=False)
    there, here = storage / run.name, alone / run.name
    assert told(there) == told(here)
    assert (there / POLICY_TENSORS).read_bytes() == (here / POLICY_TENSORS).read_bytes()


def tiny_plan(**fields: Any) -> SweepPlan:
    """The plan of `TINY`."""
    return SweepPlan(
        presets=["hover-ppo"], settings={"rows": 256, "minibatch": 256}, insects=["hawkmoth", "fruitfly"], **fields
    )
