"""`python train.py evaluate`: judge policies and strokes against optimum, CFD and other models."""

import argparse
import shlex
import sys
from pathlib import Path
from typing import Any

from agents.commands.one_line_parser import OneLineParser, folder, said
from agents.commands.train import what_counts

DEFAULT_POLICY = "hover"
"""The shipped policy that is judged where none is named."""


def parser() -> argparse.ArgumentParser:
    """The command line."""
    from agents.evaluation.noisy_actuators import NOISE_SHARE

    made = OneLineParser(
        prog="train.py evaluate",
        description=(
            "Judge policies against their task's reference, or strokes against optimum and CFD: a shipped policy, a\n"
            "run's, a file of strokes, or the insects' own. Weights are read from safetensors and flown in NumPy;\n"
            "nothing is unpickled."
        ),
        epilog=(
            "examples:\n"
            "  python train.py evaluate --list                     the shipped policies\n"
            "  python train.py evaluate                            the shipped one for the eight insects\n"
            "  python train.py evaluate random-wings heave         others\n"
            "  python train.py evaluate runs/hover-ppo-seed0 --out judged    with the report, judged/.../report.html\n"
            "  python train.py evaluate hawkmoth                   an insect's own stroke: its line of Table 3\n"
            "  python train.py evaluate published                  those of all eight\n"
            "  python train.py evaluate strokes.json               or .csv; what `explore` and `optimum` write\n"
            "  python train.py evaluate random-wings --wing docs/examples/robot.json    on a wing of one's own\n"
            "  python train.py evaluate hover --robustness         2 % actuator noise, told of other models\n"
            "  python train.py evaluate random-wings --costs       what a new wing costs\n"
            "  python train.py evaluate hover --problem profile-drag --out judged"
        ),
    )
    made.add_argument(
        "subjects",
        nargs="*",
        metavar="WHAT",
        help=f"shipped policy, run folder, policy file, stroke file, insect or 'published' (default {DEFAULT_POLICY})",
    )
    made.add_argument("--list", action="store_true", help="list the shipped policies and end")
    made.add_argument("--insects", nargs="+", metavar="NAME", help="other insects than those of the training, or these")
    made.add_argument(
        "--wing",
        type=folder,
        action="append",
        default=[],
        metavar="FILE",
        help="a wing of one's own (JSON), in place of --insects; repeatable",
    )
    made.add_argument("--problem", metavar="NAME", help="another problem with the same observations and actions")
    made.add_argument("--pool-seed", type=int, metavar="N", help="random wings: another pool of test wings")
    made.add_argument(
        "--noise",
        type=float,
        default=0.0,
        metavar="SHARE",
        help="actuator noise, its standard deviation over the range of the actions (default 0)",
    )
    made.add_argument(
        "--robustness",
        action="store_true",
        help=f"Hover with named insects: noise of {NOISE_SHARE:g}, and the other coefficient models",
    )
    made.add_argument(
        "--costs",
        action="store_true",
        help="random wings: what a new wing costs, beside multi-start SLSQP and the batched optimum",
    )
    made.add_argument(
        "--out", type=folder, metavar="DIR", help="keep results.json, report.html and the picture of each here"
    )
    return made


def evaluate_command(arguments: list[str]) -> int:
    """Judge what is named; 0 on success, 2 for bad input."""
    options = parser().parse_args(arguments)
    try:
        if options.list:
            print(shipped_table())
            return 0
        subjects = options.subjects or [DEFAULT_POLICY]
        asked, folders = _asked(options), _folders(subjects, options.out)
        command = shlex.join(["python", "train.py", "evaluate", *_what_counts(arguments, subjects)])
        for subject, kept in zip(subjects, folders, strict=True):
            print(_told(subject, asked, kept, command), flush=True)
    except (ValueError, TypeError, OSError, ArithmeticError, MemoryError) as mistake:
        print(f"train.py evaluate: {said(mistake)}", file=sys.stderr)
        return 2
    return 0


