"""Weight support and specific power of a stroke: the physics applied to an insect under stated model options."""

import math
from typing import Any, Literal

import numpy as np

from flapenv.aero import induced
from flapenv.aero.arrays import Real, as_arrays, as_result
from flapenv.aero.blade_element import STEPS, STRIPS, blade_element
from flapenv.aero.checks import is_single, record, require_flag, require_name, require_scalar
from flapenv.aero.coefficients import SECTION_LIFT_SLOPE, translational_lift_constant
from flapenv.aero.stroke import Stroke
from flapenv.aero.wingbeat import speed_averages, time_nodes
from flapenv.insects import Insect, WingFactors, as_insect


@record
class HoverModel:
    """Options of the aerodynamic model. The defaults are the paper's, with what it leaves unsaid filled in.

    Attributes:
        air_density: ρ [kg/m³].
        gravity: g [m/s²].
        section_lift_slope: a₂d [1/rad].
        tip_loss: "reference" keeps k_tip of the insect's own stroke, "stroke" computes it anew from each stroke.
        induced: False sets k = 1, the ideal uniform downwash of Fig. 6.

    Raises:
        TypeError: for an unknown option.
        ValueError: for a value outside its range.
    """

    air_density: float = 1.225
    gravity: float = 9.81
    section_lift_slope: float = SECTION_LIFT_SLOPE
    tip_loss: Literal["reference", "stroke"] = "reference"
    induced: bool = True

    def __post_init__(self) -> None:
        """Check every option."""
        for name, unit in (("air_density", "kg/m³"), ("gravity", "m/s²"), ("section_lift_slope", "1/rad")):
            value = require_scalar(name, getattr(self, name), 0.0, open_low=True, unit=unit)
            object.__setattr__(self, name, value)
        require_name("tip_loss", self.tip_loss, ("reference", "stroke"))
        require_flag("induced", self.induced)


@record
class HoverPerformance:
    """What a stroke gives; every field of the broadcast shape of insect and stroke.

    Attributes:
        weight_support: Λ, mean vertical force of both wings over the weight [-].
        specific_power: P*, mean aerodynamic power of both wings over the body mass [W/kg].
        lift: mean vertical force [N].
        power: mean aerodynamic power [W].
        lift_constant: C_T [-].
        induced_power_factor: k [-].
    """

    weight_support: Real
    specific_power: Real
    lift: Real
    power: Real
    lift_constant: Real
    induced_power_factor: Real


@record
class HoverCase:
    """What of an insect and a model enters Λ and P*, computed once and then used for any number of strokes.

        Λ  = lift_scale C_T ⟨v² sin 2α⟩,   P* = 2 power_scale C_T ⟨v³ sin² α⟩      (physics of section 3.3)

    Attributes:
        lift_scale: ρ c̄ R³ r̂₂²/(m g) [s²/rad²].
        power_scale: ρ c̄ R⁴ r̂₃³/m [W s³/(kg rad³)].
        aspect_ratio: AR of one wing [-].
        edge_correction: E [-].
        wing_factor: k_ind k_tip, or k_ind alone where k_tip follows the stroke [-].
        downwash_rate: w₀/R, for k_tip of a stroke [1/s].
        reference_frequency: of the insect's own stroke [Hz].
    """

    lift_scale: Real
    power_scale: Real
    aspect_ratio: Real
    edge_correction: Real
    wing_factor: Real
    downwash_rate: Real
    reference_frequency: Real

    def rows(self, index: Any, dtype: Any = float) -> "HoverCase":
        """The case with every field indexed by `index` and cast, to serve a batch of rows."""
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


def hover_case(insect: Insect, model: HoverModel) -> HoverCase:
    """Reduce an insect and a model to the numbers that strokes are evaluated with."""
    wing, mass = insect.wing, insect.mass
    factors = wing_factors(insect, model)
    weight = mass * model.gravity
    return HoverCase(
        lift_scale=model.air_density * wing.mean_chord * wing.length**3 * wing.moment(2) / weight,
        power_scale=model.air_density * wing.mean_chord * wing.length**4 * wing.moment(3) / mass,
        aspect_ratio=wing.aspect_ratio,
        edge_correction=wing.edge_correction,
        wing_factor=factors.k_revolving if model.tip_loss == "reference" else factors.k_ind,
        downwash_rate=induced.hover_downwash(wing, weight, model.air_density) / wing.length,
        reference_frequency=insect.stroke.frequency,
    )


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
    if not model.induced:
        return 1.0
    k = case.wing_factor * induced.k_flap_unchecked(flap_amplitude)
    return k * induced.k_tip(case.downwash_rate, flap_speed) if model.tip_loss == "stroke" else k


def lift_constant(case: HoverCase, model: HoverModel, flap_speed: Real, flap_amplitude: Real) -> Real:
    """C_T of a stroke [-]  (2.9), (2.10); arguments as in `induced_power_factor`."""
    k = induced_power_factor(case, model, flap_speed, flap_amplitude)
    return translational_lift_constant(case.aspect_ratio, case.edge_correction, k, model.section_lift_slope)


