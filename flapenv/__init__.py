"""flapenv: reinforcement-learning environments for discovering how wings should beat, with a proven optimum.

Start with `gymnasium.make("flapenv/Hover-v0")`, `flapenv.evaluate("hawkmoth")` or `flapenv.optimum("hawkmoth")`.
"""

from flapenv._version import __version__
from flapenv.aero.stroke import Stroke
from flapenv.aero.wing import Wing
from flapenv.envs.registration import register_envs
from flapenv.insects import INSECTS, HoverReference, Insect, WingFactors, load_insect
from flapenv.optimum import Optimum, optimum
from flapenv.performance import HoverModel, HoverPerformance, evaluate
from flapenv.problem import PROBLEMS, HoverProblem, StrokeBox

__all__ = [
    "INSECTS",
    "PROBLEMS",
    "HoverModel",
    "HoverPerformance",
    "HoverProblem",
    "HoverReference",
    "Insect",
    "Optimum",
    "Stroke",
    "StrokeBox",
    "Wing",
    "WingFactors",
    "__version__",
    "evaluate",
    "load_insect",
    "optimum",
    "register_envs",
]

register_envs()
