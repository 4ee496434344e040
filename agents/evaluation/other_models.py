"""A policy of Hover in aerodynamics other than those it learned, told of it and not."""

import dataclasses
from collections.abc import Sequence

import numpy as np

from agents.evaluation.scored_strokes import make_env, scores
from agents.predictor import Predictor
from flapenv.aero.checks import record
from flapenv.envs import HoverVectorEnv
from flapenv.insects import Insect
from flapenv.model import COEFFICIENTS
from flapenv.problem import HoverProblem
from flapenv.tables import text_table


@record
class ModelBeats:
    """One noise-free beat of every insect with other coefficients.

    Attributes:
        model: name of the coefficients, of `flapenv.model.COEFFICIENTS`.
        told: whether the policy saw what a yardstick stroke lifts with these coefficients (Λ_ref of the observation, of
            φmax = 60°, which does not say all of wider beats); otherwise it chose as if nothing had changed.
        feasible: names of the insects that hover with these coefficients, over which is averaged.
        infeasible: names of those that no stroke of the box carries.
        weight_support: Λ, mean [-]; None, as all means, where no insect is feasible.
        least_weight_support: Λ of the insect with the least [-].
        specific_power: P*, mean [W/kg].
        optimum_specific_power: P* of the best strokes with these coefficients, mean [W/kg].
        gap: to those, missing weight support charged, mean [-].
    """

    model: str
    told: bool
    feasible: list[str]
    infeasible: list[str]
    weight_support: float | None
    least_weight_support: float | None
    specific_power: float | None
    optimum_specific_power: float | None
    gap: float | None


def other_models(policy: Predictor, insects: Sequence[Insect], problem: HoverProblem) -> list[ModelBeats]:
    """What the policy's strokes give with each of the coefficient models, told of it and not; see `ModelBeats`.

    Models are used beyond the aspect ratios that their theories are good for, too: what is asked is how far the answer
    hangs on the model. Insects that a model has no constants for ("berman-wang") are left out of its rows.

    Args:
        policy: what chooses the strokes.
        insects: whose beats.
        problem: what the policy was trained in; only the coefficients change.
    """
    results = []
    for name in COEFFICIENTS:
        known = [insect for insect in insects if name != "berman-wang" or insect.force_constants is not None]
        if not known:
            continue
        model = dataclasses.replace(problem.model, coefficients=name)
        other = dataclasses.replace(problem, name=None, model=model)
        seen, flown = (make_env(known, one, len(known)) for one in (problem, other))
        results.append(_model_beats(name, policy, seen=flown, flown=flown, told=True))
        results.append(_model_beats(name, policy, seen=seen, flown=flown, told=False))
    return results


def model_table(results: Sequence[ModelBeats]) -> str:
    """What people read of `other_models`."""
    rows = [
        ("coefficients", "told", "insects", "weight support", "", "power", "optimum", "gap"),
        ("", "", "that hover", "mean", "least", "W/kg", "W/kg", "%"),
    ]
    for one in results:
        of = f"{len(one.feasible)} of {len(one.feasible) + len(one.infeasible)}"
        support = _number(one.weight_support, 3), _number(one.least_weight_support, 3)
        power = _number(one.specific_power, 2), _number(one.optimum_specific_power, 2)
        rows.append((one.model, "yes" if one.told else "no", of, *support, *power, _percent(one.gap)))
    return text_table(rows, header_rows=2)


def _model_beats(
    name: str, policy: Predictor, *, seen: HoverVectorEnv, flown: HoverVectorEnv, told: bool
) -> ModelBeats:
    """One row of the table of models."""
    score, flyers = scores(policy, np.arange(flown.num_envs), seen=seen, flown=flown), flown.flyers
    hovers = score.has_gap
    columns = {
        "weight_support": score.weight_support,
        "specific_power": score.specific_power,
        "optimum_specific_power": flyers.references.best_power,
        "gap": score.optimality_gap,
    }
    return ModelBeats(
        model=name,
        told=told,
        feasible=list(flyers.names[hovers]),
        infeasible=list(flyers.names[~hovers]),
        least_weight_support=float(np.min(score.weight_support[hovers])) if hovers.any() else None,
        **{key: float(np.mean(values[hovers])) if hovers.any() else None for key, values in columns.items()},
    )


def _number(value: float | None, digits: int) -> str:
    """A number, or that there is none."""
    return "none" if value is None else f"{value:.{digits}f}"


def _percent(value: float | None) -> str:
    """A fraction in percent."""
    return _number(None if value is None else 100 * value, 2)
