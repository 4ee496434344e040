"""What a training run depends on, and what it ends with."""

import re
from pathlib import Path
from typing import Any

from agents.presets import DEFAULT_PRESET, PRESETS, as_preset
from agents.tasks.task import Verdict
from flapenv.aero.checks import record, require_count, shown

LAST_SEED = 2**32 - 1
"""The largest seed that NumPy's and torch's global generators both take."""


@record
class TrainingConfig:
    """Everything a training run depends on.

    Attributes:
        preset: a name of `agents.presets.PRESETS`, a `Preset`, or the dict of one.
        seed: of networks, noise and draws.
        name: what the run is called; the preset's where it is given by name.
        command: what was typed, for the policy's card; of a registered preset what one would type.
    """

    preset: Any = DEFAULT_PRESET
    seed: int = 0
    name: str = ""
    command: str = ""

    def __post_init__(self) -> None:
        """Resolve the preset; check the seed."""
        if require_count("seed", self.seed, low=0) > LAST_SEED:
            raise ValueError(f"seed = {self.seed} is not allowed; allowed: whole numbers from 0 to {LAST_SEED}")
        for field in ("name", "command"):
            if not isinstance(getattr(self, field), str):
                raise TypeError(f"{field} = {shown(getattr(self, field))} is not allowed; allowed: a text")
        preset = as_preset(self.preset)
        own = self.preset if isinstance(self.preset, str) else f"{preset.task}-{preset.settings.algorithm.lower()}"
        name = self.name or own
        if not re.fullmatch(r"\w[\w.-]{0,99}", name):
            raise ValueError(
                f"name = {shown(name)} is not allowed; allowed: letters, digits, '_', '-' and '.', 100 at most"
            )
        object.__setattr__(self, "name", name)
        if not self.command and PRESETS.get(name) == preset:
            object.__setattr__(self, "command", f"python train.py --preset {name} --seed {self.seed}")
        object.__setattr__(self, "preset", preset)

    def to_dict(self) -> dict[str, Any]:
        """As config.json keeps it.

        Raises:
            TypeError: for an insect that no file can hold.
        """
        return {"preset": self.name, "seed": self.seed, **self.preset.to_dict()}


@record
class TrainingResult:
    """What a run ended with.

    Attributes:
        out: its folder.
        verdict: on the last policy.
        wingbeats: wingbeats trained on.
        seconds: spent training, without those spent watching it.
        interrupted: whether it was stopped before its budget was spent.
        report: the HTML file that shows it; None where none was asked for or it could not be drawn.
    """

    out: Path
    verdict: Verdict
    wingbeats: int
    seconds: float
    interrupted: bool
    report: Path | None = None
