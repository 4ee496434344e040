"""Bytes as a row of choices, so that one fuzzer's input decides a whole document."""

import copy
import struct
from collections.abc import Sequence
from typing import Any, TypeVar

T = TypeVar("T")
ODD_NUMBERS: tuple[Any, ...] = (
    0,
    1,
    -1,
    2,
    0.0,
    -0.0,
    0.5,
    1e-6,
    5e-324,
    2.2e-308,
    1e-30,
    1e30,
    1.8e308,
    -1e308,
    float("inf"),
    float("-inf"),
    float("nan"),
    2**31,
    2**53 + 1,
    2**64,
    10**400,
)
ODD_THINGS: tuple[Any, ...] = (
    None,
    True,
    False,
    "",
    " ",
    "hawkmoth",
    "all",
    "\0",
    "a\nb",
    "\u202e\x1b[2J",
    "\ud800",
    "é" * 3000,
    "0.5",
    "nan",
    [],
    {},
    [[]],
    [1.0, 2.0],
    [2.0, 1.0],
    [1.0, "a", None],
    [None] * 3000,
    {"": None},
    {"a": {"b": {"c": [{}]}}},
    {"name": "x"},
)


class Draw:
    """Choices from bytes; when they are used up, every choice is the first one."""

    def __init__(self, data: bytes) -> None:
        """Begin at the first byte."""
        self.left = data

    def take(self, count: int) -> bytes:
        """The next bytes, zeros where there are none."""
        taken, self.left = self.left[:count], self.left[count:]
        return taken.ljust(count, b"\0")

    def rest(self) -> bytes:
        """All that is left."""
        taken, self.left = self.left, b""
        return taken

    def byte(self) -> int:
        """0 to 255."""
        return self.take(1)[0]

    def index(self, count: int) -> int:
        """0 to count - 1."""
        return int.from_bytes(self.take(1 if count <= 256 else 3), "little") % count

    def one_of(self, choices: Sequence[T]) -> T:
        """One of several."""
        return choices[self.index(len(choices))]

    def real(self) -> float:
        """A double of any bit pattern."""
        value: float = struct.unpack("<d", self.take(8))[0]
        return value

    def number(self, usual: float = 1.0) -> Any:
        """A number: the usual one, near it, in another unit, an odd one, or any."""
        how = self.byte()
        if how < 48:
            return usual
        if how < 128:
            return usual * (0.5 + self.byte() / 128)
        if how < 176:
            return usual * 10.0 ** (self.byte() - 128)
        if how < 224:
            return self.one_of(ODD_NUMBERS)
        return self.real()

    def thing(self) -> Any:
        """Anything that JSON can say, and numbers that it cannot."""
        how = self.byte()
        if how < 96:
            return copy.deepcopy(self.one_of(ODD_THINGS))
        if how < 160:
            return self.one_of(ODD_NUMBERS)
        if how < 224:
            return self.number()
        return self.text()

    def text(self) -> str:
        """Up to 15 letters of any kind, halves of characters among them."""
        count, step = self.byte() % 16, 1 if self.byte() % 4 else 217
        return "".join(chr(step * one) for one in self.take(count))
