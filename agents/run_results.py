"""What a run leaves when it has ended: policy, results, pictures and the report."""

import sys
from pathlib import Path
from typing import Any

from stable_baselines3.common.base_class import BaseAlgorithm

from agents.actor_of import actor_of
from agents.curve_picture import draw_learning_curve
from agents.policy_card import PolicyCard
from agents.policy_file import save_policy
from agents.run_folder import CURVE_PICTURE, POLICY_TENSORS, RESULT_PICTURE, RESULTS, versions, write_atomically
from agents.tasks import Predictor, Task
from agents.training_config import TrainingConfig, TrainingResult
from flapenv.whole_file import write_json


def save_actor(config: TrainingConfig, model: BaseAlgorithm, out: Path, result: dict[str, Any]) -> None:
    """Write the policy's network as safetensors with its card, which says what it reached."""
    described, actor = config.to_dict(), actor_of(model)
    card = PolicyCard.of(
        actor,
        environment=described["environment"],
        task=described["task"],
        algorithm=described["algorithm"],
        preset=config.name,
        command=config.command,
        seed=config.seed,
        wingbeats=model.num_timesteps,
        result=result,
        versions=versions(),
    )
    save_policy(actor, card, out / POLICY_TENSORS)


def save_results(config: TrainingConfig, result: TrainingResult, model: BaseAlgorithm) -> None:
    """Write results.json, and what the policy reached on its card."""
    verdict = result.verdict
    scores = {"mean": verdict.mean, "worst": verdict.worst, "distance": config.preset.make_task().distance}
    save_actor(config, model, result.out, {**scores, "seconds": round(result.seconds, 1)})
    write_json(
        result.out / RESULTS,
        {
            **config.to_dict(),
            "verdict": scores,
            **verdict.results,
            "seconds": result.seconds,
            "wingbeats": result.wingbeats,
            "interrupted": result.interrupted,
            "versions": versions(),
        },
    )


def draw_pictures(title: str, task: Task, result: TrainingResult, policy: Predictor) -> None:
    """Add the learning curve, under a title, and the task's picture to the run's folder."""
    write_atomically(result.out / CURVE_PICTURE, draw_learning_curve(result.out, task.distance, title).savefig)
    write_atomically(result.out / RESULT_PICTURE, task.draw(policy).savefig)


def reported(config: TrainingConfig, task: Task, result: TrainingResult) -> Path | None:
    """The report, beside results that are kept already: whatever goes wrong with drawing must not cost the run."""
    from agents.report.of_run import report_of_run

    try:
        return report_of_run(config, task, result)
    except OSError:  # a full disk: what is missing can be made later
        raise
    except Exception as mistake:
        print(f"the report could not be drawn: {mistake}; the run is kept without it", file=sys.stderr)
        return None
