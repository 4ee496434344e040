"""A policy file holds numbers and text only, says what it is, and is refused where it is not what it says."""

import hashlib
import json
import pickle
import subprocess
import sys
from pathlib import Path
from typing import Any

import gymnasium as gym
import numpy as np
import pytest
from safetensors.numpy import save as tensors_as_bytes

from agents import policy_file
from agents.actor import Actor
from agents.policy_card import PolicyCard
from agents.policy_file import load_policy, save_policy, shipped_policies
from flapenv.envs import HoverVectorEnv

HEADER = 8
"""Bytes before a safetensors header, its length."""


def make_actor(observation: int = 6, action: int = 6, activation: str = "tanh") -> Actor:
    rng = np.random.default_rng(observation)
    shapes = (16, observation), (12, 16), (action, 12)
    return Actor(
        weights=tuple(rng.normal(size=shape).astype(np.float32) for shape in shapes),
        biases=tuple(rng.normal(size=shape[:1]).astype(np.float32) for shape in shapes),
        activation=activation,
        squash="reach",
    )


FACTS: dict[str, Any] = {
    "environment": "flapenv/Hover-v0",
    "task": {"insects": ["hawkmoth"], "problem": "free-frequency", "box": (1, 2.5)},
    "algorithm": "PPO",
    "preset": "hover-ppo",
    "command": "python train.py --preset hover-ppo",
    "seed": 3,
    "wingbeats": 4_000_000,
    "result": {"distance": "gap to the optimum", "mean": 0.0004, "worst": 0.0017, "infeasible": None},
    "versions": {"numpy": np.__version__},
}


@pytest.fixture
def saved(tmp_path: Path) -> Path:
    actor, path = make_actor(), tmp_path / "policy.safetensors"
    save_policy(actor, PolicyCard.of(actor, **FACTS), path)
    return path


def edit_card(path: Path, **changes: Any) -> None:
    """Change a card as one would with an editor; None takes a field out."""
    card = path.with_suffix(".json")
    content = json.loads(card.read_text()) | changes
    card.write_text(json.dumps({key: value for key, value in content.items() if value is not None}))


def replace_weights(path: Path, content: bytes) -> None:
    """Put other bytes in the place of the weights, with a card that vouches for them."""
    path.write_bytes(content)
    edit_card(path, sha256=hashlib.sha256(content).hexdigest())


def refused(path: Path | str, said: str, error: type[Exception] = ValueError) -> None:
    with pytest.raises(error, match=said) as caught:
        load_policy(path)
    assert "\n" not in str(caught.value)


def test_a_policy_comes_back_as_it_was_saved(saved: Path) -> None:
    actor, card = load_policy(saved)
    observations = np.random.default_rng(0).normal(size=(100, 6)).astype(np.float32)
    assert (actor.predict(observations)[0] == make_actor().predict(observations)[0]).all()
    assert card.widths == (16, 12)
    assert card.task == {"insects": ["hawkmoth"], "problem": "free-frequency", "box": [1, 2.5]}
    assert card.result["worst"] == 0.0017
    assert card.sha256 == hashlib.sha256(saved.read_bytes()).hexdigest()
    assert PolicyCard.from_dict(card.to_dict()) == card
    assert load_policy(saved.parent)[1] == load_policy(str(saved))[1] == card
    assert sorted(path.name for path in saved.parent.iterdir()) == ["policy.json", "policy.safetensors"]
    assert save_policy(actor, card, saved.with_name("again.safetensors")) == card


def test_flying_a_policy_takes_no_torch(saved: Path) -> None:
    code = (
        "import sys, numpy as np; from agents.policy_file import load_policy; "
        f"actor, card = load_policy({str(saved)!r}); print(actor.predict(np.zeros(6))[0].shape); "
        "assert not {'torch', 'stable_baselines3', 'pickle5'} & set(sys.modules)"
    )
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stderr
    assert done.stdout.strip() == "(6,)"


@pytest.mark.parametrize("kept", [0, HEADER, 100, -1])
def test_a_truncated_file_is_refused(saved: Path, kept: int) -> None:
    saved.write_bytes(saved.read_bytes()[:kept])
    refused(saved, "policy.safetensors is not the file that policy.json describes: its sha256")
    replace_weights(saved, saved.read_bytes())
    refused(saved, "holds no safetensors")


