"""Wings and strokes that no theory of this model covers are refused, with what was meant where the numbers tell.

The limits are generous: what is refused is in a wrong unit or has exchanged columns, not just unusual. They are set
around what Tables 1 and 2 have of the eight insects (Nabawy & Crowther 2014, Part II), by the factors named with them.
"""

import math

from flapenv.aero.arrays import Real
from flapenv.aero.checks import is_single, require_real, shown
from flapenv.aero.parameters import STROKE_PARAMETERS
from flapenv.aero.stroke import Stroke
from flapenv.insects import INSECTS, Insect, described
from flapenv.model import HoverModel

LENGTHS = (1e-4, 1.0)
"""Length of a wing [m]; a twentieth of Table 1's shortest, 2.02 mm, to 20 times its longest, 51.9 mm."""
CHORDS = (1e-5, 1.0)
"""Mean chord [m]; Table 1's are 0.67 to 18.26 mm."""
HEAVIEST = 1.0
"""Body mass [kg]; 600 times Table 1's largest, 1.648 g."""
STROKES: dict[str, tuple[float, float]] = {
    "frequency": (0.1, 5000.0),
    "flap_amplitude": (1e-3, STROKE_PARAMETERS["flap_amplitude"].high),
    "pitch_shape": (0.0, 1e6),
}
"""Where a file allows less than a `Stroke` [its SI units].

The frequency goes from a 260th of Table 1's least, 26.3 Hz, to 20 times its largest, 254 Hz; the amplitude from 0.06°,
Table 1's being 45° to 88.5°; Cθ → ∞ is a square wave of the pitch, and its largest value just keeps numbers finite."""
SLENDERNESS = (1.0, 20.0)
"""Aspect ratio of one wing [-]; Table 1's are 2.84 to 5.34, the lifting line is good above 2.8 (`ASPECT_RATIOS`)."""
CENTRES = (0.38, 0.65)
"""r̂₁ [-] of wings without tabulated k; Table 1's are 0.46 to 0.56, and k_ind of a beta planform leaps from 0.66 on."""
LOADINGS = (0.01, 1000.0)
"""Weight over the area of both wings [N/m²]; Table 1's are 1.8 to 17."""
LARGEST_FACTOR = 10.0
"""k_ind, k_tip, their product [-] and force constants [-]; Table 2's reach 1.37, Berman & Wang's (2007) 3.35."""
LONGEST_NAME = 100
"""Letters of an insect's."""


def require_stroke(stroke: Stroke) -> None:
    """Refuse array fields, and strokes that nothing beats.

    Raises:
        TypeError: for a field with an axis.
        ValueError: naming the field, the value and what is allowed.
    """
    _require_single(stroke)
    for name, (low, high) in STROKES.items():
        require_real(name, getattr(stroke, name), low, high, unit=STROKE_PARAMETERS[name].unit)


def require_insect(insect: Insect) -> None:
    """Refuse an insect under a name that misleads, or whose numbers lie far outside of every flapping wing's.

    Raises:
        TypeError: for a field with an axis.
        ValueError: naming the field, the value, what is allowed, and the unit it looks like where that is clear.
    """
    _require_single(insect)
    _require_name(insect.name)
    if insect.name in INSECTS and isinstance(described(insect), dict):
        raise ValueError(
            f"name = {shown(insect.name)} is that of an insect with other numbers; allowed: a name of one's own"
        )
    _require_body(insect)
    for part, least in ((insect.k_table, 1.0), (insect.force_constants, 0.0)):
        for name, value in vars(part).items() if part else ():
            require_real(name, value, least, LARGEST_FACTOR)
    require_stroke(insect.stroke)


def _require_single(part: Stroke | Insect) -> None:
    """Refuse array fields."""
    for field, value in vars(part).items():
        if not is_single(value):
            raise TypeError(f"{field} of {type(part).__name__} is an array; allowed: scalar fields")


def _require_name(name: str) -> None:
    """Refuse names that one could not see, or not on one line; pages, pictures and file names escape the rest."""
    if not (name.isprintable() and name.strip() and len(name) <= LONGEST_NAME):
        raise ValueError(f"name = {shown(name)} is not allowed; allowed: up to {LONGEST_NAME} visible letters")


def _require_body(insect: Insect) -> None:
    """Refuse sizes and masses that do not fly, or not together."""
    wing = insect.wing
    _require_length("length", wing.length, *LENGTHS)
    _require_length("mean_chord", wing.mean_chord, *CHORDS)
    area = 2 * float(wing.length) * float(wing.mean_chord)
    _require_mass("mass", insect.mass, area)
    if not SLENDERNESS[0] <= wing.aspect_ratio <= SLENDERNESS[1]:
        low, high = SLENDERNESS
        exchanged = low <= 1 / wing.aspect_ratio <= high
        raise ValueError(
            f"length/mean_chord = {wing.aspect_ratio:.4g} is not allowed: no theory of the model covers it; allowed: "
            f"{low:g} to {high:g}{'; are length and mean_chord exchanged?' if exchanged else ''}"
        )
    loading = _loading(float(insect.mass), area)
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


def _require_length(name: str, value: Real, low: float, high: float) -> None:
    """Refuse lengths that are no flapping wing's."""
    if not low <= value <= high:
        guess = f"; {value:.6g} looks like millimetres: {value / 1000:.6g} m" if high < value <= 1000 * high else ""
        small = f"; lengths are in metres, and {1000 * value:.3g} mm is no flapping wing's" if value < low else ""
        raise ValueError(
            f"{name} = {value:.6g} is not allowed; allowed: finite, in [{low:g}, {high:g}] m{guess}{small}"
        )


def _require_mass(name: str, value: Real, area: float) -> None:
    """Refuse masses that nothing flaps with."""
    if value > HEAVIEST:
        guess = _mass_guess(float(value), area)
        raise ValueError(f"{name} = {value:.6g} is not allowed; allowed: finite, in (0, {HEAVIEST:g}] kg{guess}")


def _mass_guess(mass: float, area: float) -> str:
    """The unit that would make it a flapping animal's wing loading, 1 to 100 N/m²."""
    for unit, factor in (("grams", 1e-3), ("milligrams", 1e-6)):
        if math.isclose(math.log10(_loading(mass * factor, area)), 1.0, abs_tol=1.0):
            return f"; {mass:.6g} looks like {unit}: {mass * factor:.6g} kg"
    return ""


def _loading(mass: float, area: float) -> float:
    """Weight over area [N/m²]."""
    return mass * HoverModel().gravity / area
