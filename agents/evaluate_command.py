"""`python train.py evaluate`: judge policies that were shipped or trained, in calm, with noise and in other models."""

import argparse
import sys
from collections.abc import Mapping
from pathlib import Path
from typing import Any

from agents.one_line_parser import OneLineParser, folder

DEFAULT_POLICY = "hover"
"""The shipped policy that is judged where none is named."""


def parser() -> argparse.ArgumentParser:
    """The command line."""
    from agents.noisy_actuators import NOISE_SHARE

    made = OneLineParser(
        prog="train.py evaluate",
        description=(
            "Judge policies against their task's reference: a shipped one, a run's, or a file. Weights are read from\n"
            "safetensors and flown in NumPy; nothing is unpickled."
        ),
        epilog=(
            "examples:\n"
            "  python train.py evaluate --list                     the shipped policies\n"
            "  python train.py evaluate                            the shipped one for the eight insects\n"
            "  python train.py evaluate random-wings heave         others\n"
            "  python train.py evaluate runs/hover-ppo-seed0 --insects hawkmoth\n"
            "  python train.py evaluate hover --robustness         2 % actuator noise, and other coefficient models\n"
            "  python train.py evaluate random-wings --costs       what a new wing costs\n"
            "  python train.py evaluate hover --problem profile-drag --out judged"
        ),
    )
    made.add_argument(
        "policies", nargs="*", metavar="POLICY", help=f"shipped name, run folder or file (default {DEFAULT_POLICY})"
    )
    made.add_argument("--list", action="store_true", help="list the shipped policies and end")
    made.add_argument("--insects", nargs="+", metavar="NAME", help="other insects than those of the training")
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
    made.add_argument("--out", type=folder, metavar="DIR", help="keep results.json and the picture of each policy here")
    return made


def evaluate_command(arguments: list[str]) -> int:
    """Judge the policies; 0 on success, 2 for bad input."""
    options = parser().parse_args(arguments)
    try:
        if options.list:
            print(shipped_table())
            return 0
        policies = options.policies or [DEFAULT_POLICY]
        folders = _folders(policies, options.out)
        for policy, kept in zip(policies, folders, strict=True):
            print(evaluated(policy, options, kept), flush=True)
    except (ValueError, TypeError, OSError, ArithmeticError) as mistake:
        print(f"train.py evaluate: {mistake}", file=sys.stderr)
        return 2
    return 0


def _folders(policies: list[str], out: Path | None) -> list[Path | None]:
    """A folder for each policy's results before anything is judged; None where none are to be kept.

    Raises:
        ValueError: for two policies of one name.
        OSError: for a folder that cannot be used.
    """
    from agents.run_folder import open_run_folder

    if out is None:
        return [None] * len(policies)
    paths = [Path(policy) for policy in policies]
    names = [path.parent.name if path.suffix == ".safetensors" else path.name for path in paths]
    for name in names:
        if names.count(name) > 1:
            raise ValueError(f"{names.count(name)} policies are called {name!r}; allowed with --out: each name once")
    return [open_run_folder(out / name, "") for name in names]


def evaluated(policy: str, options: argparse.Namespace, kept: Path | None) -> str:
    """One policy's verdict as text; files in the folder given.

    Raises:
        ValueError: for an unknown policy or one that does not fit what it is asked for.
        TypeError: for arguments that its task does not have.
        OSError: for files that cannot be read or written.
    """
    from agents.noisy_actuators import NoisyActuators
    from agents.policy_file import load_policy
    from agents.run_folder import RESULT_PICTURE, RESULTS, versions, write_json

    actor, card = load_policy(policy)
    task = _task(card.task, {"insects": options.insects, "problem": options.problem, "pool_seed": options.pool_seed})
    if card.environment != task.environment:
        raise ValueError(f"the card of {policy} says {card.environment}, its task flies {task.environment}")
    card.require_fit(task.vector_env(1))
    flown = NoisyActuators(actor, options.noise) if options.noise else actor
    verdict = task.judge(flown)
    title = f"{policy}: {card.algorithm} on {card.environment}, {card.wingbeats:,} wingbeats, seed {card.seed}"
    text, results = f"{title}\n{verdict.text}", dict(verdict.results)
    if options.robustness:
        shaken, told = _robustness(actor, task)
        text, results = f"{text}\n\n{told}", {**results, "robustness": shaken}
    if options.costs:
        costs, told = _costs(actor, task, card.wingbeats)
        text, results = f"{text}\n\n{told}", {**results, "costs": costs}
    if kept is not None:
        scores = {"mean": verdict.mean, "worst": verdict.worst, "distance": task.distance}
        about = {"policy": Path(policy).name, "sha256": card.sha256, "noise": options.noise, "verdict": scores}
        write_json(kept / RESULTS, {**about, **results, "versions": versions()})
        task.draw(flown).savefig(kept / RESULT_PICTURE)
        text += f"\nkept in {kept}"
    return text + "\n"


def _task(described: Mapping[str, Any], asked: Mapping[str, Any]) -> Any:
    """The task of a card with other arguments where they are asked for."""
    from agents.presets import Preset
    from agents.tasks import TASKS
    from flapenv.aero.checks import require_name

    own = {name: value for name, value in described.items() if name != "name"}
    own |= {name: value for name, value in asked.items() if value is not None}
    name = require_name("task", described.get("name"), TASKS)
    if name == "random-wings" and own.get("insects"):  # a policy for every wing flies named ones, too
        name, own = "hover", {key: own[key] for key in ("insects", "problem") if key in own}
    return Preset(task=name, arguments=own, settings=None).make_task()


def _robustness(actor: Any, task: Any) -> tuple[dict[str, Any], str]:
    """Noise and other models, of policies of named insects in Hover."""
    from agents.robustness import robustness
    from agents.tasks import HoverTask

    if not isinstance(task, HoverTask):
        raise ValueError(f"--robustness is not told of {task.environment} here; allowed: policies of named insects")
    return robustness(actor, task.insects, task.problem)


def _costs(actor: Any, task: Any, wingbeats: int) -> tuple[Any, str]:
    """What a new wing costs, of policies for random wings."""
    from agents.tasks import RandomWingsTask
    from agents.wing_costs import costs_of

    if not isinstance(task, RandomWingsTask):
        raise ValueError(f"--costs are not told of {task.environment} with named insects; allowed: random wings")
    return costs_of(actor, task.problem, wingbeats)


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
