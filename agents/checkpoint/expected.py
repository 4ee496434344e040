"""What a checkpoint has to hold for a learner built from its config: names, shapes, types and whole numbers."""

from collections.abc import Iterable, Mapping, Sequence
from typing import Any

import numpy as np

from flapenv.aero.checks import allowed, record, shown

LARGEST_COUNT = 2**62


@record
class Kind:
    """What an array has to be.

    Attributes:
        shape: of it.
        dtype: its name in NumPy.
    """

    shape: tuple[int, ...]
    dtype: str

    @classmethod
    def of(cls, array: Any) -> "Kind":
        """That of an array or a tensor."""
        return cls(shape=tuple(array.shape), dtype=str(array.dtype).removeprefix("torch."))

    def __str__(self) -> str:
        """As errors tell it."""
        return f"{self.dtype} of shape {self.shape}"


Kinds = Mapping[str, Kind]


def require_arrays(arrays: Mapping[str, np.ndarray], needed: Kinds, all_or_none: Sequence[Kinds] = ()) -> None:
    """Require arrays of these names and kinds and no others; those that are needed of finite numbers.

    Args:
        arrays: by name.
        needed: all of them.
        all_or_none: of each of these either all are there, or none.

    Raises:
        ValueError: for the first that is missing, unknown, of another kind or not finite.
    """
    wanted = dict(needed)
    for group in all_or_none:
        if any(name in arrays for name in group):
            wanted |= group
    for name in arrays:
        if name not in wanted:
            raise ValueError(f"array {shown(name)} is unknown; {allowed(name, wanted)}")
    for name, kind in wanted.items():
        if name not in arrays:
            raise ValueError(f"array {name!r} is missing; allowed: {kind}")
        array = arrays[name]
        if Kind.of(array) != kind:
            raise ValueError(f"array {name!r} is {Kind.of(array)}; allowed: {kind}")
        if name in needed and array.dtype.kind == "f" and not np.isfinite(array).all():
            raise ValueError(f"array {name!r} holds NaN or inf; allowed: finite numbers")


def require_counts(name: str, counts: Any, names: Iterable[str]) -> dict[str, int]:
    """A dict of these names, each of a whole number that is not negative.

    Raises:
        ValueError: for anything else.
    """
    wanted = tuple(names)
    if not isinstance(counts, dict) or set(counts) != set(wanted):
        raise ValueError(f"{name} = {shown(counts)} is not allowed; allowed: whole numbers for {', '.join(wanted)}")
    for key, value in counts.items():
        if type(value) is not int or not 0 <= value <= LARGEST_COUNT:
            raise ValueError(f"{name}: {key} = {shown(value)} is not allowed; allowed: whole numbers from 0")
    return counts
