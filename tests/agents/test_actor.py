"""An actor is the deterministic part of a model, whatever learned it."""

from collections.abc import Callable
from typing import Any

import gymnasium as gym
import numpy as np
import pytest
import torch
from gymnasium import spaces
from sb3_contrib import TQC, CrossQ
from stable_baselines3 import DQN, PPO, SAC, TD3
from stable_baselines3.common.base_class import BaseAlgorithm
from torch import nn

from agents.actor import ACTIVATIONS, MEAN_REACH, SQUASHES, Actor
from agents.actor_of import BETWEEN, actor_of, actor_of_modules
from agents.policy import HoverPolicy, Reach
from agents.vec_env import GymnasiumVecEnv
from flapenv.envs import HoverVectorEnv

OFF_POLICY: dict[str, Any] = {"learning_starts": 32, "batch_size": 64, "buffer_size": 2000}
MODELS: dict[str, tuple[type[BaseAlgorithm], Any, dict[str, Any], dict[str, Any]]] = {
    "hover-ppo": (PPO, HoverPolicy, {"n_steps": 4, "batch_size": 32}, {}),
    "ppo": (PPO, "MlpPolicy", {"n_steps": 4, "batch_size": 32}, {}),
    "ppo-elu": (PPO, "MlpPolicy", {"n_steps": 4, "batch_size": 32}, {"activation_fn": nn.ELU}),
    "ppo-squashed": (PPO, "MlpPolicy", {"n_steps": 4, "batch_size": 32, "use_sde": True}, {"squash_output": True}),
    "sac": (SAC, "MlpPolicy", OFF_POLICY, {}),
    "sac-silu": (SAC, "MlpPolicy", OFF_POLICY, {"activation_fn": nn.SiLU}),
    "tqc": (TQC, "MlpPolicy", OFF_POLICY, {}),
    "td3": (TD3, "MlpPolicy", OFF_POLICY, {}),
    "td3-tanh": (TD3, "MlpPolicy", OFF_POLICY, {"activation_fn": nn.Tanh}),
    "crossq": (CrossQ, "MlpPolicy", OFF_POLICY, {}),
}


@pytest.fixture(scope="module")
def vec_env() -> GymnasiumVecEnv:
    torch.set_num_threads(1)
    return GymnasiumVecEnv(HoverVectorEnv(16, autoreset_mode="SAME_STEP", infos="none"))


def build(name: str, env: GymnasiumVecEnv) -> BaseAlgorithm:
    learner, policy, arguments, network = MODELS[name]
    network = {"net_arch": [24, 16], **network}
    make: Callable[..., BaseAlgorithm] = learner
    return make(policy, env, policy_kwargs=network, device="cpu", seed=0, **arguments)


def shake(model: BaseAlgorithm, size: float = 0.3) -> None:
    """Move every weight, and statistics with them, so that no term is trivial."""
    torch.manual_seed(1)
    with torch.no_grad():
        for parameter in model.policy.parameters():
            parameter.add_(size * torch.randn_like(parameter))


def apart(model: BaseAlgorithm) -> float:
    observations = np.random.default_rng(2).uniform(-3, 3, (2000, 6)).astype(np.float32)
    expected, _ = model.predict(observations, deterministic=True)
    found, state = actor_of(model).predict(observations)
    assert state is None
    assert found.dtype == expected.dtype == np.float32
    assert found.shape == expected.shape
    assert np.std(expected) > 0.05
    return float(np.max(np.abs(found - expected)))


@pytest.mark.parametrize("name", MODELS)
def test_an_actor_does_what_its_model_predicts(name: str, vec_env: GymnasiumVecEnv) -> None:
    model = build(name, vec_env)
    shake(model)
    assert apart(model) < 5e-6


def test_running_statistics_of_a_trained_crossq_go_into_its_layers(vec_env: GymnasiumVecEnv) -> None:
    model = build("crossq", vec_env)
    model.learn(1600)
    mean = model.policy.actor.latent_pi[0].get_buffer("ra_mean")
    assert mean.abs().max() > 0.1
    shake(model)
    with torch.no_grad():
        for name, buffer in model.policy.actor.named_buffers():
            if name.endswith("ra_var"):
                buffer.mul_(torch.rand_like(buffer) + 0.2)
    assert apart(model) < 1e-5
    assert len(actor_of(model).weights) == 3


