"""How much slower processor time passes than on cores of one's own: others share caches and units with whoever is
measured, which no clock of the processor tells.
"""

from __future__ import annotations

import time

FIXED_WORK_MS = 6.2
"""What the fixed work takes where nothing else runs, on the cores that the limits of tests were measured on."""


MOST = 3.0
"""Slower than so much nobody is for sharing a core: one slow moment is to excuse nothing."""


def slowed() -> float:
    """Return how many times longer than alone a piece of work takes now, 1 to `MOST`."""
    begun, total = time.thread_time(), 0
    for k in range(100_000):
        total += k * k
    return min(max(1.0, 1000 * (time.thread_time() - begun) / FIXED_WORK_MS), MOST)
