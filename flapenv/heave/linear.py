"""The beat map about hovering, linear: what a controller is designed with."""

import numpy as np

from flapenv.aero.checks import record
from flapenv.heave.dynamics import HeaveDynamics

STEP = 1e-3
"""Of the central differences, in units of the action, R and U."""
STATES = ("height", "velocity", "gust")
OUTPUTS = ("height", "velocity", "weight_support", "specific_power")


@record
class LinearBeat:
    """First-order change of what a beat comes to, from hovering in still air, by how it begins and by the action.

    Rows are height z/R and velocity w/U at the end of the beat, Λ and P*/P*_hover over it.

    Attributes:
        by_state: derivatives by z/R, w/U and w_g/U, shape (4, 3) [-].
        by_action: derivatives by every axis of the action, shape (4, n) [-]; one-sided where hovering lies on the
            edge of the box.
        hover: the action that hovers, shape (n,).
    """

    by_state: np.ndarray
    by_action: np.ndarray
    hover: np.ndarray


def worth_of_motion(beat: LinearBeat, axis: int) -> tuple[float, float]:
    """What a unit of z/R and of w/U at the end of a beat is worth, p_z and p_w [beats of hovering].

    Hovering is a stationary point of the power to come when both prices satisfy

        p_w = -∂c/∂w + p_z ∂z'/∂w + p_w ∂w'/∂w,      0 = -∂c/∂u + p_z ∂z'/∂u + p_w ∂w'/∂u,

    c = P*/P*_hover of a beat, primes its end, u the cheapest input: to first order no way of letting go or of climbing
    pays (the discrete adjoint of the beat map). Beyond first order it costs, as P* ∝ Λ^1.5 is convex.

    Args:
        beat: the linear beat map.
        axis: u, of the action.
    """
    (z_w, w_w), c_w = beat.by_state[:2, 1], beat.by_state[3, 1]
    (z_u, w_u), c_u = beat.by_action[:2, axis], beat.by_action[3, axis]
    height, velocity = np.linalg.solve([[z_w, w_w - 1], [z_u, w_u]], [c_w, c_u])
    return float(height), float(velocity)


def linear_beat(dynamics: HeaveDynamics, index: int) -> LinearBeat:
    """The linear part of the beat map of one insect, by differences in double precision.

    Args:
        dynamics: the map, of float64.
        index: which of its insects.
    """
    hover = np.clip(dynamics.trim_actions()[index], -1, 1)
    states = STEP * np.concatenate([np.eye(3), -np.eye(3)])
    size = len(hover)
    ahead = np.minimum(hover + STEP * np.eye(size), 1)
    behind = np.maximum(hover - STEP * np.eye(size), -1)
    actions = np.concatenate([np.tile(hover, (6, 1)), ahead, behind])
    starts = np.concatenate([states, np.zeros((2 * size, 3))])
    rows = np.full(len(actions), index)
    strokes, _ = dynamics.decode(actions, rows)
    beat = dynamics.beat(rows, strokes, *starts.T)
    found = np.stack([getattr(beat, name) for name in OUTPUTS])
    found[-1] /= dynamics.trim.specific_power[index]
    by_state = (found[:, :3] - found[:, 3:6]) / (2 * STEP)
    widths = np.diagonal(ahead) - np.diagonal(behind)
    by_action = (found[:, 6 : 6 + size] - found[:, 6 + size :]) / widths
    return LinearBeat(by_state=by_state, by_action=by_action, hover=hover)
