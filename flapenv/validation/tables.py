"""The numbers of the paper's tables and figures, computed."""

import warnings

import numpy as np

from flapenv.aero import induced
from flapenv.aero.checks import record
from flapenv.aero.coefficients import SECTION_LIFT_SLOPE, translational_lift_constant
from flapenv.aero.planform import FunctionPlanform
from flapenv.aero.wing import Wing
from flapenv.case import hover_case
from flapenv.insects import INSECTS, HoverReference, load_insect, read_table
from flapenv.model import COEFFICIENTS, HoverModel
from flapenv.performance import evaluate


@record
class Table2Row:
    """Parts of the induced power factor of one insect at its own stroke, ours and Table 2's [-].

    Attributes:
        insect: its name.
        k_ind: from the planform, by the lifting line.
        k_ind_paper: printed.
        k_tip: from weight and tip speed.
        k_tip_paper: printed.
        k_flap: from φmax.
        k_flap_paper: printed.
    """

    insect: str
    k_ind: float
    k_ind_paper: float
    k_tip: float
    k_tip_paper: float
    k_flap: float
    k_flap_paper: float


@record
class Table3Row:
    """One insect beating its own stroke.

    Attributes:
        insect: its name.
        weight_support: ours [-].
        specific_power: ours [W/kg].
        paper: Table 3's, of the paper's own model.
        cfd: Table 3's, of Sun & Du's CFD.
        ideal_weight_support: ours with k = 1, the ideal downwash of Fig. 6 [-].
    """

    insect: str
    weight_support: float
    specific_power: float
    paper: HoverReference
    cfd: HoverReference
    ideal_weight_support: float


def table2() -> list[Table2Row]:
    """Nabawy & Crowther (2014), Part II, Table 2, computed from Table 1 alone."""
    model, printed = HoverModel(), read_table("induced_power_factors.csv")
    rows = []
    for name in INSECTS:
        insect, paper = load_insect(name), printed[name]
        downwash = induced.hover_downwash(insect.wing, insect.mass * model.gravity, model.air_density)
        rows.append(
            Table2Row(
                insect=name,
                k_ind=induced.k_ind(insect.wing),
                k_ind_paper=float(paper["k_ind"]),
                k_tip=induced.k_tip(downwash, insect.stroke.mean_flap_speed * insect.wing.length),
                k_tip_paper=float(paper["k_tip"]),
                k_flap=induced.k_flap(insect.stroke.flap_amplitude),
                k_flap_paper=float(paper["k_flap"]),
            )
        )
    return rows


def table3() -> list[Table3Row]:
    """Nabawy & Crowther (2014), Part II, Table 3, from Table 1 and the k_ind and k_tip of Table 2."""
    rows = []
    for name in INSECTS:
        insect = load_insect(name)
        assert insect.published is not None
        assert insect.cfd is not None
        ours = evaluate(insect)
        rows.append(
            Table3Row(
                insect=name,
                weight_support=ours.weight_support,
                specific_power=ours.specific_power,
                paper=insect.published,
                cfd=insect.cfd,
                ideal_weight_support=evaluate(insect, induced=False).weight_support,
            )
        )
    return rows


def weight_support_errors(rows: list[Table3Row]) -> np.ndarray:
    """Λ of ours minus the paper's [-], shape (8,)."""
    return np.array([row.weight_support - row.paper.weight_support for row in rows])


def specific_power_errors(rows: list[Table3Row]) -> np.ndarray:
    """P* of ours minus the paper's [W/kg], shape (8,)."""
    return np.array([row.specific_power - float(row.paper.specific_power or np.nan) for row in rows])


@record
class Figure6Row:
    """Weight support of one insect as the parts of k are added one by one (Fig. 6) [-].

    Attributes:
        insect: its name.
        ideal: k = 1.
        with_k_ind: k = k_ind.
        with_k_tip: k = k_ind k_tip.
        full: k = k_ind k_tip k_flap.
    """

    insect: str
    ideal: float
    with_k_ind: float
    with_k_tip: float
    full: float


