"""All of a learner between two rollouts, in arrays and plain numbers, and back into one built from the same config."""

from collections.abc import Mapping
from typing import Any

import numpy as np
import torch
from stable_baselines3.common.base_class import BaseAlgorithm
from stable_baselines3.common.buffers import ReplayBuffer

from agents.checkpoint.expected import Kind, require_arrays, require_counts
from agents.checkpoint.files import Checkpoint
from agents.checkpoint.random_states import random_states, restore_random_states
from agents.vec_env import GymnasiumVecEnv
from flapenv.aero.checks import shown
from flapenv.envs.batch import BatchEnv
from flapenv.envs.state import EnvState

COUNTERS = ("num_timesteps", "_n_updates", "_episode_num")
REMAINING = "_current_progress_remaining"
SEEN, BEGUN = "_last_obs", "_last_episode_starts"
"""What was seen last, and whether an episode begins there, of every row."""
REPLAY = ("observations", "next_observations", "actions", "rewards", "dones", "timeouts")


def learner_state(model: BaseAlgorithm) -> Checkpoint:
    """What a learner goes on from, taken when a rollout begins: weights, optimisers, replay buffer, rows and chances.

    What rollouts and schedules set anew is not in it. Arrays are called PART/NAME; they may share memory with the
    learner.

    Args:
        model: on a `GymnasiumVecEnv` over one of flapenv's vector environments.
    """
    environment = _batch(model).state()
    arrays = {f"weights/{name}": tensor.detach().numpy() for name, tensor in _weights(model).items()}
    arrays |= _moments(model)
    arrays |= {f"rows/{name}": np.asarray(getattr(model, name)) for name in (SEEN, BEGUN)}
    arrays |= {f"memory/{number}": state.numpy() for number, state in enumerate(_memory(model))}
    arrays |= {f"environment/{name}": array for name, array in environment.arrays.items()}
    numbers: dict[str, Any] = {
        "learner": type(model).__name__,
        "spaces": _spaces(model),
        "counters": {name: int(getattr(model, name)) for name in COUNTERS},
        "remaining": float(getattr(model, REMAINING)),
        "rates": {name: [group["lr"] for group in one.param_groups] for name, one in _optimizers(model).items()},
        "environment": environment.random,
        "random": random_states(model.action_space.np_random),
        "replay": None,
    }
    buffer = _replay(model)
    if buffer is not None:
        numbers["replay"] = {"next": int(buffer.pos), "full": bool(buffer.full)}
        filled = buffer.buffer_size if buffer.full else buffer.pos
        arrays |= {f"replay/{name}": getattr(buffer, name)[:filled] for name in REPLAY}
    return Checkpoint(numbers=numbers, arrays={name: np.asarray(array, order="C") for name, array in arrays.items()})


def restore_learner(model: BaseAlgorithm, state: Checkpoint) -> None:
    """Let a learner with random weights, built from the same config, go on where another was.

    All is checked first but the states of generators, which check themselves; where they are wrong, the learner is not
    to be used.

    Raises:
        TypeError: for a number of another kind.
        ValueError: for a state of another learner, environment or network, or one that no learner can be in.
    """
    numbers = state.numbers
    _require_same_make(model, numbers)
    counters = require_counts("counters", numbers.get("counters"), COUNTERS)
    remaining = numbers.get("remaining")
    if type(remaining) is not float or not remaining <= 1:
        raise ValueError(f"remaining = {shown(remaining)} is not allowed; allowed: a number up to 1")
    rates = _checked_rates(model, numbers.get("rates"))
    replay = _checked_replay(_replay(model), numbers.get("replay"))
    own = {name: array for name, array in state.arrays.items() if not name.startswith("environment/")}
    require_arrays(own, _needed(model, replay), _moments_of_each(model))
    _batch(model).restore(EnvState(arrays=_part(state.arrays, "environment/"), random=numbers.get("environment")))
    restore_random_states(numbers.get("random"), model.action_space.np_random)

    for name, value in counters.items():
        setattr(model, name, value)
    setattr(model, REMAINING, remaining)
    for name in (SEEN, BEGUN):
        setattr(model, name, state.arrays[f"rows/{name}"].copy())
    with torch.no_grad():
        for name, tensor in _weights(model).items():
            tensor.copy_(torch.from_numpy(state.arrays[f"weights/{name}"].copy()))
        for number, memory in enumerate(_memory(model)):
            memory.copy_(torch.from_numpy(state.arrays[f"memory/{number}"].copy()))
    for name, optimizer in _optimizers(model).items():
        _restore_optimizer(optimizer, _part(state.arrays, f"optimizer/{name}/"), rates[name])
    buffer = _replay(model)
    if buffer is not None and replay is not None:
        buffer.pos, buffer.full = replay
        for name in REPLAY:
            kept = state.arrays[f"replay/{name}"]
            getattr(buffer, name)[: len(kept)] = kept


def _needed(model: BaseAlgorithm, replay: tuple[int, bool] | None) -> dict[str, Kind]:
    """The arrays that a learner cannot do without."""
    rows, seen = model.n_envs, model.observation_space
    needed = {f"weights/{name}": Kind.of(tensor) for name, tensor in _weights(model).items()}
    needed[f"rows/{SEEN}"] = Kind(shape=(rows, *(seen.shape or ())), dtype=str(seen.dtype))
    needed[f"rows/{BEGUN}"] = Kind(shape=(rows,), dtype="bool")
    needed |= {f"memory/{number}": Kind.of(memory) for number, memory in enumerate(_memory(model))}
    buffer = _replay(model)
    if buffer is not None and replay is not None:
        filled = buffer.buffer_size if replay[1] else replay[0]
        needed |= {f"replay/{name}": Kind.of(getattr(buffer, name)[:filled]) for name in REPLAY}
    return needed


