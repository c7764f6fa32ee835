# mypy: allow-untyped-defs
"""Compiled inner loops on many paths at once: how far along each of them something is."""

from ...core.jit import kernel
from ...geometry.kernels import INF, nearest_from, place_on

_TREE = "float64[:, ::1], int64[::1], float64[:, ::1]"
_ROUNDING = 1e-9
"""mm; more than a distance is off by."""


@kernel("void(float64[::1], int64[::1], float64[::1])")
def running_sums(values, first, out):
    """Write the running sum (n,) of values within each run, from first[k] up to first[k + 1]."""
    for k in range(len(first) - 1):
        total = 0.0
        for i in range(first[k], first[k + 1]):
            total += values[i]
            out[i] = total


@kernel("void(float64[::1], int64[::1], int64[::1], float64[::1], boolean, int64[::1])")
def counts_below(values, first, run, asked, equal, out):
    """Write for each number (m,) that is asked for how many values of a run, in rising order, are less than it, or
    equal.

    Args:
        run: (m,) number of the run, from first[run] up to first[run + 1], of each that is asked for.
        equal: whether equal ones count.
    """
    for i in range(len(asked)):
        low, high = first[run[i]], first[run[i] + 1]
        begin = low
        while low < high:
            middle = (low + high) // 2
            if values[middle] < asked[i] or (equal and values[middle] == asked[i]):
                low = middle + 1
            else:
                high = middle
        out[i] = low - begin


@kernel(f"void({_TREE}, float64[:, ::1], float64[::1], float64[::1], float64, float64, boolean[::1])")
def keep_clear(walls, order, nodes, rows, sizes, need, step, miss, good):
    """Write for each row (n, 8) whether all of it is at least `need` (n,) mm from all walls.

    Walls that are farther than what is needed and the rest of the row together are not looked for.

    Args:
        sizes: (n,) length of each row, mm.
        step: shortest step, mm. miss: by which a distance may fall short, mm.
    """
    near = -1
    for k in range(len(rows)):
        at, known, good[k] = 0.0, INF, True
        while True:
            x, y = place_on(rows, k, min(at / max(sizes[k], 1e-300), 1.0))
            # farther walls need not be known: even straight at them the rest of the row comes no nearer than needed
            limit = min(max(need[k], 0.0) + sizes[k] - at, known) + _ROUNDING
            distance, row = nearest_from(walls, order, nodes, x, y, -1.0, limit, near)
            near = row if row >= 0 else near
            spare = distance - need[k]
            if spare < -miss:
                good[k] = False
                break
            if at >= sizes[k]:
                break
            way = min(max(spare, step), sizes[k] - at)
            at = at + way if way < sizes[k] - at else sizes[k]
            # the wall that was found is at most this far at the next place
            known = distance + way if row >= 0 else INF
