"""Flying in conditions that nobody tells: the task behind flapenv/HoverAdapt-v0, its optimum and its references."""

from flapenv.adapt.conditions import NOMINAL, Condition, flown
from flapenv.adapt.cut_wing import CutPlanform, cut_wing
from flapenv.adapt.task import AdaptTask

__all__ = ["NOMINAL", "AdaptTask", "Condition", "CutPlanform", "cut_wing", "flown"]