def test_one_observation_gives_one_action(vec_env: GymnasiumVecEnv) -> None:
    model = build("hover-ppo", vec_env)
    shake(model)
    actor, seen = actor_of(model), np.linspace(-1, 1, 6, dtype=np.float32)
    assert actor.predict(seen)[0].shape == (6,)
    assert actor.predict(seen)[0] == pytest.approx(model.predict(seen, deterministic=True)[0], abs=1e-6)
    assert actor.predict(seen)[0] == pytest.approx(actor.predict(seen[None])[0][0], abs=1e-6)


@pytest.mark.parametrize("kind", BETWEEN)
def test_activations_are_torchs(kind: type[nn.Module]) -> None:
    x = torch.linspace(-6, 6, 241)
    found = ACTIVATIONS[BETWEEN[kind]](x.numpy())
    assert found.dtype == np.float32
    assert found == pytest.approx(kind()(x).numpy(), abs=1e-6)


def test_every_activation_and_squash_can_be_had_from_modules() -> None:
    assert set(BETWEEN.values()) == set(ACTIVATIONS)
    x = np.linspace(-3, 3, 50, dtype=np.float32)
    assert Reach()(torch.as_tensor(x)).numpy() == pytest.approx(SQUASHES["reach"](x), abs=1e-6)
    assert MEAN_REACH > 1


def test_modules_of_ones_own_make_an_actor() -> None:
    torch.manual_seed(0)
    network = nn.Sequential(
        nn.Linear(5, 8), nn.Linear(8, 8, bias=False), nn.Identity(), nn.SiLU(), nn.Linear(8, 2), Reach()
    )
    actor = actor_of_modules(network)
    assert (actor.widths, actor.activation, actor.squash) == ((8,), "silu", "reach")
    x = torch.randn(100, 5)
    with torch.no_grad():
        assert actor.predict(x.numpy())[0] == pytest.approx(network(x).clamp(-1, 1).numpy(), abs=1e-6)


@pytest.mark.parametrize(
    ("modules", "said"),
    [
        ([nn.Linear(3, 3), nn.Hardtanh(), nn.Linear(3, 1)], r"Hardtanh\(.*\) among the layers is not .*allowed: ReLU"),
        ([nn.Linear(3, 3), nn.ELU(alpha=0.5), nn.Linear(3, 1)], r"ELU\(alpha=0.5\) among the layers is not allowed"),
        ([nn.Linear(3, 3), nn.LayerNorm(3), nn.ReLU(), nn.Linear(3, 1)], r"LayerNorm.* is not allowed"),
        ([nn.Linear(3, 3), Reach(), nn.Linear(3, 1)], r"Reach\(\) between layers is not allowed"),
        ([nn.ReLU(), nn.Linear(3, 1)], "does not follow a layer"),
        ([nn.Linear(3, 3), nn.ReLU()], r"ReLU\(\) after the last layer is not allowed"),
        ([nn.Linear(3, 3), nn.ReLU(), nn.Linear(3, 3), nn.Tanh(), nn.Linear(3, 1)], "relu, tanh are mixed"),
        ([], "no layer"),
    ],
)
def test_what_is_not_known_is_refused_by_name(modules: list[nn.Module], said: str) -> None:
    with pytest.raises(ValueError, match=said):
        actor_of_modules(modules)


def test_models_that_are_no_plain_network_are_refused(vec_env: GymnasiumVecEnv) -> None:
    with pytest.raises(ValueError, match="allowed: a Box of shape"):
        actor_of(PPO("MultiInputPolicy", _DictEnv(), n_steps=8, batch_size=8, device="cpu"))
    with pytest.raises(ValueError, match=r"action space Discrete.*allowed: a Box of \[-1, 1\]"):
        actor_of(DQN("MlpPolicy", gym.make("CartPole-v1"), device="cpu", buffer_size=10))
    with pytest.raises(ValueError, match=r"action space Box.*allowed: a Box of \[-1, 1\]"):
        actor_of(PPO("MlpPolicy", gym.make("Pendulum-v1"), n_steps=8, batch_size=8, device="cpu"))
    noisy = SAC("MlpPolicy", vec_env, use_sde=True, device="cpu", **OFF_POLICY)
    with pytest.raises(ValueError, match="Hardtanh"):
        actor_of(noisy)


