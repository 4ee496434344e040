"""`flapenv.envs.hover_of_one.beat` compiled by numba (the extra "fast"); imported only where it is asked for."""

from typing import Any

import numba

from flapenv.envs import hover_of_one

OPTIONS: dict[str, Any] = {"error_model": "numpy", "cache": True}

# numba keeps what it compiled between processes only for functions of a module that name each other there
decode: Any = numba.njit(**OPTIONS)(hover_of_one.decode)
averages: Any = numba.njit(**OPTIONS)(hover_of_one.averages)
score: Any = numba.njit(**OPTIONS)(hover_of_one.score)


def _beat(
    action: Any, axes: Any, wing: Any, fractions: Any, weights: Any, sines: Any, slack: float, results: Any
) -> None:
    """As `hover_of_one.beat`, of the compiled steps."""
    results[13] = decode(action, axes, wing, slack, results)
    lift, power = averages(results, fractions, weights, sines)
    score(wing, lift, power, results)


beat: Any = numba.njit(**OPTIONS)(_beat)
