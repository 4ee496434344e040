"""Reports of training runs and of evaluations, from what lies in their folders."""

import os
import platform
import sys
from importlib import metadata
from pathlib import Path
from typing import TYPE_CHECKING

from agents.curve_picture import read_curve
from agents.report.content import ReportContent
from agents.report.page import write_report
from agents.run_folder import CURVE, POLICY_CARD, REPORT, RESULT_PICTURE, versions
from agents.tasks.task import Task
from flapenv.aero.checks import one_line
from flapenv.read_json import read_object

if TYPE_CHECKING:
    from agents.evaluation.evaluated import Evaluated
    from agents.training_config import TrainingConfig, TrainingResult


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
    curve, missing = _curve(result.out)
    stopped = ", stopped early" if result.interrupted else ""
    content = ReportContent(
        title=f"{config.name}, seed {config.seed}",
        verdict=result.verdict,
        about=f"{task.environment}, judged by the {task.distance}",
        distance=task.distance,
        picture=picture.read_bytes(),
        curve=curve,
        missing=missing,
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


def report_of_evaluation(found: "Evaluated", out: Path, command: str) -> Path:
    """Write the report of what was evaluated into the folder that holds its picture.

    Args:
        found: the verdict and what it is about; a run's policy shows the learning curve of its folder.
        out: the folder.
        command: what was typed.

    Returns:
        The file.

    Raises:
        OSError: if the picture cannot be read, or the report not be written.
    """
    about = {name: value for name, value in found.about.items() if isinstance(value, str | float) and value}
    card = found.card
    curve, missing = _curve(found.source.parent) if found.source else ([], [])
    content = ReportContent(
        title=found.title,
        about=f"judged by the {found.about['distance']}",
        verdict=found.verdict,
        distance=str(found.about["distance"]),
        called=found.called,
        told=found.told,
        picture=(out / RESULT_PICTURE).read_bytes(),
        curve=curve,
        missing=missing,
        facts={
            "command": command,
            **{name: str(value) for name, value in about.items() if name != "distance"},
            **({"trained by": card.command} if card and card.command else {}),
            **machine_facts(),
        },
        config=card.to_dict() if card else {},
    )
    return write_report(out / REPORT, content)


def _curve(folder: Path) -> tuple[list[dict[str, float]], list[str]]:
    """The learning curve of a folder, if there is one, and why it cannot be shown; said on stderr, too."""
    if not (folder / CURVE).is_file():
        return [], []
    try:
        return read_curve(folder), []
    except (ValueError, OSError) as mistake:
        text = f"The learning curve is left out: {one_line(mistake)}"
        print(text, file=sys.stderr)
        return [], [text]


def machine_facts() -> dict[str, str]:
    """What it was made on, for `ReportContent.facts`."""
    told = {**versions(), "plotly": metadata.version("plotly")}
    return {
        "versions": ", ".join(f"{package} {version}" for package, version in told.items()),
        "system": f"{platform.system()} {platform.release()}, {platform.machine()}",
        "machine": f"{os.cpu_count()} cores, OMP_NUM_THREADS {os.environ.get('OMP_NUM_THREADS', 'not set')}",
    }
