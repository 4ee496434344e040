"""Which insects an environment draws from."""

import warnings
from collections.abc import Mapping, Sequence
from typing import Any

from flapenv.aero.checks import require_name
from flapenv.insects import INSECTS, Insect, as_insect, load_insect
from flapenv.optimum import optimum
from flapenv.problem import HoverProblem

InsectChoice = str | Insect | Mapping[str, Any] | Sequence[Any]


def named_insects(choice: InsectChoice) -> tuple[Insect, ...]:
    """The insects that are asked for, feasible or not.

    Args:
        choice: "all", a name of `INSECTS`, an `Insect` or the dict of one, or several of these.

    Raises:
        TypeError: for a choice of another kind.
        ValueError: for an unknown name, one name twice, or no insect at all.
    """
    if isinstance(choice, str):
        require_name("insect", choice, ("all", *INSECTS))
    if choice == "all":
        insects = tuple(load_insect(name) for name in INSECTS)
    elif isinstance(choice, Sequence) and not isinstance(choice, str):
        insects = tuple(as_insect(one) for one in choice)
    else:
        insects = (as_insect(choice),)
    if not insects:
        raise ValueError("insect = [] is not allowed; allowed: at least one insect")
    names = [one.name for one in insects]
    for name in names:
        if names.count(name) > 1:
            raise ValueError(f"insect holds {names.count(name)} called {name!r}; allowed: each name once")
    return insects


def choose_insects(choice: InsectChoice, problem: HoverProblem, *, include_infeasible: bool) -> tuple[Insect, ...]:
    """The insects an environment draws from, with a warning about every one that cannot hover in the box.

    Args:
        choice: as `named_insects` takes it.
        problem: the problem, which decides about feasibility.
        include_infeasible: whether "all" keeps the insects that no stroke of the box can lift.

    Raises:
        TypeError: for a choice of another kind.
        ValueError: for an unknown name, no insect at all, or "all" where none is feasible.
    """
    insects = named_insects(choice)
    largest = {insect.name: optimum(insect, problem) for insect in insects}
    infeasible = {name: best.max_weight_support for name, best in largest.items() if not best.feasible}
    dropped = choice == "all" and not include_infeasible
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
