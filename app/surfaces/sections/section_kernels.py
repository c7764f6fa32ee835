# mypy: allow-untyped-defs
"""Compiled: where upright planes cut facets and what they stand for, as short pieces whose ends lie exactly on both."""

from __future__ import annotations

import numpy as np

from ...core.jit import kernel
from ..patches.patch_kernels import copy_row, place, quarter

_R, _MANY, _NETS, _INTS = "float64[::1]", "float64[:, ::1]", "float64[:, :, :, ::1]", "int64[::1]"
S0, Z0, U0, V0, S1, Z1, U1, V1, ERROR = range(9)
"""Columns of pieces: along the plane, height and parameters on the patch of both ends, and how far off the chord the
curve is.
"""
COLUMNS = 9
_ROOM = 96
"""Quarters that wait, at most, and rows to work in: one for what is quartered, four for what comes of it."""
_QUARTERED, _QUARTERS = _ROOM - 5, _ROOM - 4
"""Rows of `work`: what is being quartered, and the four quarters."""
_U, _V, _OFF, _COLUMNS = 9, 10, 15, 17
"""Columns of `work` behind a facet's corners (9): parameters of the first corner, two a corner; how far the facet is
off what it stands for, mm.
"""
_SAME = 1e-12
"""mm; a corner that is no farther from the plane lies on it."""
_TIMES = 60
"""Places at most that are asked for one crossing."""


@kernel(f"float64({_R}, float64, float64)", counts=False)
def _off(plane, x, y):
    """Return how far a place is to the left of a plane, given by a place of it (2) and its direction (2)."""
    return (y - plane[1]) * plane[2] - (x - plane[0]) * plane[3]


@kernel(f"UniTuple(float64, 4)({_NETS}, int64, {_R}, {_MANY}, int64, int64, int64, float64, float64)", counts=False)
def _crossing(control, patch, plane, work, row, a, b, off_a, off_b):
    """Return where a plane crosses what edge a b of a facet stands for: along the plane, height, parameters."""
    if off_a == 0.0:
        b, off_b = a, 1.0
    share = off_a / (off_a - off_b) if a != b else 0.0
    if patch < 0 or a == b:
        x = work[row, 3 * a] + share * (work[row, 3 * b] - work[row, 3 * a])
        y = work[row, 3 * a + 1] + share * (work[row, 3 * b + 1] - work[row, 3 * a + 1])
        z = work[row, 3 * a + 2] + share * (work[row, 3 * b + 2] - work[row, 3 * a + 2])
        u = work[row, _U + 2 * a] + share * (work[row, _U + 2 * b] - work[row, _U + 2 * a])
        v = work[row, _V + 2 * a] + share * (work[row, _V + 2 * b] - work[row, _V + 2 * a])
        return (x - plane[0]) * plane[2] + (y - plane[1]) * plane[3], z, u, v
    # the same edge gives the same place, whichever facet asks
    if work[row, _U + 2 * a] > work[row, _U + 2 * b] or (
        work[row, _U + 2 * a] == work[row, _U + 2 * b] and work[row, _V + 2 * a] > work[row, _V + 2 * b]
    ):
        a, b, off_a, off_b = b, a, off_b, off_a
    ua, va = work[row, _U + 2 * a], work[row, _V + 2 * a]
    du, dv = work[row, _U + 2 * b] - ua, work[row, _V + 2 * b] - va
    low, high, at_low, at_high = 0.0, 1.0, off_a, off_b
    x, y, z, u, v = 0.0, 0.0, 0.0, ua, va
    for n in range(_TIMES):
        # twice the secant, then a half: what changes its sign stays between `low` and `high`
        share = low + (high - low) * at_low / (at_low - at_high) if n % 3 < 2 else 0.5 * (low + high)
        u, v = ua + share * du, va + share * dv
        x, y, z = place(control, patch, u, v)
        off = _off(plane, x, y)
        if (off > 0.0) == (at_low > 0.0):
            low, at_low = share, off
        else:
            high, at_high = share, off
        if abs(off) <= 1e-14 * (1.0 + abs(x) + abs(y)) or high - low <= 1e-15:
            break
    return (x - plane[0]) * plane[2] + (y - plane[1]) * plane[3], z, u, v


@kernel(f"boolean({_NETS}, int64, {_R}, {_MANY}, int64, {_R}, {_R})", counts=False)
def _piece(control, patch, plane, work, row, off, piece):
    """Set the piece at which a plane cuts a facet; False where all of it lies in the plane, or it is met at a corner.

    Args:
        off: (3,) how far its corners are to the left of the plane. piece: (COLUMNS,).
    """
    found = 0
    for a in range(3):
        b = (a + 1) % 3
        # A corner on the plane is counted with the one edge that begins there, so that it is not found twice.
        if off[a] == 0.0 or off[a] * off[b] < 0.0:
            s, z, u, v = _crossing(control, patch, plane, work, row, a, b, off[a], off[b])
            if found < 2:
                piece[4 * found], piece[4 * found + 1], piece[4 * found + 2], piece[4 * found + 3] = s, z, u, v
            found += 1
    if found != 2:
        return False
    if piece[S0] > piece[S1]:
        for c in range(4):
            piece[c], piece[4 + c] = piece[4 + c], piece[c]
    piece[ERROR] = work[row, _OFF]
    return True


