"""Weight support and specific power of a stroke: the physics applied to an insect under stated model options."""

import dataclasses
import itertools
import math
from typing import Any

import numpy as np

from flapenv.aero import induced
from flapenv.aero.accelerators import PlateKernel
from flapenv.aero.arrays import Real, as_arrays, as_numpy, as_result, is_tensor
from flapenv.aero.checks import record, require_count, shown
from flapenv.aero.paid_power import positive_power
from flapenv.aero.plate_averages import plate_averages
from flapenv.aero.stroke import Stroke
from flapenv.aero.threads import in_threads
from flapenv.aero.wingbeat import TimeRule, force_averages, time_rule
from flapenv.case import HoverCase, force_law, hover_case, induced_power_factor, lift_constant
from flapenv.insects import Insect, as_insect
from flapenv.model import HoverModel, warn_of_aspect_ratio

PART, PAID_PART = 2**16, 2**10
"""Rows computed at once, and where only positive power is paid, which keeps every instant of every row."""
LEAST_PART = 2**13
"""Rows that are worth a thread of their own."""


@record
class HoverPerformance:
    """What a stroke gives; every field of the broadcast shape of insect and stroke.

    Attributes:
        weight_support: Λ, mean vertical force of both wings over the weight [-].
        specific_power: P*, mean aerodynamic power of both wings over the body mass [W/kg].
        lift: mean vertical force [N].
        power: mean aerodynamic power [W].
        lift_constant: C_T, or the lift coefficient at 45° of a law other than C_T sin 2α [-].
        induced_power_factor: k; 1 where the coefficients know none [-].
    """

    weight_support: Real
    specific_power: Real
    lift: Real
    power: Real
    lift_constant: Real
    induced_power_factor: Real


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
    rule: TimeRule,
    threads: int = 1,
    kernel: PlateKernel = plate_averages,
) -> tuple[Real, Real]:
    """Λ [-] and P* [W/kg] of strokes that are known to be valid: the one path behind every other evaluation.

    Arrays of many rows are computed in parts, so that memory stays bounded, and parts on threads where asked for.

    Args:
        case: the insect's numbers, fields broadcast against the stroke's.
        model: the options.
        frequency: f [Hz].
        flap_amplitude: φmax [rad], at most π/2 unless the model leaves k out.
        pitch_amplitude: θmax [rad].
        flap_shape: Cφ [-].
        pitch_shape: Cθ [-].
        pitch_phase: δ [rad].
        rule: of the time quadrature, from `time_rule`.
        threads: how many work at once; tensors know their own.
        kernel: what computes the averages of the paper's force law, from `flapenv.aero.accelerators.plate_kernel`.

    Returns:
        Weight support and specific power, of the broadcast shape.
    """
    stroke = {
        "frequency": frequency,
        "flap_amplitude": flap_amplitude,
        "pitch_amplitude": pitch_amplitude,
        "flap_shape": flap_shape,
        "pitch_shape": pitch_shape,
        "pitch_phase": pitch_phase,
    }
    if any(is_tensor(value) for value in (*stroke.values(), *vars(case).values())):
        return _averages(case, model, stroke, rule, kernel)
    shape = np.broadcast_shapes(*(np.shape(value) for value in stroke.values()), case.shape)
    count, largest = math.prod(shape), PAID_PART if model.accounting == "positive" else PART
    parts = max(math.ceil(count / largest), min(threads, count // LEAST_PART))
    if parts <= 1:
        return _averages(case, model, stroke, rule, kernel)
    rows = {name: np.broadcast_to(value, shape).reshape(-1) for name, value in stroke.items()}
    every = dataclasses.replace(case, reference_frequency=0.0, reference_amplitude=0.0).spread(shape)
    results = np.empty((2, count), np.result_type(*rows.values(), case.lift_scale))

    def work(part: slice) -> None:
        own = {name: value[part] for name, value in rows.items()}
        results[:, part] = _averages(every.rows(part, None), model, own, rule, kernel)

    edges = np.linspace(0, count, parts + 1).astype(int)
    in_threads(work, [slice(start, stop) for start, stop in itertools.pairwise(edges)], threads)
    return results[0].reshape(shape), results[1].reshape(shape)


def _averages(
    case: HoverCase, model: HoverModel, stroke: dict[str, Real], rule: TimeRule, kernel: PlateKernel
) -> tuple[Real, Real]:
    """Λ and P* of strokes, all at once."""
    _, frequency, flap_amplitude, lift_scale, power_scale = as_arrays(
        stroke["frequency"], stroke["flap_amplitude"], case.lift_scale, case.power_scale
    )
    speed = 4 * frequency * flap_amplitude
    law = force_law(case, model, speed, flap_amplitude)
    waveform = {name: stroke[name] for name in ("flap_shape", "pitch_amplitude", "pitch_shape", "pitch_phase")}
    scale, lift_average, power_average = force_averages(law, **waveform, rule=rule, kernel=kernel)
    _, speed, lift_scale, power_scale, scale, lift_average, power_average = as_arrays(
        speed, lift_scale, power_scale, scale, lift_average, power_average
    )
    weight_support = lift_scale * scale * speed**2 * lift_average
    if model.accounting == "positive":
        return weight_support, positive_power(law, power_scale, case.inertia, **stroke, rule=rule)
    return weight_support, 2 * power_scale * scale * speed**3 * power_average


def evaluate(
    insect: Insect | str, stroke: Stroke | None = None, *, tolerance: float = 1e-9, threads: int = 1, **model: Any
) -> HoverPerformance:
    """Weight support and power of an insect beating a stroke, by the fast cycle averages.

        Λ = (ρ c̄ R³ r̂₂² C_T/(m g)) ⟨φ̇|φ̇| sin 2θ⟩,   P* = (ρ c̄ R⁴ r̂₃³/m) ⟨|φ̇|³ C_D⟩

    Args:
        insect: the insect or the name of one of `INSECTS`; array fields broadcast against the stroke's.
        stroke: the stroke; the insect's own where None, which is the line of Table 3.
        tolerance: relative error of the time quadrature, for coefficients smooth in α (robofly's lift jumps at 90°, a
            table has corners: some 1e-5); see `time_rule` for what it means near θmax = 90°.
        threads: how many work at once on large batches.
        **model: options of `HoverModel`.

    Returns:
        Performance in SI units, of the broadcast shape; Python floats for a scalar insect and stroke.

    Raises:
        TypeError: for an unknown option or an insect or stroke of another kind.
        ValueError: for an option out of range, or φmax > 90° where k_flap is used.

    Source: Nabawy & Crowther (2014), Part II, (2.1)-(2.12) and section 3.3.
    """
    require_count("threads", threads)
    insect, stroke, options = checked(insect, stroke, model)
    warn_of_aspect_ratio(insect.name, insect.wing.aspect_ratio, options, stacklevel=3)
    case = hover_case(insect, options)
    rule = time_rule(stroke.flap_shape, stroke.pitch_shape, tolerance=tolerance)
    weight_support, specific_power = hover_averages(case, options, **vars(stroke), rule=rule, threads=threads)
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


def checked(insect: Insect | str, stroke: Stroke | None, model: dict[str, Any]) -> tuple[Insect, Stroke, HoverModel]:
    """What every way of evaluating takes, checked alike."""
    insect, options = as_insect(insect), HoverModel(**model)
    stroke = insect.stroke if stroke is None else stroke
    if not isinstance(stroke, Stroke):
        raise TypeError(f"stroke = {shown(stroke)} is not allowed; allowed: a Stroke, or None for the insect's own")
    if options.accounting == "positive" and np.any(as_numpy(stroke.flap_shape) == 1):
        raise ValueError(
            "flap_shape = 1 is not allowed with accounting = 'positive': a triangle's acceleration is infinite at its "
            "corners; allowed: below 1"
        )
    if options.uses_k:
        induced.k_flap(stroke.flap_amplitude)  # refuses amplitudes that the model has no answer for
    return insect, stroke, options


def yardstick(case: HoverCase, model: HoverModel) -> tuple[Real, Real]:
    """Λ_ref and P*_felt of a wing at a yardstick stroke, two numbers an observer can know without any optimum.

    The yardstick beats at the reference frequency with φmax = 60°, constant speed v_ref = 4 f φmax and constant
    α = 35°: Λ_ref = A_L v_ref² sin 2α, P*_felt = A_P v_ref³, where Λ = A_L⟨v² sin 2α⟩ and P* = A_P⟨v³ sin² α⟩. Other
    coefficients put C_L at 35° and C_D at 90° in place of C_T sin 2α and 2 C_T.

    Returns:
        Weight support [-] and specific power [W/kg], of the case's shape.
    """
    amplitude = math.radians(60)
    speed = 4 * case.reference_frequency * amplitude
    law = force_law(case, model, speed, amplitude)
    return (
        case.lift_scale * law.lift(math.sin(math.radians(35)), math.cos(math.radians(35))) * speed**2,
        case.power_scale * law.plain_drag(1.0, 0.0) * speed**3,
    )
