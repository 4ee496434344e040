"""Folders of finished runs that never ran, shared by the tests of sweeps."""

import json
from pathlib import Path

from agents.run_folder import CONFIG, RESULTS
from agents.sweep.runs import SweepRun


def finish(run: SweepRun, storage: Path, *, mean: float | None = 0.01, interrupted: bool = False) -> None:
    """Files as a run leaves them."""
    folder = storage / run.name
    folder.mkdir(parents=True)
    described = run.described()
    (folder / CONFIG).write_text(json.dumps({**described, "versions": {}, "command": "x"}))
    verdict = {"mean": mean, "worst": None if mean is None else 2 * mean, "distance": "gap to the optimum"}
    numbers = {"verdict": verdict, "seconds": 1.5, "wingbeats": 4_096, "interrupted": interrupted}
    (folder / RESULTS).write_text(json.dumps({**described, **numbers}))
