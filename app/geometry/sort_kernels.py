"""Sorting, for kernels: numba makes machine code for each kernel that sorts, a second or two of compiling; so one of
them does it for all.
"""

from __future__ import annotations

import numpy as np

from ..core.jit import kernel


@kernel("void(int64[::1])")
def sort_integers(values):
    """Sort in place."""
    # as numba does: equal integers cannot be told apart, so that no order among them is lost
    values.sort()


@kernel("void(float64[::1])")
def sort_numbers(values):
    """Sort in place."""
    values.sort()


@kernel("int64[::1](float64[::1])")
def order_of(values):
    """Return the order (n,) that sorts numbers; equal ones in any."""
    return np.argsort(values)