def _asked(options: argparse.Namespace) -> Any:
    """What the options ask for, an `agents.evaluation.evaluated.Asked`; wings are read once."""
    from agents.evaluation.evaluated import Asked
    from flapenv.files import read_wing

    if options.wing and options.insects:
        raise ValueError("--wing and --insects ask for two sets of wings; allowed: one of them")
    return Asked(
        insects=options.insects,
        wings=[read_wing(file) for file in options.wing],
        problem=options.problem,
        pool_seed=options.pool_seed,
        noise=options.noise,
        robustness=options.robustness,
        costs=options.costs,
    )


def _folders(subjects: list[str], out: Path | None) -> list[Path | None]:
    """Where what is kept of each will lie, checked before anything is judged; None where nothing is to be kept.

    Raises:
        ValueError: for two of one name.
        OSError: for a folder that cannot be used.
    """
    from agents.run_folder import require_free_folder
    from flapenv.aero.checks import shown

    if out is None:
        return [None] * len(subjects)
    names = [_folder_name(subject) for subject in subjects]
    for name in names:
        if names.count(name) > 1:
            raise ValueError(
                f"{names.count(name)} subjects are called {shown(name)}; allowed with --out: each name once"
            )
    for name in names:
        require_free_folder(out / name)
    return [out / name for name in names]


def _folder_name(subject: str) -> str:
    """What the folder of a subject is called."""
    from agents.run_folder import real_name
    from flapenv.files.strokes import ENDINGS

    path = Path(subject)
    if path.suffix == ".safetensors":
        return real_name(path.parent)
    return path.stem if path.suffix.lower() in ENDINGS else real_name(subject)


def _what_counts(arguments: list[str], subjects: list[str]) -> list[str]:
    """The arguments that a verdict depends on, files by their names only."""
    from agents.run_folder import real_name

    return [real_name(one) if one in subjects else one for one in what_counts(arguments)]


def _told(subject: str, asked: Any, kept: Path | None, command: str) -> str:
    """One verdict as text; files in the folder given.

    Raises:
        ValueError: as `agents.evaluation.evaluated.evaluated`, like the others.
    """
    from agents.evaluation.assessment_table import ranking_table
    from agents.evaluation.evaluated import evaluated

    found = evaluated(subject, asked)
    assessments = found.verdict.assessments
    parts = [f"{found.title}\n{found.verdict.text}"]
    if any(one.rankings and not one.is_own for one in assessments):
        parts.append(ranking_table(assessments))
    parts += found.told
    if kept is not None:
        _keep(found, kept, command)
        parts.append(f"kept in {kept}")
    return "\n\n".join(parts) + "\n"


def _keep(found: Any, kept: Path, command: str) -> None:
    """Write results.json, the picture and the report."""
    from agents.report.of_run import report_of_evaluation
    from agents.run_folder import RESULT_PICTURE, RESULTS, open_run_folder, versions, write_atomically
    from flapenv.whole_file import write_json

    verdict = found.verdict
    scores = {"mean": verdict.mean, "worst": verdict.worst, "distance": found.about["distance"]}
    about = {name: value for name, value in found.about.items() if name != "distance"}
    picture = found.draw()
    open_run_folder(kept, "")
    write_json(kept / RESULTS, {**about, "verdict": scores, **verdict.results, "versions": versions()})
    write_atomically(kept / RESULT_PICTURE, picture.savefig)
    report_of_evaluation(found, kept, command)


def shipped_table() -> str:
    """The shipped policies with what their cards say."""
    from agents.policy_file import load_policy, shipped_policies
    from flapenv.tables import text_table

    rows: list[tuple[str, ...]] = [("policy", "environment", "learner", "wingbeats", "seed", "mean %", "worst %", "of")]
    for name in shipped_policies():
        _, card = load_policy(name)
        numbers = (card.result[key] for key in ("mean", "worst"))
        told = ("-" if number is None else f"{100 * number:.3f}" for number in numbers)
        beats, distance = f"{card.wingbeats:,}", str(card.result.get("distance", ""))
        rows.append((name, card.environment, card.algorithm, beats, str(card.seed), *told, distance))
    return text_table(rows)
