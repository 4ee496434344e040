"""Threads that fail to write without a word, where the thread that waits for them fails, too, and says so."""

import contextlib
import threading
from collections.abc import Iterator


@contextlib.contextmanager
def silent_threads() -> Iterator[None]:
    """Threads that end with an OSError print nothing meanwhile; TensorBoard's writer raises it again where it is fed.

    Everything else that ends a thread is told as ever.
    """
    before = threading.excepthook

    def tell(ended: threading.ExceptHookArgs) -> None:
        if not issubclass(ended.exc_type, OSError):
            before(ended)

    threading.excepthook = tell
    try:
        yield
    finally:
        threading.excepthook = before
