"""Targets: what environments take, and that nothing but finite numbers comes out of them."""

import functools
from collections.abc import Callable
from typing import Any

import gymnasium as gym
import numpy as np

from flapenv.envs import ENV_IDS
from flapenv.insects import as_insect
from fuzzing import seeds
from fuzzing.documents import changed
from fuzzing.draw import Draw
from fuzzing.verdict import FindingError, require_finite

ROWS = 3
MODES = ("NextStep", "SameStep", "Disabled")
KINDS = ("float32", "float64", "float16", "int64", "uint8", "bool", "complex128", "object", "U3")


@functools.cache
def scalar(name: str) -> Any:
    """An environment with its defaults."""
    return gym.make(name, disable_env_checker=True).unwrapped


@functools.cache
def vector(name: str, mode: str) -> Any:
    """A batch with its defaults."""
    return gym.make_vec(name, num_envs=ROWS, autoreset_mode=mode)


def actions(name: str) -> Callable[[bytes], Any]:
    """Actions of any bits, shapes and types, into one environment alone and in batches of every mode."""

    def target(data: bytes) -> Any:
        draw = Draw(data)
        how = draw.byte()
        if how % 4 == 0:
            return _steps(scalar(name), (), draw)
        return _steps(vector(name, MODES[how % 4 - 1]), (ROWS,), draw)

    return target


def _steps(env: Any, rows: tuple[int, ...], draw: Draw) -> Any:
    """A reset and up to three steps; what they give."""
    axes = (env.single_action_space if rows else env.action_space).shape[0]
    if draw.byte() % 8:
        env.reset(seed=draw.byte())
    for _ in range(1 + draw.byte() % 3):
        results = env.step(_actions((*rows, axes), draw))
        require_given(results, env, rows)
    return None


def _actions(shape: tuple[int, ...], draw: Draw) -> Any:
    """Actions: numbers of any bits or nearly right ones, sometimes of another type or shape."""
    how = draw.byte()
    kind = "float32" if how % 8 else draw.one_of(KINDS)
    count = int(np.prod(shape))
    if how < 64:
        made = np.frombuffer(draw.take(4 * count), np.float32)
        made = np.where(np.isfinite(made), made, 0.5) if how % 2 else made
    elif how < 96:
        made = np.frombuffer(draw.take(8 * count), np.float64)
        kind = "float64"
    else:
        made = np.frombuffer(draw.take(count), np.int8) / np.float32(100)
    made = made.reshape(shape)
    with np.errstate(all="ignore"), _silent():
        made = made.astype(kind)
    if how % 16 == 9:
        return draw.thing()
    if how % 16 == 10:
        return made[..., : draw.byte() % (shape[-1] + 1)]
    if how % 16 == 11:
        return made[None]
    return made.tolist() if how % 16 == 12 else made


def _silent() -> Any:
    import warnings

    return warnings.catch_warnings(action="ignore")


def require_given(results: Any, env: Any, rows: tuple[int, ...]) -> None:
    """Refuse what no environment may give: NaN or inf, and observations outside of their space.

    Raises:
        FindingError: naming it.
    """
    *numbers, info = results
    require_finite(numbers, "results")
    space = env.observation_space
    if not space.contains(numbers[0]):
        raise FindingError(f"observation {numbers[0]!r} is outside of {space}")
    require_finite_info(info, rows)


def require_finite_info(info: Any, rows: tuple[int, ...]) -> None:
    """Refuse NaN and inf in the infos that count, those of the rows that have them."""
    for key, value in info.items():
        if key.startswith("_") and key != "_":
            continue
        if not rows:
            require_finite(value, f"info[{key!r}]")
        elif key == "final_info":
            require_finite_info(value, rows)
        else:
            require_finite(np.asarray(value)[info[f"_{key}"]], f"info[{key!r}]")


def reset_options(name: str) -> Callable[[bytes], Any]:
    """Seeds and options of `reset`."""

    def target(data: bytes) -> Any:
        draw = Draw(data)
        one = draw.byte() % 2 == 0
        env, rows = (scalar(name), ()) if one else (vector(name, "Disabled"), (ROWS,))
        options: Any = {}
        for _ in range(draw.byte() % 4):
            options[draw.one_of(OPTIONS) if draw.byte() % 16 else draw.text()] = _option(draw, rows)
        seed = draw.one_of((None, 0, 1, 2**31, 2**63)) if draw.byte() % 8 else draw.thing()
        results = env.reset(seed=seed, options=options if draw.byte() % 16 else draw.thing())
        require_given(results, env, rows)
        step = env.step(np.zeros(env.action_space.shape, np.float32))
        require_given(step, env, rows)

    return target


OPTIONS = ("insect", "height", "velocity", "condition", "reset_mask")
SOME_CONDITIONS: tuple[Any, ...] = (
    {"mass_ratio": 1.1},
    {"payload": 1.1, "density_ratio": 0.9, "span_lost": 0.1},
    {"payload": [1.0, 1.1, 1.25]},
)


