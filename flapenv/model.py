"""Options of the aerodynamic model: air, coefficients, and what enters the induced power factor."""

import warnings
from collections.abc import Hashable, Mapping
from typing import Any, Literal

import numpy as np

from flapenv.aero.arrays import Real, as_numpy
from flapenv.aero.checks import HUGEST, TINIEST, record, require_flag, require_name, require_scalar, shown
from flapenv.aero.coefficients import SECTION_LIFT_SLOPE, checked_coefficients
from flapenv.aero.history import ACCOUNTING
from flapenv.aero.wing import EDGE_OUTLINES

COEFFICIENTS: dict[str, str] = {
    "lifting-line": "(2.7), (2.12) with (2.9), (2.10): the paper's",
    "extended-lifting-line": "(2.7), (2.12) with the extended lifting line, which knows no k and no edge correction",
    "polhamus": "(3.1), (3.2), the leading-edge suction analogy on the slope (2.10)",
    "robofly": "Dickinson, Lehmann & Sane's (1999) fits, the same for every wing",
    "berman-wang": "Berman & Wang's (2007) constants of the insect, on their half-ellipse planform",
}
"""The coefficient models by name."""
ASPECT_RATIOS: dict[str, tuple[float, float, str]] = {
    "lifting-line": (2.8, np.inf, "coefficients='extended-lifting-line'"),
    "extended-lifting-line": (0.0, 3.0, "coefficients='lifting-line'"),
    "polhamus": (0.0, 2.0, "coefficients='lifting-line'"),
}
"""Aspect ratios that a theory is good for, and what else there is.

Part II puts the lifting line above 3 and meets CFD with it at 2.84 (hawkmoth); it puts the extended one below 3, and
finds (3.1) too high from 2 up (sections 2.3.2 and 3.1)."""


@record
class HoverModel:
    """Options of the aerodynamic model. The defaults are the paper's, with what it leaves unsaid filled in.

    Attributes:
        air_density: ρ [kg/m³].
        gravity: g [m/s²].
        section_lift_slope: a₂d [1/rad].
        tip_loss: "reference" keeps k_tip of the insect's own stroke, "stroke" computes it anew from each stroke.
        induced: False sets k = 1, the ideal uniform downwash of Fig. 6.
        coefficients: a name of `COEFFICIENTS`, or a function of α in [0, 90°] [rad] that gives the pair (C_L, C_D) as
            NumPy arrays of α's shape; it must take tensors to be used with them.
        profile_drag: C_D0, added to the drag coefficient at every angle [-].
        accounting: "elastic" returns negative power, as the paper counts it; "positive" pays max(0, power) of
            aerodynamics, added mass and the wing's inertia together, for which the wing needs a mass.
        edge_correction: outline that Jones' E is measured on, "ellipse" or "symmetric"; see `Wing.edge_correction`.

    Raises:
        TypeError: for an unknown option.
        ValueError: for a value outside its range.
    """

    air_density: float = 1.225
    gravity: float = 9.81
    section_lift_slope: float = SECTION_LIFT_SLOPE
    tip_loss: Literal["reference", "stroke"] = "reference"
    induced: bool = True
    coefficients: Any = "lifting-line"
    profile_drag: float = 0.0
    edge_correction: Literal["ellipse", "symmetric"] = "ellipse"
    accounting: Literal["elastic", "positive"] = "elastic"

    def __post_init__(self) -> None:
        """Check every option."""
        for name, unit in (("air_density", "kg/m³"), ("gravity", "m/s²"), ("section_lift_slope", "1/rad")):
            value = require_scalar(name, getattr(self, name), TINIEST, HUGEST, unit=unit)
            object.__setattr__(self, name, value)
        object.__setattr__(self, "profile_drag", require_scalar("profile_drag", self.profile_drag, 0.0, HUGEST))
        require_name("tip_loss", self.tip_loss, ("reference", "stroke"))
        require_name("edge_correction", self.edge_correction, EDGE_OUTLINES)
        require_name("accounting", self.accounting, ACCOUNTING)
        require_flag("induced", self.induced)
        if isinstance(self.coefficients, str):
            require_name("coefficients", self.coefficients, COEFFICIENTS)
        else:
            checked_coefficients(self.coefficients)
            if not isinstance(self.coefficients, Hashable):
                raise TypeError(f"coefficients = {shown(self.coefficients)} cannot be hashed; allowed: a function")

    @property
    def uses_k(self) -> bool:
        """Whether the induced power factor enters the coefficients, and with it φmax <= 90°."""
        return self.induced and self.uses_edge_correction

    @property
    def uses_edge_correction(self) -> bool:
        """Whether Jones' E enters the coefficients."""
        return self.coefficients in ("lifting-line", "polhamus")

    @property
    def is_plate(self) -> bool:
        """Whether the coefficients are (2.7) and (2.12), with profile drag or without."""
        return self.coefficients in ("lifting-line", "extended-lifting-line")

    @property
    def has_proven_bound(self) -> bool:
        """Whether the proofs of docs/optimum.md hold: (2.7), (2.12), profile drag or none, elastic power."""
        return self.is_plate and self.accounting == "elastic"


BEYOND_THEORY = ".*is outside the range of the"
"""What finds the warning of `warn_of_aspect_ratio`, where a model is used beyond its range on purpose."""


def as_model(value: Any) -> HoverModel:
    """A `HoverModel` from itself, the dict of its options, or None for the paper's.

    Raises:
        TypeError: for anything else, or an unknown option.
        ValueError: for an option out of range.
    """
    if value is None or isinstance(value, Mapping):
        return HoverModel(**(value or {}))
    if isinstance(value, HoverModel):
        return value
    raise TypeError(f"model = {shown(value)} is not allowed; allowed: a HoverModel or a dict of its options")


def warn_of_aspect_ratio(name: str, aspect_ratio: Real, model: HoverModel, *, stacklevel: int) -> None:
    """Say where a wing lies outside the range of the theory that its coefficients come from."""
    low, high, alternative = ASPECT_RATIOS.get(str(model.coefficients), (0.0, np.inf, ""))
    ratios = as_numpy(aspect_ratio)
    outside = ratios[(ratios < low) | (ratios > high)]
    if outside.size:
        where = f"below {high:g}" if low == 0 else f"above {low:g}"
        warnings.warn(
            f"{name}: aspect ratio {outside[0]:.3g} is outside the range of the {model.coefficients} model, good "
            f"{where}; alternative: {alternative}",
            stacklevel=stacklevel,
        )
