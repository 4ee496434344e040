"""The induced power factor k = k_ind k_tip k_flap: uneven downwash, tip loss and the flapped part of the disc.

The forms are reconstructions of Nabawy & Crowther (2014), Part I, checked against Part II's Table 2: k_flap meets all
eight insects, k_tip seven of them, k_ind all eight within 0.015.
"""

import math
import warnings

import numpy as np

from flapenv.aero.arrays import Real, as_arrays, as_numpy, as_result
from flapenv.aero.checks import require_count, require_real, shown
from flapenv.aero.planform import BetaPlanform
from flapenv.aero.wing import Wing

TIP_LOSS_FACTOR = 1.386
"""2 ln 2, Prandtl's tip loss for two blades (Part I)."""

BLOCK = 256
"""Wings whose equations are solved at once, to bound the memory."""
LEAST_TERMS, LARGEST_CHANGE = 32, 0.01
"""From so many terms on, a change by this fraction against half of them is worth a warning."""


def k_flap(flap_amplitude: Real) -> Real:
    """k_flap = √(90°/φmax), the part of the actuator disc that is not swept [-].

    Args:
        flap_amplitude: φmax in (0, π/2] [rad], any shape.

    Returns:
        The factor, >= 1.

    Raises:
        ValueError: for φmax beyond 90°, where the swept sectors of the two wings would overlap.
    """
    require_real("flap_amplitude (where k_flap is used)", flap_amplitude, 0.0, math.pi / 2, open_low=True, unit="rad")
    return k_flap_unchecked(flap_amplitude)


def k_flap_unchecked(flap_amplitude: Real) -> Real:
    """`k_flap` for amplitudes that are known to be in range."""
    xp, flap_amplitude = as_arrays(flap_amplitude)
    return as_result(xp.sqrt(math.pi / 2 / flap_amplitude))


def hover_downwash(wing: Wing, weight: Real, air_density: Real) -> Real:
    """w₀ = √(W/(2ρπR²)), Rankine-Froude downwash of the full disc [m/s].

    Args:
        wing: the wing, of which the length counts.
        weight: W = m g [N].
        air_density: ρ [kg/m³].
    """
    xp, length, weight, air_density = as_arrays(wing.length, weight, air_density)
    return as_result(xp.sqrt(weight / (2 * air_density * math.pi * length**2)))


def k_tip(downwash: Real, tip_speed: Real) -> Real:
    """k_tip = 1/B, B = 1 - (1.386/2) λ/√(1+λ²), λ = w₀/U: loss at the wing tips [-].

    Args:
        downwash: w₀ from `hover_downwash`, of the weight and not of the lift produced [m/s].
        tip_speed: U = 4 φmax f R, the mean tip speed [m/s].

    Returns:
        The factor, > 1, of the broadcast shape.
    """
    xp, downwash, tip_speed = as_arrays(downwash, tip_speed)
    inflow = downwash / tip_speed
    return as_result(1 / (1 - TIP_LOSS_FACTOR / 2 * inflow / xp.sqrt(1 + inflow**2)))


