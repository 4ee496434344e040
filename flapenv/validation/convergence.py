"""How far the numbers are converged: the blade element in strips and in steps, the lifting line in terms."""

from collections.abc import Sequence

import numpy as np

from flapenv.aero.induced import k_ind
from flapenv.insects import load_insect
from flapenv.performance import evaluate
from flapenv.simulation import evaluate_by_blade_element

STRIPS = (6, 12, 25, 50, 100, 200, 400, 800)
STEPS = (8, 16, 32, 64, 125, 250, 500)
TERMS = (8, 16, 32, 64, 128)
FINEST_TERMS = 512


def strip_errors(insect: str, strips: Sequence[int] = STRIPS) -> np.ndarray:
    """Relative error of Λ and P* of the own stroke with even strips, steps converged; shape (n, 2) [-]."""
    exact = np.array(_exact(insect))
    return np.array([np.array(evaluate_by_blade_element(insect, strips=n, steps=1000)) / exact - 1 for n in strips])


def step_errors(insect: str, steps: Sequence[int] = STEPS) -> np.ndarray:
    """Relative error of Λ and P* of the own stroke with even steps, span exact; shape (n, 2) [-]."""
    exact = np.array(_exact(insect))
    return np.array(
        [np.array(evaluate_by_blade_element(insect, strips=4, steps=n, spacing="gauss")) / exact - 1 for n in steps]
    )


def term_errors(insect: str, terms: Sequence[int] = TERMS) -> np.ndarray:
    """Error of k_ind against `FINEST_TERMS` terms, shape (n,) [-]."""
    wing = load_insect(insect).wing
    return np.array([k_ind(wing, terms=n) for n in terms]) - k_ind(wing, terms=FINEST_TERMS)


def _exact(insect: str) -> tuple[float, float]:
    """Λ and P* of the fast path."""
    ours = evaluate(insect, tolerance=1e-12)
    return ours.weight_support, ours.specific_power