@kernel(
    f"int64({_MANY}, {_MANY}, {_INTS}, {_R}, {_NETS}, {_INTS}, {_MANY}, {_INTS}, float64, int64, int64, {_MANY}, "
    f"{_INTS})"
)
def pieces(triangles, corners, patch, error, control, facet, planes, plane, near, first, stop, out, source):
    """Cut pairs first to stop - 1 of facets and planes; return how many pieces that makes, more than there is room for
    if so.

    Args:
        facet, plane: (k,) numbers of both of each pair. planes: (m, 4) a place and the direction of each.
        near: facets as near to their patch as this are not quartered further, mm.
        out: (n, COLUMNS) pieces. source: (n,) the pair of each.
    """
    work, off, piece = np.empty((_ROOM, _COLUMNS)), np.empty(3), np.empty(COLUMNS)
    count = 0
    for k in range(first, stop):
        n, at = facet[k], planes[plane[k]]
        for c in range(9):
            work[0, c] = triangles[n, c]
        for c in range(6):
            work[0, _U + c] = corners[n, c]
        work[0, _OFF] = error[n]
        depth = 1
        while depth > 0:
            depth -= 1
            far = work[depth, _OFF]
            for c in range(3):
                off[c] = _off(at, work[depth, 3 * c], work[depth, 3 * c + 1])
                if abs(off[c]) <= _SAME:
                    off[c] = 0.0
            low, high = min(off[0], off[1], off[2]), max(off[0], off[1], off[2])
            # The surface is no farther from its facet than `far`: here it is all on one side.
            if low > far or high < -far:
                continue
            one_side = low > 0.0 or high < 0.0
            if patch[n] >= 0 and depth < _ROOM - 8 and (far > near or (one_side and far > _SAME)):
                copy_row(work, depth, _QUARTERED)
                quarter(control, patch[n], work, _QUARTERED, _QUARTERS)
                for c in range(_QUARTERS, _ROOM):
                    work[c, _OFF] = 0.25 * far
                    copy_row(work, c, depth)
                    depth += 1
                continue
            # on one side and not near enough to be quartered: the plane passes it by
            if one_side:
                continue
            if _piece(control, patch[n], at, work, depth, off, piece):
                if count < len(out):
                    for c in range(COLUMNS):
                        out[count, c] = piece[c]
                    source[count] = k
                count += 1
    return count


@kernel(f"int64({_R}, {_R}, {_INTS}, float64, {_INTS}, {_INTS})", counts=False)
def _nodes(along, up, order, same, node, following):
    """Set the node of each of m ends, and the end after it at the same node; return how many nodes there are.

    Args:
        along, up, order: see `chains`.
    """
    count = 0
    for i in range(len(order)):
        end, j = order[i], i - 1
        node[end], following[end] = count, -1
        while j >= 0 and along[end] - along[order[j]] <= same:
            if abs(up[end] - up[order[j]]) <= same:
                node[end], following[order[j]] = node[order[j]], end
                break
            j -= 1
        if node[end] == count:
            count += 1
    return count


@kernel(f"int64({_R}, {_R}, {_INTS}, float64, {_INTS}, {_INTS})")
def chains(along, up, order, same, out, starts):
    """Join m pieces whose ends meet; return how many chains that makes.

    Args:
        along, up: (2 m,) places of their ends along the plane and their heights, all starts and then all ends.
        order: (2 m,) of the ends along the plane. same: ends as near to each other as this are one place, mm.
        out: (2 m,) out: pieces one after the other, each as the two ends in the order in which it is run through.
        starts: (m + 1,) out: where in `out` each chain begins; behind the last one, how long `out` is.
    """
    m = len(along) // 2
    node, following, used = np.empty(2 * m, np.int64), np.empty(2 * m, np.int64), np.zeros(m, np.bool_)
    nodes = _nodes(along, up, order, same, node, following)
    first, degree = np.full(nodes, -1), np.zeros(nodes, np.int64)
    for i in range(2 * m):
        end = order[i]
        if first[node[end]] < 0:
            first[node[end]] = end
        degree[node[end]] += 1
    for k in range(m):
        used[k] = node[k] == node[k + m]
    count, size = 0, 0
    for turn in range(2):  # from loose ends first, then round closed curves
        for i in range(2 * m):
            end = order[i]
            if used[end % m] or (turn == 0 and degree[node[end]] != 1):
                continue
            starts[count] = size
            count += 1
            while end >= 0:
                used[end % m] = True
                out[size], out[size + 1] = end, (end + m) % (2 * m)
                size += 2
                end = first[node[(end + m) % (2 * m)]]
                while end >= 0 and used[end % m]:
                    end = following[end]
    starts[count] = size
    return count
