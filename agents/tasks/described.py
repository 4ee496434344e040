"""Insects as files keep them."""

from typing import Any

from flapenv.insects import INSECTS, Insect, load_insect


def described(insect: Insect) -> str | dict[str, Any]:
    """An insect for a file: its name where it is one of `INSECTS`, else all its numbers.

    Raises:
        TypeError: for an insect that no file can hold.
    """
    named = insect.name in INSECTS and insect == load_insect(insect.name)
    return insect.name if named else insect.to_dict()
