"""What the tests of all tasks judge."""

from collections.abc import Callable
from typing import Any

import numpy as np
import pytest


class Constant:
    """The same action whatever is seen, or one for each row."""

    def __init__(self, action: Any) -> None:
        self.action = np.asarray(action, dtype=np.float32)

    def predict(self, observation: np.ndarray, *, deterministic: bool) -> tuple[np.ndarray, Any]:
        assert deterministic
        return np.broadcast_to(self.action, (len(observation), self.action.shape[-1])), None


@pytest.fixture
def constant() -> Callable[[Any], Constant]:
    return Constant
