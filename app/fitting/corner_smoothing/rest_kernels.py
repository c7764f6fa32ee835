# mypy: allow-untyped-defs
"""Compiled step 407: arcs that meet with slight bends become biarcs; see `rest`. Rows and ends are those of
`joint_kernels`.
"""

from __future__ import annotations

import math

import numpy as np

from ...core.jit import kernel
from ...geometry.arcs.biarc_kernels import ARC, NONE, from_tangent, meeting
from .moment_kernels import add_up, fit_circle

WINDOW = 4
"""An arc's length in windows: so far to either side of a bend its points tell the curve's place and direction there."""

_POINT = "UniTuple(float64, 2)"


@kernel(f"{_POINT}(float64[::1], {_POINT})")
def direction(row, at):
    """Return the unit direction of a row at one of its points; (0, 0) of an empty one."""
    dx, dy = row[2] - row[0], row[3] - row[1]
    if row[7] != 0.0:
        dx, dy = -row[7] * (at[1] - row[5]), row[7] * (at[0] - row[4])
    length = math.hypot(dx, dy)
    return (dx / length, dy / length) if length > 0.0 else (0.0, 0.0)


@kernel(f"int64(float64[:, ::1], int64, int64, {_POINT})")
def _nearest(points, a, b, place):
    best, least = a, math.inf
    for k in range(a, b + 1):
        square = (points[k, 0] - place[0]) ** 2 + (points[k, 1] - place[1]) ** 2
        if square < least:
            best, least = k, square
    return best


@kernel("void(float64[::1], float64[::1])")
def _half_way(row, node):
    """Write the place and direction (4,) of an arc half way along."""
    ax, ay, bx, by = row[0] - row[4], row[1] - row[5], row[2] - row[4], row[3] - row[5]
    sweep = row[7] * math.atan2(ax * by - ay * bx, ax * bx + ay * by)
    half = row[7] * (sweep if sweep >= 0.0 else sweep + 2 * math.pi) / 2
    c, s = math.cos(half), math.sin(half)
    node[0], node[1] = row[4] + c * ax - s * ay, row[5] + s * ax + c * ay
    node[2], node[3] = direction(row, (node[0], node[1]))


@kernel("void(float64[:, ::1], int64, int64, float64[:, ::1], float64[::1])")
def _look(points, at, reach, sums, node):
    """Move a node (4,) onto the circle of the points at - reach ... at + reach, and turn it into its direction."""
    a = at - reach
    add_up(points, a, 0, 2 * reach + 1, sums)
    cx, cy, r, _ = fit_circle(sums, 0, 2 * reach + 1)
    dx, dy = node[0] - points[a, 0] - cx, node[1] - points[a, 1] - cy
    length = math.hypot(dx, dy)
    if length > 0.0 and r < 1e12:
        # to the left or the right of the circle's centre, as the node went before
        way = math.copysign(1.0, node[3] * dx - node[2] * dy)
        node[0], node[1] = points[a, 0] + cx + dx / length * r, points[a, 1] + cy + dy / length * r
        node[2], node[3] = -way * dy / length, way * dx / length


@kernel("void(float64[::1], float64, float64[::1], float64[::1])")
def _along_line(row, length, node, other):
    """Write places on a line so far from its beginning and, as `other`, from its end, and its direction."""
    dx, dy = direction(row, (row[0], row[1]))
    node[0], node[1], node[2], node[3] = row[0] + length * dx, row[1] + length * dy, dx, dy
    other[0], other[1], other[2], other[3] = row[2] - length * dx, row[3] - length * dy, dx, dy


