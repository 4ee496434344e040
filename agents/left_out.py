"""Each species left out in turn: `python -m agents.left_out` trains without its like and judges the policy on it."""

import argparse
import json
import shutil
import sys
from collections.abc import Sequence
from pathlib import Path

from tqdm import tqdm

from agents.benchmark import TRAIN
from agents.folder_lock import locked
from agents.presets import PRESETS
from agents.run_folder import RESULTS, write_atomically
from agents.subprocesses import ERRORS, Command, run_all
from flapenv.aero.checks import require_count, require_name
from flapenv.insects import INSECTS
from flapenv.tables import text_table

ROOT = Path("runs/left-out")
PRESET = "random-wings-ppo"
TABLE = "table.txt"


def train_without(names: Sequence[str], preset: str, seed: int, root: Path, jobs: int) -> dict[str, str]:
    """Train without each species, several at a time; runs that are there are kept.

    Args:
        names: of the species.
        preset: of random wings.
        seed: of every run.
        root: folder of the runs.
        jobs: how many beside each other.

    Returns:
        What went wrong, by name.

    Raises:
        ValueError: for a run that is there with another preset or seed.
        OSError: if the folder cannot be written, or is in use.
    """
    root.mkdir(parents=True, exist_ok=True)
    failed: dict[str, str] = {}
    todo = [name for name in names if not _is_there(root / name, preset, seed)]
    with locked(root) as lock, tqdm(total=len(todo), unit="run", file=sys.stderr) as bar:

        def ended(over: Command, code: int) -> None:
            bar.update()
            if code == 0:
                over.folder.rename(root / over.name)
            else:
                failed[over.name] = (over.folder / ERRORS).read_text(encoding="utf-8").strip()[-200:] or f"code {code}"

        commands = []
        for name in todo:
            part = root / f"{name}.part"
            shutil.rmtree(part, ignore_errors=True)
            part.mkdir()
            asked = ["--preset", preset, "--leave-out", name, "--seed", str(seed), "--out", str(part), "--quiet"]
            commands.append(Command(name=name, arguments=[sys.executable, str(TRAIN), *asked], folder=part))
        if not run_all(
            commands, jobs, changed=lambda now: bar.set_postfix_str(", ".join(now)), ended=ended, inherited=lock
        ):
            raise KeyboardInterrupt
    return failed


def _is_there(folder: Path, preset: str, seed: int) -> bool:
    """Whether a run has ended, with the same preset and seed."""
    if not (folder / RESULTS).is_file():
        return False
    found = json.loads((folder / RESULTS).read_text(encoding="utf-8"))
    if (found["preset"], found["seed"]) != (preset, seed):
        raise ValueError(
            f"{folder} was made with preset {found['preset']}, seed {found['seed']}; allowed: the same, or another "
            "--root"
        )
    return True


def left_out_table(root: Path, names: Sequence[str]) -> str:
    """The species' own gaps, and those on test wings, of policies that never saw their like.

    Raises:
        OSError: for a run that is missing.
    """
    rows: list[tuple[str, ...]] = [
        ("left out", "gap", "weight", "learned", "optimum", "test wings:", "mean", "95 %"),
        ("", "%", "support", "W/kg", "W/kg", "", "%", "%"),
    ]
    gaps = []
    for name in names:
        results = json.loads((root / name / RESULTS).read_text(encoding="utf-8"))
        own, test = results["insects"][name], results["wings"]["test"]
        gaps.append(own["gap_percent"])
        rows.append(
            (
                name,
                f"{own['gap_percent']:.2f}",
                f"{own['weight_support']:.4f}",
                f"{own['specific_power']:.2f}",
                f"{own['optimum_specific_power']:.2f}",
                "",
                f"{test['mean_gap_percent']:.2f}",
                f"{test['p95_gap_percent']:.2f}",
            )
        )
    return f"{text_table(rows, header_rows=2)}\nmean {sum(gaps) / len(gaps):.2f} %, worst {max(gaps):.2f} %"


def main(arguments: Sequence[str] | None = None) -> int:
    """Train, print and keep the table; 0 on success, 1 where a run failed, 2 for bad input, 130 after Ctrl-C."""
    made = argparse.ArgumentParser(prog="python -m agents.left_out", description=__doc__)
    made.add_argument("--insects", nargs="+", default=list(INSECTS), metavar="NAME", help="default: all eight")
    made.add_argument("--preset", default=PRESET, metavar="NAME", help=f"of random wings (default {PRESET})")
    made.add_argument("--seed", type=int, default=0, metavar="N", help="of every run (default 0)")
    made.add_argument("--jobs", type=int, default=2, metavar="N", help="runs beside each other (default 2)")
    made.add_argument("--root", type=Path, default=ROOT, metavar="DIR", help=f"folder of the runs (default {ROOT}/)")
    options = made.parse_args(arguments)
    try:
        for name in options.insects:
            require_name("--insects", name, INSECTS)
        known = [name for name, preset in PRESETS.items() if preset.task == "random-wings"]
        require_name("--preset", options.preset, known)
        require_count("--seed", options.seed, low=0)
        require_count("--jobs", options.jobs)
        failed = train_without(options.insects, options.preset, options.seed, options.root, options.jobs)
        if failed:
            print("\n".join(f"without {name}: {why}" for name, why in failed.items()), file=sys.stderr)
            return 1
        table = left_out_table(options.root, options.insects)
        write_atomically(options.root / TABLE, lambda part: part.write_text(f"{table}\n", encoding="utf-8"))
        print(table)
    except KeyboardInterrupt:
        print("stopped; runs that have ended are kept, and the same command goes on", file=sys.stderr)
        return 130
    except (ValueError, TypeError, OSError) as mistake:
        print(f"error: {mistake}", file=sys.stderr)
        return 2
    return 0


if __name__ == "__main__":
    sys.exit(main())
