"""Ctrl-C that cannot lose what was learned."""

import contextlib
import signal
import threading
from collections.abc import Iterator
from types import FrameType


class Interrupts:
    """Ctrl-C as it was noted: the first asks for an end, the second hurries, all others do nothing.

    Attributes:
        asked: whether there was one.
        hurrying: whether the second raises KeyboardInterrupt, as it should where the first is not heeded at once.
    """

    def __init__(self) -> None:
        """None so far."""
        self.asked, self.hurrying = False, True
        self._hurried = False

    def note(self, _number: int, _frame: FrameType | None) -> None:
        """Take note of one.

        Raises:
            KeyboardInterrupt: for the second, while `hurrying`.
        """
        if self.asked and self.hurrying and not self._hurried:
            self._hurried = True
            raise KeyboardInterrupt
        self.asked = True


@contextlib.contextmanager
def noted_interrupts() -> Iterator[Interrupts]:
    """Take note of Ctrl-C, rather than to be stopped by it wherever that may be.

    Outside of the main thread nothing changes, as signals do not reach it.
    """
    interrupts = Interrupts()
    if threading.current_thread() is not threading.main_thread():
        yield interrupts
        return
    before = signal.signal(signal.SIGINT, interrupts.note)
    try:
        yield interrupts
    finally:
        signal.signal(signal.SIGINT, before)