def hover_averages(
    case: HoverCase,
    model: HoverModel,
    *,
    frequency: Real,
    flap_amplitude: Real,
    pitch_amplitude: Real,
    flap_shape: Real,
    pitch_shape: Real,
    pitch_phase: Real,
    nodes: int,
) -> tuple[Real, Real]:
    """Λ [-] and P* [W/kg] of strokes that are known to be valid: the one path behind every other evaluation.

    Args:
        case: the insect's numbers, fields broadcast against the stroke's.
        model: the options.
        frequency: f [Hz].
        flap_amplitude: φmax [rad], at most π/2 unless the model leaves k out.
        pitch_amplitude: θmax [rad].
        flap_shape: Cφ [-].
        pitch_shape: Cθ [-].
        pitch_phase: δ [rad].
        nodes: of the time quadrature, from `time_nodes`.

    Returns:
        Weight support and specific power, of the broadcast shape.
    """
    lift_average, power_average = speed_averages(flap_shape, pitch_amplitude, pitch_shape, pitch_phase, nodes=nodes)
    _, frequency, flap_amplitude, lift_scale, power_scale = as_arrays(
        frequency, flap_amplitude, case.lift_scale, case.power_scale
    )
    speed = 4 * frequency * flap_amplitude
    constant = lift_constant(case, model, speed, flap_amplitude)
    weight_support = lift_scale * constant * speed**2 * lift_average
    specific_power = 2 * power_scale * constant * speed**3 * power_average
    return weight_support, specific_power


def evaluate(
    insect: Insect | str, stroke: Stroke | None = None, *, tolerance: float = 1e-9, **model: Any
) -> HoverPerformance:
    """Weight support and power of an insect beating a stroke, by the fast cycle averages.

        Λ = (ρ c̄ R³ r̂₂² C_T/(m g)) ⟨φ̇|φ̇| sin 2θ⟩,   P* = (ρ c̄ R⁴ r̂₃³/m) ⟨|φ̇|³ C_D⟩

    Args:
        insect: the insect or the name of one of `INSECTS`; array fields broadcast against the stroke's.
        stroke: the stroke; the insect's own where None, which is the line of Table 3.
        tolerance: relative error of the time quadrature; see `time_nodes` for what it means near θmax = 90°.
        **model: options of `HoverModel`.

    Returns:
        Performance in SI units, of the broadcast shape; Python floats for a scalar insect and stroke.

    Raises:
        TypeError: for an unknown option or an insect or stroke of another kind.
        ValueError: for an option out of range, or φmax > 90° where k_flap is used.

    Source: Nabawy & Crowther (2014), Part II, (2.1)-(2.12) and section 3.3.
    """
    insect, stroke, options = _checked(insect, stroke, model)
    case = hover_case(insect, options)
    nodes = time_nodes(stroke.flap_shape, stroke.pitch_shape, tolerance=tolerance)
    weight_support, specific_power = hover_averages(case, options, **vars(stroke), nodes=nodes)
    xp, frequency, amplitude, weight_support, specific_power, mass = as_arrays(
        stroke.frequency, stroke.flap_amplitude, weight_support, specific_power, insect.mass
    )
    speed = 4 * frequency * amplitude
    fields = {
        "weight_support": weight_support,
        "specific_power": specific_power,
        "lift": weight_support * mass * options.gravity,
        "power": specific_power * mass,
        "lift_constant": lift_constant(case, options, speed, amplitude),
        "induced_power_factor": induced_power_factor(case, options, speed, amplitude),
    }
    _, *values = as_arrays(*fields.values())
    values = [as_result(xp.broadcast_to(value, weight_support.shape)) for value in values]
    return HoverPerformance(**dict(zip(fields, values, strict=True)))


def _checked(insect: Insect | str, stroke: Stroke | None, model: dict[str, Any]) -> tuple[Insect, Stroke, HoverModel]:
    """What both ways of evaluating take, checked alike."""
    insect, options = as_insect(insect), HoverModel(**model)
    stroke = insect.stroke if stroke is None else stroke
    if not isinstance(stroke, Stroke):
        raise TypeError(f"stroke = {stroke!r} is not allowed; allowed: a Stroke, or None for the insect's own")
    if options.induced:
        induced.k_flap(stroke.flap_amplitude)  # refuses amplitudes that the model has no answer for
    return insect, stroke, options


def evaluate_by_blade_element(
    insect: Insect | str,
    stroke: Stroke | None = None,
    *,
    strips: int = STRIPS,
    steps: int = STEPS,
    spacing: str = "even",
    **model: Any,
) -> tuple[float, float]:
    """Λ [-] and P* [W/kg] of one stroke by the blade-element oracle; arguments as in `blade_element`, `evaluate`.

    Raises:
        TypeError: for what `evaluate` refuses, and for an insect or a stroke with array fields.
        ValueError: for what `evaluate` and `blade_element` refuse.
    """
    insect, stroke, options = _checked(insect, stroke, model)
    if not (is_single(insect) and is_single(stroke)):
        raise TypeError("insect or stroke has array fields; allowed: one insect and one stroke with scalar fields")
    constant = lift_constant(hover_case(insect, options), options, stroke.mean_flap_speed, stroke.flap_amplitude)
    history = blade_element(
        insect.wing,
        stroke,
        constant,
        air_density=options.air_density,
        strips=strips,
        steps=steps,
        spacing=spacing,
    )
    return history.mean_lift / (insect.mass * options.gravity), history.mean_power / insect.mass


def yardstick(case: HoverCase, model: HoverModel) -> tuple[Real, Real]:
    """Λ_ref and P*_felt of a wing at a yardstick stroke, two numbers an observer can know without any optimum.

    The yardstick beats at the reference frequency with φmax = 60°, constant speed v_ref = 4 f φmax and constant
    α = 35°: Λ_ref = A_L v_ref² sin 2α, P*_felt = A_P v_ref³, where Λ = A_L⟨v² sin 2α⟩ and P* = A_P⟨v³ sin² α⟩.

    Returns:
        Weight support [-] and specific power [W/kg], of the case's shape.
    """
    amplitude = math.radians(60)
    speed = 4 * case.reference_frequency * amplitude
    constant = lift_constant(case, model, speed, amplitude)
    return (
        case.lift_scale * constant * speed**2 * math.sin(2 * math.radians(35)),
        2 * case.power_scale * constant * speed**3,
    )
