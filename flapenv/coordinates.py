"""Action coordinates: strokes of a box as points of the cube [-1, 1]^n, shared by environments and optimisers."""

from collections.abc import Mapping
from typing import Any, Literal

import numpy as np

from flapenv.aero.arrays import Real, as_arrays, as_like, as_numpy_type
from flapenv.aero.checks import require_name
from flapenv.aero.parameters import STROKE_PARAMETERS, StrokeReference
from flapenv.problem import StrokeBox

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
        self._ends: dict[tuple[str, np.dtype], tuple[np.ndarray, np.ndarray]] = {}
        self._uses_tip_speed = scaling == "tip-speed" and {"frequency", "flap_amplitude"} <= set(self.names)

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
        shape, dtype = points.shape[:-1], as_numpy_type(points)
        bounds = {name: as_like(points, *self._inside(name, reference, dtype)) for name in STROKE_PARAMETERS}
        values: dict[str, Any] = {}
        for name, (low, high) in bounds.items():
            if name not in self.names:
                values[name] = xp.broadcast_to(low, shape)
                continue
            fraction = (inside[..., self.names.index(name)] + 1) / 2
            if name == "frequency" and self._uses_tip_speed:
                values[name] = fraction  # awaits φmax
                continue
            values[name] = xp.clip(_between(fraction, low, high, *self._scale(name)), low, high)
        if self._uses_tip_speed:
            (low, high), (first, last) = bounds["frequency"], bounds["flap_amplitude"]
            tip_speed = _between(values["frequency"], low * first, high * last, "log")
            frequency = tip_speed / values["flap_amplitude"]
            values["frequency"] = xp.clip(frequency, low, high)
            slack = 8 * np.finfo(dtype).eps
            clipped = clipped | (xp.abs(values["frequency"] - frequency) > slack * frequency)
        return values, clipped

    def _inside(self, name: str, reference: StrokeReference, dtype: np.dtype) -> tuple[np.ndarray, np.ndarray]:
        """Bounds in the type of the computation, rounded into the interval: 90° must not become a little more."""
        if self.box.is_relative(name) and self.box.is_free(name):
            low, high = (np.asarray(bound, dtype) for bound in self.box.bounds(name, reference))
            inward = dtype.type(0 if dtype.itemsize == 8 else 2 * np.finfo(dtype).eps)
            return low * (1 + inward), high * (1 - inward)
        key = name, dtype
        if self.box.is_relative(name):
            return _rounded_inside(*self.box.bounds(name, reference), dtype)
        if key not in self._ends:
            self._ends[key] = _rounded_inside(*self.box.bounds(name, reference), dtype)
        return self._ends[key]

    def encode(self, values: Mapping[str, Any], reference: StrokeReference) -> np.ndarray:
        """Points of the cube for strokes, the inverse of `decode` inside the box.

        Args:
            values: the stroke's fields by name, each of shape (...) [SI units].
            reference: the own strokes that the box may be relative to, scalars or shape (...).

        Returns:
            Points, shape (..., n), clipped to the cube.
        """
        axes = []
        for name in self.names:
            low, high = self.box.bounds(name, reference)
            value = values[name]
            if name == "frequency" and self._uses_tip_speed:
                first, last = self.box.bounds("flap_amplitude", reference)
                value, low, high = value * values["flap_amplitude"], low * first, high * last
            axes.append(np.clip(2 * _fraction(value, low, high, *self._scale(name)) - 1, -1, 1))
        return np.stack(np.broadcast_arrays(*axes), axis=-1) if axes else np.zeros((0,))

    def _scale(self, name: str) -> tuple[str, float]:
        """The scale of an axis and the floor of its logarithm."""
        row = STROKE_PARAMETERS[name]
        return ("linear", 0.0) if self.scaling == "plain" else (row.scale, row.log_floor)


def _rounded_inside(low: Real, high: Real, dtype: np.dtype) -> tuple[np.ndarray, np.ndarray]:
    """The interval's ends cast to a type, towards the inside."""
    cast_low, cast_high = np.asarray(low, dtype=dtype), np.asarray(high, dtype=dtype)
    cast_low = np.where(cast_low.astype(float) < low, np.nextafter(cast_low, dtype.type(np.inf)), cast_low)
    cast_high = np.where(cast_high.astype(float) > high, np.nextafter(cast_high, dtype.type(-np.inf)), cast_high)
    return np.minimum(cast_low, cast_high), cast_high


def _between(fraction: Real, low: Real, high: Real, scale: str, floor: float = 0.0) -> Real:
    """The value a fraction of the way from `low` to `high` along a scale."""
    xp, fraction, low, high = as_arrays(fraction, low, high)
    if scale == "linear":
        return low + (high - low) * fraction
    if scale == "log-complement":
        return 1 - _between(fraction, 1 - low, 1 - high, "log", floor)
    shift = _shift(low, high, floor)
    start, stop = xp.log(low + shift), xp.log(high + shift)
    return xp.exp(start + (stop - start) * fraction) - shift


def _fraction(value: np.ndarray, low: np.ndarray, high: np.ndarray, scale: str, floor: float = 0.0) -> np.ndarray:
    """The inverse of `_between`."""
    if scale == "linear":
        return (value - low) / (high - low)
    if scale == "log-complement":
        return _fraction(1 - value, 1 - low, 1 - high, "log", floor)
    shift = _shift(low, high, floor)
    return np.log((value + shift) / (low + shift)) / np.log((high + shift) / (low + shift))


def _shift(low: Real, high: Real, floor: float) -> Real:
    """What keeps a log scale off its pole: nothing, unless an end lies nearer to it than the floor."""
    xp, low, high = as_arrays(low, high)
    least = xp.minimum(low, high)
    return xp.where(least < floor, floor + 0 * least, 0 * least)
