"""Free waveforms: a problem's wingbeats as periodic cubic B-splines, their best ones, and pictures of them."""

from flapenv.waveform.coordinates import SPEED_FLOOR, Waveform, WaveformCoordinates
from flapenv.waveform.optimum import SplineOptimum, spline_optimum
from flapenv.waveform.performance import evaluate_waveform, waveform_performance

__all__ = [
    "SPEED_FLOOR",
    "SplineOptimum",
    "Waveform",
    "WaveformCoordinates",
    "evaluate_waveform",
    "spline_optimum",
    "waveform_performance",
]
