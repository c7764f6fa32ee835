# mypy: allow-untyped-defs
"""Sorting, for kernels: numba makes machine code for each kernel that sorts, a second or two of compiling; so few of
them do it for all.
"""

from __future__ import annotations

import numpy as np

from ..core.jit import kernel

_SHORT = 16
"""So few are put in order by moving each to its place."""

_ALL_BUT_SIGN = 0x7FFF_FFFF_FFFF_FFFF
"""Bits of a double that are turned over where it is negative, so that its bits sort as integers do."""
_NO_NUMBER = 0x7FF8_0000_0000_0000
"""Bits of a float that is no number, behind those of all numbers."""


@kernel("void(int64[::1])")
def sort_integers(values):
    """Sort in place, from short runs by merging; numba's own way is no quicker and takes longer to compile."""
    count = len(values)
    # short runs need no room beside them, and most of what is sorted is no longer
    for low in range(0, count, _SHORT):
        for k in range(low + 1, min(low + _SHORT, count)):
            value, at = values[k], k
            while at > low and values[at - 1] > value:
                values[at] = values[at - 1]
                at -= 1
            values[at] = value
    width, left = _SHORT, np.empty(count if count > _SHORT else 0, np.int64)
    while width < count:
        for low in range(0, count - width, 2 * width):
            _merge(values, left, low, low + width, min(low + 2 * width, count))
        width *= 2


@kernel("void(int64[::1], int64[::1], int64, int64, int64)", counts=False)
def _merge(values, left, low, middle, high):
    """Merge two runs that are sorted and lie side by side; `left` is room for the first one."""
    # what is nearly in order already, as rows along a path are, costs a look a run
    if values[middle - 1] <= values[middle]:
        return
    for k in range(middle - low):
        left[k] = values[low + k]
    i, j, k = 0, middle, low
    while i < middle - low and j < high:  # no branch in it: it would be foretold wrongly every other time
        one, other = left[i], values[j]
        later = other < one
        values[k] = other if later else one
        i, j, k = i + (not later), j + later, k + 1
    # what is left over of the second run is in its place; only the first one's rest has to go back
    while i < middle - low:
        values[k] = left[i]
        i, k = i + 1, k + 1


@kernel("void(float64[::1])")
def sort_numbers(values):
    """Sort in place; what is no number comes last.

    The bits of floats are integers of the same order, but for the negative ones, whose order is turned.
    """
    bits = values.view(np.int64)
    # the same change takes them back: it leaves the sign, which tells whether there was one
    for k in range(len(bits)):
        bits[k] = _NO_NUMBER if values[k] != values[k] else bits[k] ^ (bits[k] >> 63 & _ALL_BUT_SIGN)
    sort_integers(bits)
    for k in range(len(bits)):
        bits[k] ^= bits[k] >> 63 & _ALL_BUT_SIGN


@kernel("int64[::1](float64[::1])")
def order_of(values):
    """Return the order (n,) that sorts numbers; equal ones in any."""
    return np.argsort(values)
