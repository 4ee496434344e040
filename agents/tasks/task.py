"""What every task offers to training, evaluation and the benchmark."""

from typing import TYPE_CHECKING, Any, Protocol

from gymnasium.vector import VectorEnv

from agents.predictor import Predictor
from flapenv.aero.checks import record
from flapenv.assessment import StrokeAssessment

if TYPE_CHECKING:
    from matplotlib.figure import Figure


@record
class Verdict:
    """How a policy did on its task; nothing is chosen by it.

    Attributes:
        mean: distance to the task's reference [-]: 0 is the reference, 0.01 one percent worse, negative better; None
            where there is no reference.
        worst: the same where it is largest: of the insects, or the 95th percentile of many wings.
        text: the table that people read.
        results: the task's part of results.json; plain numbers, strings, lists and dicts, None for what is not known.
        assessments: of the strokes of single insects, where there are any.
    """

    mean: float | None
    worst: float | None
    text: str
    results: dict[str, Any]
    assessments: tuple[StrokeAssessment, ...] = ()


class Task(Protocol):
    """An environment with its arguments, and how a policy of it is judged."""

    @property
    def environment(self) -> str:
        """The id."""

    @property
    def distance(self) -> str:
        """What `Verdict.mean` is, in a few words: "gap to the optimum"."""

    def vector_env(self, rows: int) -> VectorEnv:
        """The environment to train in: SAME_STEP, no infos."""

    def glance(self, policy: Predictor) -> tuple[float, float]:
        """`Verdict.mean` and `Verdict.worst` in well under a second, for the learning curve."""

    def judge(self, policy: Predictor) -> Verdict:
        """The verdict, noise-free and in double precision where the environment offers it."""

    def draw(self, policy: Predictor) -> "Figure":
        """A picture of what was learned."""

    def to_dict(self) -> dict[str, Any]:
        """The arguments, as config.json keeps them and the task's constructor takes them back."""
