"""Small runs of every learner, killed at a checkpoint and gone on with."""

import json
from pathlib import Path
from typing import Any

from agents.presets import PRESETS
from agents.training import TrainingConfig, train

OFF_POLICY = {"wingbeats": 640, "rows": 16, "learning_starts": 128, "buffer": 400, "gradient_steps": 1, "batch": 32}
"""The buffer is full, and overwritten, before the end."""
SMALL: dict[str, dict[str, Any]] = {
    "hover-ppo": {"wingbeats": 1280, "rows": 128, "minibatch": 64},
    "random-wings-ppo": {"wingbeats": 1280, "rows": 128, "minibatch": 64},
    "waveform-ppo": {"wingbeats": 1280, "rows": 128, "minibatch": 64},
    "adapt-ppo": {"wingbeats": 1280, "rows": 16, "steps": 8, "minibatch": 64},
    "heave-ppo": {"wingbeats": 1280, "rows": 16, "steps": 8, "minibatch": 64},
    "adapt-recurrentppo": {"wingbeats": 1280, "rows": 16, "steps": 8},
    "hover-gradient": {"wingbeats": 1920},
    **{f"hover-{name}": OFF_POLICY for name in ("sac", "td3", "tqc", "crossq")},
}


class KilledError(Exception):
    """In place of a signal: nothing after it is run."""


def config(name: str) -> TrainingConfig:
    return TrainingConfig(preset=PRESETS[name].changed({}, SMALL[name]), name=name, seed=5)


def learned(folder: Path) -> tuple[bytes, dict[str, Any], list[list[str]]]:
    """Weights, results without seconds, the curve without its seconds."""
    results = json.loads((folder / "results.json").read_text(encoding="utf-8"))
    assert results.pop("seconds") > 0
    rows = [row.split(",") for row in (folder / "curve.csv").read_text(encoding="utf-8").splitlines()]
    return (folder / "policy.safetensors").read_bytes(), results, [row[:1] + row[2:] for row in rows]


def quietly(config: TrainingConfig, out: Path, **how: Any) -> None:
    train(config, out, progress=False, report=False, **how)
