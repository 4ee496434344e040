"""Whether this machine's part of Ray still lives: Tune itself would wait for ever for a node that comes back."""

import threading
import time
from collections.abc import Callable, Sequence
from types import ModuleType
from typing import Any

GLANCE = 2.0
"""Seconds between two looks."""
SILENCE = 60.0
"""Seconds without an answer after which the cluster counts as lost."""


def dead_node(nodes: Sequence[dict[str, Any]], own: str) -> str | None:
    """Why nothing can be started any more; None while all is well.

    Args:
        nodes: as `ray.nodes` tells them.
        own: NodeID of the node that this process is connected to.
    """
    if any(node["NodeID"] == own and node["Alive"] for node in nodes):
        return None
    return f"the node of this process ({own[:8]}) is dead"


class Watch:
    """Looks in a thread of its own, as a lost cluster may never answer."""

    def __init__(self, look: Callable[[], str | None]) -> None:
        """Begin to look.

        Args:
            look: tells what is wrong, or None; may raise or never return.
        """
        self._look, self._answered = look, time.monotonic()
        self._wrong: str | None = None
        self._over = threading.Event()
        threading.Thread(target=self._go, daemon=True).start()

    def __getstate__(self) -> dict[str, Any]:
        """Nothing: Tune writes its callbacks to disk, and nobody reads them."""
        return {}

    @property
    def wrong(self) -> str | None:
        """What is wrong with the cluster; None while it lives."""
        silent = time.monotonic() - self._answered
        if self._wrong is None and silent > SILENCE:
            return f"the cluster has not answered for {silent:.0f} s"
        return self._wrong

    def end(self) -> None:
        """Look no more."""
        self._over.set()

    def _go(self) -> None:
        """Look until something is wrong."""
        while self._wrong is None and not self._over.wait(GLANCE):
            try:
                self._wrong = self._look()
            except Exception:  # it may answer the next time
                continue
            self._answered = time.monotonic()


def watched(ray: ModuleType) -> Watch:
    """The cluster that this process is connected to."""
    own = str(ray.get_runtime_context().get_node_id())
    return Watch(lambda: dead_node(ray.nodes(), own))
