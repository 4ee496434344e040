"""How a policy of Hover stands up to noisy actuators, and to aerodynamics other than those it learned."""

import dataclasses
from collections.abc import Sequence
from typing import Any

from agents.evaluation.noisy_beats import noise_table, noisy_beats
from agents.evaluation.other_models import model_table, other_models
from agents.predictor import Predictor
from flapenv.insects import Insect
from flapenv.problem import HoverProblem


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
