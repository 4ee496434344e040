"""The validation report: every table with its errors, as text to print and as a page with figures."""

from pathlib import Path

import numpy as np

from flapenv.insects import INSECTS
from flapenv.model import COEFFICIENTS
from flapenv.tables import text_table
from flapenv.validation.convergence import STEPS, STRIPS, TERMS, step_errors, strip_errors, term_errors
from flapenv.validation.tables import (
    berman_wang_check,
    figure5_wings,
    figure6,
    k_ind_anchors,
    specific_power_errors,
    table2,
    table3,
    weight_support_by_coefficients,
    weight_support_errors,
)

ANCHOR_ASPECT_RATIOS = (3.0, 4.0, 5.0)


def table2_text() -> str:
    """Table 2 beside ours."""
    rows = table2()
    lines: list[tuple[str, ...]] = [
        ("Table 2", "k_ind", "paper", "error", "k_tip", "paper", "error", "k_flap", "paper", "error")
    ]
    for row in rows:
        cells = [row.insect]
        for ours, paper in ((row.k_ind, row.k_ind_paper), (row.k_tip, row.k_tip_paper), (row.k_flap, row.k_flap_paper)):
            cells += [f"{ours:.3f}", f"{paper:.2f}", f"{ours - paper:+.3f}"]
        lines.append(tuple(cells))
    off = {
        name: [row.insect for row in rows if round(getattr(row, name), 2) != getattr(row, f"{name}_paper")]
        for name in ("k_tip", "k_flap")
    }
    return "\n".join(
        (
            text_table(lines),
            f"k_ind: largest error {max(abs(row.k_ind - row.k_ind_paper) for row in rows):.3f}",
            *(f"{name}: differs in the second decimal for {', '.join(who) or 'none'}" for name, who in off.items()),
        )
    )


def table3_text() -> str:
    """Table 3 beside ours: the paper's model and Sun & Du's CFD."""
    rows = table3()
    lines: list[tuple[str, ...]] = [
        ("Table 3", "Λ", "paper", "error", "CFD", "P*", "paper", "error", "CFD", "error"),
        ("", "", "", "", "", "W/kg", "W/kg", "W/kg", "W/kg", "%"),
    ]
    lift, power = weight_support_errors(rows), specific_power_errors(rows)
    cfd = np.array([float(row.cfd.specific_power or np.nan) for row in rows])
    to_cfd = np.array([row.specific_power for row in rows]) / cfd - 1
    lines += [
        (
            row.insect,
            f"{row.weight_support:.3f}",
            f"{row.paper.weight_support:g}",
            f"{lift[i]:+.3f}",
            f"{row.cfd.weight_support:g}",
            f"{row.specific_power:.1f}",
            f"{row.paper.specific_power:g}",
            f"{power[i]:+.2f}",
            f"{cfd[i]:g}",
            f"{100 * to_cfd[i]:+.0f}",
        )
        for i, row in enumerate(rows)
    ]
    relative = lift / np.array([row.paper.weight_support for row in rows])
    support = np.array([row.weight_support for row in rows])
    return "\n".join(
        (
            text_table(lines, header_rows=2),
            f"Λ against the paper: largest error {np.max(np.abs(lift)):.3f}, rms {100 * _rms(relative):.2f} %",
            f"P* against the paper: largest error {np.max(np.abs(power)):.2f} W/kg, rms {_rms(power):.2f} W/kg",
            f"Λ against CFD: rms {100 * _rms(support - 1):.1f} %",
            f"P* against CFD: rms {100 * _rms(to_cfd):.1f} %",
        )
    )


def figure5_text() -> str:
    """C_T of the revolving wings."""
    lines: list[tuple[str, ...]] = [("Fig. 5", "AR", "k", "C_T")]
    lines += [
        (wing.name, f"{wing.aspect_ratio:.2f}", f"{wing.k:.2f}", f"{wing.lift_constant:.3f}")
        for wing in figure5_wings()
    ]
    return text_table(lines)


def figure6_text() -> str:
    """Weight support as the parts of k come in."""
    lines: list[tuple[str, ...]] = [("Fig. 6: Λ with", "k = 1", "k_ind", "k_ind k_tip", "full k")]
    lines += [
        (row.insect, *(f"{value:.3f}" for value in (row.ideal, row.with_k_ind, row.with_k_tip, row.full)))
        for row in figure6()
    ]
    return text_table(lines)


def anchors_text() -> str:
    """The anchors of Part I's abstract, as they come out."""
    lines: list[tuple[str, ...]] = [("k_ind of", "AR", "J = 0, a = 2π", "J = 0.05, a = a₂d", "Part I")]
    for aspect_ratio in ANCHOR_ASPECT_RATIOS:
        for (name, values), printed in zip(k_ind_anchors(aspect_ratio).items(), ("1.02", "1.07"), strict=True):
            lines.append((name, f"{aspect_ratio:g}", *(f"{value:.3f}" for value in values), printed))
    return text_table(lines)


def models_text() -> str:
    """Weight support under every coefficient model."""
    lines: list[tuple[str, ...]] = [("Λ at the own stroke", *COEFFICIENTS)]
    for name, row in weight_support_by_coefficients().items():
        lines.append((name, *("-" if value is None else f"{value:.3f}" for value in row.values())))
    return text_table(lines)


def berman_wang_text() -> str:
    """Berman & Wang's model in their air."""
    lines = [("Berman & Wang, ρ = 1.29", "Λ", "Table 3", "error")]
    lines += [
        (name, f"{ours:.3f}", f"{printed:g}", f"{ours - printed:+.3f}")
        for name, (ours, printed) in berman_wang_check().items()
    ]
    return text_table(lines)


