"""The four problems for the eight insects, as tables: `python -m flapenv.problem_tables`."""

import math

from flapenv.insects import INSECTS, load_insect
from flapenv.optimum import Optimum, optimum
from flapenv.performance import evaluate
from flapenv.problem import PROBLEMS
from flapenv.tables import text_table

HEADER = ("W/kg", "bound", "P*/bound", "Λ_max", "f Hz", "φmax °", "Cφ", "Cθ", "α_mid °", "δ °", "dP*/dΛ")


def problem_table(name: str) -> str:
    """Best strokes of one named problem, with bound, margin and the price of lift."""
    rows: list[tuple[str, ...]] = [(name, *HEADER)]
    for insect in INSECTS:
        if PROBLEMS[name].model.accounting == "positive" and load_insect(insect).wing.mass is None:
            continue
        rows.append((insect, *cells(optimum(insect, name))))
    return text_table(rows)


def springs_table() -> str:
    """What springs would save: the best stroke without them, and problem A's stroke with them and without [W/kg]."""
    rows: list[tuple[str, ...]] = [
        ("power [W/kg]", "best without springs", "best with springs", "saved %", "the latter without springs")
    ]
    for insect in INSECTS:
        if load_insect(insect).wing.mass is None:
            continue
        without, elastic = optimum(insect, "inertial"), optimum(insect)
        paid = evaluate(insect, elastic.stroke, accounting="positive").specific_power
        saved = 100 * (1 - elastic.specific_power / without.specific_power)
        rows.append(
            (
                insect,
                f"{without.specific_power:.2f}",
                f"{elastic.specific_power:.2f}",
                f"{saved:.1f}",
                f"{paid:.2f}",
            )
        )
    return text_table(rows)


def cells(best: Optimum) -> tuple[str, ...]:
    """One row: power and bound, margin, stroke, multiplier."""
    stroke, bound = best.stroke, best.lower_bound
    return (
        f"{best.specific_power:.2f}" if best.feasible else "none",
        "none" if bound is None else f"{bound:.2f}",
        "-" if bound is None or not best.feasible else f"{best.specific_power / bound:.3f}",
        f"{best.max_weight_support:.3f}",
        f"{stroke.frequency:.4g}",
        f"{math.degrees(stroke.flap_amplitude):.1f}",
        f"{stroke.flap_shape:.3f}",
        f"{stroke.pitch_shape:.2f}",
        f"{90 - math.degrees(stroke.pitch_amplitude):.1f}",
        f"{math.degrees(stroke.pitch_phase):.1f}",
        f"{best.multiplier:.1f}" if best.feasible else "-",
    )


def report() -> str:
    """All tables."""
    return "\n\n".join([*(problem_table(name) for name in PROBLEMS), springs_table()])


if __name__ == "__main__":
    print(report())
