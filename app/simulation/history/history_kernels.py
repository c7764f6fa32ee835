# mypy: allow-untyped-defs
"""Squares of a field: which have changed, kept copies of them, and a whole field put together from such copies."""

from __future__ import annotations

from ...core.jit import kernel

_FIELD = "float32[:, ::1], int32[:, ::1]"
_KEPT = "float32[:, :, ::1], int32[:, :, ::1]"


@kernel("boolean(float32[::1], float32[::1], int32[::1], int32[::1])", counts=False)
def _differ(heights, old_heights, owner, old_owner):
    """Return whether a run of cells differs from an older one."""
    found = 0
    for j in range(len(heights)):
        # no early end: without a branch the compiler compares many cells at once
        found += (1 if heights[j] != old_heights[j] else 0) + (1 if owner[j] != old_owner[j] else 0)
    return found > 0


@kernel("void(float32[::1], float32[::1], int32[::1], int32[::1])", counts=False)
def _copy(heights, to_heights, owner, to_owner):
    """Copy a run of cells."""
    for j in range(len(heights)):
        to_heights[j], to_owner[j] = heights[j], owner[j]


@kernel(f"int64({_FIELD}, {_FIELD}, UniTuple(int64, 4), int64, int32[::1])", counts=False)
def changed(heights, owner, old_heights, old_owner, box, side, squares):
    """Write which squares of a field differ from an older one, and make the older one alike; return how many.

    Args:
        heights, owner: the field. old_heights, old_owner: the older one; rewritten where it differs.
        box: first row and column, and the ends of rows and columns, outside which nothing differs; its first ones begin
            squares.
        side: of a square, cells. squares: row-wise numbers of those that differ; long enough for all.
    """
    rows, cols = heights.shape
    across, found = (cols + side - 1) // side, 0
    for r in range(box[0], box[2], side):
        for c in range(box[1], box[3], side):
            last_row, last, i, same = min(r + side, rows), min(c + side, cols), r, True
            while same and i < last_row:
                same = not _differ(heights[i, c:last], old_heights[i, c:last], owner[i, c:last], old_owner[i, c:last])
                i += 1
            if not same:
                for k in range(r, last_row):
                    _copy(heights[k, c:last], old_heights[k, c:last], owner[k, c:last], old_owner[k, c:last])
                squares[found] = (r // side) * across + c // side
                found += 1
    return found


@kernel(f"void({_FIELD}, int32[::1], {_KEPT}, int64)", counts=False)
def keep(heights, owner, squares, kept_heights, kept_owner, first):
    """Copy squares of a field into the slots first, first + 1, … of what is kept."""
    rows, cols = heights.shape
    side = kept_heights.shape[1]
    across = (cols + side - 1) // side
    for k in range(len(squares)):
        r, c = squares[k] // across * side, squares[k] % across * side
        last = min(c + side, cols)
        for i in range(min(side, rows - r)):
            _copy(heights[r + i, c:last], kept_heights[first + k, i], owner[r + i, c:last], kept_owner[first + k, i])


@kernel(f"void(int64, int32[::1], int32[::1], int64[::1], {_KEPT}, {_FIELD}, {_FIELD})", counts=False)
def restore(block, blocks, slots, bounds, kept_heights, kept_owner, base_heights, base_owner, heights, owner):
    """Put the field together that there was when a block had been done.

    Args:
        block: its number; -1: before all.
        blocks, slots: for each kept copy, by square and then by block, behind which block it was taken, and where it
            lies.
        bounds: (squares + 1,) where each square's copies begin.
        kept_heights, kept_owner: the copies. base_heights, base_owner: the field before all blocks.
        heights, owner: overwritten.
    """
    rows, cols = heights.shape
    side = kept_heights.shape[1]
    across = (cols + side - 1) // side
    for square in range(len(bounds) - 1):
        low, high = bounds[square], bounds[square + 1]
        while low < high:
            # the last copy that was taken behind a block up to this one holds what the square was then
            middle = (low + high) // 2
            if blocks[middle] <= block:
                low = middle + 1
            else:
                high = middle
        r, c = square // across * side, square % across * side
        slot = slots[low - 1] if low > bounds[square] else -1
        last = min(c + side, cols)
        for i in range(min(side, rows - r)):
            if slot >= 0:
                wide = last - c
                _copy(
                    kept_heights[slot, i, :wide],
                    heights[r + i, c:last],
                    kept_owner[slot, i, :wide],
                    owner[r + i, c:last],
                )
            else:
                _copy(
                    base_heights[r + i, c:last], heights[r + i, c:last], base_owner[r + i, c:last], owner[r + i, c:last]
                )


@kernel(f"void(int64[::1], {_KEPT})", counts=False)
def close_ranks(slots, kept_heights, kept_owner):
    """Move the copies in some slots, which rise, to the first ones."""
    for k in range(len(slots)):
        # slots rise, so that none is written over before it has been moved
        old = slots[k]
        if old != k:
            for i in range(kept_heights.shape[1]):
                _copy(kept_heights[old, i], kept_heights[k, i], kept_owner[old, i], kept_owner[k, i])
