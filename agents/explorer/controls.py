"""What the page asks for, in the units people read, and what it may send: every number is checked here."""

import math
from collections.abc import Mapping, Sequence

from flapenv.aero.checks import record, require_name, shown
from flapenv.aero.stroke import Stroke
from flapenv.aero.wing import Wing
from flapenv.files.plausible import CENTRES, LOADINGS, SLENDERNESS, require_insect
from flapenv.insects import INSECTS, Insect
from flapenv.model import HoverModel

OWN_WING = "your own wing"
"""Entry of the list of insects under which one types one's own."""
LONGEST_NAME = 60
ROUNDING = 1e-9
"""Relative, of a bound that went through degrees and back."""
SHOWN_DECIMALS = 6
"""Of a stroke that is loaded and counts: so few that a field shows all, so many that the optimum's gap is still 0."""


@record
class Control:
    """One number that the page asks for.

    Attributes:
        name: as the page's elements call it.
        label: as one reads it, a remark behind its first comma.
        unit: shown behind the label, empty for a ratio.
        low: smallest value allowed [unit].
        high: largest value allowed [unit].
        step: of the slider or the field [unit].
        start: what stands there at first, of a field [unit].
    """

    name: str
    label: str
    unit: str
    low: float
    high: float
    step: float
    start: float = math.nan

    def checked(self, value: object) -> float:
        """The number, if it is one and allowed.

        Raises:
            TypeError: for anything but a number.
            ValueError: for NaN, inf or a number out of range.
        """
        allowed = f"allowed: {self.with_unit(self.low)} to {self.with_unit(self.high)}"
        if value is None:  # what a field sends that is empty, or beyond its own bounds
            raise ValueError(f"{self.short_label} is missing; {allowed}")
        if isinstance(value, bool) or not isinstance(value, int | float):
            raise TypeError(f"{self.short_label} = {shown(value)} is not a number; {allowed}")
        low, high = (end + side * ROUNDING * abs(end) for end, side in ((self.low, -1), (self.high, 1)))
        if not low <= value <= high:
            raise ValueError(f"{self.short_label} = {self.with_unit(value)} is not allowed; {allowed}")
        return float(min(max(value, self.low), self.high))

    @property
    def short_label(self) -> str:
        """The label without its remark, as errors and print call the number."""
        return self.label.split(",")[0]

    def with_unit(self, value: float) -> str:
        """A value as one reads it, "254 Hz", "89°"."""
        text = f"{value:.6g}" if isinstance(value, float) else shown(value)
        return f"{text}{self.unit}" if self.unit in ("", "°") else f"{text} {self.unit}"


WING_CONTROLS: tuple[Control, ...] = (
    Control(name="mass", label="mass of the body", unit="mg", low=1e-3, high=1e6, step=0.001, start=100),
    Control(name="wing_length", label="wing length R", unit="mm", low=0.1, high=1000, step=0.01, start=13),
    Control(name="mean_chord", label="mean chord c̄", unit="mm", low=0.01, high=500, step=0.01, start=4),
    Control(
        name="r1_hat",
        label="r̂₁, centre of area over R",
        unit="",
        low=CENTRES[0],
        high=CENTRES[1],
        step=0.001,
        start=0.49,
    ),
    Control(
        name="reference_frequency", label="reference frequency", unit="Hz", low=0.1, high=5000, step=0.1, start=150
    ),
)
"""Of one's own wing."""
REFERENCE_ANGLES = {"flap_amplitude": math.radians(60), "pitch_amplitude": math.radians(55)}
"""Of the plain stroke that a typed wing is given for its own, [rad]: α is 35° at mid-stroke."""


def stroke_controls(insect: Insect) -> tuple[Control, ...]:
    """What is moved of a stroke; the frequency's range goes with the insect's own.

    Args:
        insect: whose stroke it is.
    """
    own = float(insect.stroke.frequency)
    step = 10.0 ** (math.floor(math.log10(own)) - 2)
    return (
        Control(name="frequency", label="frequency f", unit="Hz", low=round(0.3 * own, 6), high=2 * own, step=step),
        Control(name="flap_amplitude", label="amplitude φmax", unit="°", low=10, high=90, step=0.5),
        Control(name="flap_shape", label="Cφ, 0 sinusoid, 1 triangle", unit="", low=0, high=0.999, step=0.001),
        Control(name="pitch_shape", label="Cθ, 0 sinusoid, large square", unit="", low=0, high=100, step=0.1),
        Control(name="alpha_mid", label="angle of attack α_mid", unit="°", low=1, high=89, step=0.1),
        Control(name="pitch_phase", label="phase δ, 90° symmetric", unit="°", low=30, high=150, step=0.5),
    )