@kernel(
    "void(float64[:, ::1], Tuple((int64[::1], float64[:, ::1])), boolean[::1], Tuple((float64[:, :, ::1], int64[:, "
    "::1])))"
)
def anchor(points, path, bent, anchors):
    """Find where a curve without slight bends may leave the rows next to them and come back to them.

    It does so in an arc's middle, where the points next to it tell the curve's place and direction best, and on a line
    near its ends.

    Args:
        points: what the path was made from, three times.
        path: ends (n + 1,) and rows (n, 8).
        bent: (n,) whether a row begins with a bend.
        anchors: (n, 2, 4) place and direction for the bend before and after each row that has one; (n, 2) the points'
            numbers there: they get these.
    """
    ends, rows = path
    nodes, at = anchors
    n, period, longest = len(rows), ends[-1] - ends[0], 0
    for k in range(n):
        longest = max(longest, ends[k + 1] - ends[k])
    sums = np.zeros((2 * max(longest // WINDOW, 2) + 2, 8))
    for k in range(n):
        after = (k + 1) % n
        if not (bent[k] or bent[after]):
            continue
        steps = ends[k + 1] - ends[k]
        if rows[k, 7] != 0.0:
            _half_way(rows[k], nodes[k, 0])
            # the points are there three times: one round later there are points before and behind each
            middle = _nearest(points, ends[k], ends[k + 1], (nodes[k, 0, 0], nodes[k, 0, 1]))
            _look(points, middle + period, max(steps // WINDOW, 2), sums, nodes[k, 0])
            nodes[k, 1] = nodes[k, 0]
            at[k, 0] = at[k, 1] = middle
        else:
            next_to = min(ends[after + 1] - ends[after], ends[k] - ends[k - 1] if k > 0 else ends[n] - ends[n - 1])
            # half the line at most, so that the bends at both its ends leave each other room
            share = min(0.5, next_to / WINDOW / max(steps, 1))
            _along_line(
                rows[k], share * math.hypot(rows[k, 2] - rows[k, 0], rows[k, 3] - rows[k, 1]), nodes[k, 0], nodes[k, 1]
            )
            at[k, 0], at[k, 1] = ends[k] + int(share * steps), ends[k + 1] - int(share * steps)


@kernel(f"boolean({_POINT}, {_POINT}, {_POINT}, float64[::1], float64[::1])")
def _fill(start, leaving, end, row, carrier):
    """Write the arc or line that leaves a point in a direction and ends at another; tell whether there is one."""
    kind, cx, cy, turn = from_tangent(start, leaving, end)
    row[0], row[1], row[2], row[3] = start[0], start[1], end[0], end[1]
    row[4:] = 0.0
    if kind == ARC:
        row[4], row[5], row[6], row[7] = cx, cy, math.hypot(start[0] - cx, start[1] - cy), turn
        carrier[0], carrier[1], carrier[2], carrier[3], carrier[4] = cx, cy, row[6], turn, 1.0
    elif kind != NONE:
        dx, dy = direction(row, start)
        carrier[0], carrier[1], carrier[2], carrier[3], carrier[4] = start[0], start[1], dx, dy, 0.0
    return kind != NONE


@kernel("boolean(float64[::1], float64[::1], float64[:, ::1], float64[:, ::1])")
def _biarc(first, last, rows, carriers):
    """Write the rows (2, 8) and carriers (2, 5) of the biarc from a node to another; tell whether there is one."""
    start, end = (first[0], first[1]), (last[0], last[1])
    exists, mx, my = meeting(start, (first[2], first[3]), end, (last[2], last[3]))
    if not exists or not _fill(start, (first[2], first[3]), (mx, my), rows[0], carriers[0]):
        return False
    return _fill((mx, my), direction(rows[0], (mx, my)), end, rows[1], carriers[1])


@kernel(
    "boolean(float64[:, ::1], int64, Tuple((float64[::1], float64[::1], int64, int64)), "
    "Tuple((int64[::1], float64[:, ::1], float64[:, ::1])), int64)"
)
def _put_biarc(points, period, between, made, count):
    """Write the biarc between two nodes, whose points' numbers are told too, as rows `count` and the next; tell whether
    there is one.
    """
    first, last, a, b = between
    ends, rows, carriers = made
    exists = _biarc(first, last, rows[count : count + 2], carriers[count : count + 2])
    ends[count] = a
    ends[count + 1] = _nearest(points, a + period, b + period, (rows[count, 2], rows[count, 3])) - period
    return exists


@kernel(
    "int64(float64[:, ::1], Tuple((int64[::1], float64[:, ::1], float64[:, ::1], float64[:, :, ::1], int64[:, ::1])), "
    "boolean[::1], Tuple((int64[::1], float64[:, ::1], float64[:, ::1])), Tuple((int64[::1], boolean[::1])))"
)
def smoothed(points, path, bent, made, told):
    """Write a closed path with biarcs round its bends; return how many rows it has, 0 where there is no biarc
    somewhere.

    Args:
        points: what the path was made from, three times.
        path: ends (n + 1,), rows (n, 8), carriers (n, 5), and the anchors' nodes and points from `bends`.
        bent: (n,) the bends to make smooth; gets False at those that have no biarc.
        made: ends (4 n + 1,), rows (4 n, 8) and carriers (4 n, 5): they get the new path.
        told: (4 n,) of each new row the old one that it begins in or leads into, and whether it is of a biarc.
    """
    ends, rows, carriers, nodes, at = path
    new_ends, new_rows, new_carriers = made
    origin, free = told
    n, period, count, whole = len(rows), ends[-1] - ends[0], 0, True
    own = nodes[0].copy()
    for k in range(n):
        before, after = k - 1, (k + 1) % n
        origin[count : count + 4] = k
        free[count : count + 4] = False
        if bent[k]:
            # the bend at the path's first point begins in the round before it
            a = at[before, 1] - (period if k == 0 else 0)
            if not _put_biarc(points, period, (nodes[before, 1], nodes[k, 0], a, at[k, 0]), made, count):
                bent[k] = whole = False
            free[count : count + 2] = True
            count += 2
        for side in range(2):
            own[side, 0], own[side, 1] = rows[k, 2 * side], rows[k, 2 * side + 1]
            own[side, 2], own[side, 3] = direction(rows[k], (own[side, 0], own[side, 1]))
        first, a = (nodes[k, 0], at[k, 0]) if bent[k] else (own[0], ends[k])
        last, b = (nodes[k, 1], at[k, 1]) if bent[after] else (own[1], ends[k + 1])
        arc = rows[k, 7] != 0.0
        # an arc keeps one true end only: from its middle, where the other bend's biarc ends, a biarc leads to that end
        if arc and bent[k] != bent[after]:
            if not _put_biarc(points, period, (first, last, a, b), made, count):
                bent[k] = bent[after] = whole = False
            free[count : count + 2] = True
            count += 2
        elif not (arc and bent[k]):
            new_ends[count], new_rows[count], new_carriers[count] = a, rows[k], carriers[k]
            new_rows[count, 0], new_rows[count, 1], new_rows[count, 2], new_rows[count, 3] = (
                first[0],
                first[1],
                last[0],
                last[1],
            )
            count += 1
    if new_ends[0] < 0:
        new_ends[:count] += period
    new_ends[count] = new_ends[0] + period
    return count if whole else 0
