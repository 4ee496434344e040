"""What `train.py evaluate` judges: policies, stroke files and published strokes, all by the same kind of verdict."""

import os
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any

from agents.evaluation.comparison import Comparison
from agents.evaluation.noisy_actuators import NoisyActuators
from agents.evaluation.stroke_pairs import PUBLISHED, is_strokes, stroke_pairs
from agents.policy_card import PolicyCard
from agents.policy_file import find_policy, load_policy, shipped_policies
from agents.predictor import Predictor
from agents.presets import Preset
from agents.recurrent_actor import AnyActor
from agents.run_folder import real_name
from agents.tasks import TASKS, HoverTask, RandomWingsTask, Task, Verdict
from agents.tasks.hover_picture import draw_strokes
from agents.tasks.stroke_verdict import verdict_of
from flapenv.aero.checks import allowed, record, require_name, shown
from flapenv.assessment import assess
from flapenv.files import WingFile
from flapenv.files.envelope import errors_of
from flapenv.insects import INSECTS
from flapenv.problem import HoverProblem, as_problem

if TYPE_CHECKING:
    from matplotlib.figure import Figure


@record
class Asked:
    """What else is wanted of what is judged; None and empty where nothing is said.

    Attributes:
        insects: names of insects.
        wings: wings of one's own.
        problem: name of a problem.
        pool_seed: of random wings.
        noise: of the actuators, over the range of the actions [-].
        robustness: whether noise and other models are tried.
        costs: whether the costs of a new wing are measured.
    """

    insects: Sequence[str] | None = None
    wings: Sequence[WingFile] = ()
    problem: str | None = None
    pool_seed: int | None = None
    noise: float = 0.0
    robustness: bool = False
    costs: bool = False


@record
class Evaluated:
    """A verdict and what it is about.

    Attributes:
        title: one line that says what was judged.
        verdict: the verdict.
        about: what of it results.json holds beside the verdict's own results.
        told: what is said below the verdict, each a table or a few lines.
        called: what the strokes are, in a word.
        task: of a policy.
        policy: what was flown, with its noise.
        card: of a policy.
        source: the policy's file.
    """

    title: str
    verdict: Verdict
    about: Mapping[str, Any]
    told: Sequence[str] = ()
    called: str
    task: Task | None = None
    policy: Predictor | None = None
    card: PolicyCard | None = None
    source: Path | None = None

    def draw(self) -> "Figure":
        """A picture of what was judged."""
        if self.task is None or self.policy is None or isinstance(self.task, HoverTask):
            return draw_strokes(self.verdict.assessments, self.called)
        return self.task.draw(self.policy)


def evaluated(subject: str | os.PathLike[str], asked: Asked) -> Evaluated:
    """Judge one policy or one file of strokes.

    Args:
        subject: a shipped policy, a run's folder, NAME.safetensors, a file of strokes, an insect's name, or
            `PUBLISHED`.
        asked: what else is wanted.

    Raises:
        ValueError: for an unknown name, files that are not what they say, or what does not fit what is asked for.
        TypeError: for arguments that the policy's task does not have.
        OSError: for files that cannot be read.
    """
    name = os.fspath(subject)
    if name not in shipped_policies() and is_strokes(name):
        return _evaluated_strokes(name, asked)
    if not Path(name).exists() and name not in shipped_policies() and not Path(name).suffix and Path(name).name == name:
        files = ("a run's folder", "NAME.safetensors", "NAME.json", "NAME.csv")
        known = [*shipped_policies(), PUBLISHED, *INSECTS, *files]
        raise ValueError(f"{shown(name)} is unknown; {allowed(name, known)}")
    return _evaluated_policy(name, asked)


def _evaluated_policy(name: str, asked: Asked) -> Evaluated:
    """The verdict on a policy's strokes."""
    actor, card = load_policy(name)
    own = asked.insects if not asked.wings else [wing.insect for wing in asked.wings]
    task = _task(card.task, {"insects": own, "problem": asked.problem, "pool_seed": asked.pool_seed})
    if card.environment != task.environment:
        raise ValueError(f"the card of {name} says {card.environment}, its task flies {task.environment}")
    card.require_fit(task.vector_env(1))
    with errors_of("--noise"):
        flown = NoisyActuators(actor, asked.noise) if asked.noise else actor
    verdict = _judged(task, flown, asked.wings)
    more = [*_robustness(actor, task, asked), *_costs(actor, task, card, asked)]
    known = real_name(name)
    return Evaluated(
        title=f"{known}: {card.algorithm} on {card.environment}, {card.wingbeats:,} wingbeats, seed {card.seed}",
        verdict=verdict,
        about={
            "policy": known,
            "sha256": card.sha256,
            "noise": asked.noise,
            "distance": task.distance,
            **{key: value for key, value, _ in more},
        },
        told=[text for _, _, text in more],
        called="learned",
        task=task,
        policy=flown,
        card=card,
        source=find_policy(name),
    )


