"""The search behind the table of shipped waveforms: eight insects, three problems, four numbers of knots."""

import csv
from pathlib import Path

import numpy as np

from flapenv.aero.spline_motion import SplineMotion
from flapenv.aero.splines import refined
from flapenv.case import hover_case
from flapenv.insects import INSECTS, load_insect
from flapenv.problem import PROBLEMS
from flapenv.waveform.coordinates import SPEED_FLOOR
from flapenv.waveform.optimum import SplineOptimum, spline_optimum
from flapenv.waveform.shipped import COLUMNS, wants

KNOTS = (4, 8, 16, 32)
"""Numbers of knots a half-cycle that are searched, each twice the one before."""
SEARCHES = {"free-frequency": INSECTS[:1], "fixed-frequency": INSECTS, "profile-drag": INSECTS}
"""The insects whose waveforms are searched; with f free and no profile drag one serves all."""
STARTS = 16
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
    """The best waveform of every problem, insect and number of knots, each from that of half the knots besides."""
    found = []
    for problem, insects in SEARCHES.items():
        for insect in insects:
            guesses: tuple[SplineMotion, ...] = ()
            for knots in KNOTS:
                best = spline_optimum(insect, problem, knots=knots, starts=STARTS, guesses=guesses)
                found.append((problem, best))
                guesses = (refined_motion(best.motion),)
    return found


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
