"""The wing: size, planform, hinge line and mass, with exact moments of area and Jones' edge correction."""

import math
from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np

from flapenv.aero.arrays import Real, as_arrays, as_numpy, as_result
from flapenv.aero.checks import HUGEST, TINIEST, record, require_name, require_real, require_scalar, shown
from flapenv.aero.planform import BetaPlanform, Planform, TabulatedPlanform

EDGE_OUTLINES = ("ellipse", "symmetric")
"""What the edge correction measures: the ellipse of the same aspect ratio, or the planform laid about mid-chord."""
OUTLINE_POINTS = 4096
"""Points of the polygon that the perimeter of a planform is measured on."""


@record
class Wing:
    """One wing of the pair (Ellington 1984; Nabawy & Crowther 2014, Part II, section 2.1).

    Three numbers make a beta planform; a `planform` in place of `r1_hat` makes any other (see also `from_table`).
    Every number is a scalar or an array; arrays broadcast and the properties then have their shape.

    Attributes:
        length: R, from the root to the tip [m].
        mean_chord: c̄ [m].
        r1_hat: r̂₁, radius of the centre of area over R, in [0.001, 0.759]; any planform but beta reports its own.
        planform: a `TabulatedPlanform` (or the dict of one) or `FunctionPlanform`; None for the beta planform.
        mass: of one wing, spread evenly over its area [kg]; None where inertia is not asked for.
        pitch_axis: x̂₀, the axis it pitches about, behind the leading edge [chords], in [0, 1].

    Raises:
        TypeError: for an unknown or missing field, or one that is not real.
        ValueError: for a value outside its range, NaN or inf, or an r1_hat that is not the planform's.
    """

    length: Real
    mean_chord: Real
    r1_hat: Real = None
    planform: Any = None
    mass: Real = None
    pitch_axis: float = 0.25

    def __post_init__(self) -> None:
        """Check every field."""
        set_ = object.__setattr__
        set_(self, "length", require_real("length", self.length, TINIEST, HUGEST, unit="m"))
        set_(self, "mean_chord", require_real("mean_chord", self.mean_chord, TINIEST, HUGEST, unit="m"))
        set_(self, "pitch_axis", require_scalar("pitch_axis", self.pitch_axis, 0.0, 1.0))
        if self.mass is not None:
            set_(self, "mass", require_real("wing mass", self.mass, TINIEST, HUGEST, unit="kg"))
        if isinstance(self.planform, Mapping):
            set_(self, "planform", TabulatedPlanform(**self.planform))
        if self.planform is None and self.r1_hat is None:
            raise TypeError("Wing needs r1_hat, for the beta planform, or a planform; allowed: one of them")
        if self.planform is None:
            set_(self, "r1_hat", BetaPlanform(r1_hat=self.r1_hat).r1_hat)
            return
        if isinstance(self.planform, type) or not hasattr(self.planform, "relative_chord"):
            raise TypeError(
                f"planform = {shown(self.planform)} is not allowed; allowed: a planform, or the dict of a table"
            )
        own = self.planform.r1_hat
        if self.r1_hat is not None and not np.allclose(as_numpy(require_real("r1_hat", self.r1_hat)), own, rtol=1e-9):
            raise ValueError(
                f"r1_hat = {self.r1_hat} is not the planform's; allowed: {own:.6g}, or None to take it from there"
            )
        set_(self, "r1_hat", own)

    @classmethod
    def from_table(
        cls,
        radius: Sequence[float],
        chord: Sequence[float],
        *,
        rounded: bool = True,
        mass: float | None = None,
        pitch_axis: float | None = None,
    ) -> "Wing":
        """A wing measured at points, straight between them, and rounded at an end where the chord is zero.

        Args:
            radius: from 0 (root) up to the length [m], shape (n,).
            chord: there [m], >= 0, shape (n,).
            rounded: False for a polygon, whose ends of zero chord are pointed.
            mass: of one wing [kg].
            pitch_axis: x̂₀ [chords]; the default of `Wing` where None.

        Raises:
            TypeError: for columns that are not real numbers of equal length.
            ValueError: for radii that do not rise from 0, negative chords, no area, NaN or inf.
        """
        r = np.atleast_1d(np.asarray(require_real("radius", radius, -HUGEST, HUGEST, unit="m")))
        c = np.atleast_1d(np.asarray(require_real("chord", chord, 0.0, HUGEST, unit="m")))
        if r.shape != c.shape or r.ndim != 1 or r.size < 2:
            raise TypeError(f"radius and chord have shapes {r.shape}, {c.shape}; allowed: two columns of equal length")
        if r[0] != 0 or r[-1] < TINIEST:
            raise ValueError(
                f"radius runs from {r[0]:.6g} to {r[-1]:.6g} m and does not cover the span; allowed: from 0 (root) to "
                "the length, with a chord at both"
            )
        widest = int(np.argmax(c))
        relative = c / (c[widest] or 1.0)
        shape = TabulatedPlanform(r_hat=(r / r[-1]).tolist(), chord=relative.tolist(), rounded=rounded)
        rest = {} if pitch_axis is None else {"pitch_axis": pitch_axis}
        return cls(
            length=float(r[-1]), mean_chord=float(c[widest]) / shape.chord[widest], planform=shape, mass=mass, **rest
        )

    @property
    def shape(self) -> Planform:
        """The planform, whichever it is."""
        return BetaPlanform(r1_hat=self.r1_hat) if self.planform is None else self.planform

    @property
    def area(self) -> Real:
        """S = R c̄, area of one wing [m²]."""
        return self.length * self.mean_chord

    @property
    def aspect_ratio(self) -> Real:
        """AR = R/c̄ of ONE wing [-], as everywhere in the paper."""
        return self.length / self.mean_chord

    def moment(self, order: int) -> Real:
        """r̂ₙⁿ = ∫₀¹ ĉ r̂ⁿ dr̂, the moment of area of order n [-]; exact for beta planforms and tables.

        Args:
            order: n, a whole number >= 0.

        Returns:
            The moment, of the planform's shape; 1 for n = 0 and r̂₁ for n = 1.
        """
        return self.shape.moment(order)

    def chord(self, r_hat: Real) -> np.ndarray:
        """c(r̂) = c̄ ĉ(r̂), the chord along the span [m].

        Args:
            r_hat: r/R in [0, 1], shape (n,) [-].

        Returns:
            Chords, shape (*fields, n) [m].
        """
        return as_numpy(self.mean_chord)[..., None] * self.shape.relative_chord(r_hat)

    def edge_correction(self, outline: str) -> Real:
        """E, the wing's semi-perimeter over its length [-] (Jones 1941, as cited in Part II, section 2.3.2).

        Args:
            outline: "ellipse" of the same aspect ratio, E = (π/2)(a+b)(1 + 3η/(10+√(4-3η))), a = 1/2, b = 2/(π AR),
                η = ((a-b)/(a+b))² (Ramanujan); or "symmetric", the planform laid about mid-chord,
                E = ∫₀¹ √(1 + (c'(r̂)/2R)²) dr̂, measured on a fine polygon.

        Raises:
            ValueError: for another outline, or a chord that is infinite at the root, whose edge has no length.
        """
        if require_name("outline", outline, EDGE_OUTLINES) == "ellipse":
            xp, aspect_ratio = as_arrays(self.aspect_ratio)
            a, b = 0.5, 2 / (math.pi * aspect_ratio)
            eta = ((a - b) / (a + b)) ** 2
            return as_result(math.pi / 2 * (a + b) * (1 + 3 * eta / (10 + xp.sqrt(4 - 3 * eta))))
        points = np.sin(np.linspace(0, math.pi / 2, OUTLINE_POINTS)) ** 2
        if isinstance(self.planform, TabulatedPlanform):
            points = np.union1d(points, self.planform.r_hat)
        with np.errstate(divide="ignore", invalid="ignore"):
            half_chord = self.shape.relative_chord(points) / (2 * as_numpy(self.aspect_ratio)[..., None])
        if not np.all(np.isfinite(half_chord)):
            raise ValueError(
                f"the wing with r1_hat = {self.r1_hat} has no symmetric outline: its chord at an end is not finite; "
                "allowed: the outline 'ellipse', or another planform (beta: r1_hat above 0.38)"
            )
        return as_result(np.sum(np.hypot(np.diff(points), np.diff(half_chord, axis=-1)), axis=-1))
