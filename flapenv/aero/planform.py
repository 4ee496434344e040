"""The planform: how the chord runs from root to tip, whatever the wing's size; beta, from a table, or any function.

Radii are r̂ = r/R in [0, 1] and chords relative, ĉ = c/c̄ with ∫₀¹ ĉ dr̂ = 1.
"""

import math
from collections.abc import Callable, Sequence
from typing import Any, Protocol

import numpy as np

from flapenv.aero.arrays import Real, as_numpy
from flapenv.aero.checks import record, require_flag, require_real, shown
from flapenv.aero.quadrature import gauss_rule, graded_rule

R1_HAT_LIMIT = 0.929 ** (1 / 0.268)
"""Largest r̂₁ for which Ellington's correlation leaves a spread of area, r̂₂ > r̂₁ (here 0.7597)."""
LEAST_R1_HAT, LARGEST_R1_HAT = 1e-3, 0.759
"""Nearer to 0 or to the limit the exponents vanish or grow without end, and no rule of integration is left."""
FUNCTION_NODES = 256
"""Nodes of the integrals over a planform that is given as a function."""
LARGEST_GAUSS_RULE = 24
"""Strips up to which such a planform gets a Gauss rule of its own."""


class Planform(Protocol):
    """What a wing asks of its planform."""

    @property
    def r1_hat(self) -> Any:
        """r̂₁, the radius of the centre of area over R [-]."""

    def relative_chord(self, r_hat: Real) -> np.ndarray:
        """ĉ at radii of shape (n,); shape (*fields, n) [-]."""

    def moment(self, order: int, power: int = 1) -> Real:
        """∫₀¹ ĉ^power r̂^order dr̂ [-]."""

    def strips(self, count: int) -> tuple[np.ndarray, np.ndarray]:
        """Radii and areas ĉ dr̂ of strips that integrate smooth functions over the wing, about `count` of them."""


@record
class BetaPlanform:
    """Ellington's beta planform, ĉ = r̂^(p-1) (1-r̂)^(q-1)/B(p, q), by its first moment alone (Ellington 1984).

    Attributes:
        r1_hat: r̂₁ in [0.001, 0.759], where the exponents are positive; a scalar, array or tensor [-].

    Raises:
        TypeError: if it is not real.
        ValueError: outside that range, for NaN and inf.
    """

    r1_hat: Real

    def __post_init__(self) -> None:
        """Check the field."""
        value = require_real("r1_hat", self.r1_hat, LEAST_R1_HAT, LARGEST_R1_HAT)
        object.__setattr__(self, "r1_hat", value)

    @property
    def exponents(self) -> tuple[Real, Real]:
        """P and q [-], both > 0, from Ellington's correlation r̂₂ = 0.929 r̂₁^0.732."""
        r1 = self.r1_hat
        r2 = 0.929 * r1**0.732
        s = r1 * (1 - r1) / (r2**2 - r1**2) - 1
        return r1 * s, (1 - r1) * s

    def relative_chord(self, r_hat: Real) -> np.ndarray:
        """ĉ at radii of shape (n,); shape (*fields, n) [-]."""
        from scipy.special import betaln

        p, q = (as_numpy(e)[..., None] for e in self.exponents)
        r_hat = as_numpy(r_hat)
        return r_hat ** (p - 1) * (1 - r_hat) ** (q - 1) / np.exp(betaln(p, q))

    def moment(self, order: int, power: int = 1) -> Real:
        """∫ĉ^k r̂ⁿ dr̂ = B(k(p-1)+1+n, k(q-1)+1)/B(p, q)^k, exactly [-].

        Args:
            order: n >= 0.
            power: k >= 1; higher powers than 1 are NumPy's, not differentiable.

        Returns:
            The moment; 1 for n = 0 and r̂₁ for n = 1 where k = 1.

        Raises:
            ValueError: where the integral diverges: r̂₁ so small that ĉ^k rises too steeply at the root.
        """
        p, q = self.exponents
        if power == 1:
            moment = 1.0
            for i in range(order):
                moment = moment * (p + i) / (p + q + i)
            return moment
        from scipy.special import betaln

        p, q = as_numpy(p), as_numpy(q)
        root, tip = power * (p - 1) + 1 + order, power * (q - 1) + 1
        if np.any(root <= 0):
            raise ValueError(
                f"r1_hat = {self.r1_hat} is not allowed here: the chord to the power {power} has no integral at the "
                "root; allowed: the r1_hat of wings, above 0.38"
            )
        return np.exp(betaln(root, tip) - power * betaln(p, q))[()]

    def strips(self, count: int) -> tuple[np.ndarray, np.ndarray]:
        """Gauss-Jacobi points weighted with the chord: polynomials in r̂ up to 2 count - 1 are exact."""
        from scipy.special import roots_jacobi

        p, q = self.exponents
        x, weights = roots_jacobi(count, float(q) - 1, float(p) - 1)
        return (x + 1) / 2, weights / np.sum(weights)


