"""A policy without its learner: the layers between observation and action, flown in NumPy alone."""

from collections.abc import Callable, Mapping
from typing import Any

import numpy as np
from scipy import special

from flapenv.aero.checks import record, require_name

MEAN_REACH = 1.1
"""The squash "reach" runs over ±1.1, a little past the box, so that its faces are reached at a finite weight."""
Function = Callable[[np.ndarray], np.ndarray]
ACTIVATIONS: dict[str, Function] = {
    "relu": lambda x: np.maximum(x, 0),
    "tanh": np.tanh,
    "silu": lambda x: x * special.expit(x),
    "elu": lambda x: np.where(x > 0, x, np.expm1(np.minimum(x, 0))),
    "gelu": lambda x: x * special.ndtr(x),
    "leaky-relu": lambda x: np.where(x > 0, x, 0.01 * x),
}
"""Between layers, with the constants that torch's modules of these names have by default."""
SQUASHES: dict[str, Function] = {
    "reach": lambda x: MEAN_REACH * np.tanh(x),
    "tanh": np.tanh,
    "identity": lambda x: x,
}
"""After the last layer; what is left outside [-1, 1] is clipped."""


@record
class Actor:
    """The deterministic part of a policy, a plain feed-forward network in single precision.

    Attributes:
        weights: of each layer, shape (outputs, inputs).
        biases: of each layer, shape (outputs,).
        activation: a name of `ACTIVATIONS`, between layers.
        squash: a name of `SQUASHES`, after the last.

    Raises:
        TypeError: for a layer that is not an array of float32.
        ValueError: for an unknown name, layers that do not fit together, NaN or inf.
    """

    weights: tuple[np.ndarray, ...]
    biases: tuple[np.ndarray, ...]
    activation: str
    squash: str

    def __post_init__(self) -> None:
        """Check every layer, and keep copies that nobody can change."""
        require_name("activation", self.activation, ACTIVATIONS)
        require_name("squash", self.squash, SQUASHES)
        if not self.weights or len(self.weights) != len(self.biases):
            raise ValueError(
                f"{len(self.weights)} weights and {len(self.biases)} biases are not allowed; allowed: one of each a "
                "layer, at least one layer"
            )
        inputs = np.shape(self.weights[0])[-1:]
        for number, (weight, bias) in enumerate(zip(self.weights, self.biases, strict=True)):
            _require_layer(f"layers.{number}", weight, bias, inputs)
            inputs = bias.shape
        for field in ("weights", "biases"):
            object.__setattr__(self, field, tuple(kept(array) for array in getattr(self, field)))

    @property
    def observation_size(self) -> int:
        """How many numbers an observation has."""
        return int(self.weights[0].shape[1])

    @property
    def action_size(self) -> int:
        """How many numbers an action has."""
        return len(self.weights[-1])

    @property
    def memory(self) -> int:
        """How many numbers it remembers: none."""
        return 0

    @property
    def widths(self) -> tuple[int, ...]:
        """Neurons of each hidden layer."""
        return tuple(len(weight) for weight in self.weights[:-1])

    def predict(self, observation: np.ndarray, *, deterministic: bool = True) -> tuple[np.ndarray, None]:
        """Actions in [-1, 1], float32, of shape (action_size,) or (n, action_size), and None for a state.

        Args:
            observation: shape (observation_size,) or (n, observation_size).
            deterministic: only True: the noise of training is not part of an actor.

        Raises:
            TypeError: for an observation that is not numbers.
            ValueError: for one of another shape, or deterministic = False.
        """
        if not deterministic:
            raise ValueError("deterministic = False is not allowed; allowed: True, as an actor has no noise")
        seen = np.asarray(observation, dtype=np.float32)
        if seen.ndim not in (1, 2) or seen.shape[-1] != self.observation_size:
            size = self.observation_size
            raise ValueError(f"observation has shape {seen.shape}; allowed: ({size},) or (n, {size})")
        activate = ACTIVATIONS[self.activation]
        for weight, bias in zip(self.weights[:-1], self.biases[:-1], strict=True):
            seen = activate(seen @ weight.T + bias)
        return np.clip(SQUASHES[self.squash](seen @ self.weights[-1].T + self.biases[-1]), -1, 1), None

    def to_tensors(self) -> dict[str, np.ndarray]:
        """Weights and biases by the names that a file gives them."""
        tensors = {}
        for number, (weight, bias) in enumerate(zip(self.weights, self.biases, strict=True)):
            tensors[f"layers.{number}.weight"], tensors[f"layers.{number}.bias"] = weight, bias
        return tensors

    @classmethod
    def from_tensors(cls, tensors: Mapping[str, np.ndarray], *, activation: str, squash: str) -> "Actor":
        """The actor of tensors named as `to_tensors` names them.

        Raises:
            TypeError: as the class does.
            ValueError: as the class does, and for a missing or an unknown name.
        """
        layers = range(max(1, len(tensors) // 2))
        names = [f"layers.{number}.{part}" for number in layers for part in ("weight", "bias")]
        for name in tensors:
            require_name("tensor", name, names)
        missing = [name for name in names if name not in tensors]
        if missing:
            raise ValueError(f"tensors {', '.join(missing)} are missing; allowed: a weight and a bias for every layer")
        parts = (tuple(tensors[f"layers.{number}.{part}"] for number in layers) for part in ("weight", "bias"))
        weights, biases = parts
        return cls(weights=weights, biases=biases, activation=activation, squash=squash)


def _require_layer(name: str, weight: Any, bias: Any, inputs: tuple[int, ...]) -> None:
    """Refuse what is not finite float32 of shapes (outputs, *inputs) and (outputs,)."""
    for part, array in (("weight", weight), ("bias", bias)):
        require_numbers(f"{name}.{part}", array)
    if weight.ndim != 2 or weight.shape[1:] != inputs or not weight.size:
        raise ValueError(f"{name}.weight has shape {weight.shape}; allowed: (outputs, {', '.join(map(str, inputs))})")
    if bias.shape != weight.shape[:1]:
        raise ValueError(f"{name}.bias has shape {bias.shape}; allowed: {weight.shape[:1]}")


def require_numbers(name: str, array: Any) -> None:
    """Refuse what is not an array of finite float32.

    Raises:
        TypeError: for another type.
        ValueError: for NaN or inf.
    """
    if not isinstance(array, np.ndarray) or array.dtype != np.float32:
        kind = array.dtype if isinstance(array, np.ndarray) else type(array).__name__
        raise TypeError(f"{name} is of type {kind}; allowed: an array of float32")
    bad = array[~np.isfinite(array)]
    if bad.size:
        raise ValueError(
            f"{name} holds {bad.size} numbers that are not finite, the first {bad[0]}; allowed: finite ones"
        )


def kept(array: np.ndarray) -> np.ndarray:
    """A copy that cannot be written."""
    copy = np.array(array)
    copy.flags.writeable = False
    return copy
