"""Which insects an environment draws from."""

import warnings
from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np

from flapenv.aero.checks import is_single, require_count, require_name, shown
from flapenv.envs.flyable import require_flyable
from flapenv.insects import INSECTS, Insect, as_insect, load_insect
from flapenv.optimum import optimum
from flapenv.problem import HoverProblem
from flapenv.wing_pool import SPLITS, Split, wing_pool

InsectChoice = str | Insect | Mapping[str, Any] | Sequence[Any]


RANDOM_WING = "random-wing"
"""In place of a name: wings of a pool."""
LEAST_WEIGHT_SUPPORT = 1.05
"""Λ_max of a random wing at least, where its frequency is fixed and many could not hover."""


def listed_insects(choice: InsectChoice, *, others: tuple[str, ...] = ()) -> tuple[Insect, ...]:
    """The insects that a choice means, each name once.

    Args:
        choice: "all", a name of `INSECTS`, an `Insect` or the dict of one, or several of these.
        others: words that may stand in the place of a name, for the message about one that may not.

    Raises:
        TypeError: for a choice of another kind, or an insect with array fields.
        ValueError: for an unknown name, no insect at all, or two of one name.
    """
    if isinstance(choice, str):
        require_name("insect", choice, ("all", *others, *INSECTS))
        insects = tuple(load_insect(name) for name in (INSECTS if choice == "all" else (choice,)))
    elif isinstance(choice, Sequence):
        insects = tuple(as_insect(one) for one in choice)
    else:
        insects = (as_insect(choice),)
    if not insects:
        raise ValueError("insect = [] is not allowed; allowed: at least one insect")
    names = [one.name for one in insects]
    for one in insects:
        if not is_single(one):
            raise TypeError(f"insect {shown(one.name)} has array fields; allowed: insects with scalar fields")
        if names.count(one.name) > 1:
            raise ValueError(f"insect holds {names.count(one.name)} called {shown(one.name)}; allowed: each name once")
    return insects


def choose_insects(choice: InsectChoice, problem: HoverProblem, *, include_infeasible: bool) -> tuple[Insect, ...]:
    """The insects an environment draws from, with a warning about every one that cannot hover in the box.

    Args:
        choice: as `listed_insects` takes it.
        problem: the problem, which decides about feasibility.
        include_infeasible: whether "all" keeps the insects that no stroke of the box can lift.

    Raises:
        TypeError: for a choice of another kind.
        ValueError: for an unknown name, no insect at all, or "all" where none is feasible.
    """
    insects = listed_insects(choice, others=(RANDOM_WING,))
    require_flyable(insects, problem.model)
    largest = {insect.name: optimum(insect, problem) for insect in insects}
    infeasible = {name: best.max_weight_support for name, best in largest.items() if not best.feasible}
    dropped = isinstance(choice, str) and choice == "all" and not include_infeasible
    return without_infeasible(insects, infeasible, "stroke of the box", dropped=dropped, stacklevel=4)


def without_infeasible(
    insects: tuple[Insect, ...], infeasible: Mapping[str, float], what: str, *, dropped: bool, stacklevel: int
) -> tuple[Insect, ...]:
    """Warn about the insects that cannot hover, and leave them out where they are to be dropped.

    Args:
        insects: all of them.
        infeasible: the largest weight support of those that cannot, by name.
        what: does not carry their weight, in words.
        dropped: whether they are left out.
        stacklevel: of the warning, as the caller's own.

    Raises:
        ValueError: where none is left.
    """
    if infeasible:
        margins = ", ".join(f"{name} (largest {margin:.3f})" for name, margin in infeasible.items())
        fate = "left out" if dropped else "kept; the aim is their largest weight support"
        warnings.warn(f"no {what} carries the weight of {margins}: {fate}", stacklevel=stacklevel)
        if dropped:
            insects = tuple(insect for insect in insects if insect.name not in infeasible)
    if not insects:
        raise ValueError("insect = 'all' leaves no insect: none can hover in the box; see include_infeasible=True")
    return insects


def choose_pool(problem: HoverProblem, *, size: int, seed: int, split: Split, leave_out: Insect | str | None) -> Insect:
    """The pool that "random-wing" draws from, an insect with array fields; arguments as `wing_pool`'s.

    Raises:
        TypeError: for a size or seed that is not a whole number, or a left-out insect with array fields.
        ValueError: for one out of range or an unknown name, called as the environment's argument is.
    """
    require_count("pool_size", size)
    require_count("pool_seed", seed, low=0)
    require_name("pool_split", split, SPLITS)
    if isinstance(leave_out, str):
        require_name("leave_out", leave_out, INSECTS)
    elif leave_out is not None and not is_single(as_insect(leave_out)):
        raise TypeError("leave_out has array fields; allowed: a name or one insect")
    fixed = not problem.box.is_free("frequency")
    return wing_pool(
        size,
        seed=seed,
        split=split,
        leave_out=leave_out,
        min_weight_support=LEAST_WEIGHT_SUPPORT if fixed else None,
        problem=problem,
    )


def chosen_rows(chosen: Any, names: Sequence[str], rows: int) -> np.ndarray:
    """Numbers of the insects that the reset option "insect" asks for, shape (rows,).

    Args:
        chosen: a name, or one for each row.
        names: of the environment's insects, in order.
        rows: of the batch.

    Raises:
        TypeError: for anything but names.
        ValueError: for an unknown name or another number of them.
    """
    if not isinstance(chosen, str | list | tuple | np.ndarray):
        raise TypeError(f"reset option insect = {shown(chosen)} is not allowed; allowed: a name, or one for each row")
    if isinstance(chosen, np.ndarray) and chosen.ndim != 1:
        raise ValueError(f"reset option insect has shape {chosen.shape}; allowed: a name, or one for each row")
    wanted = [chosen] * rows if isinstance(chosen, str) else list(chosen)
    if len(wanted) != rows:
        raise ValueError(f"reset option insect has {len(wanted)} names; allowed: one, or one for each row")
    number = {name: i for i, name in enumerate(names)}
    for name in wanted:
        if not isinstance(name, str) or name not in number:
            require_name("reset option insect", name, number)
    return np.array([number[name] for name in wanted], dtype=np.intp)


def prepared_insects(options: dict[str, Any], names: Sequence[str], rows: int) -> dict[str, Any]:
    """Reset options with "insect", where it is given, as row numbers; arguments and errors as `chosen_rows`."""
    chosen = options.get("insect")
    kept = {key: value for key, value in options.items() if key != "insect"}
    return kept if chosen is None else {**kept, "insect": chosen_rows(chosen, names, rows)}
