"""States of the generators that training draws from, as JSON holds them."""

import random
from collections.abc import Mapping
from typing import Any

import numpy as np
import torch

MERSENNE = "MT19937"
"""The generator behind `numpy.random`'s functions."""


def random_states(spaces: np.random.Generator) -> dict[str, Any]:
    """The states of Python's, NumPy's and torch's global generators and of one more.

    Args:
        spaces: the generator that random actions are sampled from.
    """
    version, numbers, gauss = random.getstate()
    legacy: dict[str, Any] = np.random.get_state(legacy=False)
    return {
        "python": {"version": version, "numbers": list(numbers), "gauss": gauss},
        "numpy": _plain(legacy),
        "torch": torch.get_rng_state().numpy().tobytes().hex(),
        "actions": _plain(dict(spaces.bit_generator.state)),
    }


def restore_random_states(states: Any, spaces: np.random.Generator) -> None:
    """Let the generators go on from their states; as `random_states`.

    Raises:
        ValueError: for what is no state.
    """
    before = random_states(spaces)
    try:
        _set(states, spaces)
    except (AttributeError, IndexError, KeyError, OverflowError, RuntimeError, TypeError, ValueError) as problem:
        _set(before, spaces)
        raise ValueError(f"states of random generators are not what was written: {problem}") from None


def _set(states: Any, spaces: np.random.Generator) -> None:
    """Set all states, whatever comes of it."""
    python, legacy = states["python"], states["numpy"]
    random.setstate((python["version"], tuple(python["numbers"]), python["gauss"]))
    if legacy["bit_generator"] != MERSENNE:
        raise ValueError(f"numpy's generator {legacy['bit_generator']!r} is not {MERSENNE}")
    if not 0 <= legacy["state"]["pos"] <= len(legacy["state"]["key"]):  # NumPy would read beyond its own memory
        raise ValueError(f"numpy's position {legacy['state']['pos']!r} is not one in its {MERSENNE}")
    np.random.set_state(legacy)
    torch.set_rng_state(torch.from_numpy(np.frombuffer(bytes.fromhex(states["torch"]), dtype=np.uint8).copy()))
    spaces.bit_generator.state = dict(states["actions"])


def _plain(value: Any) -> Any:
    """Arrays as lists and NumPy's numbers as Python's, in dicts within dicts."""
    if isinstance(value, Mapping):
        return {key: _plain(one) for key, one in value.items()}
    return value.tolist() if isinstance(value, np.ndarray | np.generic) else value