def figure6(names: tuple[str, ...] = ("fruitfly", "hoverfly")) -> list[Figure6Row]:
    """Nabawy & Crowther (2014), Part II, Fig. 6, with the k of Table 2."""
    rows = []
    for name in names:
        insect, model = load_insect(name), HoverModel()
        case, table = hover_case(insect, model), insect.k_table
        assert table is not None
        full = evaluate(insect)
        lift_per_constant = full.weight_support / full.lift_constant
        ladder = (1.0, table.k_ind, table.k_revolving, full.induced_power_factor)
        supports = [
            translational_lift_constant(case.aspect_ratio, case.edge_correction, k) * lift_per_constant for k in ladder
        ]
        rows.append(
            Figure6Row(insect=name, **dict(zip(("ideal", "with_k_ind", "with_k_tip", "full"), supports, strict=True)))
        )
    return rows


@record
class RevolvingWing:
    """A revolving wing of Fig. 5, by what the paper states of it.

    Attributes:
        name: the animal.
        aspect_ratio: AR of one wing [-].
        k: k_ind k_tip [-].
    """

    name: str
    aspect_ratio: float
    k: float

    @property
    def lift_constant(self) -> float:
        """C_T by (2.9), (2.10) [-]."""
        edge = Wing(length=self.aspect_ratio, mean_chord=1.0, r1_hat=0.5).edge_correction("ellipse")
        return float(translational_lift_constant(self.aspect_ratio, edge, self.k))


def figure5_wings() -> list[RevolvingWing]:
    """The wings of Fig. 5: AR and k as in Part II, section 3.2; the fruit fly's AR from Table 1."""
    return [
        RevolvingWing(name="hawkmoth", aspect_ratio=2.83, k=1.27),
        RevolvingWing(name="bumblebee", aspect_ratio=3.16, k=1.29),
        RevolvingWing(name="fruitfly", aspect_ratio=load_insect("fruitfly").wing.aspect_ratio, k=1.37),
    ]


def k_ind_anchors(aspect_ratio: float) -> dict[str, tuple[float, float]]:
    """k_ind of the two planforms that Part I's abstract names, with J = 0, a = 2π and with J = 0.05, a = a₂d [-].

    Args:
        aspect_ratio: AR of one wing, which the abstract does not give [-].
    """
    wings = {
        "arcsech chord": Wing(length=aspect_ratio, mean_chord=1.0, planform=FunctionPlanform(function=_arcsech)),
        "beta, r̂₁ = 0.40": Wing(length=aspect_ratio, mean_chord=1.0, r1_hat=0.40),
    }
    return {
        name: (induced.k_ind(wing), induced.k_ind(wing, root_offset=0.05, section_lift_slope=SECTION_LIFT_SLOPE))
        for name, wing in wings.items()
    }


def _arcsech(r_hat: np.ndarray) -> np.ndarray:
    """Arcsech r̂, without limit at the root."""
    return np.arccosh(1 / r_hat)


def weight_support_by_coefficients() -> dict[str, dict[str, float | None]]:
    """Λ of every insect at its own stroke under each coefficient model; None where a model has no constants for it."""
    table: dict[str, dict[str, float | None]] = {}
    with warnings.catch_warnings():
        warnings.filterwarnings("ignore", message=".*outside the range of the")  # the table is there to show it
        for name in INSECTS:
            table[name] = {
                coefficients: None
                if coefficients == "berman-wang" and load_insect(name).force_constants is None
                else evaluate(name, coefficients=coefficients).weight_support
                for coefficients in COEFFICIENTS
            }
    return table


def berman_wang_check() -> dict[str, tuple[float, float]]:
    """Λ of Berman & Wang's model in their air (1.29 kg/m³) at Table 1's strokes, and what Table 3 prints for it."""
    check = {}
    for name in INSECTS:
        printed = load_insect(name).berman_wang
        if printed is not None:
            ours = evaluate(name, coefficients="berman-wang", air_density=1.29)
            check[name] = (ours.weight_support, printed.weight_support)
    return check
