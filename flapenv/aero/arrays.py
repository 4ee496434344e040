"""The one place that knows NumPy from torch.

A formula asks for its array library once, `xp, x, y = as_arrays(x, y)`, and is then written
with names that NumPy >= 2 and torch share (`xp.asin`, `xp.clip`, `xp.sum(..., axis=-1)`). torch is never imported
here: a tensor can only arrive where torch is loaded already.
"""

import functools
import sys
from types import ModuleType
from typing import Any

import numpy as np

Real = Any
"""A real scalar, a NumPy array or a torch tensor; formulas broadcast over all three alike."""


def is_tensor(value: Real) -> bool:
    """Whether `value` is a torch tensor, found out without importing torch."""
    torch = sys.modules.get("torch")
    return torch is not None and isinstance(value, torch.Tensor)


def as_arrays(*values: Real) -> tuple[Any, ...]:
    """Bring numbers of mixed kinds to one array library and one floating type.

    Python scalars adapt to the arrays beside them, as NumPy promotes them; one tensor makes the rest tensors
    on its device, of the widest floating type among the tensors.

    Args:
        *values: scalars, arrays or tensors of any shapes (nothing is broadcast here).

    Returns:
        The array library followed by the converted values, in order.
    """
    dtype = _common_type(values)
    if dtype is not None:  # nearly always, and several times a wingbeat
        return (np, *(v if type(v) is np.ndarray else np.asarray(v, dtype=dtype) for v in values))
    tensors = [value for value in values if is_tensor(value)]
    if tensors:
        torch: ModuleType = sys.modules["torch"]
        floating = [tensor.dtype for tensor in tensors if tensor.is_floating_point()]
        dtype = functools.reduce(torch.promote_types, floating) if floating else torch.get_default_dtype()
        own = (v if is_tensor(v) else np.array(v) for v in values)  # checked arrays are read-only, tensors may not be
        return (torch, *(torch.as_tensor(v, dtype=dtype, device=tensors[0].device) for v in own))
    kinds = [v if isinstance(v, int | float) else np.asarray(v).dtype for v in values]
    dtype = np.result_type(np.float16, *kinds) if kinds else np.dtype(float)
    if dtype == np.float16:  # Python scalars alone carry no type
        dtype = np.dtype(float)
    return (np, *(np.asarray(value, dtype=dtype) for value in values))


def _common_type(values: tuple[Real, ...]) -> np.dtype | None:
    """The floating type that all arrays among arrays and Python numbers share; None in any other case."""
    dtype = None
    for value in values:
        if type(value) is np.ndarray:
            if dtype is None:
                dtype = value.dtype
            elif value.dtype != dtype:
                return None
        elif type(value) is not float and type(value) is not int:
            return None
    return dtype if dtype is not None and dtype.kind == "f" and dtype.itemsize > 2 else None


def as_like(reference: Real, *values: np.ndarray) -> tuple[Real, ...]:
    """NumPy arrays in the library and the floating type of `reference`, an array or a tensor."""
    if is_tensor(reference):
        torch: ModuleType = sys.modules["torch"]
        # copies: checked and kept arrays are read-only, tensors may not be
        return tuple(torch.tensor(v, dtype=reference.dtype, device=reference.device) for v in values)
    return tuple(value.astype(reference.dtype, copy=False) for value in values)


def as_numpy_type(value: Real) -> np.dtype:
    """NumPy's name for the floating type of an array or a tensor."""
    return np.dtype(str(value.dtype).removeprefix("torch."))


def without_slope(value: Real, where: Real) -> Real:
    """`value`, taken as a constant by differentiation where the condition holds; NumPy knows no slopes.

    Args:
        value: an array or a tensor.
        where: a condition of its shape.
    """
    if not is_tensor(value):
        return value
    torch: ModuleType = sys.modules["torch"]
    return torch.where(where, value.detach(), value)


def as_numpy(value: Real) -> np.ndarray:
    """A detached float copy or view of `value`, for checks, tables and pictures."""
    if is_tensor(value):
        value = value.detach().cpu().numpy()
    return np.asarray(value, dtype=float)


def as_result(value: Real) -> Real:
    """A Python float for a NumPy number without axes; arrays and tensors as they are."""
    if is_tensor(value) or np.ndim(value):
        return value
    return float(value)
