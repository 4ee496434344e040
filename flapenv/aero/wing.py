"""The wing: Ellington's beta planform with exact moments of area, and Jones' edge correction."""

import math

import numpy as np

from flapenv.aero.arrays import Real, as_arrays, as_numpy, as_result
from flapenv.aero.checks import record, require_real

R1_HAT_LIMIT = 0.929 ** (1 / 0.268)
"""Largest r̂₁ for which Ellington's correlation leaves a spread of area, r̂₂ > r̂₁ (here 0.7597)."""


@record
class Wing:
    """One wing of the pair, by three numbers (Ellington 1984; Nabawy & Crowther 2014, Part II, section 2.1).

    Every field is a scalar or an array; arrays broadcast and the properties then have their shape.

    Attributes:
        length: R, from the root to the tip [m], > 0.
        mean_chord: c̄ [m], > 0.
        r1_hat: r̂₁, radius of the centre of area over R, in (0, 0.7597), where the beta exponents are positive.

    Raises:
        TypeError: for an unknown or missing field, or one that is not real.
        ValueError: for a value outside its range, NaN or inf.
    """

    length: Real
    mean_chord: Real
    r1_hat: Real

    def __post_init__(self) -> None:
        """Check every field."""
        set_ = object.__setattr__
        set_(self, "length", require_real("length", self.length, 0.0, open_low=True, unit="m"))
        set_(self, "mean_chord", require_real("mean_chord", self.mean_chord, 0.0, open_low=True, unit="m"))
        set_(self, "r1_hat", require_real("r1_hat", self.r1_hat, 0.0, R1_HAT_LIMIT, open_low=True, open_high=True))

    @property
    def area(self) -> Real:
        """S = R c̄, area of one wing [m²]."""
        return self.length * self.mean_chord

    @property
    def aspect_ratio(self) -> Real:
        """AR = R/c̄ of ONE wing [-], as everywhere in the paper."""
        return self.length / self.mean_chord

    @property
    def beta_exponents(self) -> tuple[Real, Real]:
        """The exponents p, q of c ∝ r̂^(p-1) (1-r̂)^(q-1) [-], both > 0 (Ellington 1984)."""
        r1 = self.r1_hat
        r2 = 0.929 * r1**0.732  # Ellington's correlation of the first two radii
        s = r1 * (1 - r1) / (r2**2 - r1**2) - 1
        return r1 * s, (1 - r1) * s

    def moment(self, n: int) -> Real:
        """r̂ₙⁿ = ∫₀¹ ĉ r̂ⁿ dr̂ = B(p+n, q)/B(p, q), the n-th moment of area, exactly [-].

        Args:
            n: order, a whole number >= 0.

        Returns:
            The moment, of the fields' shape; 1 for n = 0 and r̂₁ for n = 1.
        """
        p, q = self.beta_exponents
        moment = 1.0
        for i in range(n):
            moment = moment * (p + i) / (p + q + i)
        return moment

    def chord(self, r_hat: Real) -> np.ndarray:
        """c(r̂) = c̄ r̂^(p-1) (1-r̂)^(q-1)/B(p, q), the chord along the span [m].

        Args:
            r_hat: r/R in [0, 1], shape (n,) [-].

        Returns:
            Chords, shape (*fields, n) [m].
        """
        from scipy.special import betaln

        p, q = (as_numpy(e)[..., None] for e in self.beta_exponents)
        r_hat = as_numpy(r_hat)
        return as_numpy(self.mean_chord)[..., None] * r_hat ** (p - 1) * (1 - r_hat) ** (q - 1) / np.exp(betaln(p, q))

    @property
    def edge_correction(self) -> Real:
        """E, the wing's semi-perimeter over its length [-], of the ellipse with the same aspect ratio.

        E = (π/2)(a+b)(1 + 3η/(10+√(4-3η))), a = 1/2, b = 2/(π AR), η = ((a-b)/(a+b))² (Jones 1941, as cited by
        Nabawy & Crowther 2014, Part II, section 2.3.2; Ramanujan's perimeter).
        """
        xp, aspect_ratio = as_arrays(self.aspect_ratio)
        a, b = 0.5, 2 / (math.pi * aspect_ratio)
        eta = ((a - b) / (a + b)) ** 2
        return as_result(math.pi / 2 * (a + b) * (1 + 3 * eta / (10 + xp.sqrt(4 - 3 * eta))))
