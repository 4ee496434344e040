"""How large the settings of a learner may be: a slip of the keyboard is an error, not a machine without memory."""

from typing import Any

from flapenv.aero.checks import require_count

LARGEST = {
    "wingbeats": 10**12,
    "rows": 2**20,
    "steps": 2**16,
    "minibatch": 2**22,
    "batch": 2**20,
    "buffer": 2**26,
    "epochs": 1_000,
    "gradient_steps": 10_000,
    "width": 4_096,
    "critic_width": 4_096,
    "memory": 4_096,
    "layers": 16,
    "critics": 16,
    "threads": 256,
}
LARGEST_ROLLOUT = 2**24
"""Wingbeats between two updates, rows times steps."""


def require_counts(settings: Any, *names: str) -> None:
    """Refuse settings that are no whole numbers from 1 to `LARGEST`.

    Args:
        settings: a record.
        *names: of its fields.

    Raises:
        TypeError: for what is not a whole number.
        ValueError: for a number out of range.
    """
    for name in names:
        require_count(name, getattr(settings, name), high=LARGEST[name])


def require_an_update(wingbeats: int, update: int, what: str) -> None:
    """Refuse a budget of less than one update.

    Args:
        wingbeats: the budget.
        update: wingbeats of an update.
        what: these are, in words: "rows x steps".

    Raises:
        ValueError: naming the budget and what is allowed.
    """
    if wingbeats < update:
        raise ValueError(f"wingbeats = {wingbeats} is not allowed; allowed: at least one update, {what} = {update}")
    if update > LARGEST_ROLLOUT:
        raise ValueError(f"{what} = {update} is not allowed; allowed: at most {LARGEST_ROLLOUT}")
