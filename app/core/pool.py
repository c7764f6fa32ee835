"""The threads that share the work inside one job."""

from __future__ import annotations

import os
import threading
from collections.abc import Callable
from concurrent.futures import Future, ThreadPoolExecutor
from contextvars import copy_context
from functools import cache
from itertools import pairwise
from typing import Any, TypeVar

Result = TypeVar("Result")


class _Pool(ThreadPoolExecutor):
    """Threads that work in the context of whoever gives them work: within its budget of memory."""

    def submit(self, fn: Callable[..., Result], /, *args: Any, **kwargs: Any) -> Future[Result]:
        """Have a piece of work done."""
        context = copy_context()
        return super().submit(lambda: context.run(fn, *args, **kwargs))


_THREADS = "hitofude"
"""How the names of the executor's threads begin."""

_BANDS = 4
"""Bands that many things are shared out in: more than cores, as one may take longer than the others."""

WORTH_TWO_CORES = 4_000
"""Things from which on a second core is worth its start."""


@cache
def pool() -> ThreadPoolExecutor:
    """Return the one executor for pieces of a computation that release the GIL (compiled kernels, cv2, shapely).

    It has one thread a core, at least two. A piece must not wait for another piece of the same executor, or all threads
    may wait for ever; only jobs submit to it, and jobs do not run in it.
    """
    return _Pool(max(2, os.cpu_count() or 2), thread_name_prefix=_THREADS)


def in_bands(work: Callable[[slice], Result], count: int, worth: int = WORTH_TWO_CORES) -> list[Result]:
    """Have so many things worked on in bands, on all cores; return what became of each band, in their order.

    A piece of the executor itself does the bands alone, so that it waits for no other piece.

    Args:
        work: does the things of a slice; it releases the GIL, or nothing is won.
        worth: how many of them are worth a second core.
    """
    if count < max(worth, _BANDS) or threading.current_thread().name.startswith(_THREADS):
        return [work(slice(0, count))]
    edges = (count * k // _BANDS for k in range(_BANDS + 1))
    return list(pool().map(work, (slice(*ends) for ends in pairwise(edges))))
