"""Whether this processor has the instructions that the libraries were built with: without them the process would end
at the first of these, and say nothing.

NumPy is built for the level x86-64-v2 of the psABI of System V. What the processor has is asked of the C library, which
asked it when the process began.
"""

from __future__ import annotations

import platform
import sys
from collections.abc import Callable

NEEDED = {"SSE3": 0, "SSSE3": 9, "CX16": 13, "SSE4.1": 19, "SSE4.2": 20, "POPCNT": 23}
"""Of x86-64-v2 beyond every x86-64 processor: bits of ECX in CPUID's leaf 1."""

_LEAF_1, _ECX = 0, 2
"""Of the C library: its number for that leaf, and the place in it."""


def lacking(ecx: int) -> tuple[str, ...]:
    """Return what a processor lacks of x86-64-v2.

    Args:
        ecx: of CPUID's leaf 1.
    """
    return tuple(name for name, bit in NEEDED.items() if not ecx >> bit & 1)


def lacking_here(read: Callable[[], int | None] | None = None) -> tuple[str, ...]:
    """Return what this processor lacks; nothing where nobody knows.

    Args:
        read: returns ECX of CPUID's leaf 1, None = not known; None = asks the C library.
    """
    ecx = (read or _ecx)()
    return () if ecx is None else lacking(ecx)


def _ecx() -> int | None:
    """Return ECX of CPUID's leaf 1 as the C library of Linux has it from version 2.33 on; None = it cannot tell."""
    if not sys.platform.startswith("linux") or platform.machine() != "x86_64":
        return None
    import ctypes

    try:
        ask = getattr(ctypes.CDLL(None), "__x86_get_cpuid_feature_leaf")
    except (AttributeError, OSError):
        return None
    ask.argtypes, ask.restype = (ctypes.c_uint,), ctypes.POINTER(ctypes.c_uint)
    leaf = ask(_LEAF_1)
    return int(leaf[_ECX]) if leaf else None
