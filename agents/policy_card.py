"""What a policy file says of itself: where the policy flies, what it is made of, and how it was trained."""

import json
from collections.abc import Mapping
from dataclasses import asdict
from typing import Any

import gymnasium as gym
from gymnasium.vector import VectorEnv

from agents.actor import ACTIVATIONS, SQUASHES
from agents.recurrent_actor import AnyActor
from flapenv.aero.checks import record, require_count, require_name, require_scalar, shown
from flapenv.envs.registration import ENV_IDS

FORMAT = 1
"""The version of card and tensors together."""
NETWORK = ("observation_size", "action_size", "widths", "activation", "squash", "memory")
"""What network and card both know."""
DIGEST_LENGTH = 64


@record
class PolicyCard:
    """Everything about a policy but its weights, as the JSON file beside them holds it.

    Attributes:
        format: version of the file format.
        environment: the environment's id, one of `ENV_IDS`.
        task: what the task is made with, as `Task.to_dict` gives it.
        observation_size: numbers of an observation.
        action_size: numbers of an action.
        widths: neurons of each hidden layer.
        activation: a name of `agents.actor.ACTIVATIONS`.
        squash: a name of `agents.actor.SQUASHES`.
        memory: numbers that an LSTM before the layers remembers; 0 where there is none.
        algorithm: the learner, as one says it: "PPO".
        preset: the name of its settings.
        command: what was typed to train it.
        seed: of the training.
        wingbeats: it was trained on.
        result: "mean" and "worst" distance to the task's reference [-], and whatever else is a number or a text.
        versions: of the packages it was trained with.
        sha256: of the file of weights, hexadecimal; empty until the policy is saved.

    Raises:
        TypeError: for an unknown or a missing field, or a value of another kind.
        ValueError: for an unknown name or a value out of range.
    """

    environment: str
    task: Mapping[str, Any]
    observation_size: int
    action_size: int
    widths: tuple[int, ...]
    activation: str
    squash: str
    algorithm: str
    preset: str
    command: str
    seed: int
    wingbeats: int
    result: Mapping[str, Any]
    versions: Mapping[str, str]
    memory: int = 0
    sha256: str = ""
    format: int = FORMAT

    def __post_init__(self) -> None:
        """Check every field; mappings are copied as JSON keeps them."""
        if require_count("format", self.format) != FORMAT:
            raise ValueError(f"format = {self.format} is unknown; allowed: {FORMAT}, which this version reads")
        require_name("environment", self.environment, ENV_IDS)
        require_name("activation", self.activation, ACTIVATIONS)
        require_name("squash", self.squash, SQUASHES)
        for field in ("observation_size", "action_size"):
            require_count(field, getattr(self, field))
        for field in ("seed", "wingbeats", "memory"):
            require_count(field, getattr(self, field), low=0)
        for field in ("algorithm", "preset", "command", "sha256"):
            if not isinstance(getattr(self, field), str):
                raise TypeError(f"{field} = {shown(getattr(self, field))} is not allowed; allowed: a text")
        for field in ("task", "result", "versions"):
            object.__setattr__(self, field, _plain(field, getattr(self, field)))
        object.__setattr__(self, "widths", _checked_widths(self.widths))
        _require_digest(self.sha256)
        _require_result(self.result)

    @classmethod
    def of(cls, actor: AnyActor, **facts: Any) -> "PolicyCard":
        """The card of an actor, which fills in what the network says of itself; `facts` are the other fields.

        Raises:
            TypeError: as the class does.
            ValueError: as the class does.
        """
        return cls(**{field: getattr(actor, field) for field in NETWORK}, **facts)

    def to_dict(self) -> dict[str, Any]:
        """As the JSON file holds it; `from_dict` takes it back."""
        return {**asdict(self), "widths": list(self.widths)}

    @classmethod
    def from_dict(cls, content: Any) -> "PolicyCard":
        """The card of a dict.

        Raises:
            TypeError: as the class does, and for what is not a dict.
            ValueError: as the class does; another format is refused first, whatever its fields.
        """
        if not isinstance(content, Mapping):
            raise TypeError(f"a card of type {type(content).__name__} is not allowed; allowed: a mapping of its fields")
        if "format" not in content:
            raise ValueError(f"format is missing; allowed: {FORMAT}")
        if content["format"] != FORMAT:
            raise ValueError(
                f"format = {shown(content['format'])} is unknown; allowed: {FORMAT}, which this version reads"
            )
        return cls(**content)

    def require_actor(self, actor: AnyActor) -> None:
        """Refuse an actor that is not the one described.

        Raises:
            ValueError: naming the field that differs.
        """
        for field in NETWORK:
            said, found = getattr(self, field), getattr(actor, field)
            if said != found:
                raise ValueError(
                    f"{field} = {shown(said)} of the card is not allowed; allowed: {found!r}, the network's"
                )

    def require_fit(self, env: gym.Env | VectorEnv) -> None:
        """Refuse an environment whose spaces are not those the policy was trained in.

        Raises:
            ValueError: naming the space, its shape and what is allowed.
        """
        spaces = (env.observation_space, env.action_space)
        if isinstance(env, VectorEnv):
            spaces = (env.single_observation_space, env.single_action_space)
        for name, space, size in zip(("observation", "action"), spaces, self._sizes, strict=True):
            if space.shape != (size,):
                raise ValueError(
                    f"{name}s of shape {space.shape} do not fit a policy of {self.environment} with {name}s of {size} "
                    f"numbers; allowed: environments made as in its training"
                )

    @property
    def _sizes(self) -> tuple[int, int]:
        return self.observation_size, self.action_size


def _checked_widths(widths: Any) -> tuple[int, ...]:
    """Neurons of each hidden layer, from a list or a tuple."""
    if not isinstance(widths, list | tuple):
        raise TypeError(f"widths = {shown(widths)} are not allowed; allowed: a list of whole numbers")
    return tuple(require_count(f"widths[{number}]", width) for number, width in enumerate(widths))


def _require_digest(sha256: str) -> None:
    """Refuse what is no sha256, unless it is empty."""
    if sha256 and (len(sha256) != DIGEST_LENGTH or set(sha256) - set("0123456789abcdef")):
        raise ValueError(f"sha256 = {shown(sha256)} is not allowed; allowed: {DIGEST_LENGTH} hexadecimal digits")


def _require_result(result: Mapping[str, Any]) -> None:
    """Refuse a result without its two numbers, or with anything but plain values."""
    for name in ("mean", "worst"):
        if name not in result:
            raise ValueError(f"result has no {shown(name)}; allowed: a mapping with 'mean' and 'worst'")
    for name, value in result.items():
        if not isinstance(value, str | None):
            require_scalar(f"result[{shown(name)}]", value)


def _plain(field: str, value: Any) -> dict[str, Any]:
    """A copy as JSON keeps it, which nobody can change behind the check."""
    if not isinstance(value, Mapping) or not all(isinstance(key, str) for key in value):
        raise TypeError(f"{field} = {shown(value)} is not allowed; allowed: a mapping of texts to what JSON can hold")
    try:
        copy = json.loads(json.dumps(value, allow_nan=False))
    except (TypeError, ValueError) as problem:
        raise ValueError(f"{field} = {shown(value)} cannot be written as JSON: {problem}") from None
    assert isinstance(copy, dict)
    return copy
