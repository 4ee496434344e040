"""How a policy of Hover stands up to noisy actuators, and to aerodynamics other than those it learned."""

import dataclasses
import warnings
from collections.abc import Sequence
from typing import Any

import numpy as np

from agents.noisy_actuators import NOISE_SHARE, NoisyActuators
from agents.predictor import Predictor, begin
from flapenv.aero.checks import record, require_count
from flapenv.aero.parameters import STROKE_PARAMETERS
from flapenv.envs import HoverVectorEnv
from flapenv.insects import Insect
from flapenv.model import COEFFICIENTS
from flapenv.objective import Score
from flapenv.problem import HoverProblem
from flapenv.tables import text_table

LOW_PERCENTILE = 5.0


@record
class NoisyBeats:
    """Many beats of one insect with noisy actuators.

    Attributes:
        insect: its name.
        gap: of the beat without noise [-]; None where no stroke carries the weight.
        noisy_gap: mean over the beats, missing weight support charged in each [-]; None as `gap`.
        optimum_noisy_gap: the same of the best stroke under the same noise [-]; None as `gap`.
        weight_support: Λ, mean over the beats [-].
        low_weight_support: the 5th percentile of Λ [-].
    """

    insect: str
    gap: float | None
    noisy_gap: float | None
    optimum_noisy_gap: float | None
    weight_support: float
    low_weight_support: float


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


def robustness(policy: Predictor, insects: Sequence[Insect], problem: HoverProblem) -> tuple[dict[str, Any], str]:
    """Both questions at once: their answers as JSON keeps them, and as text.

    Args:
        policy: what chooses the strokes.
        insects: whose beats.
        problem: what the policy was trained in.
    """
    noisy, models = noisy_beats(policy, insects, problem), other_models(policy, insects, problem)
    results = {
        "actuator_noise": [dataclasses.asdict(one) for one in noisy],
        "other_models": [dataclasses.asdict(one) for one in models],
    }
    return results, f"{noise_table(noisy)}\n\n{model_table(models)}"


def noisy_beats(
    policy: Predictor,
    insects: Sequence[Insect],
    problem: HoverProblem,
    *,
    share: float = NOISE_SHARE,
    beats: int = 256,
    seed: int = 0,
) -> list[NoisyBeats]:
    """What actuator noise does to every insect.

    Two per cent of the range is a standard deviation of 0.04 in every coordinate of the cube. The steepest is the tip
    speed's: in the default box 0.04 is 3.8 % in speed and so 7.6 % in lift. Half of the beats of a stroke that just
    hovers then lack some lift, which the gap charges at least ten-fold: some 30 %, nearly all of it for missing lift.
    The optimum pays it too, as it leaves no lift to spare; what a policy adds of its own is the difference to that.

    Args:
        policy: what chooses the strokes.
        insects: whose beats.
        problem: of the environment.
        share: standard deviation of the noise over the actions' range [-].
        beats: wingbeats of each insect.
        seed: of the noise.

    Raises:
        TypeError: for an argument of another type.
        ValueError: for one out of range.
    """
    number = np.repeat(np.arange(len(insects)), require_count("beats", beats))
    env = _make_env(insects, problem, len(number))
    calm = _scores(policy, number, seen=env, flown=env)
    noisy = _scores(NoisyActuators(policy, share, seed), number, seen=env, flown=env)
    best = _scores(NoisyActuators(_Optimum(env, number), share, seed), number, seen=env, flown=env)
    results = []
    for insect, own in zip(insects, np.split(np.arange(len(number)), len(insects)), strict=True):
        known = bool(noisy.has_gap[own[0]])
        results.append(
            NoisyBeats(
                insect=insect.name,
                gap=float(calm.optimality_gap[own[0]]) if known else None,
                noisy_gap=float(np.mean(noisy.optimality_gap[own])) if known else None,
                optimum_noisy_gap=float(np.mean(best.optimality_gap[own])) if known else None,
                weight_support=float(np.mean(noisy.weight_support[own])),
                low_weight_support=float(np.percentile(noisy.weight_support[own], LOW_PERCENTILE)),
            )
        )
    return results


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
        seen, flown = (_make_env(known, one, len(known)) for one in (problem, other))
        results.append(_model_beats(name, policy, seen=flown, flown=flown, told=True))
        results.append(_model_beats(name, policy, seen=seen, flown=flown, told=False))
    return results


def noise_table(results: Sequence[NoisyBeats]) -> str:
    """What people read of `noisy_beats`."""
    rows = [
        ("insect", "gap", "with noise", "the optimum's", "weight support", "5th"),
        ("", "%", "%", "with noise %", "with noise", "percentile"),
    ]
    for one in results:
        gaps = _percent(one.gap), _percent(one.noisy_gap), _percent(one.optimum_noisy_gap)
        rows.append((one.insect, *gaps, f"{one.weight_support:.4f}", f"{one.low_weight_support:.4f}"))
    table = text_table(rows, header_rows=2)
    pairs = [(one.noisy_gap, one.optimum_noisy_gap) for one in results]
    known = [(own, best) for own, best in pairs if own is not None and best is not None]
    if not known:
        return table
    own, best = 100 * np.mean(known, axis=0)
    return f"{table}\nmean gap with noise: {own:.2f} %, the optimum's {best:.2f} %"


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


class _Optimum:
    """The best stroke of every row's insect, as a policy."""

    def __init__(self, env: HoverVectorEnv, number: np.ndarray) -> None:
        """Encode the optima that the environment knows; `number` says which insect each row is."""
        rows = zip(env.flyers.optima, map(env.flyers.__getitem__, range(len(env.flyers))), strict=True)
        actions = [env.coordinates.encode(vars(best.stroke), insect.reference) for best, insect in rows]
        self.actions = np.stack(actions)[number].astype(np.float32)

    def predict(self, observation: np.ndarray, *, deterministic: bool = True) -> tuple[np.ndarray, None]:
        """One action a row, whatever is seen."""
        return self.actions, None


def _make_env(insects: Sequence[Insect], problem: HoverProblem, rows: int) -> HoverVectorEnv:
    """The environment in double precision, without its warnings about models: the table says what hovers."""
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", UserWarning)
        return HoverVectorEnv(rows, insect=list(insects), problem=problem, autoreset_mode="DISABLED", dtype="float64")


def _scores(policy: Predictor, number: np.ndarray, *, seen: HoverVectorEnv, flown: HoverVectorEnv) -> Score:
    """Strokes chosen from what one environment shows, scored by another, which may be the same one.

    Args:
        policy: what chooses the strokes.
        number: which insect each row is, shape (rows,).
        seen: what shows the insects, `rows` rows.
        flown: what they fly in.
    """
    observations, _ = seen.reset(options={"insect": list(seen.flyers.names[number])})
    begin(policy)
    actions, _ = policy.predict(observations, deterministic=True)
    info = seen.step(actions)[-1]
    return flown.objective.score(number, {name: info[f"stroke/{name}"] for name in STROKE_PARAMETERS})


def _model_beats(
    name: str, policy: Predictor, *, seen: HoverVectorEnv, flown: HoverVectorEnv, told: bool
) -> ModelBeats:
    """One row of the table of models."""
    score, flyers = _scores(policy, np.arange(flown.num_envs), seen=seen, flown=flown), flown.flyers
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
