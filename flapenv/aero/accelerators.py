"""Which code computes the averages of the paper's force law: NumPy, or the same compiled."""

import functools
import importlib.util
from collections.abc import Callable
from typing import Any, Literal

from flapenv.aero.checks import require_name
from flapenv.aero.plate_averages import plate_averages

Accelerator = Literal["numpy", "numba"]
ACCELERATORS: tuple[Accelerator, ...] = ("numpy", "numba")
PlateKernel = Callable[..., tuple[Any, Any]]
"""A function with the arguments and returns of `flapenv.aero.plate_averages.plate_averages`."""


@functools.cache
def plate_kernel(accelerator: Accelerator) -> PlateKernel:
    """The function that an accelerator offers.

    Args:
        accelerator: "numpy", or "numba", which computes in single precision whatever it is given.

    Raises:
        ValueError: for another name.
        ImportError: where numba is not installed, naming the extra.
    """
    if require_name("accelerator", accelerator, ACCELERATORS) == "numpy":
        return plate_averages
    if importlib.util.find_spec("numba") is None:
        raise ImportError("accelerator = 'numba' needs numba: pip install 'flapenv[fast]'; allowed without it: 'numpy'")
    from flapenv.aero.compiled import compiled_averages

    return compiled_averages
