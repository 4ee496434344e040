"""The beat map about hovering, linear: what a controller is designed with."""

import numpy as np

from flapenv.aero.checks import record
from flapenv.heave.dynamics import HeaveDynamics

STEP = 1e-3
"""Of the central differences, in units of the action, R and U."""
POWER_CURVATURE = 0.75
"""d²P*/dΛ² over P*_hover of the best strokes, P* ∝ Λ^1.5."""
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


@record
class WorthOfMotion:
    """What height and velocity at the end of an episode are worth, p·x - x·S x for x = (z/R, w/U) [beats of hovering].

    Attributes:
        price: p, shape (2,).
        curvature: S, shape (2, 2), symmetric.
    """

    price: np.ndarray
    curvature: np.ndarray


def worth_of_motion(beat: LinearBeat, axis: int, height_cost: float) -> WorthOfMotion:
    """The power and the height still to be paid for after hovering has been left, to second order.

    Hovering is a stationary point of what is to come when the prices satisfy (the discrete adjoint of the beat map)

        p_w = -∂c/∂w + p_z ∂z'/∂w + p_w ∂w'/∂w,      0 = -∂c/∂u + p_z ∂z'/∂u + p_w ∂w'/∂u,

    c = P*/P*_hover of a beat, primes its end, u the cheapest input: to first order no way of letting go or of climbing
    pays. Coming back costs x·S x, the least of Σ height_cost (z/R)² + ½ ¾ (Λ_u u)² on the linear map, where P* ∝ Λ^1.5
    has the curvature ¾: the solution of a discrete algebraic Riccati equation.

    Args:
        beat: the linear beat map.
        axis: u, of the action.
        height_cost: charged a beat for (z/R)² = 1 [-].
    """
    from scipy.linalg import solve_discrete_are

    (z_w, w_w), c_w = beat.by_state[:2, 1], beat.by_state[3, 1]
    (z_u, w_u), c_u = beat.by_action[:2, axis], beat.by_action[3, axis]
    price = np.linalg.solve([[z_w, w_w - 1], [z_u, w_u]], [c_w, c_u])
    strain = 0.5 * POWER_CURVATURE * float(beat.by_action[2, axis]) ** 2
    way = beat.by_state[:2, :2], beat.by_action[:2, axis : axis + 1]
    return WorthOfMotion(
        price=price, curvature=solve_discrete_are(*way, np.diag([height_cost, 0.0]), np.array([[strain]]))
    )


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
