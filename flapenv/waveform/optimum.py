"""The best free waveform of an insect in a problem, found by SLSQP with exact gradients from several starts."""

import importlib.util
import math
from typing import Any

import numpy as np

from flapenv.aero.checks import is_single, record, require_count
from flapenv.aero.spline_motion import SplineMotion
from flapenv.case import hover_case
from flapenv.insects import Insect, as_insect
from flapenv.optimum import lower_bound
from flapenv.problem import HoverProblem, as_problem
from flapenv.simulation import simulate
from flapenv.waveform.coordinates import Waveform, WaveformCoordinates
from flapenv.waveform.largest_lift import largest_weight_support, strongest
from flapenv.waveform.performance import PRECISE_POINTS, peak_rates, waveform_performance

STARTS = 8
"""Starts of the search, at least."""
ITERATIONS, PRECISION = 800, 1e-13
"""Of SLSQP, from each start."""
WEIGHT_TOLERANCE = 1e-7
"""Λ may miss 1 by this much where the weight counts as carried."""
ORACLE_STEPS, ORACLE_TOLERANCE = 20_000, 1e-5
"""Instants a cycle of the blade element that confirms the waveform, and the relative difference allowed."""


@record
class SplineOptimum:
    """The least power for hovering with n knots a half-cycle.

    Attributes:
        insect: its name.
        knots: n.
        feasible: whether any waveform carries the weight.
        motion: the best waveform found; the one of the largest lift where none carries the weight.
        weight_support: Λ of it [-].
        specific_power: P* of it [W/kg].
        lower_bound: proven, of every waveform within the problem's limits [W/kg].
        max_weight_support: the largest Λ known [-].
        multiplier: dP*/dΛ, what a unit of weight support costs [W/kg]; inf where infeasible.
        flap_acceleration: φ̈max/ω² [rad].
        pitch_rate: θ̇max/ω [rad].
        agreeing: how many of the starts ended within 1e-4 of the best.
        starts: how many there were.
        wingbeats: waveforms evaluated, each gradient counted as three.
    """

    insect: str
    knots: int
    feasible: bool
    motion: SplineMotion
    weight_support: float
    specific_power: float
    lower_bound: float
    max_weight_support: float
    multiplier: float
    flap_acceleration: float
    pitch_rate: float
    agreeing: int
    starts: int
    wingbeats: int

    @property
    def gap_to_bound(self) -> float:
        """P* over the lower bound, minus one [-]."""
        return self.specific_power / self.lower_bound - 1


def spline_optimum(
    insect: Insect | str,
    problem: HoverProblem | str | None = None,
    *,
    knots: int = 8,
    starts: int = STARTS,
    guesses: tuple[SplineMotion, ...] = (),
    seed: int = 0,
) -> SplineOptimum:
    """The least power with which an insect hovers on free waveforms of n knots a half-cycle.

    Minimises log P* subject to Λ >= 1 in the coordinates of the environment's actions.

    Args:
        insect: one insect (scalar fields) or a name of `INSECTS`.
        problem: a `HoverProblem` or a name of `PROBLEMS` that waveforms serve; problem A where None.
        knots: n.
        starts: how many, at least 8: sinusoidal, of constant speed, peaked, and random ones that lift,
            every second of them a short beat.
        guesses: motions of n knots to start from besides.
        seed: of the random starts.

    Returns:
        The best of all ends, confirmed by the blade element.

    Raises:
        ImportError: without torch, naming the extra to install.
        TypeError: for arguments of another kind, or an insect with array fields.
        ValueError: for an unknown name, a problem that waveforms do not serve, or too few starts.
        ArithmeticError: if the blade element does not confirm the waveform to 1e-5.
    """
    require_torch()
    insect, problem = as_insect(insect), as_problem(problem)
    require_count("starts", starts, STARTS)
    if not is_single(insect):
        raise TypeError("insect has array fields; allowed: one insect with scalar fields")
    problem.require_suitable(insect.name, insect.reference)
    search = _Search(insect, problem, knots)
    most = float(largest_weight_support(search.case, problem, search.coordinates))
    feasible = most >= 1 - WEIGHT_TOLERANCE
    point, agreeing = search.start(0), 0
    if feasible:
        places = [search.start(i, seed) for i in range(starts)]
        places += [search.coordinates.encode(_as_waveform(guess), insect.reference) for guess in guesses]
        ends = [end for end in map(search.descend, places) if end[0] < math.inf]
        if not ends:
            raise ArithmeticError(f"{insect.name}: no start led to a waveform of {knots} knots that hovers")
        best, point = min(ends, key=lambda end: end[0])
        agreeing = sum(end[0] < best + 1e-4 for end in ends)
        starts = len(places)
    else:
        point = search.coordinates.encode(strongest(search.case, problem, search.coordinates), insect.reference)
    waveform, _ = search.coordinates.decode(point, insect.reference)
    weight, power = (
        float(v) for v in waveform_performance(search.case, problem.model, waveform, points=PRECISE_POINTS)[:2]
    )
    motion = waveform.motion()
    _confirm(insect, problem, motion, weight, power)
    acceleration, pitch_rate = peak_rates(waveform)
    return SplineOptimum(
        insect=insect.name,
        knots=search.coordinates.knots,
        feasible=feasible,
        motion=motion,
        weight_support=weight,
        specific_power=power,
        lower_bound=float(np.asarray(lower_bound(search.case, problem))),
        max_weight_support=max(most, weight),
        multiplier=search.multiplier(point, power) if feasible else math.inf,
        flap_acceleration=float(acceleration),
        pitch_rate=float(pitch_rate),
        agreeing=agreeing,
        starts=starts,
        wingbeats=search.wingbeats,
    )