def test_a_policy_that_does_more_than_its_layers_is_refused(vec_env: GymnasiumVecEnv) -> None:
    class Doubled(HoverPolicy):
        def _predict(self, observation: torch.Tensor, deterministic: bool = False) -> torch.Tensor:
            return super()._predict(2 * observation, deterministic)

    model = PPO(Doubled, vec_env, n_steps=4, batch_size=32, device="cpu", seed=0)
    shake(model)
    with pytest.raises(ValueError, match="Doubled does more than its layers say"):
        actor_of(model)


class _DictEnv(gym.Env):
    observation_space = spaces.Dict({"a": spaces.Box(-1, 1, (2,))})
    action_space = spaces.Box(-1, 1, (1,))

    def reset(self, **_: Any) -> tuple[dict[str, np.ndarray], dict[str, Any]]:
        return self.observation_space.sample(), {}


def layers(*sizes: int) -> dict[str, Any]:
    rng = np.random.default_rng(0)
    pairs = list(zip(sizes[1:], sizes[:-1], strict=True))
    return {
        "weights": tuple(rng.normal(size=pair).astype(np.float32) for pair in pairs),
        "biases": tuple(rng.normal(size=pair[:1]).astype(np.float32) for pair in pairs),
        "activation": "tanh",
        "squash": "reach",
    }


(W0, W1), (B0, B1) = layers(4, 8, 2)["weights"], layers(4, 8, 2)["biases"]


def test_an_actor_cannot_be_changed_and_knows_its_sizes() -> None:
    parts = layers(4, 8, 7, 2)
    actor = Actor(**parts)
    assert (actor.observation_size, actor.widths, actor.action_size) == (4, (8, 7), 2)
    before = actor.predict(np.ones(4))[0]
    parts["weights"][0][:] = 0
    assert (actor.predict(np.ones(4))[0] == before).all()
    with pytest.raises(ValueError, match="read-only"):
        actor.weights[0][0] = 1
    again = Actor.from_tensors(actor.to_tensors(), activation=actor.activation, squash=actor.squash)
    assert (again.predict(np.ones(4))[0] == before).all()
    assert (np.abs(actor.predict(1e3 * np.random.default_rng(0).normal(size=(100, 4)))[0]) <= 1).all()


@pytest.mark.parametrize(
    ("change", "error", "said"),
    [
        ({"activation": "rela"}, ValueError, "activation = 'rela' is unknown; .*did you mean 'relu'"),
        ({"squash": "than"}, ValueError, "squash = 'than' is unknown; .*did you mean 'tanh'"),
        ({"biases": (B0,)}, ValueError, "2 weights and 1 biases"),
        ({"weights": (), "biases": ()}, ValueError, "at least one layer"),
        ({"weights": (W1, W0)}, ValueError, r"layers.0.bias has shape \(8,\); allowed: \(2,\)"),
        ({"weights": (W0, W1.T)}, ValueError, r"allowed: \(outputs, 8\)"),
        ({"weights": (W0, W1.astype(float))}, TypeError, "float64; allowed: .*float32"),
        ({"weights": (W0, W1 * np.float32(np.nan))}, ValueError, "layers.1.weight holds 16 .*nan"),
        ({"biases": (B0 + np.float32(np.inf), B1)}, ValueError, "layers.0.bias holds .*inf"),
    ],
)
def test_layers_that_do_not_fit_are_refused(change: dict[str, Any], error: type[Exception], said: str) -> None:
    with pytest.raises(error, match=said):
        Actor(**layers(4, 8, 2) | change)


def test_observations_that_do_not_fit_are_refused() -> None:
    actor = Actor(**layers(4, 8, 2))
    for bad in (np.ones(5), np.ones((3, 5)), np.ones((2, 3, 4)), np.float32(1)):
        with pytest.raises(ValueError, match=r"allowed: \(4,\) or \(n, 4\)"):
            actor.predict(bad)
    with pytest.raises(ValueError, match="deterministic = False"):
        actor.predict(np.ones(4), deterministic=False)
