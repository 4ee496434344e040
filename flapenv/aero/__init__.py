"""The aerodynamics: wings, strokes, coefficients and their averages. It knows no insects, rewards or environments."""

from flapenv.aero.blade_element import BladeElementHistory, blade_element
from flapenv.aero.parameters import STROKE_PARAMETERS, StrokeParameter
from flapenv.aero.stroke import Motion, Stroke
from flapenv.aero.wing import Wing
from flapenv.aero.wingbeat import speed_averages, time_nodes

__all__ = [
    "STROKE_PARAMETERS",
    "BladeElementHistory",
    "Motion",
    "Stroke",
    "StrokeParameter",
    "Wing",
    "blade_element",
    "speed_averages",
    "time_nodes",
]
