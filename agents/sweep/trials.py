"""What a worker of Ray does: one run, in its folder. A mistake of the run is its result, told like any other.

Imported on every node, without Ray.
"""

import json
import time
from pathlib import Path
from typing import Any

from agents.commands.one_line_parser import said
from agents.file_rights import keep_others_from_writing
from agents.presets import as_preset
from agents.training_config import TrainingConfig, TrainingResult

PATIENCE = 120.0
"""Seconds that a run waits for a folder which the worker of a lost node still holds."""
GLANCE = 1.0
"""Seconds between two tries."""


def packed(config: TrainingConfig) -> str:
    """A config as text, which says what config.json says."""
    described = config.to_dict()
    return json.dumps({"config": described, "name": config.name, "seed": config.seed, "command": config.command})


def unpacked(text: str) -> TrainingConfig:
    """The config in a text of `packed`."""
    told = json.loads(text)
    preset = {key: told["config"][key] for key in ("task", "algorithm", "settings")}
    return TrainingConfig(preset=as_preset(preset), seed=told["seed"], name=told["name"], command=told["command"])


def go_on(config: TrainingConfig, folder: Path) -> TrainingResult:
    """Train, or go on with what a folder holds."""
    from agents.training import train

    return train(config, folder, progress=False, report=False, resume=True)


def run_trial(trial: dict[str, Any]) -> dict[str, Any]:
    """The function that Tune calls.

    Args:
        trial: the run's `folder` and its `packed` config.

    Returns:
        `mean`, the distance reached; or why there is none, in `failed`, and in `final` whether it would end so again.
    """
    keep_others_from_writing()  # the node was started by whatever shell
    deadline = time.monotonic() + PATIENCE
    while True:
        try:
            result = go_on(unpacked(trial["packed"]), Path(trial["folder"]))
        except BlockingIOError as held:
            if time.monotonic() > deadline:
                return {"failed": said(held), "final": False}
            time.sleep(GLANCE)
        except Exception as mistake:
            return {"failed": said(mistake), "final": isinstance(mistake, ArithmeticError)}
        else:
            return {"mean": result.verdict.mean, "failed": None, "final": False}
