# mypy: allow-untyped-defs
"""Compiled: how far places are from triangles, and how deep the deepest place of an upright segment lies under them."""

from __future__ import annotations

import math

import numpy as np

from ...core.jit import kernel
from ..box_tree import LEAF

_R, _MANY = "float64[::1]", "float64[:, ::1]"
_STACK = 128
"""Nodes that wait, at most: one a level of the tree, and no tree is so deep."""
_HALVINGS = 64
"""Intervals of a segment that wait at most; each is half as long as the one before it."""


@kernel("float64(float64, float64, float64, float64, float64, float64, float64, float64, float64)", counts=False)
def _from_edge(px, py, pz, ax, ay, az, ux, uy, uz):
    """Return the square of the distance of p from the segment that begins at a and goes along u."""
    x, y, z = px - ax, py - ay, pz - az
    square = ux * ux + uy * uy + uz * uz
    share = min(max((x * ux + y * uy + z * uz) / square, 0.0), 1.0) if square > 0.0 else 0.0
    x, y, z = x - share * ux, y - share * uy, z - share * uz
    return x * x + y * y + z * z


@kernel(f"float64({_R}, float64, float64, float64)", counts=False)
def _from_triangle(t, x, y, z):
    """Return the square of the distance of a place from a triangle (9,): from its face if it is over that, else from an
    edge.
    """
    ux, uy, uz, vx, vy, vz = t[3] - t[0], t[4] - t[1], t[5] - t[2], t[6] - t[0], t[7] - t[1], t[8] - t[2]
    nx, ny, nz = uy * vz - uz * vy, uz * vx - ux * vz, ux * vy - uy * vx
    square = nx * nx + ny * ny + nz * nz
    px, py, pz = x - t[0], y - t[1], z - t[2]
    if square > 0.0:
        uu, uv, vv = ux * ux + uy * uy + uz * uz, ux * vx + uy * vy + uz * vz, vx * vx + vy * vy + vz * vz
        du, dv = px * ux + py * uy + pz * uz, px * vx + py * vy + pz * vz
        # barycentric coordinates times the squared normal: over the face where both are >= 0 and their sum <= it
        s, r = vv * du - uv * dv, uu * dv - uv * du
        if s >= 0.0 and r >= 0.0 and s + r <= square:
            off = nx * px + ny * py + nz * pz
            return off * off / square
    best = _from_edge(x, y, z, t[0], t[1], t[2], ux, uy, uz)
    best = min(best, _from_edge(x, y, z, t[0], t[1], t[2], vx, vy, vz))
    return min(best, _from_edge(x, y, z, t[3], t[4], t[5], vx - ux, vy - uy, vz - uz))


@kernel(f"float64({_MANY}, int64, float64, float64, float64)", counts=False)
def _from_box(boxes, k, x, y, z):
    dx = max(boxes[k, 0] - x, 0.0, x - boxes[k, 3])
    dy = max(boxes[k, 1] - y, 0.0, y - boxes[k, 4])
    dz = max(boxes[k, 2] - z, 0.0, z - boxes[k, 5])
    return dx * dx + dy * dy + dz * dz


@kernel(f"Tuple((float64, int64))({_MANY}, {_MANY}, float64, float64, float64, int64, int64[::1])", counts=False)
def _nearest(boxes, triangles, x, y, z, guess, stack):
    """Return the square of the distance of a place from the nearest triangle, and which one that is.

    Args:
        guess: a triangle that may be it. stack: (_STACK,) to work in.
    """
    best, which = _from_triangle(triangles[guess], x, y, z), guess
    leaves = (len(boxes) + 1) // 2
    stack[0], depth = 0, 1
    while depth > 0:
        depth -= 1
        k = stack[depth]
        if _from_box(boxes, k, x, y, z) >= best:
            continue
        if k >= leaves - 1:
            first = (k - leaves + 1) * LEAF
            for n in range(first, min(first + LEAF, len(triangles))):
                square = _from_triangle(triangles[n], x, y, z)
                if square < best:
                    best, which = square, n
            continue
        near, far = 2 * k + 1, 2 * k + 2
        if _from_box(boxes, near, x, y, z) > _from_box(boxes, far, x, y, z):
            near, far = far, near
        stack[depth], stack[depth + 1] = far, near
        depth += 2
    return best, which


@kernel(f"void({_MANY}, {_MANY}, {_MANY}, {_R})")
def distances(boxes, triangles, places, out):
    """Write how far each of some places (m, 3) is from the nearest triangle, mm."""
    guess, stack = 0, np.empty(_STACK, np.int64)
    for k in range(len(places)):
        square, guess = _nearest(boxes, triangles, places[k, 0], places[k, 1], places[k, 2], guess, stack)
        out[k] = math.sqrt(square)


@kernel(f"void({_MANY}, {_MANY}, {_MANY}, {_R}, float64, {_R})")
def deepest(boxes, triangles, segments, known, fine, out):
    """Write how far the farthest place of each upright segment is from the nearest triangle, mm.

    Between two places the distance is at most half the sum of theirs and of the way between them, and at most the
    larger distance of both from one triangle, as that is a convex function. An interval is halved until neither bound
    promises more.

    Args:
        boxes, triangles: of a `TriangleTree`.
        segments: (m, 4) x, y, low z, high z.
        known: (m,) what is of no interest if it is no deeper, mm: less may be written for such a segment.
        fine: by so much what is written may be too small, mm, > 0.
    """
    low, high = np.empty(_HALVINGS), np.empty(_HALVINGS)
    at_low, at_high = np.empty(_HALVINGS), np.empty(_HALVINGS)
    guess, stack = 0, np.empty(_STACK, np.int64)
    for k in range(len(segments)):
        x, y = segments[k, 0], segments[k, 1]
        square, guess = _nearest(boxes, triangles, x, y, segments[k, 2], guess, stack)
        low[0], high[0], at_low[0] = segments[k, 2], segments[k, 3], math.sqrt(square)
        square, guess = _nearest(boxes, triangles, x, y, segments[k, 3], guess, stack)
        at_high[0] = math.sqrt(square)
        best, depth = max(at_low[0], at_high[0]), 1
        while depth > 0:
            depth -= 1
            a, b, at_a, at_b = low[depth], high[depth], at_low[depth], at_high[depth]
            most = max(best, known[k]) + fine
            # distance is 1-Lipschitz along the segment: its graph lies under both slopes from the ends
            if 0.5 * (at_a + at_b + b - a) <= most:
                continue
            middle = 0.5 * (a + b)
            square, guess = _nearest(boxes, triangles, x, y, middle, guess, stack)
            at_middle = math.sqrt(square)
            best = max(best, at_middle)
            # convex: nowhere between is it farther from this one triangle than at one of the ends
            from_one = max(_from_triangle(triangles[guess], x, y, a), _from_triangle(triangles[guess], x, y, b))
            if math.sqrt(from_one) <= max(best, known[k]) + fine or depth + 2 > _HALVINGS:
                continue
            low[depth], high[depth], at_low[depth], at_high[depth] = a, middle, at_a, at_middle
            low[depth + 1], high[depth + 1], at_low[depth + 1], at_high[depth + 1] = middle, b, at_middle, at_b
            depth += 2
        out[k] = best
