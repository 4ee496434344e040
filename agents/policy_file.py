"""Policies in files that nothing can hide in: weights as safetensors, all else as a JSON card beside them."""

import dataclasses
import hashlib
import os
from pathlib import Path

from safetensors import SafetensorError
from safetensors.numpy import load as load_tensors
from safetensors.numpy import save as tensors_as_bytes

from agents.actor import Actor
from agents.policy_card import PolicyCard
from agents.recurrent_actor import AnyActor, RecurrentActor
from agents.run_folder import CHECKPOINT, POLICY_TENSORS, write_atomically
from flapenv.aero.checks import allowed
from flapenv.read_json import read_object
from flapenv.whole_file import write_json

SHIPPED = Path(__file__).parent / "policies"
"""Where the repository's own policies lie."""
LARGEST = 2**26
"""A policy is small; a larger file is not read [bytes]."""


def shipped_policies() -> dict[str, Path]:
    """Names of the policies that come with the repository, and their files."""
    return {path.stem: path for path in sorted(SHIPPED.glob("*.safetensors"))}


def save_policy(actor: AnyActor, card: PolicyCard, path: Path) -> PolicyCard:
    """Write the weights to `path` and the card beside it, each in one step.

    A crash between the two leaves weights that the older card does not know, which `load_policy` finds.

    Args:
        actor: the network.
        card: its description, from `PolicyCard.of`.
        path: NAME.safetensors; the card is NAME.json.

    Returns:
        The card as written, with the weights' sha256.

    Raises:
        ValueError: for another ending, or a card that describes another network.
        OSError: if a file cannot be written.
    """
    _require_ending(path)
    card.require_actor(actor)
    content = tensors_as_bytes(actor.to_tensors())
    card = dataclasses.replace(card, sha256=hashlib.sha256(content).hexdigest())
    write_atomically(path, lambda part: part.write_bytes(content))
    write_json(path.with_suffix(".json"), card.to_dict())
    return card


def load_policy(policy: str | os.PathLike[str]) -> tuple[AnyActor, PolicyCard]:
    """A policy and its card, checked before anything is flown; nothing in the files is ever executed.

    The card's sha256 finds files that were cut short, damaged or mixed up. It is no signature: who changes the weights
    can change the card.

    Args:
        policy: the name of a shipped policy, a run's folder, or NAME.safetensors with NAME.json beside it.

    Raises:
        ValueError: for an unknown name, or files that are not what they say.
        OSError: for a file that is missing or cannot be read.
    """
    path = find_policy(policy)
    card_path = path.with_suffix(".json")
    card = _read_card(card_path)
    content = _read(path)
    digest = hashlib.sha256(content).hexdigest()
    if digest != card.sha256:
        raise ValueError(
            f"{path} is not the file that {card_path.name} describes: its sha256 is {digest[:12]}..., the card's "
            f"{card.sha256[:12] or 'empty'}...; allowed: the pair as it was saved, unchanged"
        )
    kind = RecurrentActor if card.memory else Actor
    try:
        actor = kind.from_tensors(load_tensors(content), activation=card.activation, squash=card.squash)
    except SafetensorError as problem:
        raise ValueError(f"{path} holds no safetensors: {problem}; allowed: what `save_policy` wrote") from None
    except (TypeError, ValueError, KeyError) as problem:  # KeyError: a dtype that NumPy does not have
        raise ValueError(f"{path}: {problem}") from None
    try:
        card.require_actor(actor)
    except ValueError as problem:
        raise ValueError(f"{card_path}: {problem}") from None
    return actor, card


def find_policy(policy: str | os.PathLike[str]) -> Path:
    """The file of weights that a name, a folder or a path means; a shipped name comes first.

    Raises:
        ValueError: for an unknown name or another kind of file.
        OSError: for a path that does not exist, or a folder without a policy.
    """
    name, shipped = os.fspath(policy), shipped_policies()
    if name in shipped:
        return shipped[name]
    path = Path(name)
    if path.is_dir():
        inside = path / POLICY_TENSORS
        if not inside.is_file():
            mend = f"; its run goes on with --resume {path}" if (path / CHECKPOINT).is_dir() else ""
            choice = "the folder of a run that saved one"
            raise FileNotFoundError(f"{path} holds no {POLICY_TENSORS}; allowed: {choice}{mend}")
        return inside
    if path.exists():
        _require_ending(path)
        return path
    choice = allowed(name, [*shipped, "a run's folder", "NAME.safetensors"])
    if path.suffix or path.name != name:
        raise FileNotFoundError(f"{path} does not exist; {choice}")
    raise ValueError(f"policy = {name!r} is unknown; {choice}")


def _require_ending(path: Path) -> None:
    """Refuse files of another kind by their ending."""
    if path.suffix != ".safetensors":
        note = "; a .zip of Stable-Baselines3 holds pickles, which can run anything" if path.suffix == ".zip" else ""
        raise ValueError(f"{path} does not end in .safetensors{note}; allowed: NAME.safetensors")


def _read_card(path: Path) -> PolicyCard:
    """The card in a file."""
    if not path.is_file():
        raise FileNotFoundError(f"{path} does not exist; allowed: a card beside every file of weights")
    content = read_object(path, mend="a card as `save_policy` wrote it", largest=LARGEST)
    try:
        return PolicyCard.from_dict(content)
    except (TypeError, ValueError) as problem:
        raise ValueError(f"{path}: {problem}") from None


def _read(path: Path) -> bytes:
    """A file's bytes, if they are not too many."""
    size = path.stat().st_size
    if size > LARGEST:
        raise ValueError(f"{path} has {size:,} bytes; allowed: up to {LARGEST:,}")
    return path.read_bytes()
