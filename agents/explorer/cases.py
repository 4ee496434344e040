"""Insects in problems, solved once: what the sliders need without solving anything."""

import json
import threading
import warnings
from collections import OrderedDict
from collections.abc import Mapping
from functools import cached_property
from typing import Any

from agents.evaluation.comparison import Comparison
from agents.explorer.controls import OWN_WING, read_insect
from agents.policy_file import load_policy
from flapenv.aero.checks import require_name, shown
from flapenv.aero.parameters import STROKE_PARAMETERS
from flapenv.aero.stroke import Stroke
from flapenv.assessment import StrokeAssessment, assess, assess_another
from flapenv.files import WingFile
from flapenv.insects import INSECTS, Insect, load_insect
from flapenv.problem import PROBLEMS, HoverProblem

EXPLORED = ("free-frequency", "fixed-frequency", "profile-drag")
"""Problems that are solved in a moment."""
LEARNED_IN = PROBLEMS["free-frequency"]
"""What the shipped policies were trained for, whatever is explored."""
POLICY, WING_POLICY = "hover", "random-wings"
"""The shipped policies of the eight insects, and of any wing."""
KEPT = 64
"""Cases that are kept; the one that was used longest ago goes first."""


class Case:
    """An insect in a problem with its optimum, beside which strokes are judged in a moment."""

    def __init__(self, insect: Insect, problem: HoverProblem, *, is_typed: bool = False) -> None:
        """Solve the optimum.

        Args:
            insect: the insect.
            problem: whose optimum, box and model count.
            is_typed: whether the wing was typed, so that its own stroke is made up.

        Raises:
            ValueError: for a wing that the model has no answer for.
            ArithmeticError: where the optimum cannot be confirmed.
        """
        self.insect, self.problem, self.is_typed = insect, problem, is_typed
        self.own = assess(insect, problem=problem)

    def judged(self, stroke: Stroke) -> StrokeAssessment:
        """A stroke judged as `assess` does it, without the other models; solves nothing."""
        return assess_another(self.own, stroke)

    @property
    def explored(self) -> str:
        """Which of `EXPLORED` the problem is, within limits or not."""
        return next(name for name in EXPLORED if str(self.problem.name).startswith(name))

    def strokes(self) -> dict[str, Stroke]:
        """What the buttons load, by label."""
        return {"own": self.insect.stroke, "optimal": self.own.best.stroke, "learned": self.learned}

    @cached_property
    def learned(self) -> Stroke:
        """The stroke of the shipped policy that knows the insect, or any wing."""
        actor, _ = load_policy(POLICY if self.insect.name in INSECTS else WING_POLICY)
        with warnings.catch_warnings():  # of a wing that cannot hover, which the page says itself
            warnings.simplefilter("ignore", UserWarning)
            info = Comparison([self.insect], LEARNED_IN).beat(actor)
        return Stroke(**{name: float(info[f"stroke/{name}"][0]) for name in STROKE_PARAMETERS})


class Cases:
    """The cases that the page asked for, by a key that only `solve` gives out."""

    def __init__(self, extra: WingFile | None = None) -> None:
        """Know the eight insects, and one more.

        Args:
            extra: of a file, whose limits narrow every problem's box.

        Raises:
            ValueError: for a name that is taken.
        """
        self.insects: Mapping[str, Insect] = {name: load_insect(name) for name in INSECTS}
        self.extra = extra
        if extra is not None:
            name = extra.insect.name
            if name in (*INSECTS, OWN_WING):
                raise ValueError(f"name = {shown(name)} is taken by one of the page's own; allowed: another name")
            self.insects = {name: extra.insect, **self.insects}
        self._solved: OrderedDict[str, Case] = OrderedDict()
        self._lock = threading.Lock()
        self.one_at_a_time = threading.Lock()
        """Held by what takes long, or silences warnings, which Python does for all threads together."""

    def solve(self, name: object, own: object, problem: object) -> tuple[str, Case]:
        """The case that the page asks for, with its key; solved where it is asked for the first time.

        Args:
            name: as in `read_insect`.
            own: likewise.
            problem: one of `EXPLORED`.

        Raises:
            TypeError: for a field of another kind.
            ValueError: for an unknown name or a number that is not allowed.
            ArithmeticError: where the optimum cannot be confirmed.
        """
        insect = read_insect(name, own, self.insects)
        chosen = PROBLEMS[require_name("problem", problem, EXPLORED)]
        if self.extra is not None and insect is self.extra.insect:
            chosen = self.extra.problem(chosen)
        key = json.dumps([name, own if name == OWN_WING else None, chosen.name], ensure_ascii=True)
        with self._lock:
            case = self._solved.get(key)
        if case is None:
            with self.one_at_a_time:
                case = Case(insect, chosen, is_typed=name == OWN_WING)
        with self._lock:
            self._solved[key] = case
            self._solved.move_to_end(key)
            while len(self._solved) > KEPT:
                self._solved.popitem(last=False)
        return key, case

    def known(self, key: Any) -> Case:
        """The case of a key.

        Raises:
            ValueError: for a key that `solve` did not give out, or so long ago that its case is gone.
        """
        with self._lock:
            case = self._solved.get(key) if isinstance(key, str) else None
        if case is None:
            raise ValueError("this page is older than the explorer that answers it; reload the page")
        return case
