"""Arguments, options and actions of the environments, checked alike everywhere."""

import inspect
from collections.abc import Sequence
from typing import Any

import numpy as np
from gymnasium.vector import AutoresetMode

from flapenv.aero.checks import LONGEST_SHOWN, allowed, one_line, require_count, require_name, shown

RENDER_MODES = ("rgb_array",)


def as_autoreset_mode(value: AutoresetMode | str) -> AutoresetMode:
    """An `AutoresetMode` from itself, its name ("SAME_STEP") or its value ("SameStep").

    Raises:
        ValueError: for anything else.
    """
    for mode in AutoresetMode if isinstance(value, AutoresetMode | str) else ():
        if value in (mode, mode.name, mode.value):
            return mode
    raise ValueError(f"autoreset_mode = {shown(value)} is unknown; {allowed(value, [m.name for m in AutoresetMode])}")


InfoChoice = str | Sequence[str]
"""Which infos are wanted: "all", "none" or their keys."""


def require_infos(infos: Any, known: tuple[str, ...]) -> tuple[str, ...]:
    """The keys of the infos that are wanted.

    Raises:
        TypeError: for another kind of value.
        ValueError: for an unknown key.
    """
    if isinstance(infos, str):
        return known if require_name("infos", infos, ("all", "none")) == "all" else ()
    if not isinstance(infos, Sequence):
        raise TypeError(f"infos = {shown(infos)} is not allowed; allowed: 'all', 'none' or a list of keys")
    return tuple(require_name("infos key", key, known) for key in infos)


def require_render_mode(value: str | None) -> str | None:
    """`value` if it can be rendered.

    Raises:
        ValueError: for an unknown mode.
    """
    if value is not None and value not in RENDER_MODES:
        raise ValueError(f"render_mode = {shown(value)} is unknown; {allowed(value, RENDER_MODES)}, or None")
    return value


def require_seed(seed: Any) -> int | None:
    """A seed as Gymnasium takes it.

    Raises:
        TypeError: if it is not a whole number.
        ValueError: if it is negative.
    """
    return None if seed is None else require_count("seed", seed, low=0)


def require_options(options: dict[str, Any] | None, known: tuple[str, ...]) -> dict[str, Any]:
    """The reset options, all of them known.

    Raises:
        ValueError: for an unknown key.
    """
    if options is not None and not isinstance(options, dict):
        raise TypeError(f"options = {shown(options)} are not allowed; allowed: a dict with keys of {known}, or None")
    options = dict(options or {})
    for key in options:
        if key not in known:
            raise ValueError(f"reset option {shown(key)} = {shown(options[key])} is unknown; {allowed(key, known)}")
    return options


def checked_actions(field: str, actions: Any, shape: tuple[int, ...] | None) -> np.ndarray:
    """Actions as float32, finite and of the right shape; those beyond ±1 stay beyond it.

    Raises:
        TypeError: if they are not numbers.
        ValueError: if they have another shape, or NaN or inf.
    """
    try:
        array = np.asarray(actions)
    except ValueError:  # rows of different lengths
        array = np.empty(0, dtype=object)
    if array.dtype.kind not in "fiu":
        raise TypeError(f"{field} = {shown(actions)} are not real numbers; allowed: floats in [-1, 1]")
    if array.shape != shape:
        raise ValueError(f"{field} with shape {array.shape} is not allowed; allowed: {shape}")
    if not np.isfinite(array).all():
        row = tuple(int(i) for i in np.argwhere(~np.isfinite(array))[0])
        raise ValueError(
            f"{field}[{', '.join(map(str, row))}] = {array[row]} is not allowed; allowed: finite, in [-1, 1] "
            "(beyond it they are clipped)"
        )
    return np.clip(array, -2, 2).astype(np.float32)  # beyond ±1 still shows as clipped, and no cast overflows


def arguments_of(environment: type) -> tuple[str, ...]:
    """Names of the arguments of an environment's constructor."""
    names = inspect.signature(environment).parameters
    return tuple(name for name, parameter in names.items() if parameter.kind is not parameter.VAR_KEYWORD)


def refuse_unknown(unknown: dict[str, Any], environment: type, *, hidden: tuple[str, ...] = ()) -> None:
    """Name an argument that does not exist, and those that do.

    Raises:
        TypeError: for the first of `unknown`.
    """
    known = [name for name in arguments_of(environment) if name not in hidden]
    for name, value in unknown.items():
        raise TypeError(
            f"{one_line(name, LONGEST_SHOWN)} = {shown(value)} is not an argument of this environment; "
            f"{allowed(name, known)}"
        )


def refuse_unused(arguments: dict[str, Any], environment: type, when: str) -> None:
    """Refuse arguments that differ from their defaults and would change nothing.

    Args:
        arguments: by name.
        environment: whose constructor holds the defaults.
        when: what they belong to.

    Raises:
        ValueError: for the first of them.
    """
    known = inspect.signature(environment).parameters
    for name, value in arguments.items():
        if value != known[name].default:
            raise ValueError(
                f"{name} = {shown(value)} belongs to {when} and would change nothing; allowed: leave it out"
            )