def test_every_flipped_byte_is_found(saved: Path) -> None:
    content = saved.read_bytes()
    for place in np.linspace(0, len(content) - 1, 40).astype(int):
        saved.write_bytes(content[:place] + bytes([content[place] ^ 1]) + content[place + 1 :])
        refused(saved, "its sha256 is")
    saved.write_bytes(content)
    load_policy(saved)


def test_a_pickle_in_disguise_is_refused_and_does_not_run(saved: Path) -> None:
    mark = saved.with_name("it-ran")

    class Trap:
        def __reduce__(self) -> tuple[Any, ...]:
            return Path.touch, (mark,)

    replace_weights(saved, pickle.dumps(Trap()))
    refused(saved, "holds no safetensors")
    saved.with_name("policy.zip").write_bytes(pickle.dumps(Trap()))
    refused(saved.with_name("policy.zip"), "does not end in .safetensors; a .zip of Stable-Baselines3 holds pickles")
    saved.with_suffix(".json").write_bytes(pickle.dumps(Trap()))
    refused(saved, "policy.json is not JSON")
    assert not mark.exists()


def tensors(**changes: np.ndarray | None) -> bytes:
    changed = make_actor().to_tensors() | {name.replace("_", "."): value for name, value in changes.items()}
    return tensors_as_bytes({name: np.ascontiguousarray(value) for name, value in changed.items() if value is not None})


@pytest.mark.parametrize(
    ("content", "said"),
    [
        (
            tensors(layers_1_weight=np.full((12, 16), np.nan, np.float32)),
            "layers.1.weight holds 192 .* not finite.* nan",
        ),
        (tensors(layers_1_bias=np.array([np.inf] * 12, np.float32)), "layers.1.bias holds .* inf"),
        (
            tensors(layers_1_weight=np.zeros((12, 15), np.float32)),
            r"layers.1.weight has shape \(12, 15\); .*\(outputs, 16",
        ),
        (
            tensors(layers_1_weight=np.zeros((12, 16))),
            "layers.1.weight is of type float64; allowed: an array of float32",
        ),
        (tensors(layers_2_bias=None), "tensor = 'layers.2.weight' is unknown; allowed: .*did you mean"),
        (tensors(layers_7_bias=np.zeros(3, np.float32)), "tensor = 'layers.7.bias' is unknown"),
        (tensors_as_bytes({}), "tensors layers.0.weight, layers.0.bias are missing"),
    ],
)
def test_weights_that_are_no_network_are_refused(saved: Path, content: bytes, said: str) -> None:
    replace_weights(saved, content)
    refused(saved, said)


@pytest.mark.parametrize(
    ("changes", "said"),
    [
        ({"wingbeat": 3}, "PolicyCard has no field 'wingbeat' .*did you mean 'wingbeats'"),
        ({"seed": None}, "PolicyCard needs seed"),
        ({"format": 2, "anything": 1}, "format = 2 is unknown; allowed: 1"),
        ({"format": None}, "format is missing; allowed: 1"),
        (
            {"environment": "flapenv/Hovr-v0"},
            "environment = 'flapenv/Hovr-v0' is unknown; .*did you mean 'flapenv/Hover-v0'",
        ),
        ({"observation_size": 7}, "observation_size = 7 of the card is not allowed; allowed: 6"),
        ({"action_size": 5}, "action_size = 5 of the card is not allowed; allowed: 6"),
        ({"widths": [16, 13]}, r"widths = \(16, 13\) of the card is not allowed; allowed: \(16, 12\)"),
        ({"widths": 16}, "widths = 16 are not allowed"),
        ({"widths": [16, True]}, r"widths\[1\] = True is not a whole number"),
        ({"activation": "gelo"}, "activation = 'gelo' is unknown; .*did you mean 'gelu'"),
        ({"squash": 1}, "squash = 1 is unknown"),
        ({"seed": -1}, "seed = -1 is not allowed"),
        ({"wingbeats": 1.5}, "wingbeats = 1.5 is not a whole number"),
        ({"algorithm": 4}, "algorithm = 4 is not allowed; allowed: a text"),
        ({"result": {"mean": 0.1}}, "result has no 'worst'"),
        (
            {"result": {"mean": 0.1, "worst": [1, 2]}},
            r"result\['worst'\] = \[1, 2\] is not allowed; allowed: one number",
        ),
        ({"result": {"mean": 0.1, "worst": float("nan")}}, "NaN is not a number"),
        ({"task": "hover"}, "task = 'hover' is not allowed; allowed: a mapping"),
        ({"sha256": "abc"}, "sha256 = 'abc' is not allowed; allowed: 64 hexadecimal digits"),
        ({"sha256": ""}, "the card's empty"),
    ],
)
def test_a_card_that_is_wrong_is_refused(saved: Path, changes: dict[str, Any], said: str) -> None:
    edit_card(saved, **changes)
    refused(saved, said)