@record
class TabulatedPlanform:
    """A planform measured at points, straight between them, and rounded at an end where the chord is zero.

    There the chord runs as the square root of the distance from the end, as it does on wings. A straight last panel
    would make a pointed tip, for which the lifting line finds a much larger k_ind, however narrow it is.

    Attributes:
        r_hat: radii over R, rising from 0 (root) to 1 (tip), at least two [-].
        chord: chords there, >= 0, in any unit: kept relative to their mean [-].
        rounded: False for a polygon, whose ends of zero chord are pointed.

    Raises:
        TypeError: if they are not sequences of real numbers of equal length.
        ValueError: for radii that do not rise or do not reach from root to tip, negative chords, no area, NaN or inf.
    """

    r_hat: Sequence[float]
    chord: Sequence[float]
    rounded: bool = True

    def __post_init__(self) -> None:
        """Check both columns and bring the chords to mean one."""
        require_flag("rounded", self.rounded)
        r_hat, chord = (
            np.asarray(require_real(name, getattr(self, name), low)) for name, low in (("r_hat", -np.inf), ("chord", 0))
        )
        if r_hat.ndim != 1 or r_hat.shape != chord.shape or r_hat.size < 2:
            raise TypeError(
                f"r_hat and chord have shapes {r_hat.shape} and {chord.shape}; allowed: two columns of equal length, "
                "at least two rows"
            )
        falls = np.flatnonzero(np.diff(r_hat) <= 0)
        if falls.size:
            i = int(falls[0])
            raise ValueError(f"r_hat[{i + 1}] = {r_hat[i + 1]:.6g} does not exceed r_hat[{i}]; allowed: rising radii")
        if r_hat[0] != 0 or r_hat[-1] != 1:
            raise ValueError(
                f"r_hat runs from {r_hat[0]:.6g} to {r_hat[-1]:.6g} and does not cover the span; allowed: from 0 "
                "(root) to 1 (tip), with a chord at both"
            )
        with np.errstate(over="ignore"):
            area = self._area(r_hat, chord)
        if not math.isfinite(area):
            raise ValueError(f"chord up to {np.max(chord):.6g} has no finite area; allowed: smaller numbers")
        if area <= 0:
            raise ValueError("chord is zero everywhere; allowed: a planform with area")
        object.__setattr__(self, "r_hat", tuple(r_hat.tolist()))
        mean = 1.0 if math.isclose(area, 1.0, rel_tol=1e-14) else area  # replacing a field must not drift
        object.__setattr__(self, "chord", tuple((chord / mean).tolist()))

    @property
    def r1_hat(self) -> float:
        """r̂₁, the radius of the centre of area over R [-]."""
        return self.moment(1)

    def relative_chord(self, r_hat: Real) -> np.ndarray:
        """ĉ at radii of any shape [-]."""
        radii = as_numpy(r_hat)
        chord = np.interp(radii, self.r_hat, self.chord)
        if self._round_root:
            chord = np.where(radii < self.r_hat[1], self.chord[1] * np.sqrt(radii / self.r_hat[1]), chord)
        if self._round_tip:
            last = self.r_hat[-2]
            chord = np.where(radii > last, self.chord[-2] * np.sqrt(np.maximum(1 - radii, 0) / (1 - last)), chord)
        return chord

    @property
    def _round_root(self) -> bool:
        return self.rounded and self.chord[0] == 0

    @property
    def _round_tip(self) -> bool:
        return self.rounded and self.chord[-1] == 0

    def _area(self, r_hat: np.ndarray, chord: np.ndarray) -> float:
        """∫ chord dr̂ before the chords are scaled: trapezes, and 2/3 of the rectangle under a rounded end."""
        panels = np.diff(r_hat) * (chord[1:] + chord[:-1]) / 2
        if self.rounded and chord[0] == 0:
            panels[0] *= 4 / 3
        if self.rounded and chord[-1] == 0:
            panels[-1] *= 4 / 3
        return float(np.sum(panels))

    def moment(self, order: int, power: int = 1) -> float:
        """∫ĉ^power r̂^order dr̂, exactly [-]."""
        r_hat, area = self._panels(order + power + 1)
        return float(np.sum(area * self.relative_chord(r_hat) ** (power - 1) * r_hat**order))

    def strips(self, count: int) -> tuple[np.ndarray, np.ndarray]:
        """Gauss points of every panel, at least four each, so that no strip straddles a corner."""
        return self._panels(max(4, math.ceil(count / (len(self.r_hat) - 1))))

    def _panels(self, nodes: int) -> tuple[np.ndarray, np.ndarray]:
        """Radii and areas of `nodes` Gauss-Legendre points in each panel, in the root of the distance where rounded."""
        x, weights = np.polynomial.legendre.leggauss(nodes)
        x, weights = (x + 1) / 2, weights / 2
        edges = np.array(self.r_hat)
        width = np.diff(edges)[:, None]
        place, share = np.tile(x, (len(width), 1)), np.tile(weights, (len(width), 1))
        if self._round_root:
            place[0], share[0] = x**2, 2 * x * weights
        if self._round_tip:
            place[-1], share[-1] = 1 - x**2, 2 * x * weights
        r_hat = (edges[:-1, None] + width * place).ravel()
        return r_hat, self.relative_chord(r_hat) * (width * share).ravel()


