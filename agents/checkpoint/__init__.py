"""Training that survives its process: all of a learner, its environment and its chances in files without pickles."""

from agents.checkpoint.callback import CHECKPOINT_SECONDS, Checkpoints
from agents.checkpoint.files import STATE, Checkpoint, read_checkpoint, remove_checkpoint, write_checkpoint
from agents.checkpoint.learner import learner_state, restore_learner

__all__ = [
    "CHECKPOINT_SECONDS",
    "STATE",
    "Checkpoint",
    "Checkpoints",
    "learner_state",
    "read_checkpoint",
    "remove_checkpoint",
    "restore_learner",
    "write_checkpoint",
]
