"""Wings that have lost their tip: what is left of any planform, with its own moments."""

from typing import Any

import numpy as np

from flapenv.aero.arrays import Real, as_numpy, as_result
from flapenv.aero.checks import record, require_real
from flapenv.aero.planform import FUNCTION_NODES, LARGEST_GAUSS_RULE, BetaPlanform
from flapenv.aero.quadrature import gauss_rule, graded_rule
from flapenv.aero.wing import Wing

CUT_NODES = 512
"""Nodes of the integrals over what is left of a planform other than beta."""


@record
class CutPlanform:
    """The inner part of a planform, its radii over the remaining length and its chords over their own mean.

    With κ = 1 - lost and Iₙ = ∫₀^κ ĉ r̂ⁿ dr̂ of the whole wing: ĉ'(r̂) = ĉ(κ r̂) κ/I₀. For the beta planform the Iₙ are
    incomplete beta functions, exactly; for others quadratures of `CUT_NODES` nodes.

    Attributes:
        planform: of the whole wing, one wing only.
        lost: share of the span that is missing at the tip, in [0, 1); a scalar or an array [-].

    Raises:
        TypeError: if `lost` is not real.
        ValueError: outside that range, for NaN and inf.
    """

    planform: Any
    lost: Real

    def __post_init__(self) -> None:
        """Check the share."""
        object.__setattr__(self, "lost", require_real("span lost", self.lost, 0.0, 1.0, open_high=True))

    @property
    def r1_hat(self) -> Real:
        """r̂₁, the radius of the centre of area over the remaining length [-]."""
        return self.moment(1)

    def remaining(self, order: int, power: int = 1) -> Real:
        """∫₀^κ ĉ^power r̂^order dr̂ of the whole wing's ĉ and r̂ [-]: the moment that the lost tip leaves.

        Args:
            order: n >= 0.
            power: k >= 1.
        """
        kept = 1 - as_numpy(self.lost)
        if isinstance(self.planform, BetaPlanform) and power == 1:
            from scipy.special import betainc

            p, q = self.planform.exponents
            return as_result(betainc(p + order, q, kept) * self.planform.moment(order))
        place, weights = graded_rule(CUT_NODES)
        radii = kept[..., None] * place
        chord = self.planform.relative_chord(radii)
        return as_result(kept * np.sum(weights * chord**power * radii**order, axis=-1))

    def relative_chord(self, r_hat: Real) -> np.ndarray:
        """ĉ' at radii of shape (n,); shape (*lost, n) [-]."""
        kept, area = 1 - as_numpy(self.lost), as_numpy(self.remaining(0))
        chord: np.ndarray = self.planform.relative_chord(kept[..., None] * as_numpy(r_hat))
        return chord * (kept / area)[..., None]

    def moment(self, order: int, power: int = 1) -> Real:
        """∫₀¹ ĉ'^power r̂^order dr̂ of what is left [-]; arguments as in `remaining`."""
        kept, area = 1 - as_numpy(self.lost), as_numpy(self.remaining(0))
        return as_result(self.remaining(order, power) / kept ** (order + 1) * (kept / area) ** power)

    def strips(self, count: int) -> tuple[np.ndarray, np.ndarray]:
        """Gauss points weighted with the chord, exact up to degree 2 count - 1; many are crowded to both ends."""
        few = count <= LARGEST_GAUSS_RULE
        r_hat, weights = graded_rule(FUNCTION_NODES if few else count)
        areas = weights * self.relative_chord(r_hat)
        return gauss_rule(r_hat, areas, count) if few else (r_hat, areas)


def cut_wing(wing: Wing, lost: Real) -> Wing:
    """A wing without its tip: the chord of what is left stays as it was, and so does what it weighs per area.

    Args:
        wing: the whole wing, scalar fields.
        lost: share of the span that is missing at the tip, in [0, 1); a scalar or an array [-].

    Returns:
        The remaining wing, of length R (1 - lost) and the mean chord of the remaining area.

    Raises:
        TypeError: if `lost` is not real.
        ValueError: for a share outside that range.
    """
    shape = CutPlanform(planform=wing.shape, lost=lost)
    kept, area = 1 - shape.lost, shape.remaining(0)
    return Wing(
        length=wing.length * kept,
        mean_chord=wing.mean_chord * area / kept,
        planform=shape,
        mass=None if wing.mass is None else wing.mass * area,
        pitch_axis=wing.pitch_axis,
    )
