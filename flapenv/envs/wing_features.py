"""What an observation tells of a wing and its task, alike in every environment that hovers."""

import math

import numpy as np

from flapenv.aero.parameters import StrokeReference
from flapenv.case import HoverCase
from flapenv.performance import yardstick
from flapenv.problem import HoverProblem, StrokeBox

OBSERVATION_LIMIT = 5.0
AMPLITUDE_0, AMPLITUDE_1 = math.radians(67.5), math.radians(22.5)
"""Middle and half-range of the observed bounds of φmax [rad]."""


def wing_features(cases: HoverCase, r1_hat: np.ndarray, problem: HoverProblem) -> tuple[np.ndarray, np.ndarray]:
    """The features of several wings, and the power that felt power is measured in.

    Args:
        cases: the wings' numbers, array fields of shape (n,).
        r1_hat: r̂₁, shape (n,) [-].
        problem: the model, and the box whose bounds may differ from wing to wing.

    Returns:
        AR - 4, (r̂₁ - 0.51)/0.04, log Λ_ref and the varying bounds in the units of an action, as observed, shape
        (n, k); and P*_felt [W/kg], shape (n,).

    Raises:
        ValueError: for coefficients that lift nothing at 35°.
    """
    weight_support, felt_power = yardstick(cases, problem.model)
    if not np.all(weight_support > 0):
        raise ValueError("coefficients lift nothing at an angle of attack of 35°; allowed: a lift to fly on")
    features = [cases.aspect_ratio - 4, (r1_hat - 0.51) / 0.04, np.log(weight_support)]
    features += _varying_bounds(problem.box, cases.reference)
    return seen(np.stack(features, axis=-1)), np.asarray(felt_power)


def seen(values: np.ndarray) -> np.ndarray:
    """Values as an observation shows them: float32, within ±`OBSERVATION_LIMIT`."""
    return np.clip(values, -OBSERVATION_LIMIT, OBSERVATION_LIMIT).astype(np.float32, copy=False)


def _varying_bounds(box: StrokeBox, reference: StrokeReference) -> list[np.ndarray]:
    """Bounds that differ from wing to wing in the units of an action; a fixed parameter has one."""
    bounds = []
    if not box.is_relative("frequency"):  # the same in Hz is another multiple of every wing's own
        ends = box.bounds("frequency", reference)
        bounds += [np.log(end / reference.frequency) for end in ends[: 1 + box.is_free("frequency")]]
    if box.is_relative("flap_amplitude"):
        ends = box.bounds("flap_amplitude", reference)
        bounds += [(end - AMPLITUDE_0) / AMPLITUDE_1 for end in ends[: 1 + box.is_free("flap_amplitude")]]
    return bounds
