"""The threads that share the work inside one job."""

from __future__ import annotations

import os
from concurrent.futures import ThreadPoolExecutor
from functools import cache


@cache
def pool() -> ThreadPoolExecutor:
    """Return the one executor for pieces of a computation that release the GIL (compiled kernels, cv2, shapely).

    It has one thread a core, at least two. A piece must not wait for another piece of the same executor, or all threads
    may wait for ever; only jobs submit to it, and jobs do not run in it.
    """
    return ThreadPoolExecutor(max(2, os.cpu_count() or 2), thread_name_prefix="hitofude")
