"""The search behind the table of shipped waveforms: eight insects, three problems, four numbers of knots."""

import csv
from pathlib import Path

import numpy as np

from flapenv.aero.spline_motion import SplineMotion
from flapenv.aero.splines import refined
from flapenv.case import hover_case
from flapenv.insects import INSECTS, load_insect
from flapenv.optimum import optimum
from flapenv.problem import PROBLEMS
from flapenv.waveform.coordinates import SPEED_FLOOR
from flapenv.waveform.optimum import SplineOptimum, spline_optimum
from flapenv.waveform.shipped import COLUMNS, known_optimum, wants

SEARCHES = {"free-frequency": INSECTS[:1], "fixed-frequency": INSECTS, "profile-drag": INSECTS}
"""The insects whose waveforms are searched; with f free and no profile drag one serves all."""
STARTS = {4: 48, 8: 32, 16: 16, 32: 8}
"""Starts by the number of knots a half-cycle, each twice the one before."""
UNBOUND = 1e-4
"""With f free and inside its bounds dP*/dΛ is 1.5 P*; a waveform that misses this by more serves no other wing."""


def refined_motion(motion: SplineMotion) -> SplineMotion:
    """The motion on twice the knots, its speeds lifted to the floor."""
    speed = refined(np.array(motion.speed_coefficients))
    speed = np.maximum(np.abs(speed), SPEED_FLOOR * np.max(np.abs(speed)))
    return SplineMotion(
        frequency=motion.frequency,
        flap_amplitude=motion.flap_amplitude,
        speed_coefficients=speed.tolist(),
        pitch_coefficients=refined(np.array(motion.pitch_coefficients)).tolist(),
    )


def search_all() -> list[tuple[str, SplineOptimum]]:
    """The best waveform of every problem, insect and number of knots.

    Each search also starts from the best waveform of half the knots, from that of the insect before, in the order of
    the lift they need, and from the one that is shipped, so that searching again never loses: power has many local
    minima where f is fixed.
    """
    found = []
    for problem, insects in SEARCHES.items():
        coarser: dict[str, SplineMotion] = {}
        for knots, starts in STARTS.items():
            before: tuple[SplineMotion, ...] = ()
            for insect in sorted(insects, key=lambda name: -optimum(name, problem).max_weight_support):
                guesses = before + ((coarser[insect],) if insect in coarser else ()) + _shipped(problem, insect, knots)
                best = spline_optimum(insect, problem, knots=knots, starts=starts, guesses=guesses)
                found.append((problem, best))
                coarser[insect], before = refined_motion(best.motion), (best.motion,)
    return found


def _shipped(problem: str, insect: str, knots: int) -> tuple[SplineMotion, ...]:
    """The waveform that the present table has, if any."""
    case = hover_case(load_insect(insect), PROBLEMS[problem].model)
    known = known_optimum(case, PROBLEMS[problem], knots)
    return () if known is None else (known.waveform.motion(),)


def write_table(path: Path) -> None:
    """Search and write the CSV, but for waveforms found with the frequency at one of its bounds."""
    found = search_all()
    with path.open("w", encoding="utf-8", newline="") as file:
        file.write(
            "# best free waveforms, written by python -m flapenv.waveform --data; see flapenv.waveform.shipped\n"
        )
        writer = csv.writer(file, lineterminator="\n")
        writer.writerow(COLUMNS)
        for name, best in found:
            problem = PROBLEMS[name]
            wanted = wants(hover_case(load_insect(best.insect), problem.model), problem)
            if wanted is None:
                raise ArithmeticError(f"{name}: no wing shares its waveform with others")
            kind, ratio, needed = wanted
            cost, motion = best.multiplier / best.specific_power, best.motion
            if kind == "free" and abs(cost - 1.5) > UNBOUND:
                continue
            writer.writerow(
                [
                    kind,
                    name,
                    best.insect if len(SEARCHES[name]) > 1 else "any",
                    best.knots,
                    repr(problem.box.pitch_amplitude[1]),
                    repr(ratio),
                    repr(needed),
                    f"{cost:.9g}",
                    " ".join(f"{w:.9g}" for w in motion.speed_coefficients),
                    " ".join(f"{theta:.9g}" for theta in motion.pitch_coefficients),
                ]
            )
