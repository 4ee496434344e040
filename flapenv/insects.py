"""Insects: mass, wing and own stroke, the eight CFD cases of Tables 1-3, and one's own."""

import csv
import dataclasses
import functools
import math
from collections.abc import Mapping
from importlib import resources
from typing import Any

import numpy as np

from flapenv.aero.arrays import Real
from flapenv.aero.checks import HUGEST, TINIEST, record, require_name, require_real, require_scalar, shown
from flapenv.aero.parameters import StrokeReference
from flapenv.aero.planform import FunctionPlanform
from flapenv.aero.stroke import Stroke
from flapenv.aero.wing import Wing


@record
class HoverReference:
    """What a published source found for an insect hovering with its own stroke (Part II, Table 3).

    Attributes:
        weight_support: vertical force over weight [-].
        specific_power: aerodynamic power over body mass [W/kg]; None where the source gives none.
    """

    weight_support: float
    specific_power: float | None = None

    def __post_init__(self) -> None:
        """Check both."""
        support = require_scalar("weight_support", self.weight_support, TINIEST, HUGEST)
        object.__setattr__(self, "weight_support", support)
        if self.specific_power is not None:
            power = require_scalar("specific_power", self.specific_power, TINIEST, HUGEST, unit="W/kg")
            object.__setattr__(self, "specific_power", power)


@record
class WingFactors:
    """The parts of the induced power factor that belong to the wing and stay fixed while its stroke varies (Table 2).

    Attributes:
        k_ind: uneven downwash [-], >= 1.
        k_tip: tip loss at the insect's own stroke [-], >= 1.
        k_revolving: k_ind k_tip, the factor of the revolving wing [-], >= 1. Table 2 rounds it apart from its parts,
            so it is the better number; the product of the parts where None.
    """

    k_ind: Real
    k_tip: Real
    k_revolving: Real | None = None

    def __post_init__(self) -> None:
        """Check all, and fill in the product."""
        for name in ("k_ind", "k_tip"):
            object.__setattr__(self, name, require_real(name, getattr(self, name), 1.0, HUGEST))
        product = self.k_ind * self.k_tip if self.k_revolving is None else self.k_revolving
        object.__setattr__(self, "k_revolving", require_real("k_revolving", product, 1.0, HUGEST))


@record
class ForceConstants:
    """Constants of C_L = C_T sin 2α, C_D = C_D0 cos² α + C_D90 sin² α, measured or fitted for one wing.

    Attributes:
        lift_constant: C_T [-], > 0.
        zero_drag: C_D0 [-], >= 0.
        normal_drag: C_D90 [-], >= 0.
    """

    lift_constant: Real
    zero_drag: Real
    normal_drag: Real

    def __post_init__(self) -> None:
        """Check all."""
        lift = require_real("lift_constant", self.lift_constant, TINIEST, HUGEST)
        object.__setattr__(self, "lift_constant", lift)
        for name in ("zero_drag", "normal_drag"):
            object.__setattr__(self, name, require_real(name, getattr(self, name), 0.0, HUGEST))


@record
class Insect:
    """A hovering animal or vehicle: what it weighs, its wing, and the stroke it is known to beat.

    Attributes:
        name: how it is called in tables and files.
        mass: m of the whole body [kg].
        wing: one wing of the pair.
        stroke: its own stroke, which sets the reference frequency of boxes and the stroke k_tip is computed at.
        k_table: tabulated k_ind and k_tip; computed from the wing where None.
        force_constants: for the coefficients "berman-wang", where there are any; Berman & Wang's for three insects.
        cfd: what CFD found at its own stroke, if anything did.
        published: what the paper's own model found there.
        berman_wang: what Berman & Wang's quasi-steady model found there.

    Raises:
        TypeError: for an unknown or missing field or one of another kind.
        ValueError: for a mass that is not finite and positive, or beyond any flyer's.
    """

    name: str
    mass: Real
    wing: Wing
    stroke: Stroke
    k_table: WingFactors | None = None
    force_constants: ForceConstants | None = None
    cfd: HoverReference | None = None
    published: HoverReference | None = None
    berman_wang: HoverReference | None = None

    def __post_init__(self) -> None:
        """Check every field; parts may come as plain dicts, as from JSON."""
        if not isinstance(self.name, str) or not self.name:
            raise TypeError(f"name = {shown(self.name)} is not allowed; allowed: a non-empty string")
        object.__setattr__(self, "mass", require_real("mass", self.mass, TINIEST, HUGEST, unit="kg"))
        _part(self, "wing", Wing)
        _part(self, "stroke", Stroke)
        _part(self, "k_table", WingFactors, optional=True)
        _part(self, "force_constants", ForceConstants, optional=True)
        for source in ("cfd", "published", "berman_wang"):
            _part(self, source, HoverReference, optional=True)

    @property
    def reference(self) -> StrokeReference:
        """What of its own stroke boxes may be relative to."""
        return StrokeReference(self.stroke.frequency, self.stroke.flap_amplitude)

    def to_dict(self) -> dict[str, Any]:
        """The insect as JSON keeps it; `Insect(**d)` gives it back.

        Raises:
            TypeError: for a planform that is a function, which no file can hold.
        """
        if isinstance(self.wing.planform, FunctionPlanform):
            raise TypeError(
                f"the planform of {self.name} is a function, which cannot be written to a file; allowed there: a beta "
                "planform or a TabulatedPlanform"
            )
        return dataclasses.asdict(self)