def read_stroke(values: object, insect: Insect) -> Stroke:
    """The stroke that the sliders say.

    Args:
        values: what the page sent, in the controls' order.
        insect: whose stroke it is.

    Raises:
        TypeError: for anything but a list of so many numbers.
        ValueError: for a number that is not allowed.
    """
    controls = stroke_controls(insect)
    if not isinstance(values, Sequence) or isinstance(values, str) or len(values) != len(controls):
        raise TypeError(f"stroke = {shown(values)} is not allowed; allowed: a list of {len(controls)} numbers")
    number = {control.name: control.checked(value) for control, value in zip(controls, values, strict=True)}
    return Stroke(
        frequency=number["frequency"],
        flap_amplitude=math.radians(number["flap_amplitude"]),
        flap_shape=number["flap_shape"],
        pitch_shape=number["pitch_shape"],
        pitch_amplitude=math.radians(90 - number["alpha_mid"]),
        pitch_phase=math.radians(number["pitch_phase"]),
    )


def shown_stroke(stroke: Stroke, insect: Insect) -> list[float]:
    """A stroke as the sliders show it, as near to it as they reach, in the controls' order."""
    shown = {
        "frequency": stroke.frequency,
        "flap_amplitude": math.degrees(stroke.flap_amplitude),
        "flap_shape": stroke.flap_shape,
        "pitch_shape": stroke.pitch_shape,
        "alpha_mid": 90 - math.degrees(stroke.pitch_amplitude),
        "pitch_phase": math.degrees(stroke.pitch_phase),
    }
    controls = stroke_controls(insect)
    near = {name: round(float(value), SHOWN_DECIMALS) for name, value in shown.items()}
    return [min(max(near[control.name], control.low), control.high) for control in controls]


def read_insect(name: object, own: object, insects: Mapping[str, Insect]) -> Insect:
    """The insect that the page asks for.

    Args:
        name: of one of the insects, or `OWN_WING`.
        own: for that, the name one gave it and the numbers in `WING_CONTROLS`' order.
        insects: all there are.

    Raises:
        TypeError: for a field of another kind.
        ValueError: for an unknown name or a number that is not allowed.
    """
    if require_name("insect", name, [*insects, OWN_WING]) != OWN_WING:
        return insects[str(name)]
    if not isinstance(own, Sequence) or isinstance(own, str) or len(own) != 1 + len(WING_CONTROLS):
        raise TypeError(f"wing = {shown(own)} is not allowed; allowed: a name and {len(WING_CONTROLS)} numbers")
    called, *values = own
    number = {control.name: control.checked(value) for control, value in zip(WING_CONTROLS, values, strict=True)}
    insect = Insect(
        name=_read_name(called),
        mass=number["mass"] * 1e-6,
        wing=Wing(length=number["wing_length"] * 1e-3, mean_chord=number["mean_chord"] * 1e-3, r1_hat=number["r1_hat"]),
        stroke=Stroke(frequency=number["reference_frequency"], **REFERENCE_ANGLES),
    )
    _require_together(insect)
    require_insect(insect)
    return insect


def _require_together(insect: Insect) -> None:
    """Refuse sizes and masses that do not go together, in the page's words and before `require_insect` does in SI's."""
    ratio, (low, high) = float(insect.wing.aspect_ratio), SLENDERNESS
    if not low <= ratio <= high:
        raise ValueError(f"wing length R over mean chord c̄ = {ratio:.4g} is not allowed; allowed: {low:g} to {high:g}")
    area = 2 * float(insect.wing.length) * float(insect.wing.mean_chord)
    loading, (low, high) = float(insect.mass) * HoverModel().gravity / area, LOADINGS
    if not low <= loading <= high:
        raise ValueError(
            f"mass of the body = {1e6 * insect.mass:.6g} mg on two wings of {5e5 * area:.4g} mm² each is a wing "
            f"loading of {loading:.3g} N/m²; allowed: {low:g} to {high:g} N/m²"
        )


def _read_name(name: object) -> str:
    """What a wing is called: one line of text."""
    if not isinstance(name, str) or not name.strip() or len(name) > LONGEST_NAME or not name.isprintable():
        raise ValueError(f"name of the wing is not allowed; allowed: 1 to {LONGEST_NAME} printable characters")
    if name.strip() in INSECTS:
        raise ValueError(f"name of the wing = {shown(name.strip())} is taken by an insect; allowed: another name")
    return name.strip()
