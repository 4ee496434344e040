"""Work on several threads: NumPy lets other threads run while it computes on large arrays."""

import functools
import os
from collections.abc import Callable, Sequence
from concurrent.futures import ThreadPoolExecutor


@functools.lru_cache(maxsize=4)
def _pool(threads: int) -> ThreadPoolExecutor:
    """A pool that is kept; its threads start when first needed."""
    return ThreadPoolExecutor(threads, thread_name_prefix="flapenv")


if hasattr(os, "register_at_fork"):  # a forked process inherits the pool but not its threads
    os.register_at_fork(after_in_child=_pool.cache_clear)


def in_threads(work: Callable[[slice], None], parts: Sequence[slice], threads: int) -> None:
    """Do some work on every part, `threads` of them at a time.

    Raises:
        BaseException: the first that any part raised.
    """
    if threads == 1 or len(parts) == 1:
        for part in parts:
            work(part)
        return
    for _ in _pool(threads).map(work, parts):
        pass
