"""Action coordinates: strokes of a box as points of the cube [-1, 1]^n, shared by environments and optimisers."""

import math
from collections.abc import Mapping
from typing import Any, Literal

import numpy as np

from flapenv.aero.arrays import Real, as_arrays, as_like, as_numpy_type
from flapenv.aero.checks import require_name
from flapenv.aero.parameters import STROKE_PARAMETERS, StrokeReference
from flapenv.problem import RELATIVE, Interval, StrokeBox

Scaling = Literal["tip-speed", "log", "plain"]
SCALINGS: tuple[Scaling, ...] = ("tip-speed", "log", "plain")


class StrokeCoordinates:
    """The map between the free parameters of a box and the cube, one axis a free parameter, in the table's order.

    Along an axis the parameter runs linearly, with its logarithm, or with the logarithm of its complement, as the
    parameter table says. With "tip-speed" scaling the first axis is q = f φmax on a log scale over all that the box
    allows, f = q/φmax, clipped to its own bounds: lift depends on q, and axes along (f, φmax) would leave the solution
    on a curved ridge. "log" takes f itself on a log scale, "plain" takes everything linearly.
    """

    def __init__(self, box: StrokeBox, *, scaling: Scaling = "tip-speed") -> None:
        """Prepare the map.

        Args:
            box: the bounds.
            scaling: one of `SCALINGS`.

        Raises:
            ValueError: for an unknown scaling.
        """
        self.box = box
        self.scaling = require_name("action_scaling", scaling, SCALINGS)
        self.names = box.free
        self._uses_tip_speed = scaling == "tip-speed" and {"frequency", "flap_amplitude"} <= set(self.names)
        units = StrokeReference(1.0, 1.0)  # relative bounds are multiples of the own stroke until the end
        self.axes: dict[str, Axis] = {}
        for name, row in STROKE_PARAMETERS.items():
            scale, floor = ("linear", 0.0) if scaling == "plain" else (row.scale, row.log_floor)
            self.axes[name] = Axis(*box.bounds(name, units), scale, floor)
        if self._uses_tip_speed:
            frequency, amplitude = self.axes["frequency"], self.axes["flap_amplitude"]
            self.axes["frequency"] = Axis(frequency.low * amplitude.low, frequency.high * amplitude.high, "log", 0.0)
        self._bounds: dict[np.dtype, dict[str, Interval]] = {}

    def __len__(self) -> int:
        """Number of axes."""
        return len(self.names)

    @property
    def axis_names(self) -> tuple[str, ...]:
        """What each axis is; "tip_speed" stands for q = f φmax."""
        return tuple("tip_speed" if n == "frequency" and self._uses_tip_speed else n for n in self.names)

    def decode(self, points: Real, reference: StrokeReference) -> tuple[dict[str, Any], Any]:
        """Strokes at points of the cube; a point outside is moved to its nearest face.

        Args:
            points: shape (..., n), float32 or float64, finite; arrays, or tensors, which keep their gradient.
            reference: the own strokes that the box may be relative to, scalars or shape (...).

        Returns:
            The stroke's fields by name, each of shape (...) and the points' type [SI units], and where anything
            was clipped, shape (...) of bool.
        """
        xp, points = as_arrays(points)
        inside = xp.clip(points, -1, 1)
        clipped = xp.any(inside != points, axis=-1)
        dtype = as_numpy_type(points)
        bounds = self.bounds(dtype)
        values: dict[str, Any] = {}
        for name, (low, high) in bounds.items():
            if name not in self.names:
                values[name] = as_like(points, np.full(points.shape[:-1], low, dtype))[0]
                continue
            value = self.axes[name].value((inside[..., self.names.index(name)] + 1) / 2, xp)
            values[name] = value if name == "frequency" and self._uses_tip_speed else xp.clip(value, low, high)
        if self._uses_tip_speed:
            frequency = values["frequency"] / values["flap_amplitude"]
            values["frequency"] = xp.clip(frequency, *bounds["frequency"])
            slack = 8 * np.finfo(dtype).eps
            clipped = clipped | (xp.abs(values["frequency"] - frequency) > slack * frequency)
        for name in RELATIVE:
            if self.box.is_relative(name):
                values[name] = values[name] * as_like(points, np.asarray(getattr(reference, name)))[0]
        return values, clipped

    def bounds(self, dtype: np.dtype) -> dict[str, Interval]:
        """Bounds that no stroke leaves in the type of the computation: 90° must not become a little more.

        Args:
            dtype: of the computation.

        Returns:
            Lower and upper bound by name; of relative parameters, as multiples of the own stroke.
        """
        if dtype in self._bounds:
            return self._bounds[dtype]
        inside = self._bounds[dtype] = {}
        for name in STROKE_PARAMETERS:
            low, high = self.box.bounds(name, StrokeReference(1.0, 1.0))
            ends = dtype.type(low), dtype.type(high)
            inwards = np.inf if float(ends[0]) < low else ends[0], -np.inf if float(ends[1]) > high else ends[1]
            first, last = (float(np.nextafter(end, dtype.type(to))) for end, to in zip(ends, inwards, strict=True))
            if self.box.is_relative(name) and dtype.itemsize < 8:  # what they are multiplied with is rounded too
                slack = 2 * float(np.finfo(dtype).eps)
                first, last = first * (1 + slack), last * (1 - slack)
            inside[name] = (min(first, last), last)
        return inside

    def encode(self, values: Mapping[str, Any], reference: StrokeReference) -> np.ndarray:
        """Points of the cube for strokes, the inverse of `decode` inside the box.

        Args:
            values: the stroke's fields by name, each of shape (...) [SI units].
            reference: the own strokes that the box may be relative to, scalars or shape (...).

        Returns:
            Points, shape (..., n), clipped to the cube.
        """
        units = {
            name: value / np.asarray(getattr(reference, name)) if self.box.is_relative(name) else np.asarray(value)
            for name, value in values.items()
        }
        if self._uses_tip_speed:
            units["frequency"] = units["frequency"] * units["flap_amplitude"]
        axes = [np.clip(2 * self.axes[name].fraction(units[name]) - 1, -1, 1) for name in self.names]
        return np.stack(np.broadcast_arrays(*axes), axis=-1) if axes else np.zeros((0,))