def require_torch() -> None:
    """Say how to get torch where it is missing.

    Raises:
        ImportError: naming the extra to install.
    """
    if importlib.util.find_spec("torch") is None:
        raise ImportError("the search for the best waveform needs torch: pip install 'flapenv[train]'")


class _Search:
    """log P* and Λ with their gradients at points of the cube, and descents by SLSQP."""

    def __init__(self, insect: Insect, problem: HoverProblem, knots: int) -> None:
        self.insect, self.problem = insect, problem
        self.coordinates = WaveformCoordinates(problem, knots)
        self.case = hover_case(insect, problem.model)
        self.wingbeats = 0
        self._seen: tuple[bytes, tuple[np.ndarray, np.ndarray]] = (b"", (np.zeros(0), np.zeros(0)))

    def values(self, point: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """(log P*, Λ) and their gradients, shape (2,) and (2, m)."""
        if self._seen[0] == point.tobytes():
            return self._seen[1]
        import torch

        leaf = torch.tensor(np.clip(point, -1, 1), dtype=torch.float64, requires_grad=True)
        waveform, _ = self.coordinates.decode(leaf, self.insect.reference)
        weight, power, _ = waveform_performance(self.case, self.problem.model, waveform, points=PRECISE_POINTS)
        both = torch.log(power), weight
        slopes = [torch.autograd.grad(value, leaf, retain_graph=True)[0].numpy() for value in both]
        self.wingbeats += 3
        self._seen = point.tobytes(), (np.array([float(value.detach()) for value in both]), np.stack(slopes))
        return self._seen[1]

    def descend(self, start: np.ndarray) -> tuple[float, np.ndarray]:
        """Log P* and the point where SLSQP ends; inf where that does not carry the weight."""
        from scipy.optimize import minimize

        found = minimize(
            lambda point: self.values(point)[0][0],
            start,
            jac=lambda point: self.values(point)[1][0],
            bounds=[(-1.0, 1.0)] * len(start),
            constraints={
                "type": "ineq",
                "fun": lambda point: self.values(point)[0][1] - 1,
                "jac": lambda point: self.values(point)[1][1],
            },
            method="SLSQP",
            options={"maxiter": ITERATIONS, "ftol": PRECISION},
        )
        point = np.clip(found.x, -1, 1)
        power, weight = self.values(point)[0]
        return (float(power) if weight >= 1 - WEIGHT_TOLERANCE else math.inf), point

    def multiplier(self, point: np.ndarray, power: float) -> float:
        """dP*/dΛ by stationarity along the axes that lie on no face [W/kg]; 0 where more is carried than the weight."""
        (_, weight), slopes = self.values(point)
        if weight > 1 + 1e-4:
            return 0.0
        cost, lift = slopes[:, np.abs(point) < 1 - 1e-6]
        strength = float(lift @ lift)
        return power * float(cost @ lift) / strength if strength > 0 else math.inf

    def start(self, number: int, seed: int = 0) -> np.ndarray:
        """The place where a search begins: sinusoidal, of constant speed, peaked, or random but of positive lift."""
        n, head = self.coordinates.knots, len(self.coordinates.beat)
        arc = np.sin(math.pi * (np.arange(n) + 0.5) / n)
        floor = np.full(n, -1.0)
        beat = np.full(head, 0.5)
        if number == 0:
            shape = np.concatenate([2 * arc - 1, 0.8 * arc])
        elif number == 1:
            shape = np.concatenate([np.zeros(n), np.full(n, 0.8)])
        elif number == 2:
            shape = np.concatenate([2 * arc**3 - 1, np.full(n, 0.6)])
        else:
            rng = np.random.default_rng([seed, number])
            speed = rng.uniform(-1, 1, n)
            if number % 2:  # a short beat at any time of the half-stroke
                first = rng.integers(n)
                speed = np.where((np.arange(n) >= first) & (np.arange(n) <= first + rng.integers(n // 2)), 1.0, floor)
            shape = np.concatenate([speed, rng.uniform(0.2, 1, n)])
        return np.concatenate([beat, shape])


def _as_waveform(motion: SplineMotion) -> Waveform:
    return Waveform(
        motion.frequency,
        motion.flap_amplitude,
        np.array(motion.speed_coefficients),
        np.array(motion.pitch_coefficients),
    )


def _confirm(insect: Insect, problem: HoverProblem, motion: SplineMotion, weight: float, power: float) -> None:
    """Let the blade element confirm what the fast averages found."""
    history: Any = simulate(insect, motion, model=problem.model, strips=6, steps=ORACLE_STEPS, spacing="gauss")
    found = history.mean_lift / (insect.mass * problem.model.gravity), history.mean_power() / insect.mass
    if not np.allclose(found, (weight, power), rtol=ORACLE_TOLERANCE):
        raise ArithmeticError(f"{insect.name}: the blade element finds {found}, the averages {(weight, power)}")
