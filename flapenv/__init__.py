"""flapenv: reinforcement-learning environments for discovering how wings should beat, with a proven optimum.

Start with `gymnasium.make("flapenv/Hover-v0")`, `flapenv.evaluate("hawkmoth")` or `flapenv.optimum("hawkmoth")`.
"""

from flapenv._version import __version__
from flapenv.aero.motions import FourierMotion, SampledMotion
from flapenv.aero.planform import FunctionPlanform, TabulatedPlanform
from flapenv.aero.stroke import Stroke
from flapenv.aero.wing import Wing
from flapenv.animation.film import animate
from flapenv.envs.registration import register_envs
from flapenv.files import NamedStroke, WingFile, read_strokes, read_wing, strokes_to_text, write_strokes, write_wing
from flapenv.insects import INSECTS, ForceConstants, HoverReference, Insect, WingFactors, load_insect
from flapenv.model import COEFFICIENTS, HoverModel
from flapenv.optimum import Optimum, optimum
from flapenv.performance import HoverPerformance, evaluate
from flapenv.problem import PROBLEMS, HoverProblem, StrokeBox
from flapenv.simulation import simulate

__all__ = [
    "COEFFICIENTS",
    "INSECTS",
    "PROBLEMS",
    "ForceConstants",
    "FourierMotion",
    "FunctionPlanform",
    "HoverModel",
    "HoverPerformance",
    "HoverProblem",
    "HoverReference",
    "Insect",
    "NamedStroke",
    "Optimum",
    "SampledMotion",
    "Stroke",
    "StrokeBox",
    "TabulatedPlanform",
    "Wing",
    "WingFactors",
    "WingFile",
    "__version__",
    "animate",
    "evaluate",
    "load_insect",
    "optimum",
    "read_strokes",
    "read_wing",
    "register_envs",
    "simulate",
    "strokes_to_text",
    "write_strokes",
    "write_wing",
]

register_envs()
