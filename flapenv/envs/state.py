"""States of the environments that can be saved: plain arrays by name, and where the generator stands.

An object says in the class attribute `kept` which of its attributes the next steps depend on. These are arrays, flags,
dicts and records of such, or objects with a `kept` of their own; everything else follows from how the object was made,
or from these.
"""

import dataclasses
import json
from collections.abc import Iterator, Mapping
from typing import Any

import numpy as np

from flapenv.aero.checks import allowed, record, shown

GENERATOR = np.random.PCG64
"""What Gymnasium seeds."""
KEYS = ("seed", "generator")
"""Of `EnvState.random`."""
Limits = tuple[Any, Any]
"""The smallest and the largest whole number of an array, each for all or one for every element."""


@record
class EnvState:
    """All that the next steps and pictures of an environment depend on.

    Attributes:
        arrays: by name, such as "insect" or "streams.key", of bool, whole numbers or floats; no objects.
        random: what JSON holds of `np_random`, {"seed": the one it was made of, "generator": the state of its bit
            generator}; None where nothing has been seeded or drawn.
    """

    arrays: Mapping[str, np.ndarray]
    random: Mapping[str, Any] | None = None


def kept_arrays(owner: object) -> dict[str, np.ndarray]:
    """Copies of all that an object keeps, by name; flags as arrays of no axes."""
    return {name: np.array(value, order="C") for name, value in _leaves("", owner)}


def checked_arrays(
    given: Mapping[str, np.ndarray], own: Mapping[str, np.ndarray], *, with_nan: tuple[str, ...] = ()
) -> dict[str, np.ndarray]:
    """Copies of the arrays of a state, as many and of the same kind as an environment's own.

    Args:
        given: of the state.
        own: of the environment.
        with_nan: names of those in which NaN stands for what has not been.

    Raises:
        TypeError: for what is not an array, or no dict of them.
        ValueError: for a missing or an unknown array, another type or shape, or numbers that are not finite.
    """
    if not isinstance(given, Mapping):
        raise TypeError(f"state: arrays = {shown(given)} is not allowed; allowed: a dict of arrays")
    for name in given:
        if name not in own:
            raise ValueError(f"state holds {shown(name)}, which this environment does not keep; {allowed(name, own)}")
    checked = {}
    for name, present in own.items():
        kind = f"an array of {present.dtype} of shape {present.shape}"
        if name not in given:
            raise ValueError(f"state has no {name!r}; allowed: {kind}")
        value = given[name]
        if not isinstance(value, np.ndarray):
            raise TypeError(f"state: {name} = {shown(value)} is not an array; allowed: {kind}")
        if value.dtype != present.dtype or value.shape != present.shape:
            raise ValueError(
                f"state: {name} is an array of {value.dtype} of shape {value.shape}; allowed: {kind}, as of an "
                "environment made with the same arguments"
            )
        if value.dtype.kind == "f":
            bad = np.isinf(value) if name in with_nan else ~np.isfinite(value)
            _refuse(name, value, bad, "finite numbers")
        checked[name] = value.copy()
    return checked


def require_limits(arrays: Mapping[str, np.ndarray], limits: Mapping[str, Limits]) -> None:
    """Require that whole numbers lie within their limits.

    Raises:
        ValueError: for the first that does not.
    """
    for name, (low, high) in limits.items():
        value = arrays[name]
        bad = (value < low) | (value > high)
        place = tuple(np.argwhere(bad)[0]) if bad.any() else ()
        first, last = (np.broadcast_to(end, value.shape)[place] for end in (low, high))
        _refuse(name, value, bad, f"whole numbers from {first} to {last}")


def _refuse(name: str, value: np.ndarray, bad: np.ndarray, what: str) -> None:
    """Refuse the first element that is bad, if one is."""
    if bad.any():
        place = tuple(int(i) for i in np.argwhere(bad)[0])
        where = f"[{', '.join(map(str, place))}]" if place else ""
        raise ValueError(f"state: {name}{where} = {value[place]} is not allowed; allowed: {what}")


