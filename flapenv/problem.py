"""What is being asked: which stroke parameters are free and within what box, under which model, at what price."""

import math
from collections.abc import Mapping
from dataclasses import asdict, fields
from typing import Any, Literal

import numpy as np

from flapenv.aero.arrays import Real
from flapenv.aero.checks import HUGEST, TINIEST, record, require_name, require_scalar, shown
from flapenv.aero.parameters import STROKE_PARAMETERS, StrokeReference
from flapenv.aero.wingbeat import TimeRule, time_rule
from flapenv.model import COEFFICIENTS, HoverModel

Interval = tuple[float, float]
RELATIVE = ("frequency", "flap_amplitude")
"""Parameters whose bounds may be given relative to the insect's own stroke."""


@record
class StrokeBox:
    """The box a stroke is sought in, by the names of `Stroke`'s fields.

    Each bound is a pair (lower, upper) or one number, which fixes the parameter.

    Attributes:
        frequency_ratio: f over the insect's reference frequency [-]; the default unless `frequency` is given.
        frequency: f [Hz], in place of `frequency_ratio`.
        flap_amplitude: φmax [rad]; the default unless `flap_amplitude_ratio` is given.
        flap_amplitude_ratio: φmax over the insect's own amplitude [-], in place of `flap_amplitude`.
        flap_shape: Cφ [-].
        pitch_shape: Cθ [-].
        pitch_amplitude: θmax [rad]; its upper bound is 90° minus the smallest angle of attack allowed.
        pitch_phase: δ [rad].

    Raises:
        TypeError: for an unknown parameter or a bound that is not a number or a pair.
        ValueError: for lower > upper, or a bound outside the parameter's valid range.
    """

    frequency_ratio: Interval | None = None
    frequency: Interval | None = None
    flap_amplitude: Interval | None = None
    flap_amplitude_ratio: Interval | None = None
    flap_shape: Interval = STROKE_PARAMETERS["flap_shape"].box
    pitch_shape: Interval = STROKE_PARAMETERS["pitch_shape"].box
    pitch_amplitude: Interval = STROKE_PARAMETERS["pitch_amplitude"].box
    pitch_phase: Interval = STROKE_PARAMETERS["pitch_phase"].box

    def __post_init__(self) -> None:
        """Bring every bound to a checked pair of floats."""
        for name, default in (("frequency", "frequency_ratio"), ("flap_amplitude", "flap_amplitude")):
            ratio = f"{name}_ratio"
            if getattr(self, name) is None and getattr(self, ratio) is None:
                object.__setattr__(self, default, STROKE_PARAMETERS[name].box)
            elif getattr(self, name) is not None and getattr(self, ratio) is not None:
                raise ValueError(
                    f"{name} = {shown(getattr(self, name))} and {ratio} = {shown(getattr(self, ratio))} both bound the "
                    f"{name}; "
                    "allowed: one of them"
                )
        for field, value in vars(self).copy().items():
            if value is not None:
                object.__setattr__(self, field, _interval(field, value))
            elif field.removesuffix("_ratio") not in RELATIVE:
                raise TypeError(f"bounds of {field} = None are not allowed; allowed: (lower, upper) or one number")

    def bounds(self, name: str, reference: StrokeReference) -> tuple[Real, Real]:
        """Lower and upper bound of a stroke parameter for an insect's own stroke [its SI unit]."""
        if not self.is_relative(name):
            low, high = getattr(self, name)
            return low, high
        low, high = getattr(self, f"{name}_ratio")
        own = getattr(reference, name)
        return low * own, high * own

    def is_relative(self, name: str) -> bool:
        """Whether the parameter's bounds go with the insect's own stroke."""
        return name in RELATIVE and getattr(self, f"{name}_ratio") is not None

    def is_free(self, name: str) -> bool:
        """Whether the parameter may vary."""
        low, high = self.bounds(name, StrokeReference(1.0, 1.0))
        return bool(high > low)

    def time_rule(self, *, tolerance: float) -> TimeRule:
        """The time quadrature that serves every stroke of the box; see `flapenv.aero.wingbeat.time_rule`."""
        low, high = self.flap_shape
        sharpest = np.nextafter(1.0, 0.0) if low < high == 1 else high  # as near to the triangle as a stroke can be
        return time_rule(sharpest, self.pitch_shape[1], tolerance=tolerance)

    @property
    def free(self) -> tuple[str, ...]:
        """Names of the parameters that may vary, in the order of the table."""
        return tuple(name for name in STROKE_PARAMETERS if self.is_free(name))