@record
class FunctionPlanform:
    """A planform given as a function; it may rise or fall steeply at either end but should be smooth between.

    It is tried at `FUNCTION_NODES` radii; what lies between them goes unseen. Wings that are to be pickled need a
    function with a name in a module, wings that are written to files a `TabulatedPlanform`.

    Attributes:
        function: chord at radii over R, an array in (0, 1) in and one of the same shape out, in any unit.

    Raises:
        TypeError: if it is not callable or does not answer with real numbers.
        ValueError: for negative chords, no area, NaN or inf.
    """

    function: Callable[[np.ndarray], Any]

    def __post_init__(self) -> None:
        """Try the function over the span and keep the mean of what it gives."""
        if not callable(self.function):
            raise TypeError(f"chord function = {shown(self.function)} is not allowed; allowed: a function of r/R")
        r_hat, weights = graded_rule(FUNCTION_NODES)
        chord = np.asarray(require_real("chord function's value", self.function(r_hat), 0.0))
        if chord.shape != r_hat.shape:
            raise TypeError(f"chord function gives shape {chord.shape} for radii of shape {r_hat.shape}; allowed: it")
        mean = float(chord @ weights)
        if mean <= 0:
            raise ValueError("chord function is zero everywhere; allowed: a planform with area")
        object.__setattr__(self, "_mean", mean)

    @property
    def r1_hat(self) -> float:
        """r̂₁, the radius of the centre of area over R [-]."""
        return self.moment(1)

    def relative_chord(self, r_hat: Real) -> np.ndarray:
        """ĉ at radii of any shape [-]."""
        mean: float = vars(self)["_mean"]
        return np.asarray(self.function(as_numpy(r_hat)), dtype=float) / mean

    def moment(self, order: int, power: int = 1) -> float:
        """∫ĉ^power r̂^order dr̂ by `FUNCTION_NODES` nodes crowded to both ends [-]."""
        r_hat, weights = graded_rule(FUNCTION_NODES)
        return float(np.sum(weights * self.relative_chord(r_hat) ** power * r_hat**order))

    def strips(self, count: int) -> tuple[np.ndarray, np.ndarray]:
        """Gauss points weighted with the chord, exact up to degree 2 count - 1; many are crowded to both ends."""
        if count > LARGEST_GAUSS_RULE:
            r_hat, weights = graded_rule(count)
            return r_hat, weights * self.relative_chord(r_hat)
        r_hat, weights = graded_rule(FUNCTION_NODES)
        return gauss_rule(r_hat, weights * self.relative_chord(r_hat), count)


def half_ellipse(r_hat: np.ndarray) -> np.ndarray:
    """√(1-r̂²), the chord of Berman & Wang's (2007) half-ellipse, greatest at the root [-]."""
    return np.sqrt((1 - r_hat) * (1 + r_hat))


HALF_ELLIPSE = FunctionPlanform(function=half_ellipse)
"""Berman & Wang's planform for every insect, c(r̂) = (4c̄/π)√(1-r̂²)."""