def k_ind(wing: Wing, *, root_offset: float = 0.0, section_lift_slope: float = 2 * math.pi, terms: int = 64) -> Real:
    """k_ind from the lifting line of one wing turning about its root [-].

    With r̂ = (1-cos ϑ)/2, Γ = 2 Σ Aₙ sin nϑ, zero at root and tip, and ĉ = c/c̄,

        Σ Aₙ sin nϑ [2 + (a ĉ/(2AR)) n/sin ϑ] = (a ĉ/(2AR)) (J + r̂),    w = Σ n Aₙ sin nϑ/sin ϑ,
        k_ind = 2∫|w|³ r̂ dr̂/(2∫w² r̂ dr̂)^(3/2).

    Args:
        wing: a wing of any planform; array fields give an array of factors.
        root_offset: J, distance from the axis to the root over R [-].
        section_lift_slope: a [1/rad].
        terms: terms of the sine series; 64 are converged to 1e-4 for beta planforms with r̂₁ of 0.42 to 0.57. Beyond it,
            and for pointed tips, the downwash at an end grows ever more steeply and convergence slows (at r̂₁ = 0.35 or
            0.65 they are about 6 % below 1,024 terms).

    Returns:
        The factor, of the wing's shape. The defaults hold no fitted constant.

    Raises:
        TypeError: for what is not a wing.
        ValueError: for a non-finite or negative argument, or a planform without chord at all of the points.

    Warns:
        UserWarning: where a planform other than beta changes it by more than 1 % between half of the terms and all.
    """
    if not isinstance(wing, Wing):
        raise TypeError(f"wing = {shown(wing)} is not allowed; allowed: a Wing")
    require_real("root_offset", root_offset, 0.0)
    require_real("section_lift_slope", section_lift_slope, 0.0, open_low=True, unit="1/rad")
    require_count("terms", terms)
    r_hat = (1 - np.cos((np.arange(terms) + 0.5) * math.pi / terms)) / 2
    relative_chord, aspect_ratio = wing.shape.relative_chord(r_hat), as_numpy(wing.aspect_ratio)
    shape = np.broadcast_shapes(relative_chord.shape[:-1], aspect_ratio.shape)
    chords = np.broadcast_to(relative_chord / aspect_ratio[..., None], (*shape, terms)).reshape(-1, terms)
    factors = [
        _lifting_line(section_lift_slope / 2 * chords[start : start + BLOCK], root_offset)
        for start in range(0, len(chords), BLOCK)
    ]
    factor = np.concatenate(factors).reshape(shape)
    if not np.all(np.isfinite(factor)):
        raise ValueError(f"terms = {terms} are too few for the planform, which has no chord there; allowed: more")
    if not isinstance(wing.shape, BetaPlanform):
        _warn_unless_converged(wing, factor, root_offset, section_lift_slope, terms)
    return as_result(factor)


def _warn_unless_converged(wing: Wing, factor: np.ndarray, root_offset: float, slope: float, terms: int) -> None:
    """Compare with half of the terms, for planforms that are not known to converge."""
    if terms < LEAST_TERMS:
        return
    half = (np.arange(terms // 2) + 0.5) * math.pi / (terms // 2)
    chord = wing.shape.relative_chord((1 - np.cos(half)) / 2) / as_numpy(wing.aspect_ratio)[..., None]
    coarse = _lifting_line(slope / 2 * chord.reshape(-1, terms // 2), root_offset).reshape(factor.shape)
    change = float(np.max(np.abs(coarse / factor - 1)))
    if change > LARGEST_CHANGE:
        warnings.warn(
            f"k_ind = {float(np.max(factor)):.3f} is not converged: {terms} terms change it by {100 * change:.1f} % "
            "against half of them; the planform has a pointed tip or a jump, where lifting lines converge slowly. "
            "Take more terms, a rounded table, or give the insect a k_table",
            stacklevel=4,
        )


def _lifting_line(coupling: np.ndarray, root_offset: float) -> np.ndarray:
    """k_ind of wings with a ĉ/(2AR) at the collocation points ϑ, shape (wings, terms)."""
    terms = coupling.shape[-1]
    theta = (np.arange(terms) + 0.5) * math.pi / terms
    order = np.arange(1, terms + 1)
    r_hat = (1 - np.cos(theta)) / 2
    sines = np.sin(np.outer(theta, order))
    matrix = sines * (2 + coupling[..., None] * order / np.sin(theta)[:, None])
    amplitudes = np.linalg.solve(matrix, (coupling * (root_offset + r_hat))[..., None])[..., 0]
    downwash = (amplitudes * order) @ sines.T / np.sin(theta)
    weights = math.pi / terms * np.sin(theta) / 2  # dr̂, midpoint rule in ϑ
    energy = np.sum(np.abs(downwash) ** 3 * r_hat * weights, axis=-1)
    momentum = np.sum(downwash**2 * r_hat * weights, axis=-1)
    with np.errstate(invalid="ignore"):  # no chord at any of the points: the caller says so
        return 2 * energy / (2 * momentum) ** 1.5
