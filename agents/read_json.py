"""Files of JSON that others may have changed: what is wrong is an error that names the file."""

import json
from pathlib import Path
from typing import Any


def read_object(path: Path) -> dict[str, Any]:
    """The object in a file.

    Raises:
        ValueError: for what is not text, not JSON (which knows no NaN) or no object.
        OSError: if the file cannot be read.
    """
    try:
        content = json.loads(path.read_text(encoding="utf-8"), parse_constant=_refuse_constant)
    except RecursionError:
        raise ValueError(f"{path} is nested too deep; allowed: a file as it was written") from None
    except ValueError as mistake:
        raise ValueError(f"{path} is not JSON: {mistake}; allowed: a file as it was written") from None
    if not isinstance(content, dict):
        raise ValueError(f"{path} holds no object but {type(content).__name__}; allowed: a file as it was written")
    return content


def _refuse_constant(name: str) -> Any:
    """NaN and infinity are not JSON, but Python reads them."""
    raise ValueError(f"{name} is not a number")