def _interval(field: str, value: Any) -> Interval:
    """A checked (lower, upper) from a pair or a single number."""
    name = field.removesuffix("_ratio")
    ends = tuple(value) if isinstance(value, list | tuple) or np.ndim(value) else (value, value)
    if len(ends) != 2 or any(isinstance(end, list | tuple) or np.ndim(end) for end in ends):
        raise TypeError(f"bounds of {field} = {shown(value)} are not allowed; allowed: (lower, upper) or one number")
    low, high = (
        float(np.asarray(STROKE_PARAMETERS[name].check(end, field=f"{which} bound of {field}")))
        for which, end in zip(("lower", "upper"), ends, strict=True)
    )
    if low > high:
        raise ValueError(f"bounds of {field}: lower = {low:.6g} > upper = {high:.6g}; allowed: lower <= upper")
    return low, high


@record
class HoverProblem:
    """Hovering with the least power: minimise P* over the box subject to Λ >= 1.

    With no argument, problem A of the documentation: the frequency is free and the smallest angle of attack is
    bounded, so that the optimum is known with a proof.

    Attributes:
        name: what tables and files call it; where None, the preset's name or "custom".
        box: the search box; a dict overrides single bounds of the default.
        model: the aerodynamic options; a dict overrides single ones.
        lift_penalty: λ of the reward, in units of the reference power per unit of missing weight support, > 0;
            "auto" is max(3, twice the multiplier of the constrained optimum), which makes the penalty exact.
        reward_floor: the reward is clipped below at this, < 0.

    Raises:
        TypeError: for an unknown field, bound or option.
        ValueError: for a value outside its range.
    """

    name: str | None = None
    box: StrokeBox = StrokeBox()
    model: HoverModel = HoverModel()
    lift_penalty: float | Literal["auto"] = "auto"
    reward_floor: float = -20.0

    def __post_init__(self) -> None:
        """Check every field; box and model may be dicts."""
        if self.name is not None and (not isinstance(self.name, str) or not self.name):
            raise TypeError(f"name = {shown(self.name)} is not allowed; allowed: a non-empty string, or None")
        for field, kind in (("box", StrokeBox), ("model", HoverModel)):
            value = getattr(self, field)
            if isinstance(value, Mapping):
                object.__setattr__(self, field, kind(**value))
            elif not isinstance(value, kind):
                raise TypeError(f"{field} = {shown(value)} is not allowed; allowed: a {kind.__name__} or a dict")
        if isinstance(self.lift_penalty, str):
            require_name("lift_penalty", self.lift_penalty, ("auto",))
        else:
            penalty = require_scalar("lift_penalty", self.lift_penalty, TINIEST, HUGEST)
            object.__setattr__(self, "lift_penalty", penalty)
        floor = require_scalar("reward_floor", self.reward_floor, -HUGEST, -TINIEST)
        object.__setattr__(self, "reward_floor", floor)
        if self.box.flap_amplitude is not None:
            self._require_amplitude("upper bound of flap_amplitude", self.box.flap_amplitude[1])
        if self.model.accounting == "positive" and self.box.flap_shape[1] == 1:
            raise ValueError(
                "upper bound of flap_shape = 1 is not allowed with accounting = 'positive': a triangle's acceleration "
                "is infinite at its corners; allowed: below 1"
            )
        if self.name is None:
            rest = (field for field in fields(self) if field.name not in ("name", "box", "model"))
            same = self.box == StrokeBox() and self.model == HoverModel()
            same &= all(getattr(self, field.name) == field.default for field in rest)
            object.__setattr__(self, "name", "free-frequency" if same else "custom")

    def _require_amplitude(self, field: str, amplitude: float) -> None:
        """Refuse an amplitude that the model has no answer for."""
        if self.model.uses_k and amplitude > math.pi / 2 * (1 + 1e-12):
            raise ValueError(
                f"{field} = {amplitude:.6g} is not allowed; allowed: up to 1.5708 rad where k_flap is used, more only "
                "with model={'induced': False} or coefficients without k"
            )
        if amplitude > math.pi:
            raise ValueError(f"{field} = {amplitude:.6g} is not allowed; allowed: up to 3.1416 rad")

    def require_suitable(self, name: str, reference: StrokeReference) -> None:
        """Refuse an insect whose own stroke the box takes out of the model's range.

        Args:
            name: of the insect.
            reference: its own stroke.

        Raises:
            ValueError: for an amplitude beyond what the model knows.
        """
        if self.box.flap_amplitude_ratio is not None:
            upper = float(np.max(self.box.bounds("flap_amplitude", reference)[1]))
            self._require_amplitude(f"upper bound of flap_amplitude for {name}", upper)

    @property
    def min_angle_of_attack(self) -> float:
        """α_min, the smallest angle of attack that a stroke of the box can reach [rad]."""
        return math.pi / 2 - self.box.pitch_amplitude[1]

    def to_dict(self) -> dict[str, Any]:
        """The problem as JSON keeps it; `HoverProblem(**d)` gives it back.

        Raises:
            TypeError: for coefficients that are a function, which no file can hold.
        """
        if callable(self.model.coefficients):
            raise TypeError(
                f"coefficients = {shown(self.model.coefficients)} cannot be written to a file; "
                "allowed there: a name of "
                f"{', '.join(COEFFICIENTS)}"
            )
        return asdict(self)


