"""An insect under a model, reduced to the numbers that any number of strokes are evaluated with."""

import dataclasses
import math
from typing import Any

import numpy as np

from flapenv.aero import induced
from flapenv.aero.arrays import Real, as_arrays, as_result
from flapenv.aero.checks import record
from flapenv.aero.coefficients import extended_lift_curve_slope, lift_curve_slope, translational_lift_constant
from flapenv.aero.force_laws import BermanWangLaw, FittedLaw, ForceLaw, PlateLaw, PolhamusLaw, robofly
from flapenv.aero.inertia import wing_inertia
from flapenv.aero.parameters import StrokeReference
from flapenv.aero.planform import HALF_ELLIPSE
from flapenv.aero.wing import Wing
from flapenv.insects import Insect, WingFactors
from flapenv.model import HoverModel

TRAILING = ("force_constants", "inertia")
"""Fields of `HoverCase` with an axis of their own behind the batch's."""


@record
class HoverCase:
    """What of an insect and a model enters Λ and P*, computed once and then used for any number of strokes.

        Λ  = lift_scale C_T ⟨v² sin 2α⟩,   P* = 2 power_scale C_T ⟨v³ sin² α⟩      (physics of section 3.3)

    Attributes:
        lift_scale: ρ c̄ R³ r̂₂²/(m g) [s²/rad²].
        power_scale: ρ c̄ R⁴ r̂₃³/m [W s³/(kg rad³)].
        aspect_ratio: AR of one wing [-].
        edge_correction: E; 1 where the coefficients know none [-].
        wing_factor: k_ind k_tip, or k_ind alone where k_tip follows the stroke [-].
        downwash_rate: w₀/R, for k_tip of a stroke [1/s].
        reference_frequency: of the insect's own stroke [Hz].
        reference_amplitude: φmax of the insect's own stroke [rad].
        force_constants: C_T, C_D0 and C_D90 of the insect along the last axis; empty where they do not count [-].
        inertia: of both wings over the body mass, I_r, I_rξ, I_ξ and the added mass' M along the last axis, as
            `flapenv.aero.paid_power` takes them [m²]; empty where they do not count.
    """

    lift_scale: Real
    power_scale: Real
    aspect_ratio: Real
    edge_correction: Real
    wing_factor: Real
    downwash_rate: Real
    reference_frequency: Real
    reference_amplitude: Real
    force_constants: np.ndarray
    inertia: np.ndarray

    @property
    def reference(self) -> StrokeReference:
        """What boxes may be relative to."""
        return StrokeReference(self.reference_frequency, self.reference_amplitude)

    @property
    def shape(self) -> tuple[int, ...]:
        """Of all that enters Λ and P*; the own stroke, which does not, may have another."""
        shapes = []
        for name, value in vars(self).items():
            if name not in ("reference_frequency", "reference_amplitude"):
                shapes.append(np.shape(value)[:-1] if name in TRAILING else np.shape(value))
        return np.broadcast_shapes(*shapes)

    def spread(self, shape: tuple[int, ...]) -> "HoverCase":
        """The case with every field broadcast to a shape and its axes made one; trailing axes stay."""
        count = math.prod(shape)
        spread = {}
        for name, value in vars(self).items():
            own = np.shape(value)[-1:] if name in TRAILING else ()
            spread[name] = np.broadcast_to(value, (*shape, *own)).reshape(count, *own)
        return HoverCase(**spread)

    def rows(self, index: Any, dtype: Any = float) -> "HoverCase":
        """The case with every field indexed by `index` and cast (None: as it is), to serve a batch of rows."""
        return HoverCase(**{name: np.asarray(value, dtype=dtype)[index] for name, value in vars(self).items()})


def wing_factors(insect: Insect, model: HoverModel | None = None) -> WingFactors:
    """k_ind and k_tip of an insect: tabulated where it has a table, else computed at its own stroke.

    Source: Nabawy & Crowther (2014), Part II, Table 2; forms of `flapenv.aero.induced`.
    """
    model = model or HoverModel()
    if insect.k_table is not None:
        return insect.k_table
    downwash = induced.hover_downwash(insect.wing, insect.mass * model.gravity, model.air_density)
    tip_speed = insect.stroke.mean_flap_speed * insect.wing.length
    return WingFactors(k_ind=induced.k_ind(insect.wing), k_tip=induced.k_tip(downwash, tip_speed))


def model_wing(insect: Insect, model: HoverModel) -> Wing:
    """The wing that the coefficients go with: the insect's own, or Berman & Wang's half-ellipse of its size."""
    if model.coefficients != "berman-wang":
        return insect.wing
    return dataclasses.replace(insect.wing, r1_hat=None, planform=HALF_ELLIPSE)


