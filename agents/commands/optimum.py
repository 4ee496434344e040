"""`python train.py optimum`: the stroke of least power of insects and of one's own wings, with its proven bound."""

import argparse
import json
import sys
from pathlib import Path
from typing import TYPE_CHECKING

from agents.commands.one_line_parser import OneLineParser, folder, said

if TYPE_CHECKING:
    from flapenv import HoverProblem, Insect, Optimum

Solved = tuple["Insect", "HoverProblem", "Optimum"]


def parser() -> argparse.ArgumentParser:
    """The command line."""
    from flapenv import INSECTS, PROBLEMS

    made = OneLineParser(
        prog="train.py optimum",
        description=(
            "The stroke that hovers with the least power, beside the power that no stroke of the box can go below\n"
            "(proven), and how it was verified. Nothing is learned and nothing is kept but with --out."
        ),
        epilog=(
            "examples:\n"
            "  python train.py optimum                                  the eight insects\n"
            "  python train.py optimum hawkmoth --problem profile-drag\n"
            "  python train.py optimum --wing docs/examples/robot.json  your own wing, within its limits\n"
            "  python train.py optimum --out optima.csv                 keep the strokes, as JSON or CSV"
        ),
    )
    made.add_argument("insects", nargs="*", metavar="INSECT", help=f"of {', '.join(INSECTS)} (default all)")
    made.add_argument(
        "--wing", type=folder, action="append", default=[], metavar="FILE", help="your own wing; repeatable"
    )
    made.add_argument("--problem", metavar="NAME", help=f"of {', '.join(PROBLEMS)} (default the first)")
    made.add_argument("--out", type=folder, metavar="FILE", help="keep the strokes in FILE.json or FILE.csv")
    return made


def optimum_command(arguments: list[str]) -> int:
    """Solve and print; 0 on success, 2 for bad input."""
    options = parser().parse_args(arguments)
    try:
        asked = cases(options)
        check_out(options.out, [insect for insect, _ in asked])
        solved = [solve(*one) for one in asked]
        print(report(solved), flush=True)
        if options.out is not None:
            keep(solved, options.out)
            print(f"kept in {options.out}")
    except (ValueError, TypeError, OSError, ArithmeticError, MemoryError) as mistake:
        print(f"train.py optimum: {said(mistake)}", file=sys.stderr)
        return 2
    return 0


def cases(options: argparse.Namespace) -> list[tuple["Insect", "HoverProblem"]]:
    """What is to be solved: named insects, wings in files, or all eight insects.

    Raises:
        ValueError: for an unknown name, two of one name, or a problem that needs wing masses which are not known.
        TypeError: for files with values of another kind.
        OSError: for files that cannot be read.
    """
    from flapenv import INSECTS, load_insect
    from flapenv.aero.checks import shown
    from flapenv.files import read_wing
    from flapenv.files.envelope import errors_of
    from flapenv.problem import as_problem

    base = as_problem(options.problem)
    everything = not options.insects and not options.wing
    found = [(load_insect(name), base) for name in (INSECTS if everything else options.insects)]
    weighed = base.model.accounting == "positive"
    if everything and weighed:
        light = [insect.name for insect, _ in found if insect.wing.mass is None]
        print(f"left out, as their wing masses are not known: {', '.join(light)}", file=sys.stderr)
        found = [(insect, base) for insect, _ in found if insect.wing.mass is not None]
    for path in options.wing:
        wing = read_wing(path)
        with errors_of(path):
            found.append((wing.insect, wing.problem(base)))
    names = [insect.name for insect, _ in found]
    for insect, _ in found:
        if names.count(insect.name) > 1:
            raise ValueError(f"{names.count(insect.name)} are called {shown(insect.name)}; allowed: each name once")
        if weighed and insect.wing.mass is None:
            raise ValueError(f"problem = {shown(base.name)} needs wing masses, which {insect.name} lacks")
    return found


def check_out(out: Path | None, insects: list["Insect"]) -> None:
    """Refuse a file that could not be written, before anything is solved.

    Raises:
        ValueError: for another ending, or insects that a CSV file cannot hold.
        OSError: for a folder that is not there.
    """
    from flapenv.files.strokes import NamedStroke, require_writable

    if out is not None:
        require_writable(out, [NamedStroke(stroke=insect.stroke, insect=insect) for insect in insects])


def solve(insect: "Insect", problem: "HoverProblem") -> Solved:
    """The optimum of one insect.

    Raises:
        TypeError, ValueError: as `flapenv.optimum`, with the insect's name.
    """
    from flapenv import optimum
    from flapenv.files.envelope import errors_of

    with errors_of(insect.name):
        return insect, problem, optimum(insect, problem)


def report(solved: list[Solved]) -> str:
    """What people read: a table for each problem, what no CFD covers, and how everything was verified."""
    from agents.evaluation.assessment_table import outside_sentences
    from flapenv.assessment import assess

    tables: dict[str, list[Solved]] = {}
    for one in solved:
        tables.setdefault(json.dumps(one[1].to_dict(), sort_keys=True), []).append(one)
    parts = [table(rows) for rows in tables.values()]
    outside = outside_sentences([assess(insect, best.stroke, problem) for insect, problem, best in solved])
    ways: dict[str, list[str]] = {}
    for insect, _, best in solved:
        ways.setdefault(best.verification, []).append(insect.name)
    verified = [f"verified ({', '.join(names)}): {way}" for way, names in ways.items()]
    return "\n\n".join(part for part in (*parts, outside, "\n".join(verified)) if part)


def table(solved: list[Solved]) -> str:
    """The optima of one problem, and below them what cannot hover."""
    from flapenv.aero.parameters import STROKE_PARAMETERS
    from flapenv.problem_tables import HEADER, cells
    from flapenv.tables import text_table

    rows: list[tuple[str, ...]] = [(f"{solved[0][1].name}", "weight", *HEADER, "at bounds")]
    for insect, _, best in solved:
        bounds = " ".join(f"{STROKE_PARAMETERS[name].symbol}:{end}" for name, end in best.active_bounds)
        rows.append((insect.name, f"{best.weight_support:.4f}", *cells(best), bounds or "none"))
    infeasible = [
        f"{insect.name} is INFEASIBLE: no stroke of the box supports more than {best.max_weight_support:.3f} of its "
        "weight; its line is the stroke that supports the most"
        for insect, _, best in solved
        if not best.feasible
    ]
    return "\n".join([text_table(rows), *infeasible])


def keep(solved: list[Solved], out: Path) -> None:
    """Write the strokes.

    Raises:
        OSError: if they cannot be written.
    """
    from flapenv.files import NamedStroke, write_strokes

    write_strokes(out, [NamedStroke(stroke=best.stroke, insect=insect) for insect, _, best in solved])
