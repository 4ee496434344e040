"""The actor within a trained model of Stable-Baselines3 or sb3-contrib, or within torch modules."""

from collections.abc import Iterable, Iterator

import numpy as np
import torch
from gymnasium import spaces
from sb3_contrib.common.recurrent.policies import RecurrentActorCriticPolicy
from sb3_contrib.common.torch_layers import BatchRenorm
from stable_baselines3.common.base_class import BaseAlgorithm
from stable_baselines3.common.policies import ActorCriticPolicy, BasePolicy
from stable_baselines3.common.torch_layers import BaseFeaturesExtractor, FlattenExtractor
from torch import nn

from agents.actor import Actor
from agents.policy import Reach
from agents.predictor import begin
from agents.recurrent_actor import AnyActor, LstmCell, RecurrentActor
from agents.remembering import flown

Affine = tuple[np.ndarray, np.ndarray]
BETWEEN: dict[type[nn.Module], str] = {
    nn.ReLU: "relu",
    nn.Tanh: "tanh",
    nn.SiLU: "silu",
    nn.ELU: "elu",
    nn.GELU: "gelu",
    nn.LeakyReLU: "leaky-relu",
}
LAST: dict[type[nn.Module], str] = {Reach: "reach", nn.Tanh: "tanh"}
BEATS, PROBES, CLOSE_ENOUGH = 4, 64, 1e-3
"""Beats of as many observations on which an actor must agree with its model, and how closely; rounding stays below
1e-5."""


def actor_of(model: BaseAlgorithm) -> AnyActor:
    """The deterministic part of a model's policy: what `model.predict(..., deterministic=True)` computes.

    Known are PPO's (`HoverPolicy`, `MlpPolicy`), RecurrentPPO's (`MlpLstmPolicy`), SAC's, TQC's, TD3's and CrossQ's
    networks on flat observations; the batch renormalisation of CrossQ, affine once it is trained, goes into the layer
    beside it.

    Raises:
        ValueError: for spaces, a policy or a layer that an `Actor` has no place for.
    """
    policy = model.policy
    assert isinstance(policy, BasePolicy)
    seen, chosen = policy.observation_space, policy.action_space
    if not isinstance(seen, spaces.Box) or len(seen.shape) != 1:
        raise ValueError(f"observation space {seen} is not allowed; allowed: a Box of shape (n,)")
    if not isinstance(chosen, spaces.Box) or len(chosen.shape) != 1 or {*chosen.low, *-chosen.high} != {-1}:
        raise ValueError(f"action space {chosen} is not allowed; allowed: a Box of [-1, 1] of shape (n,)")
    layers = actor_of_modules(_modules(policy))
    actor: AnyActor = layers
    if isinstance(policy, RecurrentActorCriticPolicy):
        actor = RecurrentActor(_cell(policy.lstm_actor), layers)
    sizes, wanted = (actor.observation_size, actor.action_size), (seen.shape[0], chosen.shape[0])
    if sizes != wanted:
        raise ValueError(
            f"{type(policy).__name__} has layers from {sizes[0]} to {sizes[1]} numbers between spaces of {wanted[0]} "
            f"and {wanted[1]}; allowed: nothing but layers from observation to action"
        )
    probes = np.random.default_rng(0).normal(size=(BEATS, PROBES, *seen.shape)).astype(np.float32)
    own = flown(model)
    pairs = [(actor.predict(beat)[0], own.predict(beat, deterministic=True)[0]) for beat in probes]
    apart = float(np.max(np.abs(np.subtract(*zip(*pairs, strict=True)))))
    begin(actor)
    if not apart < CLOSE_ENOUGH:
        raise ValueError(
            f"{type(policy).__name__} does more than its layers say: actions differ by {apart:.3g}; allowed: a "
            "network from observation to action"
        )
    return actor


