# mypy: allow-untyped-defs
"""Compiled: the chords and the level arcs that arcs are swept in, see `pieces`."""

from __future__ import annotations

import math

from ...core.jit import kernel

_QUARTER = math.pi / 2
"""Radians; directions at whose multiples an arc lies farthest along an axis."""
_POINTS, _NUMBERS, _COUNTS = "float64[:, ::1]", "float64[::1]", "int64[::1]"
_ARCS = (
    f"Tuple((int64[:, ::1], {_POINTS}, {_NUMBERS}, {_NUMBERS}, {_NUMBERS}, {_NUMBERS}, {_NUMBERS}, {_NUMBERS}, "
    "boolean[::1]))"
)


@kernel(f"void({_ARCS}, int64, float64, {_NUMBERS})", counts=False)
def _place(arcs, k, fraction, out):
    """Write the place (3,) of arc k at a fraction."""
    axes, centre, angle, sweep, start_radius, end_radius, height, rise = arcs[:8]
    turned = angle[k] + sweep[k] * fraction
    radius = start_radius[k] + (end_radius[k] - start_radius[k]) * fraction
    out[axes[k, 0]] = centre[k, 0] + radius * math.cos(turned)
    out[axes[k, 1]] = centre[k, 1] + radius * math.sin(turned)
    out[axes[k, 2]] = height[k] + rise[k] * fraction


@kernel(f"void({_ARCS}, int64, int64, int64, {_NUMBERS}, {_NUMBERS}, {_NUMBERS})", counts=False)
def _level_arc(arcs, k, part, count, start, end, row):
    """Write start and end (3,), so that it is counter-clockwise, and the row (7,) of one of the level arcs that arc k
    falls into.
    """
    centre, angle, sweep, start_radius, end_radius, height = arcs[1:7]
    radius = start_radius[k] + (end_radius[k] - start_radius[k]) * ((part + 0.5) / count)
    first, last = angle[k] + sweep[k] * (part / count), angle[k] + sweep[k] * ((part + 1) / count)
    low, high = min(first, last), max(first, last)
    cx, cy = centre[k, 0], centre[k, 1]
    start[0], start[1], start[2] = cx + radius * math.cos(low), cy + radius * math.sin(low), height[k]
    end[0], end[1], end[2] = cx + radius * math.cos(high), cy + radius * math.sin(high), height[k]
    row[0], row[1], row[2] = cx, cy, radius
    row[3], row[4] = min(start[0], end[0]), min(start[1], end[1])
    row[5], row[6] = max(start[0], end[0]), max(start[1], end[1])
    # An arc bulges beyond its ends where it goes through a quarter of the circle: right, top, left, bottom.
    for quarter in range(4):
        if (quarter * _QUARTER - low) % (2 * math.pi) <= high - low:
            side = 5 + quarter if quarter < 2 else 1 + quarter
            row[side] = (cx if quarter % 2 == 0 else cy) + (radius if quarter < 2 else -radius)


@kernel(
    f"void({_POINTS}, {_POINTS}, {_COUNTS}, {_ARCS}, {_COUNTS}, {_COUNTS}, {_COUNTS}, {_COUNTS}, int64, int64, "
    f"{_POINTS}, {_POINTS}, int32[::1], int32[::1], {_POINTS})"
)
def split(begins, finishes, arc_of, arcs, counts, whole, places, levels, first, last, start, end, motion, arc, table):
    """Write the pieces of motions first … last - 1: straight ones, chords of arcs, and level arcs.

    Args:
        begins, finishes: (n, 3) of all motions. arc_of: (n,) which of the arcs each is, -1 for none.
        arcs: axes, centre, angle, sweep, start and end radius, height and rise of each, as of `ArcPaths`, and whether
            it is swept in level arcs.
        counts: (n,) pieces that are made of each. whole: (n,) pieces that it has; of more the first and the last are
            made.
        places: (n,) where the pieces of each motion begin. levels: (n,) where its rows of `table` do.
        start, end, motion, arc, table: out, as of `Pieces`.
    """
    for row in range(first, last):
        k, count = arc_of[row], counts[row]
        for part in range(count):
            at = places[row] + part
            motion[at], arc[at] = row, -1
            # Of a motion of which not all pieces are wanted the first and the last one stand for it.
            step = whole[row] - 1 if part == 1 and count < whole[row] else part
            if k >= 0 and arcs[8][k]:
                arc[at] = levels[row] + part
                _level_arc(arcs, k, step, whole[row], start[at], end[at], table[arc[at]])
                continue
            for axis in range(3):  # one by one: copying slices takes seconds to compile
                start[at, axis], end[at, axis] = begins[row, axis], finishes[row, axis]
            if k >= 0 and step > 0:
                _place(arcs, k, step / whole[row], start[at])
            if k >= 0 and step + 1 < whole[row]:
                _place(arcs, k, (step + 1) / whole[row], end[at])