def _part(insect: Insect, field: str, kind: type, *, optional: bool = False) -> None:
    """Build the part from a mapping where one was given, and check its kind."""
    value = getattr(insect, field)
    if isinstance(value, Mapping):
        value = kind(**value)
        object.__setattr__(insect, field, value)
    if not (isinstance(value, kind) or (optional and value is None)):
        raise TypeError(f"{field} = {shown(value)} is not allowed; allowed: a {kind.__name__} or a dict of its fields")


def read_table(name: str) -> dict[str, dict[str, str]]:
    """A table of `flapenv/data` by insect, in its own order, its values as the strings of the file."""
    with resources.files("flapenv").joinpath("data", name).open(encoding="utf-8") as file:
        return {row["insect"]: row for row in csv.DictReader(file)}


@functools.cache
def _load_all() -> dict[str, Insect]:
    """The eight insects of Tables 1-3 by name."""
    factors, references = read_table("induced_power_factors.csv"), read_table("validation_table3.csv")
    constants = read_table("berman_wang_insects.csv")
    insects = {}
    for name, row in read_table("insects.csv").items():
        number = {key: float(value) for key, value in row.items() if key != "insect"}
        table3 = references[name]
        berman_wang, fitted = table3["berman_wang_weight_support"], constants.get(name)
        insects[name] = Insect(
            name=name,
            mass=number["mass_mg"] * 1e-6,
            wing=Wing(
                length=number["wing_length_mm"] * 1e-3,
                mean_chord=number["mean_chord_mm"] * 1e-3,
                r1_hat=number["r1_hat"],
                mass=float(fitted["wing_mass_mg"]) * 1e-6 if fitted else None,
            ),
            stroke=Stroke(
                frequency=number["frequency_hz"],
                flap_amplitude=math.radians(number["flap_amplitude_deg"]),
                pitch_amplitude=math.radians(90 - number["mid_stroke_alpha_deg"]),
            ),
            k_table=WingFactors(
                k_ind=float(factors[name]["k_ind"]),
                k_tip=float(factors[name]["k_tip"]),
                k_revolving=float(factors[name]["k_ind_k_tip"]),
            ),
            force_constants=ForceConstants(
                lift_constant=float(fitted["C_T"]),
                zero_drag=float(fitted["C_D0"]),
                normal_drag=float(fitted["C_D90"]),
            )
            if fitted
            else None,
            cfd=HoverReference(
                weight_support=float(table3["cfd_weight_support"]),
                specific_power=float(table3["cfd_specific_power_w_per_kg"]),
            ),
            published=HoverReference(
                weight_support=float(table3["model_weight_support"]),
                specific_power=float(table3["model_specific_power_w_per_kg"]),
            ),
            berman_wang=HoverReference(weight_support=float(berman_wang)) if berman_wang else None,
        )
    return insects


INSECTS: tuple[str, ...] = tuple(_load_all())
"""Names of the eight CFD-validated insects, in Table 1's order."""


def load_insect(name: str) -> Insect:
    """One of the eight insects, with the data of Tables 1-3 (Sun & Du 2003; Nabawy & Crowther 2014, Part II).

    Fruit fly, bumblebee and hawkmoth also have Berman & Wang's (2007) constants and wing mass, read as one wing's.

    Args:
        name: one of `INSECTS`.

    Raises:
        ValueError: for an unknown name, with the names that exist and the nearest one.
    """
    return _load_all()[require_name("insect", name, INSECTS)]


def as_insect(value: Any) -> Insect:
    """An `Insect` from a name, an `Insect`, or the dict of its fields that JSON gives back.

    Raises:
        TypeError: for anything else.
        ValueError: for an unknown name.
    """
    if isinstance(value, str):
        return load_insect(value)
    if isinstance(value, Mapping):
        return Insect(**value)
    if isinstance(value, Insect):
        return value
    raise TypeError(f"insect = {shown(value)} is not allowed; allowed: an Insect, a dict of its fields or a name")


def described(insect: Insect) -> str | dict[str, Any]:
    """An insect for a file: its name where it is one of `INSECTS`, else all its numbers; `as_insect` gives it back.

    Raises:
        TypeError: for an insect that no file can hold.
    """
    named = insect.name in INSECTS and insect == load_insect(insect.name)
    return insect.name if named else insect.to_dict()


def pick(insects: Insect, number: int) -> Insect:
    """One of the insects that array fields hold, with scalar fields, called by its number.

    Args:
        insects: an insect with fields of shape (n,) or scalars.
        number: which, from 0.
    """

    def one(value: Any) -> Any:
        if dataclasses.is_dataclass(value) and not isinstance(value, type):
            return dataclasses.replace(
                value, **{f.name: one(getattr(value, f.name)) for f in dataclasses.fields(value)}
            )
        return float(value[number]) if np.ndim(value) == 1 and not isinstance(value, tuple | list | str) else value

    return dataclasses.replace(one(insects), name=f"{insects.name}-{number}")
