"""The aerodynamics: wings, strokes, coefficients and their averages. It knows no insects, rewards or environments."""

from flapenv.aero.blade_element import TERMS, blade_element
from flapenv.aero.force_laws import BermanWangLaw, FittedLaw, ForceLaw, PlateLaw, PolhamusLaw
from flapenv.aero.history import TermHistory, WingbeatHistory
from flapenv.aero.motions import FourierMotion, Motion, SampledMotion
from flapenv.aero.parameters import STROKE_PARAMETERS, StrokeParameter
from flapenv.aero.planform import BetaPlanform, FunctionPlanform, TabulatedPlanform
from flapenv.aero.spline_motion import SplineMotion
from flapenv.aero.splines import SplineAverages, spline_averages
from flapenv.aero.stroke import Stroke
from flapenv.aero.wing import Wing
from flapenv.aero.wingbeat import TimeRule, speed_averages, time_rule

__all__ = [
    "STROKE_PARAMETERS",
    "TERMS",
    "BermanWangLaw",
    "BetaPlanform",
    "FittedLaw",
    "ForceLaw",
    "FourierMotion",
    "FunctionPlanform",
    "Motion",
    "PlateLaw",
    "PolhamusLaw",
    "SampledMotion",
    "SplineAverages",
    "SplineMotion",
    "Stroke",
    "StrokeParameter",
    "TabulatedPlanform",
    "TermHistory",
    "TimeRule",
    "Wing",
    "WingbeatHistory",
    "blade_element",
    "speed_averages",
    "spline_averages",
    "time_rule",
]
