"""A learner goes on from its own state alone: what was made for another, or that none can be in, is refused."""

import json
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from checkpoints import equal

from agents.checkpoint import Checkpoint, learner_state, read_checkpoint, restore_learner, write_checkpoint
from agents.presets import PRESETS, Preset
from agents.training import make_model
from flapenv.whole_file import json_text

SMALL = {"wingbeats": 128, "rows": 8, "learning_starts": 32, "buffer": 64, "gradient_steps": 1, "batch": 16}


def made(name: str = "hover-sac", **settings: Any) -> Any:
    """A small learner."""
    preset: Preset = PRESETS[name].changed(
        {}, {**SMALL, **settings} if "sac" in name else {"wingbeats": 512, "rows": 8}
    )
    return make_model(preset, preset.make_task(), 2)


@pytest.fixture(scope="module")
def state() -> Checkpoint:
    """Of a learner that has learned a little."""
    model = made()
    model.learn(96)
    found = learner_state(model)
    return Checkpoint(
        numbers=json.loads(json_text(found.numbers)), arrays={name: one.copy() for name, one in found.arrays.items()}
    )


def test_a_learner_comes_back_whole(tmp_path: Path, state: Checkpoint) -> None:
    write_checkpoint(tmp_path, state)
    found = read_checkpoint(tmp_path)
    assert found is not None
    model = made()
    restore_learner(model, found)
    assert equal(learner_state(model), state)


@pytest.mark.parametrize(
    ("changed", "said"),
    [
        ({"learner": "PPO"}, "learner = 'PPO' is not allowed; allowed: 'SAC'"),
        ({"spaces": {"rows": 8}}, "spaces = .* is not allowed; allowed: "),
        ({"counters": None}, "counters = None is not allowed"),
        ({"counters": {"num_timesteps": -1, "_n_updates": 0, "_episode_num": 0}}, "num_timesteps = -1 is not allowed"),
        ({"counters": {"num_timesteps": 1.5, "_n_updates": 0, "_episode_num": 0}}, "num_timesteps = 1.5 is not"),
        ({"remaining": 2.0}, "remaining = 2.0 is not allowed"),
        ({"remaining": "1"}, "remaining = '1' is not allowed"),
        ({"rates": {"actor.optimizer": [0.1]}}, "rates = .* is not allowed"),
        ({"rates": {"actor.optimizer": ["0.1"], "critic.optimizer": [0.1]}}, "rates = .* is not allowed"),
        ({"replay": None}, "replay = None is not allowed; allowed: next, below 8"),
        ({"replay": {"next": 8, "full": False}}, "replay = .*'next': 8.* is not allowed; allowed: next, below 8"),
        (
            {"replay": {"next": 3, "full": False}},
            r"replay/observations' is float32 of shape \(8, 8, 6\); allowed",
        ),
        ({"environment": {"seed": 1}}, "random has the keys"),
        ({"random": {}}, "states of random generators are not allowed"),
    ],
)
def test_numbers_that_no_learner_has_are_refused(changed: dict[str, Any], said: str, state: Checkpoint) -> None:
    with pytest.raises(ValueError, match=said):
        restore_learner(made(), Checkpoint(numbers={**state.numbers, **changed}, arrays=state.arrays))


def test_the_position_of_numpys_generator_cannot_lie_beyond_its_memory(state: Checkpoint) -> None:
    states = json.loads(json.dumps(state.numbers["random"]))
    for position in (-1, 625, 10**9):
        states["numpy"]["state"]["pos"] = position
        with pytest.raises(ValueError, match=f"numpy's position {position} is not one in its MT19937"):
            restore_learner(made(), Checkpoint(numbers={**state.numbers, "random": states}, arrays=state.arrays))


@pytest.mark.parametrize(
    "name", ["weights/actor.mu.bias", "rows/_last_obs", "replay/rewards", "optimizer/actor.optimizer/0/exp_avg"]
)
def test_arrays_that_no_learner_has_are_refused(name: str, state: Checkpoint) -> None:
    array = state.arrays[name]
    nan = array.copy()
    nan.flat[0] = np.nan
    cases = [
        (None, f"array '{name}' is missing; allowed: float32"),
        (array.astype(np.float64), "is float64 of shape"),
        (array[..., :-1], f"array '{name}' is float32 of shape"),
        (nan, f"array '{name}' holds NaN or inf; allowed: finite numbers"),
    ]
    for other, said in cases:
        arrays = {key: value for key, value in state.arrays.items() if key != name}
        arrays |= {} if other is None else {name: other}
        if other is nan and name.startswith("optimizer"):
            restore_learner(made(), Checkpoint(numbers=state.numbers, arrays=arrays))  # Adam's may overflow
            continue
        with pytest.raises(ValueError, match=said):
            restore_learner(made(), Checkpoint(numbers=state.numbers, arrays=arrays))
    with pytest.raises(ValueError, match="array 'more' is unknown"):
        restore_learner(made(), Checkpoint(numbers=state.numbers, arrays={**state.arrays, "more": array}))


def test_a_checkpoint_of_another_learner_or_network_or_buffer_is_refused(state: Checkpoint) -> None:
    for other, said in (
        (made("hover-ppo"), "learner = 'SAC' is not allowed; allowed: 'PPO'"),
        (made(width=32), r"weights/actor.latent_pi.0.weight' is float32 of shape \(64, 6\); allowed: .*\(32, 6\)"),
        (made(rows=4), "spaces = .*'rows': 8"),
        (made(buffer=32), "replay = .*allowed: next, below 4|replay/"),
    ):
        before = learner_weights(other)
        with pytest.raises(ValueError, match=said):
            restore_learner(other, state)
        assert learner_weights(other) == before


def learner_weights(model: Any) -> list[bytes]:
    return [tensor.detach().numpy().tobytes() for tensor in model.policy.parameters()]
