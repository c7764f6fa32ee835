# mypy: allow-untyped-defs
"""Compiled loops along the rows of a bitmap, many columns at once."""

from __future__ import annotations

import numpy as np

from ..core.jit import kernel

AT_ONCE = 128
"""Columns that are compared together."""


@kernel("int64(uint16[::1], int64, int64)", counts=False)
def end_of_run(row, c, here):
    """Return the first column from c on in which a row is not `here`."""
    while c + AT_ONCE <= len(row):
        block, other = row[c : c + AT_ONCE], np.uint16(0)
        for k in range(AT_ONCE):
            # no early end within a block: without a branch its columns are compared together
            other |= block[k] ^ np.uint16(here)
        if other != 0:
            break
        c += AT_ONCE
    while c < len(row) and row[c] == here:
        c += 1
    return c


@kernel("int64(uint16[::1], int64)", counts=False)
def first_zero(row, c):
    """Return the first column from c on in which a row is 0."""
    while c + AT_ONCE <= len(row):
        block, zero = row[c : c + AT_ONCE], np.uint16(0)
        for k in range(AT_ONCE):
            zero |= np.uint16(block[k] == 0)
        if zero != 0:
            break
        c += AT_ONCE
    while c < len(row) and row[c] != 0:
        c += 1
    return c


@kernel("void(uint8[:, ::1], uint8[:, ::1], int64, int64)", counts=False)
def inner(area, found, first, stop):
    """Write which pixels of an area have all four neighbours in it, in rows first ... stop - 1.

    Args:
        area: (r, c) 0 and 1; beyond the picture is outside.
        found: (r, c) gets 0 and 1.
    """
    rows, cols = area.shape
    for r in range(first, stop):
        row, line = area[r], found[r]
        line[0] = line[cols - 1] = 0
        if r == 0 or r == rows - 1:
            line[:] = 0
            continue
        # shifted views of whole rows: one loop without a branch, which the compiler does many pixels at a time
        above, below, left, right = area[r - 1], area[r + 1], row[: cols - 2], row[2:]
        for c in range(cols - 2):
            line[c + 1] = row[c + 1] & above[c + 1] & below[c + 1] & left[c] & right[c]