def changes(owner: object, arrays: Mapping[str, np.ndarray]) -> list[tuple[object, str, Any]]:
    """What is to be set, (object, attribute, value), so that an object keeps checked arrays; nothing is set yet.

    Raises:
        ValueError: for numbers that a record refuses.
    """
    found: list[tuple[object, str, Any]] = []
    _rebuilt("", owner, arrays, found)
    return found


def random_state(generator: np.random.Generator | None, seed: int | None) -> dict[str, Any] | None:
    """Where a generator stands, in numbers that JSON holds.

    Raises:
        ValueError: for a generator of another kind than Gymnasium's.
    """
    if generator is None:
        return None
    name = type(generator.bit_generator).__name__
    if name != GENERATOR.__name__:
        raise ValueError(f"np_random draws from {name}; allowed: {GENERATOR.__name__}, as Gymnasium seeds it")
    return dict(zip(KEYS, (seed, dict(generator.bit_generator.state)), strict=True))


def as_generator(random: Any) -> tuple[np.random.Generator | None, int | None]:
    """A generator that stands where `random_state` found one, and its seed.

    Raises:
        TypeError: for what is not a dict or None.
        ValueError: for other keys, another bit generator, or numbers that it cannot hold.
    """
    if random is None:
        return None, None
    if not isinstance(random, Mapping):
        raise TypeError(f"state: random = {shown(random)} is not allowed; allowed: a dict or None")
    if set(random) != set(KEYS):
        raise ValueError(f"state: random has the keys {shown(list(random))}; allowed: {', '.join(KEYS)}")
    seed, wanted = (random[key] for key in KEYS)
    if seed is not None and type(seed) is not int:
        raise ValueError(f"state: random seed = {shown(seed)} is not allowed; allowed: a whole number or None")
    name = wanted.get("bit_generator") if isinstance(wanted, Mapping) else None
    if name != GENERATOR.__name__:
        raise ValueError(f"state: random bit_generator = {shown(name)} is not allowed; allowed: {GENERATOR.__name__}")
    bits = GENERATOR(0)
    try:
        bits.state = wanted
        stands = json.dumps(bits.state, sort_keys=True) == json.dumps(wanted, sort_keys=True)
    except (KeyError, TypeError, ValueError, OverflowError):
        stands = False
    if not stands:
        raise ValueError(f"state: random generator = {shown(wanted)} is not a state of {GENERATOR.__name__}")
    return np.random.Generator(bits), seed


def _parts(value: Any) -> Mapping[str, Any] | None:
    """What a value consists of, by name; None where it is one array or flag."""
    if hasattr(type(value), "kept"):
        return {name: getattr(value, name) for name in value.kept}
    if dataclasses.is_dataclass(value):
        return vars(value)
    return value if isinstance(value, dict) else None


def _joined(name: str, part: str) -> str:
    """The name of a part."""
    return f"{name}.{part.lstrip('_')}".lstrip(".")


def _leaves(name: str, value: Any) -> Iterator[tuple[str, Any]]:
    """All arrays and flags of a value with their names."""
    parts = _parts(value)
    if parts is None:
        yield name, value
        return
    for part, own in parts.items():
        yield from _leaves(_joined(name, part), own)


def _rebuilt(name: str, value: Any, arrays: Mapping[str, np.ndarray], found: list[tuple[object, str, Any]]) -> Any:
    """A value with other arrays; an object is the same one, and what is to be set in it is added to `found`."""
    parts = _parts(value)
    if parts is None:
        return bool(arrays[name]) if isinstance(value, bool) else arrays[name]
    made = {part: _rebuilt(_joined(name, part), own, arrays, found) for part, own in parts.items()}
    if hasattr(type(value), "kept"):
        found += [(value, part, own) for part, own in made.items()]
        return value
    kind: Any = type(value)
    return made if isinstance(value, dict) else kind(**made)
