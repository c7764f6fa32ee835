# mypy: allow-untyped-defs
"""Equal rows of words get one number: a table of open addresses, one look a row."""

from __future__ import annotations

import numpy as np

from ...core.jit import kernel

_FIRST, _SECOND = np.uint64(0x9E3779B97F4A7C15), np.uint64(0xC2B2AE3D27D4EB4F)
"""Odd numbers that spread the bits of a word over all of it."""

_SHIFT = np.uint64(32)
"""Bits: half a word, so that a hash of its upper half reaches the lower one that picks the slot."""


@kernel("int64(uint64[:, ::1], int32[::1], int64[::1])")
def number_rows(rows, table, out):
    """Write the number of each row (n, m): equal ones have the same, new ones the next; return how many numbers there
    are.

    Args:
        table: -1 all over; a power of two long, and longer than there are rows.
    """
    count, last = 0, np.uint64(len(table) - 1)
    for k in range(len(rows)):
        word = _FIRST
        for column in range(rows.shape[1]):
            word = (word ^ rows[k, column]) * _SECOND
            word ^= word >> _SHIFT
        # open addressing: the table is longer than there are rows, so that an empty slot ends every search
        slot = np.int64((word * _FIRST) >> _SHIFT & last)
        while True:
            other = table[slot]
            if other < 0:
                table[slot] = k
                out[k] = count
                count += 1
                break
            same = True
            for column in range(rows.shape[1]):
                if rows[other, column] != rows[k, column]:
                    same = False
                    break
            if same:
                out[k] = out[other]
                break
            slot = (slot + 1) & np.int64(last)
    return count
