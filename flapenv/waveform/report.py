"""What free waveforms reach, as tables and pictures; all from the shipped waveforms, nothing is searched for."""

import math
from pathlib import Path

import numpy as np

from flapenv.aero.motions import Motion
from flapenv.case import hover_case, stack_cases
from flapenv.insects import INSECTS, load_insect
from flapenv.optimum import lower_bound, optimum
from flapenv.problem import PROBLEMS
from flapenv.tables import text_table
from flapenv.waveform.coordinates import WaveformCoordinates
from flapenv.waveform.largest_lift import largest_weight_support
from flapenv.waveform.performance import evaluate_waveform
from flapenv.waveform.pictures import (
    best_motion,
    draw_away_from_the_triangle,
    draw_towards_the_triangle,
    draw_waveform,
)
from flapenv.waveform.shipped import KnownOptimum, known_optimum, shipped_waveforms

SAMPLES = 100_000
"""Instants a cycle that the peaks of a motion are sought at."""


def shipped_knots() -> tuple[int, ...]:
    """Numbers of knots that waveforms are shipped for."""
    return tuple(sorted({row.knots for row in shipped_waveforms()}))


def knots_table(insect: str = INSECTS[0]) -> str:
    """Problem A, the same for every wing: what each number of knots costs and how fast it turns."""
    rows: list[tuple[str, ...]] = [("free-frequency, every wing", "P*/bound", "gap %", "φ̈max/ω²", "θ̇max/ω")]
    bound, stroke = _bound(insect, "free-frequency"), optimum(insect)
    candidates: list[tuple[str, float, Motion]] = []
    for knots in shipped_knots():
        motion = best_motion(insect, "free-frequency", knots)
        candidates.append((f"{knots} knots", evaluate_waveform(insect, motion).specific_power, motion))
    candidates.append(("best of (2.1), (2.2)", stroke.specific_power, stroke.stroke))
    for name, power, found in candidates:
        peaks = (f"{peak:.2f}" for peak in _peaks(found))
        rows.append((name, f"{power / bound:.4f}", f"{100 * (power / bound - 1):.2f}", *peaks))
    return text_table(rows)


def insects_table(problem: str) -> str:
    """Least power by insect and number of knots, beside the bound and the best of (2.1), (2.2)."""
    every = shipped_knots()
    header = (f"{problem} [W/kg]", "bound", "(2.1), (2.2)", *(f"{n} knots" for n in every))
    rows: list[tuple[str, ...]] = [(*header, *(f"gap % {n}" for n in every))]
    for insect in INSECTS:
        best, bound = optimum(insect, problem), _bound(insect, problem)
        known = [_known(insect, problem, knots) for knots in every]
        rows.append(
            (
                insect,
                f"{bound:.2f}",
                f"{best.specific_power:.2f}" if best.feasible else "none",
                *("-" if one is None else f"{one.specific_power:.2f}" for one in known),
                *("-" if one is None else f"{100 * (one.specific_power / bound - 1):.1f}" for one in known),
            )
        )
    return text_table(rows)


def lift_table(problem: str = "fixed-frequency") -> str:
    """Largest weight support by insect and number of knots, and the peak rates of the best waveforms."""
    every, chosen = shipped_knots(), PROBLEMS[problem]
    header = ("", "Λ_max (2.1)", *(f"Λ_max {n}" for n in every), *(f"φ̈max/ω² {n}" for n in every))
    rows: list[tuple[str, ...]] = [(*header, *(f"θ̇max/ω {n}" for n in every))]
    cases = stack_cases([hover_case(load_insect(insect), chosen.model) for insect in INSECTS])
    largest = np.stack([largest_weight_support(cases, chosen, WaveformCoordinates(chosen, n)) for n in every], axis=-1)
    for insect, margins in zip(INSECTS, largest, strict=True):
        peaks = [_peaks(best_motion(insect, problem, knots)) for knots in every]
        rows.append(
            (
                insect,
                f"{optimum(insect, problem).max_weight_support:.3f}",
                *(f"{margin:.2f}" for margin in margins),
                *(f"{acceleration:.1f}" for acceleration, _ in peaks),
                *(f"{pitch_rate:.1f}" for _, pitch_rate in peaks),
            )
        )
    return text_table(rows)


def report() -> str:
    """All tables."""
    return "\n\n".join([knots_table(), insects_table("fixed-frequency"), lift_table(), insects_table("profile-drag")])


def write_pictures(folder: Path) -> list[Path]:
    """Draw what is found in A and in B to a folder."""
    folder.mkdir(parents=True, exist_ok=True)
    bumblebee = load_insect("bumblebee")
    figures = {
        "waveforms_free_frequency.png": draw_towards_the_triangle(),
        "waveforms_fixed_frequency.png": draw_away_from_the_triangle(),
        "waveform_bumblebee.png": draw_waveform(bumblebee, best_motion("bumblebee", "fixed-frequency", 8)),
    }
    for name, figure in figures.items():
        figure.savefig(folder / name)
    return [folder / name for name in figures]


def _known(insect: str, problem: str, knots: int) -> KnownOptimum | None:
    return known_optimum(hover_case(load_insect(insect), PROBLEMS[problem].model), PROBLEMS[problem], knots)


def _bound(insect: str, problem: str) -> float:
    return float(np.asarray(lower_bound(hover_case(load_insect(insect), PROBLEMS[problem].model), PROBLEMS[problem])))


def _peaks(motion: Motion) -> tuple[float, float]:
    """φ̈max/ω² and θ̇max/ω of any motion [rad]."""
    phase, omega = np.linspace(0, 2 * math.pi, SAMPLES), 2 * math.pi * motion.frequency
    acceleration, pitch_rate = motion.flap_acceleration(phase), motion.pitch_rate(phase)
    return float(np.max(np.abs(acceleration))) / omega**2, float(np.max(np.abs(pitch_rate))) / omega
