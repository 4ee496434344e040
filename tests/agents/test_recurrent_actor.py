"""A policy with memory remembers the same in NumPy, in a file and within its model, and forgets when episodes begin."""

import hashlib
import json
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import torch
from safetensors.numpy import save as tensors_as_bytes
from sb3_contrib import RecurrentPPO

from agents.actor import Actor
from agents.actor_of import actor_of
from agents.evaluation.noisy_actuators import NoisyActuators
from agents.policy_card import PolicyCard
from agents.policy_file import load_policy, save_policy
from agents.recurrent_actor import LstmCell, RecurrentActor
from agents.remembering import Remembering, flown
from agents.vec_env import GymnasiumVecEnv
from flapenv.envs import HoverVectorEnv

BEATS, ROWS, SEEN, MEMORY, ACTIONS = 20, 50, 6, 12, 6
FACTS: dict[str, Any] = {
    "environment": "flapenv/HoverAdapt-v0",
    "task": {"insects": ["hawkmoth"]},
    "algorithm": "RecurrentPPO",
    "preset": "adapt-recurrentppo",
    "command": "",
    "seed": 0,
    "wingbeats": 100,
    "result": {"mean": 0.1, "worst": 0.2},
    "versions": {},
}


def make_model(**network: Any) -> RecurrentPPO:
    """With every weight moved, so that no term is trivial."""
    torch.set_num_threads(1)
    env = GymnasiumVecEnv(HoverVectorEnv(4, autoreset_mode="SAME_STEP", infos="none"))
    sizes = {"net_arch": [16, 8], "lstm_hidden_size": MEMORY, **network}
    model = RecurrentPPO("MlpLstmPolicy", env, n_steps=4, batch_size=16, policy_kwargs=sizes, seed=0, device="cpu")
    torch.manual_seed(1)
    with torch.no_grad():
        for parameter in model.policy.parameters():
            parameter.add_(0.4 * torch.randn_like(parameter))
    return model


def cell_parts() -> dict[str, np.ndarray]:
    shapes = {"seen_weight": (4 * MEMORY, SEEN), "held_weight": (4 * MEMORY, MEMORY), "bias": (4 * MEMORY,)}
    rng = np.random.default_rng(0)
    return {name: rng.normal(size=shape).astype(np.float32) for name, shape in shapes.items()}


def make_actor() -> RecurrentActor:
    rng = np.random.default_rng(1)
    weight, bias = rng.normal(size=(ACTIONS, MEMORY)), rng.normal(size=ACTIONS)
    head = Actor(
        weights=(weight.astype(np.float32),), biases=(bias.astype(np.float32),), activation="tanh", squash="identity"
    )
    return RecurrentActor(LstmCell(**cell_parts()), head)


def observations(beats: int = BEATS) -> np.ndarray:
    return np.random.default_rng(2).normal(size=(beats, ROWS, SEEN)).astype(np.float32)


def actions(policy: Any, seen: np.ndarray) -> np.ndarray:
    """Of episodes that begin with the first beat."""
    policy.start()
    return np.stack([policy.predict(beat, deterministic=True)[0] for beat in seen])


@pytest.mark.parametrize("network", [{"enable_critic_lstm": False}, {"shared_lstm": True, "enable_critic_lstm": False}])
def test_an_actor_remembers_what_its_model_remembers(network: dict[str, Any]) -> None:
    model, seen, state = make_model(**network), observations(), None
    expected = []
    for beat in seen:
        action, state = model.predict(beat, state=state, deterministic=True)
        expected.append(action)
    actor = actor_of(model)
    assert isinstance(actor, RecurrentActor)
    assert (actor.observation_size, actor.memory, actor.widths, actor.action_size) == (SEEN, MEMORY, (16, 8), ACTIONS)
    assert np.abs(np.stack([actor.predict(beat)[0] for beat in seen]) - expected).max() < 1e-5
    assert np.abs(actions(actor, seen) - expected).max() < 1e-5
    assert (actions(flown(model), seen) == expected).all()
    assert np.std(expected) > 0.05


def test_a_model_that_has_learned_is_flown_as_it_is() -> None:
    model = make_model(enable_critic_lstm=False)
    model.learn(64)
    own = flown(model)
    assert isinstance(own, Remembering)
    assert np.abs(actions(actor_of(model), observations()) - actions(own, observations())).max() < 1e-5


def test_what_was_seen_changes_what_is_done_until_episodes_begin() -> None:
    actor, seen = make_actor(), observations(3)
    first, second, third = actions(actor, seen)
    again = actions(actor, seen[:1])[0]
    assert (again == first).all()
    repeated, _ = actor.predict(seen[0])
    assert np.abs(repeated - first).max() > 0.05
    assert np.abs(actions(actor, seen[2:])[0] - third).max() > 0.05
    assert second.shape == (ROWS, ACTIONS)


def test_one_row_remembers_as_it_does_within_a_batch() -> None:
    actor, seen = make_actor(), observations()
    alone = actions(actor, seen[:, 0])
    assert alone.shape == (BEATS, ACTIONS)
    assert alone == pytest.approx(actions(actor, seen)[:, 0], abs=1e-5)


def test_noisy_actuators_let_it_forget() -> None:
    noisy, seen = NoisyActuators(make_actor(), 0.0), observations(5)
    assert (actions(noisy, seen) == actions(make_actor(), seen)).all()
    assert (actions(noisy, seen) == actions(make_actor(), seen)).all()