class Axis:
    """How a parameter runs from one bound to the other: start + span x for x from 0 to 1, or the exponential of that.

    Attributes:
        scale: "linear", "log" or "log-complement".
        start: where it begins, in the units of its scale.
        span: how far it goes.
        shift: what keeps a logarithm off its pole.
    """

    def __init__(self, low: float, high: float, scale: str, floor: float) -> None:
        """Bounds, the scale, and how near a logarithm may come to its pole."""
        self.low, self.high, self.scale = low, high, scale
        first, last = (1 - low, 1 - high) if scale == "log-complement" else (low, high)
        # nothing is shifted unless an end lies nearer to the pole than the floor
        self.shift = floor if min(first, last) < floor else 0.0
        self.start, self.span = low, high - low
        if scale != "linear" and low < high:
            self.start = math.log(first + self.shift)
            self.span = float(np.log((last + self.shift) / (first + self.shift)))
        self._first = first + self.shift

    def value(self, fraction: Any, xp: Any) -> Any:
        """The value a fraction of the way; arrays or tensors of the library `xp`."""
        if self.scale == "linear":
            return self.start + self.span * fraction
        run = xp.exp(self.start + self.span * fraction) - self.shift
        return 1 - run if self.scale == "log-complement" else run

    def fraction(self, value: np.ndarray) -> np.ndarray:
        """The inverse of `value`."""
        if self.scale == "linear":
            return (value - self.start) / self.span
        run = 1 - value if self.scale == "log-complement" else value
        return np.log((run + self.shift) / self._first) / self.span  # exactly 1 at the far bound