def hover_case(insect: Insect, model: HoverModel) -> HoverCase:
    """Reduce an insect and a model to the numbers that strokes are evaluated with.

    Raises:
        ValueError: for the coefficients "berman-wang" where the insect has no constants for them.
    """
    wing, mass = model_wing(insect, model), insect.mass
    factors = wing_factors(insect, model)
    weight = mass * model.gravity
    constants = np.zeros(0)
    if model.coefficients == "berman-wang":
        given = insect.force_constants
        if given is None:
            raise ValueError(
                f"coefficients = 'berman-wang' have no constants for {insect.name}; allowed: fruitfly, bumblebee, "
                "hawkmoth, or an Insect with force_constants"
            )
        constants = np.stack(np.broadcast_arrays(given.lift_constant, given.zero_drag, given.normal_drag), axis=-1)
    return HoverCase(
        lift_scale=model.air_density * wing.mean_chord * wing.length**3 * wing.moment(2) / weight,
        power_scale=model.air_density * wing.mean_chord * wing.length**4 * wing.moment(3) / mass,
        aspect_ratio=wing.aspect_ratio,
        edge_correction=wing.edge_correction(model.edge_correction) if model.uses_edge_correction else 1.0,
        wing_factor=factors.k_revolving if model.tip_loss == "reference" else factors.k_ind,
        downwash_rate=induced.hover_downwash(wing, weight, model.air_density) / wing.length,
        reference_frequency=insect.stroke.frequency,
        reference_amplitude=insect.stroke.flap_amplitude,
        force_constants=constants,
        inertia=_inertia(insect, wing, model) if model.accounting == "positive" else np.zeros(0),
    )


def _inertia(insect: Insect, wing: Wing, model: HoverModel) -> np.ndarray:
    """What accelerating both wings and the air around them takes, over the body mass, shape (..., 4) [m²]."""
    if wing.mass is None:
        raise ValueError(
            f"accounting = 'positive' needs the wing mass of {insect.name}; allowed: Wing(..., mass=...) [kg] of one "
            "wing, or fruitfly, bumblebee, hawkmoth"
        )
    moments = wing_inertia(wing)
    added = math.pi / 4 * model.air_density * wing.mean_chord**2 * wing.length**3 * wing.shape.moment(2, 2)
    parts = moments.radius, moments.product, moments.chord, added
    return np.stack(np.broadcast_arrays(*(2 * part / insect.mass for part in parts)), axis=-1)


def stack_cases(cases: list[HoverCase]) -> HoverCase:
    """Several scalar cases as one with array fields, in order."""
    return HoverCase(**{name: np.array([vars(case)[name] for case in cases]) for name in vars(cases[0])})


def induced_power_factor(case: HoverCase, model: HoverModel, flap_speed: Real, flap_amplitude: Real) -> Real:
    """K = k_ind k_tip k_flap of a stroke [-]: the wing's part is fixed, k_flap follows φmax (Part II, Table 2).

    Args:
        case: the insect's numbers.
        model: the options.
        flap_speed: v̄ = 4 f φmax [rad/s]; counts where tip_loss is "stroke".
        flap_amplitude: φmax [rad], in range already.
    """
    if not model.uses_k:
        return 1.0
    _, wing_factor, k_flap = as_arrays(case.wing_factor, induced.k_flap_unchecked(flap_amplitude))
    k = as_result(wing_factor * k_flap)
    return k * induced.k_tip(case.downwash_rate, flap_speed) if model.tip_loss == "stroke" else k


def force_law(case: HoverCase, model: HoverModel, flap_speed: Real, flap_amplitude: Real) -> ForceLaw:
    """C_L and C_D of a stroke as the model has them, by default (2.11) and (2.12).

    Arguments as in `induced_power_factor`.
    """
    drag, name = model.profile_drag, model.coefficients
    if name == "extended-lifting-line":
        slope = extended_lift_curve_slope(case.aspect_ratio, model.section_lift_slope)
        return PlateLaw(constant=slope / 2, profile_drag=drag)
    if name == "robofly":
        return FittedLaw(function=robofly, profile_drag=drag)
    if name == "berman-wang":
        lift, zero, normal = (case.force_constants[..., i] for i in range(3))
        return BermanWangLaw(constant=lift, zero_drag=zero, normal_drag=normal, profile_drag=drag)
    if callable(name):
        return FittedLaw(function=name, profile_drag=drag)
    k = induced_power_factor(case, model, flap_speed, flap_amplitude)
    wing = case.aspect_ratio, case.edge_correction, k, model.section_lift_slope
    if name == "polhamus":
        _, slope, k, aspect_ratio = as_arrays(lift_curve_slope(*wing), k, case.aspect_ratio)
        return PolhamusLaw(slope=slope, suction=1 - k * slope / (math.pi * aspect_ratio), profile_drag=drag)
    return PlateLaw(constant=translational_lift_constant(*wing), profile_drag=drag)


def lift_constant(case: HoverCase, model: HoverModel, flap_speed: Real, flap_amplitude: Real) -> Real:
    """C_T of a stroke [-]  (2.9), (2.10), or C_L at 45°; arguments as in `induced_power_factor`."""
    return force_law(case, model, flap_speed, flap_amplitude).lift_constant