def test_observations_that_do_not_fit_are_refused() -> None:
    actor = make_actor()
    for bad in (np.ones(5), np.ones((2, 3, SEEN))):
        with pytest.raises(ValueError, match=r"allowed: \(6,\) or \(n, 6\)"):
            actor.predict(bad)
    with pytest.raises(ValueError, match="deterministic = False"):
        actor.predict(np.ones(SEEN), deterministic=False)
    actor.predict(np.ones((3, SEEN)))
    for bad in (np.ones((2, SEEN)), np.ones(SEEN)):
        with pytest.raises(ValueError, match=r"allowed: \(3, 6\), .* others begin with start\(\)"):
            actor.predict(bad)
    actor.start()
    actor.predict(np.ones((2, SEEN)))


@pytest.mark.parametrize(
    ("change", "error", "said"),
    [
        ({"bias": np.zeros(47, np.float32)}, ValueError, r"memory.bias has shape \(47,\); allowed: \(4 memory,\)"),
        ({"bias": np.zeros(0, np.float32)}, ValueError, r"memory.bias has shape \(0,\)"),
        ({"bias": np.zeros((48, 1), np.float32)}, ValueError, r"memory.bias has shape \(48, 1\)"),
        ({"seen_weight": np.zeros((47, 6), np.float32)}, ValueError, r"memory.seen_weight has shape \(47, 6\)"),
        ({"seen_weight": np.zeros((48, 0), np.float32)}, ValueError, r"memory.seen_weight has shape \(48, 0\)"),
        ({"held_weight": np.zeros((48, 11), np.float32)}, ValueError, r"memory.held_weight .*allowed: \(48, 12\)"),
        ({"held_weight": np.zeros((48, 12))}, TypeError, "memory.held_weight is of type float64"),
        ({"bias": np.full(48, np.nan, np.float32)}, ValueError, "memory.bias holds 48 .*nan"),
    ],
)
def test_cells_that_do_not_fit_are_refused(change: dict[str, Any], error: type[Exception], said: str) -> None:
    with pytest.raises(error, match=said):
        LstmCell(**cell_parts() | change)


def test_a_cell_cannot_be_changed() -> None:
    parts = cell_parts()
    cell = LstmCell(**parts)
    parts["bias"][:] = 0
    assert cell.bias.any()
    with pytest.raises(ValueError, match="read-only"):
        cell.bias[0] = 1


@pytest.mark.parametrize(
    "network", [{"n_lstm_layers": 2}, {"lstm_kwargs": {"bias": False}}, {"lstm_kwargs": {"bidirectional": True}}]
)
def test_other_memories_are_refused(network: dict[str, Any]) -> None:
    with pytest.raises(ValueError, match=r"LSTM\(.*allowed: LSTM of one layer"):
        actor_of(make_model(enable_critic_lstm=False, **network))


@pytest.fixture
def saved(tmp_path: Path) -> Path:
    actor, path = make_actor(), tmp_path / "policy.safetensors"
    save_policy(actor, PolicyCard.of(actor, **FACTS), path)
    return path


def test_it_comes_back_from_its_file(saved: Path) -> None:
    actor, card = load_policy(saved)
    assert isinstance(actor, RecurrentActor)
    assert card.memory == MEMORY
    assert (actions(actor, observations()) == actions(make_actor(), observations())).all()
    assert PolicyCard.from_dict(card.to_dict()) == card


def edit_card(path: Path, **changes: Any) -> None:
    card = path.with_suffix(".json")
    content = json.loads(card.read_text()) | changes
    card.write_text(json.dumps({key: value for key, value in content.items() if value is not None}))


@pytest.mark.parametrize(
    ("memory", "said"),
    [
        (13, "memory = 13 of the card is not allowed; allowed: 12, the network's"),
        (0, "tensor = 'memory.*is unknown"),
        (None, "tensor = 'memory.*is unknown"),
        (-1, "memory = -1 is not allowed"),
    ],
)
def test_a_card_with_another_memory_is_refused(saved: Path, memory: int | None, said: str) -> None:
    edit_card(saved, memory=memory)
    with pytest.raises(ValueError, match=said):
        load_policy(saved)


@pytest.mark.parametrize(
    ("changes", "said"),
    [
        ({"memory.bias": None}, "tensors memory.bias are missing"),
        ({"memory.gate": np.zeros(3, np.float32)}, "tensor = 'memory.gate' is unknown"),
        ({"memory.held_weight": np.full((48, 12), np.inf, np.float32)}, "memory.held_weight holds 576"),
        ({"layers.0.weight": np.zeros((6, 11), np.float32)}, "layers.0.weight takes 11 numbers; allowed: 12"),
    ],
)
def test_weights_that_are_no_network_are_refused(saved: Path, changes: dict[str, Any], said: str) -> None:
    tensors = {name: array for name, array in (make_actor().to_tensors() | changes).items() if array is not None}
    content = tensors_as_bytes(tensors)
    saved.write_bytes(content)
    edit_card(saved, sha256=hashlib.sha256(content).hexdigest())
    with pytest.raises(ValueError, match=said):
        load_policy(saved)


def test_a_card_without_memory_is_one_of_plain_layers(tmp_path: Path) -> None:
    head, path = make_actor().head, tmp_path / "policy.safetensors"
    save_policy(head, PolicyCard.of(head, **FACTS), path)
    edit_card(path, memory=None)
    actor, card = load_policy(path)
    assert isinstance(actor, Actor)
    assert card.memory == 0
