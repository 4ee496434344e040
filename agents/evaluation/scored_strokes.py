"""Strokes that a policy chooses in one Hover environment, scored by the same or another one in double precision."""

import warnings
from collections.abc import Sequence

import numpy as np

from agents.predictor import Predictor, begin
from flapenv.aero.parameters import STROKE_PARAMETERS
from flapenv.envs import HoverVectorEnv
from flapenv.insects import Insect
from flapenv.objective import Score
from flapenv.problem import HoverProblem


def make_env(insects: Sequence[Insect], problem: HoverProblem, rows: int) -> HoverVectorEnv:
    """The environment in double precision, without its warnings about models: the table says what hovers."""
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", UserWarning)
        return HoverVectorEnv(rows, insect=list(insects), problem=problem, autoreset_mode="DISABLED", dtype="float64")


def scores(policy: Predictor, number: np.ndarray, *, seen: HoverVectorEnv, flown: HoverVectorEnv) -> Score:
    """Strokes chosen from what one environment shows, scored by another, which may be the same one.

    Args:
        policy: what chooses the strokes.
        number: which insect each row is, shape (rows,).
        seen: what shows the insects, `rows` rows.
        flown: what they fly in, any number of rows.
    """
    observations, _ = seen.reset(options={"insect": list(seen.flyers.names[number])})
    begin(policy)
    actions, _ = policy.predict(observations, deterministic=True)
    info = seen.step(actions)[-1]
    return flown.objective.score(number, {name: info[f"stroke/{name}"] for name in STROKE_PARAMETERS})
