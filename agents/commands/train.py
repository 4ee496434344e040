"""`python train.py`: train one policy by a preset."""

import argparse
import shlex
import sys
from pathlib import Path
from typing import Any

from agents.commands.one_line_parser import OneLineParser, folder, said
from agents.run_folder import CONFIG, RECIPE
from flapenv.aero.checks import allowed, shown

CONFIG_KEYS = ("preset", "seed", "environment", "task", "algorithm", "settings", "command", "versions")
"""Of a config.json; `environment`, `command` and `versions` are told, not asked for."""
UNCOUNTED = ("--quiet", "--no-report")
"""Options that change nothing about what is learned."""
UNCOUNTED_VALUES = ("--out", "--checkpoint-seconds")
"""The same of options with a value."""
BESIDE_RESUME = ("resume", "quiet", "no_report", "checkpoint_seconds")
"""Options that can be told of a run that goes on."""


def parser() -> argparse.ArgumentParser:
    """The command line."""
    from agents.presets import DEFAULT_PRESET, PRESETS
    from flapenv import INSECTS, PROBLEMS

    budget = PRESETS[DEFAULT_PRESET].settings.wingbeats
    made = OneLineParser(
        prog="train.py",
        description=(
            "Train a policy that hovers with the least power, and compare it with the proven optimum and CFD.\n\n"
            "With no argument: one policy for all eight insects, from random weights, on the CPU, in a few minutes."
        ),
        epilog=(
            "examples:\n"
            "  python train.py                              all eight insects, seed 0, into runs/hover-ppo-seed0/\n"
            "  python train.py --seed 1 --out runs/second   another seed, a folder of your own\n"
            "  python train.py --insects hawkmoth fruitfly --wingbeats 500000\n"
            "  python train.py --wing docs/examples/robot.json   your own wing, within its limits\n"
            "  python train.py --preset random-wings-ppo    one policy for every wing; see --list\n"
            "  python train.py --set rows=4096 --set learning_rate=0.001\n"
            "  python train.py --resume runs/second         goes on with a run that was stopped or killed\n\n"
            "other commands, each with its own --help:\n"
            "  python train.py evaluate hover               a shipped policy, or a run's, judged again\n"
            "  python train.py explore                      a page on which one moves a stroke and sees its cost\n"
            "  python train.py benchmark                    every learner and every task, five seeds each\n"
            "  python train.py sweep                        seeds, presets, problems, searches; on a cluster too\n"
            "  python train.py optimum hawkmoth             the best stroke and its proven bound, without learning\n"
            "  python train.py compare                      optimisers on the same strokes, with equal budgets\n\n"
            "a run folder holds config.json, results.json, the policy (policy.safetensors with its card policy.json,\n"
            "and Stable-Baselines3's policy.zip), curve.csv, TensorBoard logs, two pictures and report.html, one\n"
            "page that shows it all; Ctrl-C stops early, keeps what was learned and prints the comparison for it.\n"
            "A run that was stopped or killed, whenever that was, goes on from its checkpoint with --resume DIR and\n"
            "ends as if nothing had happened"
        ),
    )
    made.add_argument(
        "--preset", metavar="NAME", help=f"recipe: task and learner, see --list (default {DEFAULT_PRESET})"
    )
    made.add_argument(
        "--algorithm", metavar="NAME", help=f"the hover preset of {', '.join(hover_learners())}; in place of --preset"
    )
    made.add_argument("--list", action="store_true", help="list all presets and end")
    made.add_argument("--config", type=folder, metavar="FILE", help="a run's config.json; in place of --preset")
    made.add_argument("--seed", type=int, metavar="N", help="of networks, noise and draws (default 0)")
    made.add_argument(
        "--out", type=folder, metavar="DIR", help="folder of the run, new or empty (default runs/PRESET-seedN/)"
    )
    made.add_argument(
        "--insects", nargs="+", metavar="NAME", help=f"of {', '.join(INSECTS)} (default all); of tasks that name them"
    )
    made.add_argument(
        "--wing", type=folder, action="append", metavar="FILE", help="your own wing, in place of --insects; repeatable"
    )
    made.add_argument(
        "--problem", metavar="NAME", help=f"of {', '.join(PROBLEMS)} (default the first); of tasks that have one"
    )
    made.add_argument("--leave-out", metavar="NAME", help="an insect whose like is not trained on; of random wings")
    made.add_argument(
        "--wingbeats", type=int, metavar="N", help=f"training budget (default the preset's; {budget:,} for the default)"
    )
    made.add_argument(
        "--set",
        action="append",
        default=[],
        metavar="NAME=VALUE",
        dest="settings",
        help="of the learner; repeatable",
    )
    made.add_argument(
        "--resume", type=folder, metavar="DIR", help="go on with the run in DIR; its config says the rest"
    )
    made.add_argument(
        "--checkpoint-seconds",
        type=float,
        metavar="S",
        help="between two checkpoints, at least (default 5); they never take more than a hundredth of the time",
    )
    made.add_argument("--no-report", action="store_true", help="no report.html")
    made.add_argument("--quiet", action="store_true", help="no progress bar")
    return made