PROBLEMS: dict[str, HoverProblem] = {
    "free-frequency": HoverProblem(),
    "fixed-frequency": HoverProblem(
        name="fixed-frequency",
        box=StrokeBox(
            frequency_ratio=(1.0, 1.0),
            flap_amplitude_ratio=(1.0, 1.0),
            pitch_shape=(0.1, 100.0),
            pitch_amplitude=(math.radians(30), math.radians(85)),
        ),
    ),
    "profile-drag": HoverProblem(
        name="profile-drag",
        box=StrokeBox(pitch_amplitude=(math.radians(45), math.radians(85))),
        model=HoverModel(profile_drag=0.1),
    ),
    "inertial": HoverProblem(name="inertial", model=HoverModel(accounting="positive")),
}
"""The named problems.

- "free-frequency" (A): frequency and amplitude free, α >= 25°; the bound is tight and attained in the limit.
- "fixed-frequency" (B): the insect's own frequency and amplitude, α_mid in [5°, 60°]; the bound is loose.
- "profile-drag" (C): C_D0 = 0.1, α_mid in [5°, 45°]; the best angle lies inside.
- "inertial" (D): A without springs, only positive power is paid, wing inertia and added mass count; no bound is proven.
"""


def as_problem(value: Any) -> HoverProblem:
    """A `HoverProblem` from a name of `PROBLEMS`, a `HoverProblem`, the dict of its fields, or None for the default.

    Raises:
        TypeError: for anything else.
        ValueError: for an unknown name.
    """
    if value is None:
        return HoverProblem()
    if isinstance(value, str):
        return PROBLEMS[require_name("problem", value, PROBLEMS)]
    if isinstance(value, Mapping):
        return HoverProblem(**value)
    if isinstance(value, HoverProblem):
        return value
    raise TypeError(f"problem = {shown(value)} is not allowed; allowed: a HoverProblem, a dict of its fields or a name")