@pytest.mark.parametrize("text", ["", "{", "[1]", "3", '"x"', "null", "[" * 100_000, "\udcff"])
def test_a_card_that_is_no_card_is_refused(saved: Path, text: str) -> None:
    saved.with_suffix(".json").write_bytes(text.encode("utf-8", "surrogateescape"))
    refused(saved, "policy.json")


def test_what_is_missing_is_named(saved: Path, monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> None:
    shipped = tmp_path / "shipped"
    shipped.mkdir()
    monkeypatch.setattr(policy_file, "SHIPPED", shipped)
    assert shipped_policies() == {}
    actor = make_actor()
    save_policy(actor, PolicyCard.of(actor, **FACTS), shipped / "hover-ppo.safetensors")
    assert shipped_policies() == {"hover-ppo": shipped / "hover-ppo.safetensors"}
    assert load_policy("hover-ppo")[1].preset == "hover-ppo"
    refused(
        "hovr-ppo", "policy = 'hovr-ppo' is unknown; allowed: hover-ppo, a run's folder, .*did you mean 'hover-ppo'"
    )
    refused("runs/none", "runs/none does not exist; allowed: hover-ppo", FileNotFoundError)
    refused(saved.with_name("none.safetensors"), "none.safetensors does not exist", FileNotFoundError)
    refused(shipped, "holds no policy.safetensors", FileNotFoundError)
    saved.with_suffix(".json").unlink()
    refused(saved, "policy.json does not exist; allowed: a card beside", FileNotFoundError)


def test_a_huge_file_is_not_read(saved: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(policy_file, "LARGEST", 1000)
    refused(saved, "bytes; allowed: up to 1,000")


def test_shipped_policies_load_are_small_and_fit_their_environment() -> None:
    for name, path in shipped_policies().items():
        actor, card = load_policy(name)
        assert path.stat().st_size <= 200_000
        assert card.sha256
        card.require_actor(actor)


def test_a_card_of_another_network_is_not_saved(tmp_path: Path) -> None:
    card = PolicyCard.of(make_actor(), **FACTS)
    with pytest.raises(ValueError, match="activation = 'tanh' of the card is not allowed; allowed: 'relu'"):
        save_policy(make_actor(activation="relu"), card, tmp_path / "a.safetensors")
    with pytest.raises(ValueError, match=r"does not end in .safetensors"):
        save_policy(make_actor(), card, tmp_path / "a.zip")
    with pytest.raises(ValueError, match=r"task = .* cannot be written as JSON"):
        PolicyCard.of(make_actor(), **FACTS | {"task": {"problem": object()}})
    assert list(tmp_path.iterdir()) == []


def test_an_environment_with_other_spaces_is_refused() -> None:
    card = PolicyCard.of(make_actor(), **FACTS)
    card.require_fit(HoverVectorEnv(2))
    card.require_fit(gym.make("flapenv/Hover-v0"))
    with pytest.raises(ValueError, match=r"observations of shape \(7,\) do not fit a policy of flapenv/Hover-v0 with"):
        card.require_fit(HoverVectorEnv(2, insect="hawkmoth", problem="fixed-frequency"))
    with pytest.raises(ValueError, match=r"actions of shape \(5,\) do not fit"):
        card.require_fit(HoverVectorEnv(2, problem={"box": {"pitch_phase": np.pi / 2}}))


def test_a_run_that_was_killed_has_no_policy_yet_and_is_told_how_it_gets_one(tmp_path: Path) -> None:
    (tmp_path / "checkpoint").mkdir()
    with pytest.raises(FileNotFoundError, match=f"holds no policy.safetensors; .*goes on with --resume {tmp_path}"):
        load_policy(tmp_path)