def train_command(arguments: list[str]) -> int:
    """Train as the command line says; 0 on success, 1 where training diverged, 2 for bad input, 130 after Ctrl-C."""
    options = parser().parse_args(arguments)
    if options.list:
        print(presets_table())
        return 0
    try:
        command = shlex.join(["python", "train.py", *what_counts(arguments)])
        config = config_of(options, command) if options.resume is None else resumed_config(options)
        from agents.training import summary, train

        apart = options.checkpoint_seconds
        result = train(
            config,
            options.out if options.resume is None else options.resume,
            progress=not options.quiet,
            report=not options.no_report,
            resume=options.resume is not None,
            **({} if apart is None else {"checkpoint_seconds": apart}),
        )
    except (ValueError, TypeError, OSError, ArithmeticError, MemoryError) as mistake:
        print(f"train.py: {said(mistake)}", file=sys.stderr)
        return 1 if isinstance(mistake, ArithmeticError) else 2
    print(summary(result), flush=True)
    return 130 if result.interrupted else 0


def what_counts(arguments: list[str]) -> list[str]:
    """The arguments that a run depends on: not where it is kept, nor what it shows."""
    kept, rest = [], iter(arguments)
    for one in rest:
        name, _, value = one.partition("=")
        if one in UNCOUNTED_VALUES:
            next(rest, None)
        elif one in ("--config", "--wing"):
            kept += [one, Path(next(rest, "")).name]  # not where on this machine it lies
        elif name in ("--config", "--wing"):
            kept.append(f"{name}={Path(value).name}")
        elif one not in UNCOUNTED and name not in UNCOUNTED_VALUES:
            kept.append(one)
    return kept


def config_of(options: argparse.Namespace, command: str) -> Any:
    """What the command line asks for, a `TrainingConfig`.

    Raises:
        ValueError: for unknown names or values that are not allowed.
        TypeError: for unknown keys or values of another kind.
        OSError: for a file that cannot be read.
    """
    from agents.presets import DEFAULT_PRESET, as_preset, setting_of
    from agents.training import TrainingConfig
    from flapenv.aero.checks import require_name

    given = [name for name in ("preset", "algorithm", "config") if getattr(options, name) is not None]
    if len(given) > 1:
        raise ValueError(f"--{given[0]} and --{given[1]} ask for two recipes; allowed: one of them")
    name, seed = DEFAULT_PRESET if options.preset is None else options.preset, 0
    if options.algorithm is not None:
        known = {algorithm.lower(): preset for algorithm, preset in hover_learners().items()}
        name = known[require_name("--algorithm", options.algorithm.lower(), known)]
    chosen: Any = name
    if options.config is not None:
        content = read_config(options.config, f"--config {options.config}")
        name, seed, chosen = content["preset"], content["seed"], recipe(content)
    preset = as_preset(chosen)
    own = {"insects": options.insects, "problem": options.problem, "leave_out": options.leave_out}
    task = {key: value for key, value in own.items() if value is not None}
    if options.wing is not None:
        task |= own_wings(options, preset)
    settings = dict(setting_of(text) for text in options.settings)
    if options.wingbeats is not None:
        settings["wingbeats"] = options.wingbeats
    seed = seed if options.seed is None else options.seed
    return TrainingConfig(preset=preset.changed(task, settings), name=name, seed=seed, command=command)


