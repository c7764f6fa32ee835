"""Compiled: how far a cone that goes up or down along a straight move reaches beyond walls, in closed form."""

from __future__ import annotations

import math

import numpy as np

from ..core.jit import kernel
from ..geometry.kernels import DEPTH, INF, LEAF, point_distance

_GENTLE = 1 - 1e-12
_CANDIDATES = 12


@kernel("float64(float64[:, ::1], int64, float64)", counts=False)
def _width(moves, m, share):
    """Return how wide the cone is at the surface at a fraction of a move, mm; above it, the less."""
    z = moves[m, 2] + (moves[m, 5] - moves[m, 2]) * share
    return min(moves[m, 6] - z * moves[m, 7], moves[m, 8])


@kernel("void(float64[:, ::1], int64, float64[:, ::1], int64, float64[::1])", counts=False)
def _candidates(moves, m, walls, w, shares):
    """Write the fractions of a move one of which is where it reaches farthest beyond a wall: its ends, the best places
    for the wall's ends and its centre, as wide as the cone grows and as wide as it stays behind its rim, where it is
    over the wall's circle or crosses the line through the wall's ends, and where it gets as wide as its rim.
    """
    wx, wy = moves[m, 3] - moves[m, 0], moves[m, 4] - moves[m, 1]
    size = max(math.hypot(wx, wy), 1e-300)
    rise = (moves[m, 2] - moves[m, 5]) * moves[m, 7]
    slope = min(max(rise / size, -_GENTLE), _GENTLE)
    # as far ahead of the wall's foot as the width gains by the way: distance and width change alike there
    steep = slope / math.sqrt(1 - slope * slope)
    arc = walls[w, 7] != 0.0
    shares[0], shares[1] = 0.0, 1.0
    for k in range(3):
        column = 2 * k if k < 2 or arc else 0
        ox, oy = walls[w, column] - moves[m, 0], walls[w, column + 1] - moves[m, 1]
        along, aside = (ox * wx + oy * wy) / size, abs(ox * wy - oy * wx) / size
        shares[2 + k] = (along + aside * steep) / size
        shares[9 + k] = along / size
        if k == 2:
            reach = math.sqrt(max(walls[w, 6] * walls[w, 6] - aside * aside, 0.0)) if arc else 0.0
            shares[5], shares[6] = (along - reach) / size, (along + reach) / size
    sx, sy = walls[w, 2] - walls[w, 0], walls[w, 3] - walls[w, 1]
    ox, oy = walls[w, 0] - moves[m, 0], walls[w, 1] - moves[m, 1]
    across = wx * sy - wy * sx
    # the axis crosses the line through both ends of the wall there: no distance is left
    shares[7] = (ox * sy - oy * sx) / across if across != 0.0 else 0.0
    shares[8] = (moves[m, 8] - moves[m, 6] + moves[m, 2] * moves[m, 7]) / rise if rise != 0.0 else 0.0


@kernel("float64(float64, float64, float64, float64, float64[:, ::1], int64)", counts=False)
def _boxes_apart(x0, y0, x1, y1, boxes, k):
    """Return the distance of two boxes, mm; 0 where they meet."""
    dx = max(boxes[k, 0] - x1, x0 - boxes[k, 2], 0.0)
    dy = max(boxes[k, 1] - y1, y0 - boxes[k, 3], 0.0)
    return math.sqrt(dx * dx + dy * dy)


@kernel(
    "void(float64[:, ::1], float64[:, ::1], float64[:, ::1], int64[::1], float64[:, ::1], float64[::1], "
    "float64[:, ::1])"
)
def reaches(moves, walls, boxes, order, nodes, depth, places):
    """Write how far each move's cone reaches beyond the wall that it reaches beyond most, mm (< 0: it keeps clear of
    all by as much), and where, (n, 2).

    Below a node of the walls' tree the cone reaches beyond none by more than it is wide less the distance of the boxes.

    Args:
        moves: (n, 9) start and end of the tip, radius of the flat, mm of radius per mm of height, radius of the rim.
        walls: (m, 8) lines and arcs below half a turn. boxes: (m, 4) of them. order, nodes: their tree.
    """
    leaves, stack, shares = (len(nodes) + 1) // 2, np.empty(DEPTH, np.int64), np.empty(_CANDIDATES)
    for m in range(len(moves)):
        x0, x1 = min(moves[m, 0], moves[m, 3]), max(moves[m, 0], moves[m, 3])
        y0, y1 = min(moves[m, 1], moves[m, 4]), max(moves[m, 1], moves[m, 4])
        most = max(_width(moves, m, 0.0), _width(moves, m, 1.0))
        best, stack[0], top = -INF, 0, 1
        while top > 0:
            top -= 1
            k = stack[top]
            if most - _boxes_apart(x0, y0, x1, y1, nodes, k) < best:
                continue
            if k < leaves - 1:
                one, other = 2 * k + 1, 2 * k + 2
                if _boxes_apart(x0, y0, x1, y1, nodes, other) < _boxes_apart(x0, y0, x1, y1, nodes, one):
                    one, other = other, one
                stack[top], stack[top + 1] = other, one
                top += 2
                continue
            first = (k - leaves + 1) * LEAF
            for place in range(first, min(first + LEAF, len(order))):
                w = order[place]
                if most - _boxes_apart(x0, y0, x1, y1, boxes, w) < best:
                    continue
                _candidates(moves, m, walls, w, shares)
                # between two neighbouring candidates the reach is monotone, so one of them is where it is greatest
                for i in range(len(shares)):
                    share = min(max(shares[i], 0.0), 1.0)
                    x = moves[m, 0] + (moves[m, 3] - moves[m, 0]) * share
                    y = moves[m, 1] + (moves[m, 4] - moves[m, 1]) * share
                    reach = _width(moves, m, share) - point_distance(walls, w, x, y)
                    if reach > best:
                        best, places[m, 0], places[m, 1] = reach, x, y
        depth[m] = best
