"""The threads that share the work inside one job."""

from __future__ import annotations

import os
from collections.abc import Callable
from concurrent.futures import Future, ThreadPoolExecutor
from contextvars import copy_context
from functools import cache
from typing import Any, TypeVar

Result = TypeVar("Result")


class _Pool(ThreadPoolExecutor):
    """Threads that work in the context of whoever gives them work: within its budget of memory."""

    def submit(self, fn: Callable[..., Result], /, *args: Any, **kwargs: Any) -> Future[Result]:
        """Have a piece of work done."""
        context = copy_context()
        return super().submit(lambda: context.run(fn, *args, **kwargs))


@cache
def pool() -> ThreadPoolExecutor:
    """Return the one executor for pieces of a computation that release the GIL (compiled kernels, cv2, shapely).

    It has one thread a core, at least two. A piece must not wait for another piece of the same executor, or all threads
    may wait for ever; only jobs submit to it, and jobs do not run in it.
    """
    return _Pool(max(2, os.cpu_count() or 2), thread_name_prefix="hitofude")
