"""Runs that are killed at a checkpoint of one's choice."""

from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest
from killed_runs import KilledError

import agents.learning
from agents.checkpoint import Checkpoint, Checkpoints, write_checkpoint


@pytest.fixture
def killed_at(monkeypatch: pytest.MonkeyPatch) -> Callable[[int | None], None]:
    """Make a checkpoint before every rollout, and let training end at the one of this number."""
    often = Checkpoints.__init__

    def init(self: Checkpoints, make: Callable[[], object], **_: Any) -> None:
        often(self, make, seconds=0.0, share=1.0)

    monkeypatch.setattr(Checkpoints, "__init__", init)

    def set_end(last: int | None) -> None:
        made = 0

        def write(folder: Path, checkpoint: Checkpoint) -> None:
            nonlocal made
            write_checkpoint(folder, checkpoint)
            made += 1
            if made == last:
                raise KilledError

        monkeypatch.setattr(agents.learning, "write_checkpoint", write)

    return set_end
