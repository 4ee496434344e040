"""What checkpoints cost, of the time that training takes: `python -m benchmarks.checkpoints`.

Runs of an on-policy learner, of an off-policy one whose replay buffer is full, and of one with memory, with checkpoints
as `train.py` makes them. What is counted is all that training waits for: collecting, hashing, writing and forcing to
the disk, the last checkpoint after training included.
"""

import argparse
import os
import sys
import tempfile
import time
from pathlib import Path

import torch
from tqdm import tqdm

from agents.checkpoint import CHECKPOINT_SECONDS
from agents.learning import Learning
from agents.presets import PRESETS
from agents.remembering import flown
from agents.run_folder import CHECKPOINT
from agents.training import TrainingConfig, make_model
from flapenv.tables import text_table

WINGBEATS = {"hover-ppo": 1_500_000, "hover-sac": 150_000, "adapt-recurrentppo": 200_000}
"""Half a minute and more of each; more than the second's replay buffer holds."""


class Watched(Learning):
    """Training whose checkpoints are timed."""

    spent: tuple[float, ...] = ()
    """Seconds of each."""
    largest = 0
    """Bytes of the largest."""

    def make_checkpoint(self) -> None:
        """Time it."""
        began = time.perf_counter()
        super().make_checkpoint()
        self.spent += (time.perf_counter() - began,)
        written = sum(path.stat().st_size for path in (self.folder / CHECKPOINT).iterdir())
        self.largest = max(self.largest, written)


def row(name: str, wingbeats: int, folder: Path) -> tuple[str, ...]:
    """One preset's line of the table."""
    config = TrainingConfig(preset=PRESETS[name].changed({}, {"wingbeats": wingbeats}), name=name)
    torch.set_num_threads(config.preset.settings.threads)
    task = config.preset.make_task()
    model = make_model(config.preset, task, config.seed)
    task.glance(flown(model))
    folder.mkdir()
    run = Watched(config, task, model, folder)
    run.learn(progress=False, checkpoint_seconds=CHECKPOINT_SECONDS)
    spent = sum(run.spent)
    seconds = run.curve.seconds + run.spent[-1]  # the last one is made after training has ended
    return (
        name,
        f"{wingbeats:,}",
        f"{seconds:.1f} s",
        str(len(run.spent)),
        f"{run.largest / 1e6:.2f} MB",
        f"{1e3 * spent / len(run.spent):.0f} ms",
        f"{100 * spent / seconds:.2f} %",
    )


def main(arguments: list[str] | None = None) -> None:
    """Print the table."""
    parser = argparse.ArgumentParser(prog="python -m benchmarks.checkpoints", description="What checkpoints cost.")
    parser.add_argument("--share", type=float, default=1.0, help="of the runs' wingbeats (default %(default)s)")
    share = parser.parse_args(arguments).share
    rows: list[tuple[str, ...]] = [
        ("preset", "wingbeats", "training", "checkpoints", "size", "each", "share of the time")
    ]
    with tempfile.TemporaryDirectory() as scratch:
        for name, wingbeats in tqdm(WINGBEATS.items(), disable=not sys.stderr.isatty()):
            rows.append(row(name, int(share * wingbeats), Path(scratch) / name))
    print(f"{text_table(rows)}\n{os.cpu_count()} cores, OMP_NUM_THREADS {os.environ.get('OMP_NUM_THREADS', 'not set')}")


if __name__ == "__main__":
    main()
