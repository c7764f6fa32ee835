# mypy: allow-untyped-defs
"""Compiled: symmetric positive systems with their entries in a band about the diagonal, as splines and joints have."""

from __future__ import annotations

import math

from ..core.jit import kernel


@kernel("boolean(float64[:, ::1])", counts=False)
def factor(band):
    """Factor a symmetric positive matrix in place; return whether it is one.

    Args:
        band: (k, p + 1) its lower band: row i has the entries i, i - 1, ..., i - p of the matrix's row.
    """
    count, p = len(band), band.shape[1] - 1
    # Cholesky: band = L L^T. L has no entries outside the band either, so the cost is count times its width squared.
    for i in range(count):
        for off in range(min(p, i), -1, -1):
            j = i - off
            total = band[i, off]
            for m in range(max(0, i - p), j):
                total -= band[i, i - m] * band[j, j - m]
            if off > 0:
                band[i, off] = total / band[j, 0]
            elif not total > 0.0:
                return False
            else:
                band[i, 0] = math.sqrt(total)
    return True
