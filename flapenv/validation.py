"""The paper's tables beside ours: `python -m flapenv.validation` prints them with their errors."""

import numpy as np

from flapenv.aero import induced
from flapenv.aero.checks import record
from flapenv.insects import INSECTS, HoverReference, load_insect, read_table
from flapenv.model import HoverModel
from flapenv.performance import evaluate
from flapenv.tables import text_table


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


def validation_report() -> str:
    """Both tables and their errors as text."""
    second, third = table2(), table3()
    factors: list[tuple[str, ...]] = [("Table 2", "k_ind", "paper", "k_tip", "paper", "k_flap", "paper")]
    factors += [
        (
            row.insect,
            *(
                f"{value:.{digits}f}"
                for ours, paper in (
                    (row.k_ind, row.k_ind_paper),
                    (row.k_tip, row.k_tip_paper),
                    (row.k_flap, row.k_flap_paper),
                )
                for value, digits in ((ours, 3), (paper, 2))
            ),
        )
        for row in second
    ]
    hover: list[tuple[str, ...]] = [("Table 3", "Λ", "paper", "CFD", "P* [W/kg]", "paper", "CFD", "Λ at k = 1")]
    hover += [
        (
            row.insect,
            f"{row.weight_support:.3f}",
            f"{row.paper.weight_support:g}",
            f"{row.cfd.weight_support:g}",
            f"{row.specific_power:.1f}",
            f"{row.paper.specific_power:g}",
            f"{row.cfd.specific_power:g}",
            f"{row.ideal_weight_support:.3f}",
        )
        for row in third
    ]
    lift, power = weight_support_errors(third), specific_power_errors(third)
    relative = lift / np.array([row.paper.weight_support for row in third])
    k_ind = max(abs(row.k_ind - row.k_ind_paper) for row in second)
    exact = {
        name: [row.insect for row in second if round(getattr(row, name), 2) != getattr(row, f"{name}_paper")]
        for name in ("k_tip", "k_flap")
    }
    return "\n".join(
        (
            text_table(factors),
            f"k_ind: largest error {k_ind:.3f}",
            *(f"{name}: differs in the second decimal for {', '.join(off) or 'none'}" for name, off in exact.items()),
            "",
            text_table(hover),
            f"Λ against the paper: largest error {np.max(np.abs(lift)):.3f}, "
            f"rms {100 * np.sqrt(np.mean(relative**2)):.2f} %",
            f"P* against the paper: largest error {np.max(np.abs(power)):.2f} W/kg, "
            f"rms {np.sqrt(np.mean(power**2)):.2f} W/kg",
        )
    )


if __name__ == "__main__":
    print(validation_report())
