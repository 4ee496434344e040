"""The largest weight support of free waveforms.

At a given mean speed ⟨φ̇|φ̇| sin 2θ⟩ <= ⟨φ̇²⟩, and ⟨φ̇²⟩ is a convex function of the speed coefficients whose sum is
given: it is largest in a corner, where each is either the smallest or the largest allowed. The corner with one large
coefficient in mid-stroke, with θ at 45° or as near as the limit lets it, lifts within 1 % of the most that was found
(tests).
"""

import math

import numpy as np

from flapenv.case import HoverCase
from flapenv.problem import HoverProblem
from flapenv.waveform.coordinates import SPEED_FLOOR, Waveform, WaveformCoordinates
from flapenv.waveform.performance import PRECISE_POINTS, waveform_performance


def strongest(case: HoverCase, problem: HoverProblem, coordinates: WaveformCoordinates) -> Waveform:
    """The waveform of the largest lift known, at the largest f and φmax; scalar or array fields as the case has."""
    frequency, amplitude = (
        np.asarray(problem.box.bounds(name, case.reference)[1], dtype=float) for name in ("frequency", "flap_amplitude")
    )
    shape = (*np.broadcast_shapes(frequency.shape, amplitude.shape, np.shape(case.lift_scale)), coordinates.knots)
    speed = np.full(shape, SPEED_FLOOR)
    speed[..., coordinates.knots // 2] = 1.0
    pitch = np.full(shape, min(math.pi / 4, coordinates.pitch_limit))
    return Waveform(frequency, amplitude, speed, pitch)


def largest_weight_support(case: HoverCase, problem: HoverProblem, coordinates: WaveformCoordinates) -> np.ndarray:
    """Λ of `strongest` [-], of the case's shape."""
    weight, *_ = waveform_performance(case, problem.model, strongest(case, problem, coordinates), points=PRECISE_POINTS)
    return np.asarray(weight)
