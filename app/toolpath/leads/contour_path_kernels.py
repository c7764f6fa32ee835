"""Compiled inner loops on many paths at once: how far along each of them something is."""

from ...core.jit import kernel


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
