"""A policy with memory without its learner: an LSTM cell before the layers, flown in NumPy alone."""

from collections.abc import Mapping

import numpy as np
from scipy import special

from agents.actor import Actor, kept, require_numbers
from flapenv.aero.checks import record

GATES = 4
"""Input, forget, cell and output gate, in torch's order."""
PREFIX = "memory."
"""Of the names of the cell's tensors in a file."""


@record
class LstmCell:
    """One layer of long short-term memory in single precision, with torch's equations.

    Attributes:
        seen_weight: of the observation, the four gates i, f, g, o one below the other, shape (4 memory, observation).
        held_weight: of the cell's last output, shape (4 memory, memory).
        bias: shape (4 memory,).

    Raises:
        TypeError: for what is not an array of float32.
        ValueError: for arrays that do not fit together, NaN or inf.
    """

    seen_weight: np.ndarray
    held_weight: np.ndarray
    bias: np.ndarray

    def __post_init__(self) -> None:
        """Check every array, and keep copies that nobody can change."""
        for field in self.__dataclass_fields__:
            array = getattr(self, field)
            require_numbers(f"{PREFIX}{field}", array)
            object.__setattr__(self, field, kept(array))
        rows, size = GATES * self.size, self.size
        _require_shape("bias", self.bias, f"(4 memory,), here ({rows},)", self.bias.shape == (rows,) != (0,))
        shape = self.seen_weight.shape
        _require_shape("seen_weight", self.seen_weight, f"({rows}, observation)", len(shape) == 2 and shape[0] == rows)
        _require_shape("held_weight", self.held_weight, f"({rows}, {size})", self.held_weight.shape == (rows, size))

    @property
    def size(self) -> int:
        """How many numbers it remembers, and gives out."""
        return self.bias.size // GATES

    def step(self, seen: np.ndarray, held: np.ndarray, cell: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Output h and cell c of the next beat, shape (rows, size) each.

        c' = σ(f) c + σ(i) tanh g, h' = σ(o) tanh c', where i, f, g, o = W x + U h + b.

        Args:
            seen: observation x, shape (rows, observation).
            held: h of the last beat, shape (rows, size).
            cell: c of the last beat, shape (rows, size).
        """
        gates = seen @ self.seen_weight.T + held @ self.held_weight.T + self.bias
        take, keep, new, give = np.split(gates, GATES, axis=-1)
        cell = special.expit(keep) * cell + special.expit(take) * np.tanh(new)
        return special.expit(give) * np.tanh(cell), cell


class RecurrentActor:
    """The deterministic part of a policy with memory: a cell, and an `Actor` of what the cell gives out.

    It remembers from one `predict` to the next; `start` before the episodes of a batch, which begin together.
    """

    def __init__(self, cell: LstmCell, head: Actor) -> None:
        """Join a cell and the layers after it.

        Raises:
            ValueError: for layers that do not take what the cell gives out.
        """
        if head.observation_size != cell.size:
            raise ValueError(f"layers.0.weight takes {head.observation_size} numbers; allowed: {cell.size}, the memory")
        self.cell, self.head = cell, head
        self.activation, self.squash, self.widths = head.activation, head.squash, head.widths
        self._state: tuple[np.ndarray, np.ndarray] | None = None

    @property
    def observation_size(self) -> int:
        """How many numbers an observation has."""
        return int(self.cell.seen_weight.shape[1])

    @property
    def action_size(self) -> int:
        """How many numbers an action has."""
        return self.head.action_size

    @property
    def memory(self) -> int:
        """How many numbers it remembers."""
        return self.cell.size

    def start(self) -> None:
        """Forget: the next observations are the first of their episodes."""
        self._state = None

    def predict(self, observation: np.ndarray, *, deterministic: bool = True) -> tuple[np.ndarray, None]:
        """Actions in [-1, 1], float32, of shape (action_size,) or (n, action_size), and None: the state stays here.

        Args:
            observation: of the next beat, shape (observation_size,) or (n, observation_size).
            deterministic: only True: the noise of training is not part of an actor.

        Raises:
            TypeError: for an observation that is not numbers.
            ValueError: for one of another shape, other rows than those since `start`, or deterministic = False.
        """
        if not deterministic:
            raise ValueError("deterministic = False is not allowed; allowed: True, as an actor has no noise")
        seen = np.asarray(observation, dtype=np.float32)
        if seen.ndim not in (1, 2) or seen.shape[-1] != self.observation_size:
            size = self.observation_size
            raise ValueError(f"observation has shape {seen.shape}; allowed: ({size},) or (n, {size})")
        shape = (*seen.shape[:-1], self.memory)
        if self._state is None:
            self._state = np.zeros(shape, dtype=np.float32), np.zeros(shape, dtype=np.float32)
        if self._state[0].shape != shape:
            rows = self._state[0].shape[:-1]
            raise ValueError(
                f"observation has shape {seen.shape}; allowed: {(*rows, self.observation_size)}, as since the start of "
                "these episodes; others begin with start()"
            )
        self._state = self.cell.step(seen, *self._state)
        return self.head.predict(self._state[0])

    def to_tensors(self) -> dict[str, np.ndarray]:
        """Weights and biases by the names that a file gives them."""
        cell = {f"{PREFIX}{field}": getattr(self.cell, field) for field in self.cell.__dataclass_fields__}
        return {**cell, **self.head.to_tensors()}

    @classmethod
    def from_tensors(cls, tensors: Mapping[str, np.ndarray], *, activation: str, squash: str) -> "RecurrentActor":
        """The actor of tensors named as `to_tensors` names them.

        Raises:
            TypeError: as its parts do.
            ValueError: as its parts do, and for a missing or an unknown name.
        """
        names = [f"{PREFIX}{field}" for field in LstmCell.__dataclass_fields__]
        missing = [name for name in names if name not in tensors]
        if missing:
            raise ValueError(f"tensors {', '.join(missing)} are missing; allowed: all of {', '.join(names)}")
        cell = LstmCell(**{name.removeprefix(PREFIX): tensors[name] for name in names})
        layers = {name: tensor for name, tensor in tensors.items() if name not in names}
        return cls(cell, Actor.from_tensors(layers, activation=activation, squash=squash))


AnyActor = Actor | RecurrentActor
"""What a policy file holds."""


def _require_shape(field: str, array: np.ndarray, wanted: str, fits: bool) -> None:
    """Refuse an array of another shape."""
    if not fits or not array.size:
        raise ValueError(f"{PREFIX}{field} has shape {array.shape}; allowed: {wanted}")
