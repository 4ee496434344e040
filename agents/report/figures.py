"""The figures of a report and what they say to those who do not see them."""

from collections.abc import Sequence

import plotly.graph_objects as go

from agents.plots.beat import beat
from agents.plots.cycle import forces, terms, waveforms
from agents.plots.front import front
from agents.plots.learning_curve import learning_curve
from agents.plots.savings import savings
from agents.plots.sensitivities import fixed_parameters, sensitivities
from agents.report.content import ReportContent
from flapenv.aero.checks import record
from flapenv.aero.stroke import Stroke
from flapenv.assessment import StrokeAssessment
from flapenv.model import HoverModel
from flapenv.trade_off import weight_front

FRONT_WEIGHTS = (0.7, 0.8, 0.9, 1.0, 1.1, 1.2, 1.3, 1.4, 1.5, 1.6)
"""Weight supports at which fronts are found, with the full weight among them."""


SLOWED = "Each is slowed down so that one beat takes as long on the screen as the other's."


@record
class PlacedFigure:
    """A figure with its place on the page.

    Attributes:
        key: its id on the page.
        title: above it.
        text: what it shows, in words, below it and for those who do not see it.
        json: the figure as Plotly reads it.
        height: of it [px].
    """

    key: str
    title: str
    text: str
    json: str
    height: int


def placed(figure: go.Figure, key: str, title: str, text: str) -> PlacedFigure:
    """A figure ready for the page."""
    made = str(figure.to_json(validate=False))
    return PlacedFigure(key=key, title=title, text=text, json=made, height=int(figure.layout.height))


def curve_figure(content: ReportContent) -> PlacedFigure | None:
    """The learning curve, where something was trained."""
    if not content.curve:
        return None
    figure = learning_curve(content.curve, content.distance)
    text = (
        f"The policy's {content.distance}, without noise, against the wingbeats it was trained on; dotted: 1 %. "
        "Watched only: the last policy is the result."
    )
    return placed(figure, "learning-curve", "Learning curve", text)


def savings_figure(strokes: Sequence[StrokeAssessment], called: str) -> PlacedFigure:
    """How much less power is needed."""
    hatched = (
        "Hatched bars: of the power that CFD found. " if any(one.saving_to_cfd is not None for one in strokes) else ""
    )
    whiskers = any(one.saving_uncertainty is not None for one in strokes)
    text = (
        f"What the {called} stroke saves of the power of the insect's own stroke. Plain bars: in this model, both "
        "strokes slowed or hurried until they carry exactly the weight"
        f"{'; whiskers: what the model is off CFD makes of it' if whiskers else ''}. {hatched}"
        "Diamonds: both as they are, whatever they lift."
    )
    return placed(savings(strokes), "savings", "Power saved", text)


def front_figure(strokes: Sequence[StrokeAssessment], called: str) -> PlacedFigure | None:
    """The fronts, where they can be had in a moment: not without springs, and not where nobody can hover."""
    hovering = [one for one in strokes if one.best.feasible and one.problem.model.has_proven_bound]
    if not hovering:
        return None
    fronts = [weight_front(one.insect, FRONT_WEIGHTS, one.problem) for one in hovering]
    text = (
        "Least power (grey; insects whose fronts agree within 1 % share a line, which ends where none of them can "
        "carry more) against the weight that is carried, both over the insect's optimum at its full weight, so that "
        f"all fronts pass through (1, 1). Circles: {called}, named where they lie elsewhere. Squares: the insects' own "
        "strokes at the weight that they carry in this model. Below its line no stroke of the box lies."
    )
    return placed(front(hovering, fronts, called), "front", "Power against weight support", text)


def sensitivities_figure(strokes: Sequence[StrokeAssessment]) -> PlacedFigure | None:
    """What steps from the optimum cost, where it has a price."""
    optima = [one.best for one in strokes if one.best.feasible and one.best.sensitivity]
    if not optima:
        return None
    fixed = fixed_parameters(strokes[0].problem)
    several = "median of the insects, whiskers from the least to the most. " if len(optima) > 1 else ""
    left_out = "; parameters that the problem fixes have no line" if fixed else ""
    text = (
        f"What a small step from the optimum costs: {several}No bar: "
        f"the optimum lies inside the box, where a small step costs nothing to first order{left_out}."
    )
    return placed(sensitivities(optima, fixed), "sensitivities", "What counts", text)


def counted_of(model: HoverModel) -> str:
    """What the figure of force and power shows, in words."""
    if model.accounting == "positive":
        return (
            "Translational lift over weight, and over body mass the power that is paid: each wing's power of "
            "translation, added mass and inertia together, where it is positive"
        )
    return "Translational lift over weight and aerodynamic power over body mass"


def counting_of(model: HoverModel) -> str:
    """Which of the terms count, in a sentence."""
    if model.accounting == "positive":
        return (
            "In the table above the translational term counts for the lift, and for the power those of translation, "
            "added mass and inertia together, where they are positive; the others show what it leaves out."
        )
    return "Only the translational term counts in the table above; the others show what it leaves out."


def strokes_of(one: StrokeAssessment, called: str) -> dict[str, Stroke]:
    """The strokes of an insect that are shown beside each other, by label."""
    best = "optimal" if one.best.feasible else "most lift"
    own = {} if one.is_own else {"own": one.insect.stroke}
    return {called: one.stroke, best: one.best.stroke, **own}


def insect_figures(one: StrokeAssessment, called: str, number: int) -> dict[str, PlacedFigure]:
    """What the wing of one insect does, by a short name of what is shown.

    Args:
        one: its stroke.
        called: what the stroke is, in a word.
        number: of the insect on the page.
    """
    insect, model, strokes = one.insect, one.problem.model, strokes_of(one, called)
    beside = {label: stroke for label, stroke in strokes.items() if label in (called, "own")}
    names = ", ".join(strokes)
    drawn = {
        "beat": (
            beat(insect, beside, model),
            "The wingbeat",
            f"Wing section at r̂₂ R seen from the wing tip, dot at the leading edge, arrow for the force: "
            f"{', '.join(beside)}. {SLOWED if len(beside) > 1 else ''}",
        ),
        "waveforms": (
            waveforms(insect, strokes, model),
            "Waveforms",
            f"Flapping angle φ, pitching angle θ and angle of attack α over the cycle: {names}.",
        ),
        "forces": (
            forces(insect, strokes, model),
            "Force and power",
            f"{counted_of(model)}, over the cycle: {names}.",
        ),
        "terms": (
            terms(insect, one.stroke, model),
            f"Term by term: {called}",
            f"Lift and power of the stroke by the blade element, term by term. {counting_of(model)}",
        ),
    }
    return {key: placed(figure, f"{key}-{number}", *told) for key, (figure, *told) in drawn.items()}
