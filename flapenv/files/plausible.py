"""Wings that no theory of this model covers are refused, with what was meant where the numbers tell.

The limits are wide: a wing is refused for a wrong unit or exchanged columns, not for being unusual.
"""

import math

from flapenv.aero.arrays import Real
from flapenv.aero.checks import require_real
from flapenv.insects import Insect

LONGEST = 1.0
"""Length of a wing, and its chord [m]; the model is validated up to 0.05."""
HEAVIEST = 1.0
"""Body mass [kg]; the model is validated up to 0.0016."""
FASTEST = 5000.0
"""Flapping frequency [Hz]; midges beat at up to 1000."""
SLENDERNESS = (1.0, 20.0)
"""Aspect ratio of one wing [-]; the lifting line is good above 2.8, the extended one below 3; insects show 2.8-6."""
CENTRES = (0.38, 0.65)
"""r̂₁ [-] of wings without tabulated k; insects show 0.44-0.58, and k_ind of a beta planform leaps from 0.66 on."""
LOADINGS = (0.01, 1000.0)
"""Weight over the area of both wings [N/m²]; insects show 2-20."""
GRAVITY = 9.81
"""For the guess of a unit only [m/s²]."""


def require_plausible(insect: Insect) -> None:
    """Refuse an insect whose numbers lie far outside of every flapping wing's.

    Raises:
        ValueError: naming the field, the value, what is allowed, and the unit it looks like where that is clear.
    """
    wing = insect.wing
    for name in ("length", "mean_chord"):
        _require_length(name, getattr(wing, name))
    area = 2 * float(wing.length) * float(wing.mean_chord)
    _require_mass("mass", insect.mass, area)
    if not SLENDERNESS[0] <= wing.aspect_ratio <= SLENDERNESS[1]:
        low, high = SLENDERNESS
        exchanged = low <= 1 / wing.aspect_ratio <= high
        raise ValueError(
            f"length/mean_chord = {wing.aspect_ratio:.4g} is not allowed: no theory of the model covers it; allowed: "
            f"{low:g} to {high:g}{'; are length and mean_chord exchanged?' if exchanged else ''}"
        )
    loading = float(insect.mass) * GRAVITY / area
    if not LOADINGS[0] <= loading <= LOADINGS[1]:
        raise ValueError(
            f"mass = {insect.mass:.6g} kg on two wings of {area / 2:.3g} m² is a wing loading of {loading:.3g} N/m²; "
            f"allowed: {LOADINGS[0]:g} to {LOADINGS[1]:g}{_mass_guess(float(insect.mass), area)}"
        )
    if insect.k_table is None:
        require_real("r1_hat", wing.r1_hat, *CENTRES)
    if wing.mass is not None and wing.mass > insect.mass / 2:
        raise ValueError(
            f"wing mass = {wing.mass:.6g} kg of each of two wings is not allowed; allowed: up to half of the body's "
            f"mass, {insect.mass / 2:.6g} kg"
        )
    require_real("frequency", insect.stroke.frequency, 0.0, FASTEST, open_low=True, unit="Hz")


def _require_length(name: str, value: Real) -> None:
    """Refuse lengths that are no flapping wing's."""
    if value > LONGEST:
        guess = f"; {value:.6g} looks like millimetres: {value / 1000:.6g} m" if value <= 1000 * LONGEST else ""
        raise ValueError(f"{name} = {value:.6g} is not allowed; allowed: finite, in (0, {LONGEST:g}] m{guess}")


def _require_mass(name: str, value: Real, area: float) -> None:
    """Refuse masses that nothing flaps with."""
    if value > HEAVIEST:
        guess = _mass_guess(float(value), area)
        raise ValueError(f"{name} = {value:.6g} is not allowed; allowed: finite, in (0, {HEAVIEST:g}] kg{guess}")


def _mass_guess(mass: float, area: float) -> str:
    """The unit that would make it a flapping animal's wing loading, 1 to 100 N/m²."""
    for unit, factor in (("grams", 1e-3), ("milligrams", 1e-6)):
        if math.isclose(math.log10(mass * factor * GRAVITY / area), 1.0, abs_tol=1.0):
            return f"; {mass:.6g} looks like {unit}: {mass * factor:.6g} kg"
    return ""
