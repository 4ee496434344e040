"""The report of a training run."""

import os
from pathlib import Path
from typing import TYPE_CHECKING

from agents.curve_picture import read_curve
from agents.read_json import read_object
from agents.report.content import ReportContent
from agents.report.page import write_report
from agents.run_folder import CURVE, POLICY_CARD, REPORT, RESULT_PICTURE, versions
from agents.tasks.task import Task

if TYPE_CHECKING:
    from agents.training import TrainingConfig, TrainingResult


def report_of_run(config: "TrainingConfig", task: Task, result: "TrainingResult") -> Path:
    """Write the report of a run into its folder, from what lies there.

    Args:
        config: what was trained.
        task: that it was trained for.
        result: what it ended with.

    Returns:
        The file.

    Raises:
        OSError: if a file of the run cannot be read, or the report not be written.
        ValueError: if a file of the run is not as it was written.
    """
    card = read_object(result.out / POLICY_CARD)
    picture = result.out / RESULT_PICTURE
    stopped = ", stopped early" if result.interrupted else ""
    content = ReportContent(
        title=f"{config.name}, seed {config.seed}",
        verdict=result.verdict,
        task=task,
        picture=picture.read_bytes(),
        curve=read_curve(result.out) if (result.out / CURVE).is_file() else (),
        facts={
            "command": config.command or "python train.py --config config.json, with the file in this folder",
            "preset": config.name,
            "seed": str(config.seed),
            "learner": config.preset.settings.algorithm,
            "trained for": f"{result.wingbeats:,} wingbeats in {result.seconds:.1f} s{stopped}",
            "policy": f"policy.safetensors, sha256 {card['sha256']}",
            **machine_facts(),
        },
        config=config.to_dict(),
    )
    return write_report(result.out / REPORT, content)


def machine_facts() -> dict[str, str]:
    """What it was made on, for `ReportContent.facts`."""
    told = ", ".join(f"{package} {version}" for package, version in versions().items())
    return {"versions": told, "machine": f"{os.cpu_count()} cores"}
