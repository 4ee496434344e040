"""What actuator noise costs a policy of Hover, beside what it costs the best strokes."""

from collections.abc import Sequence

import numpy as np

from agents.evaluation.noisy_actuators import NOISE_SHARE, NoisyActuators
from agents.evaluation.scored_strokes import make_env, scores
from agents.predictor import Predictor
from flapenv.aero.checks import record, require_count
from flapenv.envs import HoverVectorEnv
from flapenv.insects import Insect
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
    each = np.arange(len(insects))
    number = np.repeat(each, require_count("beats", beats))
    one, many = (make_env(insects, problem, rows) for rows in (len(each), len(number)))
    calm = scores(policy, each, seen=one, flown=one)
    noisy = scores(NoisyActuators(policy, share, seed), number, seen=many, flown=many)
    best = scores(NoisyActuators(_Optimum(many, number), share, seed), number, seen=many, flown=many)
    results = []
    for place, insect in enumerate(insects):
        own, known = number == place, bool(calm.has_gap[place])
        results.append(
            NoisyBeats(
                insect=insect.name,
                gap=float(calm.optimality_gap[place]) if known else None,
                noisy_gap=float(np.mean(noisy.optimality_gap[own])) if known else None,
                optimum_noisy_gap=float(np.mean(best.optimality_gap[own])) if known else None,
                weight_support=float(np.mean(noisy.weight_support[own])),
                low_weight_support=float(np.percentile(noisy.weight_support[own], LOW_PERCENTILE)),
            )
        )
    return results


def noise_table(results: Sequence[NoisyBeats]) -> str:
    """What people read of `noisy_beats`."""
    rows: list[tuple[str, ...]] = [
        ("insect", "gap", "with noise", "the optimum's", "weight support", "5th"),
        ("", "%", "%", "with noise %", "with noise", "percentile"),
    ]
    for one in results:
        known = (one.gap, one.noisy_gap, one.optimum_noisy_gap)
        gaps = ("none" if gap is None else f"{100 * gap:.2f}" for gap in known)
        rows.append((one.insect, *gaps, f"{one.weight_support:.4f}", f"{one.low_weight_support:.4f}"))
    table = text_table(rows, header_rows=2)
    pairs = [(one.noisy_gap, one.optimum_noisy_gap) for one in results]
    both = [(own, best) for own, best in pairs if own is not None and best is not None]
    if not both:
        return table
    own, best = 100 * np.mean(both, axis=0)
    return f"{table}\nmean gap with noise: {own:.2f} %, the optimum's {best:.2f} %"


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
