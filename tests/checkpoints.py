"""Checkpoints compared."""

from agents.checkpoint import Checkpoint


def equal(one: Checkpoint, other: Checkpoint) -> bool:
    """Whether numbers are equal, and arrays to the last bit."""
    same = one.numbers == other.numbers and one.arrays.keys() == other.arrays.keys()
    return same and all(
        (array.dtype, array.shape) == (other.arrays[name].dtype, other.arrays[name].shape)
        and array.tobytes() == other.arrays[name].tobytes()
        for name, array in one.arrays.items()
    )