def convergence_text() -> str:
    """Largest errors over the eight insects."""
    lines = [("largest of eight insects", "", "Λ", "P*")]
    for what, counts, errors in (
        ("even strips", STRIPS, [strip_errors(name) for name in INSECTS]),
        ("even steps", STEPS, [step_errors(name) for name in INSECTS]),
    ):
        worst = np.max(np.abs(errors), axis=0)
        lines += [(what, f"{n}", f"{a:.0e}", f"{b:.0e}") for n, (a, b) in zip(counts, worst, strict=True) if n >= 25]
    terms = np.max(np.abs([term_errors(name) for name in INSECTS]), axis=0)
    lines += [("terms of k_ind", f"{n}", f"{error:.0e}", "") for n, error in zip(TERMS, terms, strict=True)]
    return text_table(lines)


SECTIONS = (
    table2_text,
    table3_text,
    figure5_text,
    figure6_text,
    anchors_text,
    models_text,
    berman_wang_text,
    convergence_text,
)
"""Every table, in the order it is printed."""


def report() -> str:
    """Every table, as text."""
    return "\n\n".join(section() for section in SECTIONS)


def _rms(values: np.ndarray) -> float:
    """Root of the mean square."""
    return float(np.sqrt(np.mean(values**2)))


def page() -> str:
    """The report as docs/validation.md."""
    hoverfly = figure6(("hoverfly",))[0].ideal
    tables = {section.__name__: _indented(section()) for section in SECTIONS}
    return PAGE.format(hoverfly_excess=f"{100 * (hoverfly - 1):.0f}", **tables)


def write_report(folder: Path) -> list[Path]:
    """Write the page and draw its figures.

    Args:
        folder: made if need be; gets validation.md and images/.

    Returns:
        The files written.

    Raises:
        ImportError: without matplotlib.
        OSError: if the folder cannot be written.
    """
    from flapenv.validation.figures import FIGURES

    images = folder / "images"
    images.mkdir(parents=True, exist_ok=True)
    written = []
    for name, draw in FIGURES.items():
        written.append(images / f"{name}.png")
        draw().savefig(written[-1])
    written.append(folder / "validation.md")
    written[-1].write_text(page(), encoding="utf-8")
    return written


def _indented(text: str) -> str:
    """Text as a block of Markdown."""
    return "\n".join(f"    {line}".rstrip() for line in text.splitlines())


PAGE = """# Validation

Written by `python -m flapenv.validation --out docs`; `make validate` prints the tables. References: Nabawy &
Crowther (2014), Part II, for the model; Sun & Du (2003) for CFD; Berman & Wang (2007) and Dickinson, Lehmann & Sane
(1999) for the other coefficients.

## Table 2: the induced power factor

k_ind by the lifting line from the planform alone, k_tip from weight and tip speed, k_flap from φmax, all at the
insect's own stroke.

{table2_text}

Dronefly's k_tip comes out at 1.09 where 1.06 is printed, with the formula that meets the other seven; it is reported,
not tuned.

Part I's abstract names two more k_ind, without an aspect ratio. They come out higher:

{anchors_text}

## Table 3: weight support and power

At Table 1's strokes with Cφ → 0, Cθ = 5, δ = 90° and Table 2's k_ind k_tip, ρ = 1.225 kg/m³ (the paper does not state
it). CFD's weight support is 1 by construction: Sun & Du sought the angle of attack that gives it.

{table3_text}

Against CFD, the error of P* is the uncertainty of a power that this package prints.

## Fig. 2: the kinematics

![Waveforms of the flapping and the pitching angle](images/figure2.png)

## Fig. 4: against the leading-edge suction analogy

(a) shape of (3.1) and of sin 2α, each over its largest value; (b) what (3.1) has beyond (2.7), at 45° and k = 1, on the
extended lifting line. It lies a little above one and grows with the aspect ratio, as the paper finds.

![Polhamus against sin 2α](images/figure4.png)

## Fig. 5: revolving wings

{figure5_text}

Curves of this model and of two sets of fitted coefficients. The paper draws digitised experiments here (Usherwood &
Ellington 2002, Lentink & Dickinson 2009): those points are not redistributed, so the curves stand alone. Only the
fits of Dickinson et al. come from measurements (a dynamically scaled fruit fly, for every wing the same); Berman &
Wang's constants are those of their hovering model.

![Lift and drag coefficients of revolving wings](images/figure5.png)

## Fig. 6: what each part of k does

{figure6_text}

With k = 1 the hoverfly's weight support is {hoverfly_excess} % above unity; the paper says 23 %.

![Weight support as the parts of k come in](images/figure6.png)

## Other coefficient models

`evaluate(insect, coefficients=name)`; each at Table 1's stroke, ρ = 1.225 kg/m³, where CFD's weight support is 1.
Nearly all lift more than the paper's model. The extended lifting line is meant for aspect ratios below 3 and Polhamus'
analogy for less than 2; beyond, a warning says so.

{models_text}

Berman & Wang's model, on their half-ellipse planform and in their air, at the kinematics of Table 1 (for the bumblebee
155 Hz, not the 116 Hz of their own table):

{berman_wang_text}

## Convergence

The fast path (exact span moments, quadrature in time to 1e-12) is what the paper's blade element tends to as its strips
and steps are refined; 50 x 500 is the paper's resolution. k_ind is used with 64 terms.

{convergence_text}

![Convergence of strips, steps and terms](images/convergence.png)
"""
