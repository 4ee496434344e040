"""A wingbeat of an insect in full, by the blade element: any motion, every force term, over time."""

import inspect
import warnings
from collections.abc import Mapping
from typing import Any

import numpy as np

from flapenv.aero import induced
from flapenv.aero.blade_element import STEPS, STRIPS, blade_element
from flapenv.aero.checks import allowed, is_single, shown
from flapenv.aero.history import WingbeatHistory
from flapenv.aero.motions import Motion
from flapenv.aero.stroke import Stroke
from flapenv.case import force_law, hover_case, model_wing
from flapenv.insects import Insect, as_insect
from flapenv.model import HoverModel, as_model, warn_of_aspect_ratio
from flapenv.performance import checked

OPTIONS = tuple(name for name, p in inspect.signature(blade_element).parameters.items() if p.kind is p.KEYWORD_ONLY)[1:]
"""What `simulate` hands to the blade element; the air density is the model's."""
MOTION_METHODS = tuple(name for name in vars(Motion) if not name.startswith("_"))


def simulate(
    insect: Insect | str,
    motion: Motion | None = None,
    *,
    model: HoverModel | Mapping[str, Any] | None = None,
    **options: Any,
) -> WingbeatHistory:
    """One wingbeat of an insect by the blade element, with every force term apart.

    Args:
        insect: one insect (scalar fields) or a name of `INSECTS`.
        motion: a `Stroke` with scalar fields or any other motion (`SampledMotion`, `FourierMotion`, or one that answers
            as `Motion` says); the insect's own stroke where None.
        model: a `HoverModel` or the dict of its options. Coefficients follow the motion's φmax and mean speed.
        **options: of `flapenv.aero.blade_element`: terms, stroke_plane_angle, body_velocity, strips, steps, spacing.

    Returns:
        Histories of forces, torques and power.

    Raises:
        TypeError: for an unknown option, an insect or a motion of another kind, or array fields.
        ValueError: for what `HoverModel` and `blade_element` refuse, or φmax > 90° where k_flap is used.

    Source: Nabawy & Crowther (2014), Part II, (2.3)-(2.16).
    """
    insect = as_insect(insect)
    model = as_model(model)
    for name, value in options.items():
        if name not in OPTIONS:
            raise TypeError(f"{name} = {shown(value)} is not an option of simulate; {allowed(name, OPTIONS)}")
    motion = insect.stroke if motion is None else motion
    missing = [name for name in MOTION_METHODS if not hasattr(motion, name)]
    if isinstance(motion, type) or missing:
        raise TypeError(
            f"motion = {shown(motion)} is not allowed; allowed: a Stroke, SampledMotion, FourierMotion, or an "
            "object with "
            f"{', '.join(MOTION_METHODS)}"
        )
    if not (is_single(insect) and (not isinstance(motion, Stroke) or is_single(motion))):
        raise TypeError("insect or stroke has array fields; allowed: one insect and one stroke with scalar fields")
    if model.uses_k:
        induced.k_flap(motion.flap_amplitude)
    warn_of_aspect_ratio(insect.name, insect.wing.aspect_ratio, model, stacklevel=3)
    return _history(insect, motion, model, **options)


def _history(insect: Insect, motion: Motion, model: HoverModel, **options: Any) -> WingbeatHistory:
    """The blade element with the model's wing and coefficients."""
    law = force_law(hover_case(insect, model), model, motion.mean_flap_speed, motion.flap_amplitude)
    return blade_element(model_wing(insect, model), motion, law, air_density=model.air_density, **options)


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

    As in `evaluate`, the lift is the translational one; added mass and inertia enter the power where it is "positive".

    Raises:
        TypeError: for what `evaluate` refuses, and for an insect or a stroke with array fields.
        ValueError: for what `evaluate` and `blade_element` refuse.
    """
    insect, stroke, options = checked(insect, stroke, model)
    if not (is_single(insect) and is_single(stroke)):
        raise TypeError("insect or stroke has array fields; allowed: one insect and one stroke with scalar fields")
    terms = ("translational", "added-mass", "inertia") if options.accounting == "positive" else ("translational",)
    with warnings.catch_warnings():
        warnings.filterwarnings("ignore", message="steps = .* do not resolve")  # the caller refines until they agree
        history = _history(insect, stroke, options, terms=terms, strips=strips, steps=steps, spacing=spacing)
    lift = float(np.mean(history.terms["translational"].force[:, 2]))
    return lift / (insect.mass * options.gravity), history.mean_power(options.accounting) / insect.mass