def own_wings(options: argparse.Namespace, preset: Any) -> dict[str, Any]:
    """Insects and problem of the hover task for the wings in files, within their limits.

    Raises:
        ValueError: beside --insects, for another task, or for wings whose limits differ.
        TypeError: for files with values of another kind.
        OSError: for files that cannot be read.
    """
    from flapenv.files import read_wing
    from flapenv.files.envelope import errors_of
    from flapenv.problem import as_problem

    if options.insects is not None:
        raise ValueError("--insects and --wing both say what flies; allowed: one of them")
    if preset.task != "hover":
        raise ValueError(f"--wing is not told of task {shown(preset.task)}; allowed: 'hover', see --list")
    base = as_problem(preset.arguments.get("problem") if options.problem is None else options.problem)
    files, problems = [read_wing(path) for path in options.wing], []
    for path, one in zip(options.wing, files, strict=True):
        with errors_of(path):
            problems.append(one.problem(base))
    for path, problem in zip(options.wing, problems, strict=True):
        if problem != problems[0]:
            raise ValueError(
                f"--wing {path} has other limits than {options.wing[0]}; allowed: equal ones, as one policy has one box"
            )
    return {"insects": [one.insect for one in files], "problem": problems[0]}


def hover_learners() -> dict[str, str]:
    """Learners with a hover preset of their name, and that name."""
    from agents.presets import ALGORITHMS, PRESETS

    names = {algorithm: f"hover-{algorithm.lower()}" for algorithm in ALGORITHMS}
    return {algorithm: name for algorithm, name in names.items() if name in PRESETS}


def resumed_config(options: argparse.Namespace) -> Any:
    """The `TrainingConfig` of a run that goes on.

    Raises:
        ValueError: beside an option that asks for another run, and for a config that is not one.
        TypeError: for unknown keys or values of another kind.
        OSError: if it cannot be read.
    """
    from agents.training import TrainingConfig

    given = {
        name: value for name, value in vars(options).items() if value is not None and value is not False and value != []
    }
    beside = [name for name in given if name not in BESIDE_RESUME]
    if beside:
        told = f"--{beside[0].replace('_', '-')}" if beside[0] != "settings" else "--set"
        raise ValueError(f"--resume and {told} ask for two runs; allowed: --resume, and how to show it")
    path = options.resume / CONFIG
    content = read_config(path, str(path))
    return TrainingConfig(
        preset=recipe(content), name=content["preset"], seed=content["seed"], command=content["command"]
    )


def read_config(path: Path, called: str) -> dict[str, Any]:
    """What a config.json says, with "preset", "seed" and "command" whether they are there or not.

    Args:
        path: of the file.
        called: how errors call it.

    Raises:
        ValueError: for what is not JSON, or lacks a key.
        TypeError: for an unknown key.
        OSError: if the file cannot be read.
    """
    from agents.presets import as_preset
    from flapenv.read_json import read_object

    content = read_object(path, called=called, mend="a config.json as a run writes it")
    for key in content:
        if key not in CONFIG_KEYS:
            raise TypeError(f"{called} has an unknown key {shown(key)}; {allowed(key, CONFIG_KEYS)}")
    missing = [key for key in RECIPE if key not in content]
    if missing:
        raise ValueError(f"{called} lacks {', '.join(missing)}; allowed: a config.json as a run writes it")
    told = content.get("environment")
    if told is not None and told != (flies := as_preset(recipe(content)).make_task().environment):
        raise ValueError(f"{called} has environment = {shown(told)}; allowed: {flies!r}, which its task flies")
    return {"preset": "", "seed": 0, "command": "", **content}


def recipe(content: dict[str, Any]) -> dict[str, Any]:
    """The part of a config that is a preset."""
    return {key: content[key] for key in RECIPE}


def presets_table() -> str:
    """Every preset with its task, learner and budget."""
    from agents.presets import PRESETS
    from flapenv.tables import text_table

    rows: list[tuple[str, ...]] = [("preset", "environment", "judged by", "learner", "wingbeats")]
    for name, preset in PRESETS.items():
        task = preset.make_task()
        learner = preset.settings
        rows.append((name, task.environment, task.distance, learner.algorithm, f"{learner.wingbeats:,}"))
    return text_table(rows)