def _moments_of_each(model: BaseAlgorithm) -> list[dict[str, Kind]]:
    """What Adam remembers of each parameter that had a gradient."""
    return [
        {
            f"optimizer/{name}/{number}/step": Kind(shape=(), dtype="float32"),
            f"optimizer/{name}/{number}/exp_avg": Kind.of(parameter),
            f"optimizer/{name}/{number}/exp_avg_sq": Kind.of(parameter),
        }
        for name, optimizer in _optimizers(model).items()
        for number, parameter in enumerate(_parameters(optimizer))
    ]


def _checked_rates(model: BaseAlgorithm, rates: Any) -> dict[str, list[float]]:
    """The learning rates of the optimisers' groups of parameters."""
    wanted = {name: len(optimizer.param_groups) for name, optimizer in _optimizers(model).items()}
    right = (
        isinstance(rates, dict)
        and {name: len(own) if isinstance(own, list) else None for name, own in rates.items()} == wanted
        and all(type(rate) is float and rate >= 0 for own in rates.values() for rate in own)
    )
    if not right:
        raise ValueError(f"rates = {shown(rates)} is not allowed; allowed: learning rates of {', '.join(wanted)}")
    return dict(rates)


def _checked_replay(buffer: ReplayBuffer | None, replay: Any) -> tuple[int, bool] | None:
    """Where a replay buffer is written next, and whether it is full."""
    if buffer is None and replay is None:
        return None
    if buffer is not None and isinstance(replay, dict) and set(replay) == {"next", "full"}:
        following, full = replay["next"], replay["full"]
        if type(following) is int and type(full) is bool and 0 <= following < buffer.buffer_size:
            return following, full
    what = "null" if buffer is None else f"next, below {buffer.buffer_size}, and full, true or false"
    raise ValueError(f"replay = {shown(replay)} is not allowed; allowed: {what}")


def _batch(model: BaseAlgorithm) -> BatchEnv:
    """The vector environment that a learner flies."""
    env = model.get_env()
    assert isinstance(env, GymnasiumVecEnv)
    assert isinstance(env.venv, BatchEnv)
    return env.venv


def _spaces(model: BaseAlgorithm) -> dict[str, Any]:
    """What a learner's networks and buffers are made for."""
    spaces = {"observations": model.observation_space, "actions": model.action_space}
    return {"rows": model.n_envs, **{name: [list(one.shape or ()), str(one.dtype)] for name, one in spaces.items()}}


def _require_same_make(model: BaseAlgorithm, numbers: Mapping[str, Any]) -> None:
    """Refuse the state of another learner, or of one for other rows and spaces."""
    for name, own in (("learner", type(model).__name__), ("spaces", _spaces(model))):
        if numbers.get(name) != own:
            raise ValueError(f"{name} = {numbers.get(name)!r} is not allowed; allowed: {own!r}, as the config asks for")


def _weights(model: BaseAlgorithm) -> dict[str, torch.Tensor]:
    """All tensors of the networks and those learned beside them, by name."""
    beside = {name: getattr(model, name) for name in model._get_torch_save_params()[1]}
    return {**model.policy.state_dict(), **{f"beside/{name}": tensor for name, tensor in beside.items()}}


def _optimizers(model: BaseAlgorithm) -> dict[str, torch.optim.Optimizer]:
    """The optimisers by where they are: "policy.optimizer"."""
    found: dict[str, torch.optim.Optimizer] = {}
    for name in model._get_torch_save_params()[0]:
        owner: Any = model
        for part in name.split("."):
            owner = getattr(owner, part)
        if isinstance(owner, torch.optim.Optimizer):
            found[name] = owner
    return found


def _parameters(optimizer: torch.optim.Optimizer) -> list[torch.Tensor]:
    """What an optimiser moves, in the order in which its states are numbered."""
    return [parameter for group in optimizer.param_groups for parameter in group["params"]]


def _moments(model: BaseAlgorithm) -> dict[str, np.ndarray]:
    """What the optimisers remember of the gradients of parameters that had one."""
    return {
        f"optimizer/{name}/{number}/{key}": tensor.numpy()
        for name, optimizer in _optimizers(model).items()
        for number, moments in optimizer.state_dict()["state"].items()
        for key, tensor in moments.items()
    }


def _restore_optimizer(optimizer: torch.optim.Optimizer, moments: Mapping[str, np.ndarray], rates: list[float]) -> None:
    """Give an optimiser its moments and its learning rates; all else is as the config has made it."""
    state: dict[int, dict[str, torch.Tensor]] = {}
    for name, array in moments.items():
        number, key = name.split("/")
        state.setdefault(int(number), {})[key] = torch.from_numpy(array.copy())
    groups = optimizer.state_dict()["param_groups"]
    for group, rate in zip(groups, rates, strict=True):
        group["lr"] = rate
    optimizer.load_state_dict({"state": state, "param_groups": groups})


def _memory(model: BaseAlgorithm) -> list[torch.Tensor]:
    """What a recurrent policy remembers of the rows' episodes."""
    states = getattr(model, "_last_lstm_states", None)
    return [] if states is None else [*states.pi, *states.vf]


def _replay(model: BaseAlgorithm) -> ReplayBuffer | None:
    """The wingbeats that a learner keeps; None where it keeps none."""
    buffer: ReplayBuffer | None = getattr(model, "replay_buffer", None)
    return buffer


def _part(arrays: Mapping[str, np.ndarray], name: str) -> dict[str, np.ndarray]:
    """The arrays whose names begin so, by the rest of their names."""
    return {whole.removeprefix(name): array for whole, array in arrays.items() if whole.startswith(name)}
