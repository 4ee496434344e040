"""What may come of a call with input from outside: finite numbers, or an error of the project's own in one line."""

import contextlib
import dataclasses
import math
import traceback
import warnings
from collections.abc import Callable, Iterator, Mapping
from pathlib import Path
from typing import Any

import numpy as np
from gymnasium.error import ResetNeeded

from flapenv.aero.checks import LONGEST_LINE

ROOT = Path(__file__).parents[2]
OURS = tuple(str(ROOT / folder) for folder in ("flapenv", "agents"))
LONGEST = 3 * LONGEST_LINE
"""Letters of an error: a path, a place in the file and what is wrong there, each cut at `LONGEST_LINE`."""
SAYS_WHAT_IS_ALLOWED = ("allowed", "its fields are", "its keys are", "reload the page", "needs wing masses")
"""One of these is in every error."""


class FindingError(AssertionError):
    """An input that breaks the rule, which is a mistake of ours."""


def refused(mistake: BaseException) -> str | None:
    """Why an exception is not the project's own error; None where it is."""
    if isinstance(mistake, ResetNeeded):
        return None
    kind = type(mistake)
    if kind not in (ValueError, TypeError, ArithmeticError) and not (
        isinstance(mistake, OSError) and kind.__module__ == "builtins"
    ):
        return f"a {kind.__name__}"
    if not traceback.extract_tb(mistake.__traceback__)[-1].filename.startswith(OURS):
        return f"a {kind.__name__} of another library"
    text = str(mistake)
    if not text.isprintable():
        return "an error of more than one line"
    if len(text) > LONGEST:
        return f"an error of {len(text):,} letters"
    if not any(words in text for words in SAYS_WHAT_IS_ALLOWED):
        return "an error that does not say what is allowed"
    return None


def require_finite(value: Any, where: str = "value") -> None:
    """Refuse NaN and inf anywhere in what came back.

    Raises:
        FindingError: naming the place.
    """
    if isinstance(value, Mapping):
        for key, one in value.items():
            require_finite(one, f"{where}[{key!r}]")
    elif isinstance(value, np.ndarray) and value.dtype.kind in "fc":
        if not np.isfinite(value).all():
            raise FindingError(f"{where} = {value!r} is not finite")
    elif isinstance(value, list | tuple | np.ndarray):
        for number, one in enumerate(value):
            require_finite(one, f"{where}[{number}]")
    elif dataclasses.is_dataclass(value) and not isinstance(value, type):
        require_finite(vars(value), type(value).__name__)
    elif isinstance(value, float | np.floating) and not math.isfinite(value):
        raise FindingError(f"{where} = {value!r} is not finite")


@contextlib.contextmanager
def strict_warnings() -> Iterator[None]:
    """Every warning is an error but our own, which tell of a wing what one should know."""
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        warnings.simplefilter("ignore", UserWarning)
        yield


def judge(target: Callable[[bytes], Any], data: bytes) -> str:
    """Run a target: "accepted" or "refused".

    Raises:
        FindingError: where the input broke the rule, from what it raised.
    """
    try:
        with strict_warnings():
            value = target(data)
    except FindingError:
        raise
    except Exception as mistake:
        why = refused(mistake)
        if why is not None:
            raise FindingError(f"{why}: {type(mistake).__name__}: {str(mistake)[:500]!r}") from mistake
        return "refused"
    require_finite(value)
    return "accepted"