def _option(draw: Draw, rows: tuple[int, ...]) -> Any:
    """The value of an option: nearly right, or anything."""
    how = draw.byte() % 8
    if how == 0:
        return draw.thing()
    if how == 1:
        return draw.one_of(("hawkmoth", "fruitfly", "x"))
    if how == 2:
        return [draw.one_of(("hawkmoth", "cranefly")) for _ in range(draw.byte() % 5)]
    if how == 3:
        return np.array([draw.byte() % 2 for _ in range(draw.byte() % 5)], dtype=draw.one_of(("bool", "int8")))
    if how == 4:
        return np.array(
            [draw.number(0.1) for _ in range(draw.byte() % 5)], dtype=object if draw.byte() % 8 == 0 else None
        )
    if how == 5:
        return changed(draw.one_of(SOME_CONDITIONS), draw)
    return draw.number(0.1)


def insects_flown(name: str) -> Callable[[bytes], Any]:
    """Insects of one's own with any number that `Insect` takes, in an environment: refused, or finite."""

    def target(data: bytes) -> Any:
        draw = Draw(data)
        told = seeds.own_insect()
        parts = {
            "mass": draw.number(told["mass"]),
            "wing": _numbers_changed(told["wing"], draw),
            "stroke": _numbers_changed(told["stroke"], draw),
            "k_table": told["k_table"] if draw.byte() % 2 else None,
        }
        flyer = as_insect({"name": "mine", **parts})
        kind = draw.one_of(("float32", "float64"))
        return _flown(name, {"insect": flyer, "dtype": kind}, draw)

    return target


def _numbers_changed(told: Any, draw: Draw) -> dict[str, Any]:
    """A dict whose numbers are others, one in four."""
    return {
        key: draw.number(value) if isinstance(value, float) and draw.byte() % 4 == 0 else value
        for key, value in told.items()
    }


def problems_flown(name: str) -> Callable[[bytes], Any]:
    """Problems with any bound and option that `HoverProblem` takes, in an environment: refused, or finite."""

    def target(data: bytes) -> Any:
        draw = Draw(data)
        told = changed(draw.one_of(seeds.problem_documents()), draw)
        return _flown(name, {"insect": "hawkmoth", "problem": told}, draw)

    return target


def arguments(name: str) -> Callable[[bytes], Any]:
    """Arguments of an environment by name; sizes of batches and pools stay small."""

    def target(data: bytes) -> Any:
        draw = Draw(data)
        chosen: dict[str, Any] = {"insect": "hawkmoth"}
        for _ in range(1 + draw.byte() % 3):
            key = draw.one_of(tuple(ARGUMENTS)) if draw.byte() % 16 else draw.text()
            usual = ARGUMENTS.get(key, (None,))
            chosen[key] = draw.one_of(usual) if draw.byte() % 4 else _small(draw.thing())
        if chosen.get("insect") in ("random-wing", "all") and name == "flapenv/Hover-v0":
            chosen["pool_size"] = 2
        return _flown(name, chosen, draw)

    return target


def _small(value: Any) -> Any:
    """A thing, but no count so large that it is honoured with all of the memory."""
    return value if isinstance(value, bool) or not isinstance(value, int) or abs(value) < 16 else 3


ARGUMENTS: dict[str, tuple[Any, ...]] = {
    "insect": ("hawkmoth", "cranefly", ["hawkmoth", "fruitfly"], [], "random-wing"),
    "include_infeasible": (True, False),
    "pool_size": (1, 2, 0),
    "pool_seed": (0, 1, -1),
    "pool_split": ("train", "test", "outside"),
    "leave_out": (None, "hawkmoth"),
    "gap_to": ("bound", "optimum"),
    "action_scaling": ("tip-speed", "box"),
    "reward": ("scalar", "vector"),
    "infos": ("all", "none", ["insect"], ["x"], []),
    "autoreset_mode": ("SameStep", "NEXT_STEP", "x"),
    "dtype": ("float32", "float64", "float16", np.float32, float),
    "threads": (1, 2, 0),
    "accelerator": ("numpy", "x"),
    "render_mode": (None, "x"),
    "num_envs": (1, 2, 0, -1),
    "beats": (1, 2, 0),
    "references": (True, False),
    "gusts": (None, {"strength": 0.1}, {"strength": 1.0}, {"correlation": 1e-3}, {"correlation": 1e6}, {"x": 1}),
    "knots": (2, 4, 5, 256, 257, 0),
}


def _flown(name: str, chosen: dict[str, Any], draw: Draw) -> None:
    """An environment made with arguments, reset and stepped twice."""
    env: Any = _batch_class(name)(**chosen)
    rows = (env.num_envs,)
    require_given(env.reset(seed=0), env, rows)
    for _ in range(2):
        shape = env.action_space.shape
        raw = np.frombuffer(draw.take(int(np.prod(shape))), np.int8).reshape(shape) / np.float32(127)
        require_given(env.step(raw), env, rows)


def _batch_class(name: str) -> Any:
    """The class behind an id; `gym.make_vec` copies arguments, which costs more than the environment."""
    module, _, kind = str(gym.spec(name).vector_entry_point).partition(":")
    from importlib import import_module

    return getattr(import_module(module), kind)


NAMES = {name.partition("/")[2].removesuffix("-v0").lower(): name for name in ENV_IDS}
"""Ids by what a target calls them."""