def actor_of_modules(modules: Iterable[nn.Module]) -> Actor:
    """The actor that torch modules make one after the other.

    Args:
        modules: `Linear`, an activation, `Linear` and so on, nested in `Sequential` or not, and after the last
            `Linear` nothing, `Tanh` or `agents.policy.Reach`; `BatchRenorm` anywhere, as it is in evaluation.

    Raises:
        ValueError: for another module, by name, or another order.
    """
    layers: list[Affine] = []
    functions: list[nn.Module] = []
    for module in _flat(modules):
        affine = _affine(module)
        if affine is None:
            _name(module, BETWEEN | LAST, "among the layers")
            functions.append(module)
        elif len(functions) < len(layers):  # nothing bends what lies between: two layers are one
            weight, bias = affine
            before, shift = layers[-1]
            layers[-1] = weight @ before, weight @ shift + bias
        else:
            layers.append(affine)
        if len(functions) > len(layers):
            raise ValueError(f"{module} does not follow a layer; allowed: one activation between two layers")
    if not layers:
        raise ValueError("no layer was found; allowed: at least one Linear")
    squash = _name(functions.pop(), LAST, "after the last layer") if len(functions) == len(layers) else "identity"
    names = {_name(function, BETWEEN, "between layers") for function in functions} or {"tanh"}
    if len(names) > 1:
        raise ValueError(f"activations {', '.join(sorted(names))} are mixed; allowed: one for all layers")
    return Actor(
        weights=tuple(weight.astype(np.float32) for weight, _ in layers),
        biases=tuple(bias.astype(np.float32) for _, bias in layers),
        activation=names.pop(),
        squash=squash,
    )


def _modules(policy: BasePolicy) -> list[nn.Module]:
    """Everything between observation and action."""
    if isinstance(policy, ActorCriticPolicy):
        _require_flat(policy.pi_features_extractor)
        squash = [nn.Tanh()] if policy.squash_output else []
        return [policy.mlp_extractor.policy_net, policy.action_net, *squash]
    actor = getattr(policy, "actor", None)
    if not isinstance(actor, BasePolicy) or not isinstance(getattr(actor, "mu", None), nn.Module):
        raise ValueError(
            f"policy {type(policy).__name__} is unknown; allowed: HoverPolicy, and the MlpPolicy of PPO, SAC, TQC, TD3 "
            "and CrossQ"
        )
    _require_flat(actor.features_extractor)
    mean = actor.get_submodule("mu")
    if not hasattr(actor, "latent_pi"):
        return [mean]  # TD3's, which ends in a tanh of its own
    return [actor.get_submodule("latent_pi"), mean, nn.Tanh()]


def _require_flat(extractor: BaseFeaturesExtractor | None) -> None:
    """Refuse what would stand between the observation and the first layer."""
    if type(extractor) is not FlattenExtractor:
        raise ValueError(f"features extractor {type(extractor).__name__} is not allowed; allowed: FlattenExtractor")


def _cell(lstm: nn.LSTM) -> LstmCell:
    """The cell of an LSTM of one layer; torch keeps its bias in two halves."""
    if str(lstm) != str(nn.LSTM(lstm.input_size, lstm.hidden_size)):
        raise ValueError(f"{lstm} is not allowed; allowed: LSTM of one layer, with the arguments it has by default")
    numbers = {name: _numbers(parameter) for name, parameter in lstm.named_parameters()}
    return LstmCell(
        seen_weight=numbers["weight_ih_l0"].astype(np.float32),
        held_weight=numbers["weight_hh_l0"].astype(np.float32),
        bias=(numbers["bias_ih_l0"] + numbers["bias_hh_l0"]).astype(np.float32),
    )


def _flat(modules: Iterable[nn.Module]) -> Iterator[nn.Module]:
    """Modules out of the sequences they are nested in."""
    for module in modules:
        if isinstance(module, nn.Sequential):
            yield from _flat(module)
        elif not isinstance(module, nn.Identity):
            yield module


def _affine(module: nn.Module) -> Affine | None:
    """W and b of a module that computes W x + b in evaluation, in double precision; None for others."""
    if isinstance(module, nn.Linear):
        weight = _numbers(module.weight)
        return weight, np.zeros(len(weight)) if module.bias is None else _numbers(module.bias)
    if isinstance(module, BatchRenorm):
        scale, shift = np.ones(module.num_features), np.zeros(module.num_features)
        if module.affine:
            scale, shift = _numbers(module.scale), _numbers(module.bias)
        mean, variance = (_numbers(module.get_buffer(name)) for name in ("ra_mean", "ra_var"))
        scale = scale / np.sqrt(variance + module.eps)
        return np.diag(scale), shift - scale * mean
    return None


def _numbers(tensor: torch.Tensor) -> np.ndarray:
    """A tensor's values in double precision."""
    return tensor.detach().cpu().numpy().astype(np.float64)


def _name(module: nn.Module, names: dict[type[nn.Module], str], where: str) -> str:
    """An activation's name, if it is one of `names` with the constants it has by default."""
    kind = type(module)
    if kind not in names or str(module) != str(kind()):
        allowed = ", ".join(str(known()) for known in names)
        raise ValueError(f"{module} {where} is not allowed; allowed: {allowed}")
    return names[kind]