def _task(described: Mapping[str, Any], asked: Mapping[str, Any]) -> Task:
    """The task of a card with other arguments where they are asked for."""
    own = {name: value for name, value in described.items() if name != "name"}
    own |= {name: value for name, value in asked.items() if value is not None}
    name = require_name("task", described.get("name"), TASKS)
    if name == "random-wings" and own.get("insects"):  # a policy for every wing flies named ones, too
        name, own = "hover", {key: own[key] for key in ("insects", "problem") if key in own}
    return Preset(task=name, arguments=own, settings=None).make_task()


def _judged(task: Task, flown: Predictor, wings: Sequence[WingFile]) -> Verdict:
    """The task's verdict; of wings with limits each within its own.

    The policy beats as it learned to, in the box of its problem: its strokes are held against the limits, not forced
    into them.
    """
    if not any(wing.limits for wing in wings):
        return task.judge(flown)
    if not isinstance(task, HoverTask):
        raise ValueError(f"--wing with limits is not told of {task.environment}; allowed: a policy of Hover-v0")
    strokes = Comparison(task.insects, task.problem).strokes(flown)
    return verdict_of(
        [
            assess(wing.insect, stroke, wing_problem(wing, task.problem))
            for wing, (_, stroke) in zip(wings, strokes, strict=True)
        ],
        task.problem,
    )


def _robustness(actor: AnyActor, task: Task, asked: Asked) -> list[tuple[str, Any, str]]:
    """Noise and other models, of policies of named insects in Hover."""
    from agents.evaluation.robustness import robustness

    if not asked.robustness:
        return []
    if not isinstance(task, HoverTask):
        raise ValueError(f"--robustness is not told of {task.environment} here; allowed: policies of named insects")
    return [("robustness", *robustness(actor, task.insects, task.problem))]


def _costs(actor: AnyActor, task: Task, card: PolicyCard, asked: Asked) -> list[tuple[str, Any, str]]:
    """What a new wing costs, of policies for random wings."""
    from agents.evaluation.wing_costs import costs_of

    if not asked.costs:
        return []
    if not isinstance(task, RandomWingsTask):
        raise ValueError(f"--costs are not told of {task.environment} with named insects; allowed: random wings")
    return [("costs", *costs_of(actor, task.problem, card.wingbeats))]


def _evaluated_strokes(name: str, asked: Asked) -> Evaluated:
    """The verdict on strokes that were published, or that a file holds."""
    for option in ("noise", "robustness", "costs", "pool_seed"):
        if getattr(asked, option) != getattr(Asked(), option):
            raise ValueError(f"--{option.replace('_', '-')} is not told of strokes; allowed: a policy, not {name}")
    pairs = stroke_pairs(name, asked.insects or (), [wing.insect for wing in asked.wings])
    problem, told = as_problem(asked.problem), []
    light = [insect.name for insect, _ in pairs if insect.wing.mass is None]
    if problem.model.accounting == "positive" and name == PUBLISHED and not asked.insects and light:
        pairs = [(insect, stroke) for insect, stroke in pairs if insect.name not in light]
        told = [f"left out, as their wing masses are not known: {', '.join(light)}"]
    limited = [wing_problem(wing, problem) for wing in asked.wings] or [problem] * len(pairs)
    called = PUBLISHED if name in (*INSECTS, PUBLISHED) else "given"
    known, assessed = real_name(name), []
    for (insect, stroke), own in zip(pairs, limited, strict=True):
        with errors_of(f"{known}, {insect.name}"):
            assessed.append(assess(insect, stroke, own))
    verdict = verdict_of(assessed, problem, called)
    return Evaluated(
        title=f"{known}: {len(pairs)} stroke{'s' * (len(pairs) > 1)}, in the problem {problem.name}",
        verdict=verdict,
        about={"strokes": known, "distance": HoverTask.distance},
        told=told,
        called=called,
    )


def wing_problem(wing: WingFile, base: HoverProblem) -> HoverProblem:
    """A problem within a wing's limits; errors say whose they are."""
    with errors_of(f"--wing, {wing.insect.name}"):
        return wing.problem(base)
