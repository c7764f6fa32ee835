# mypy: allow-untyped-defs
"""Compiled: points of a cutter's path: what they are, and what is touched at a place along a line."""

from __future__ import annotations

import math

from ...core.jit import kernel
from ..cutter_contact.facet_tree_kernels import DESK, NONE, OWNER, TREE
from ..cutter_contact.quick_kernels import quick_one

_R = "float64[::1]"
S, X, Y, Z, FACET, U, V, LEFT, LEFT_U, LEFT_V, NEW, TRUE_Z, MET = range(13)
"""Columns of points: place along the line, x, y, tip, what is touched there and where; what is touched on the side that
the line comes from, which differs at boundary points; what it is (see BEGINS); the tip before it was rounded; of a
boundary point where along the line both surfaces are touched.
"""
COLUMNS = 13
BEGINS, CORNER, BOUNDARY = 1.0, 2.0, 3.0
"""NEW of a point where a run begins, of a jump's corner, of a boundary point; 0 of others."""
DS, TOLERANCE, ALLOWED, LEAST, GRID, SLACK, FINE = range(7)
"""Rules of `follow_kernels.follow`."""


@kernel(f"float64(float64, {_R})", counts=False)
def written(z, rules):
    """Return a height as it will be written: rounded up."""
    # Up, so that rounding never takes a tip into the part; 1e-6 of a step keeps what is on the grid where it is.
    return math.ceil(z / rules[GRID] - 1e-6) * rules[GRID] if rules[GRID] > 0.0 and z > -math.inf else z


@kernel(f"UniTuple(float64, 2)({_R}, {_R}, float64)", counts=False)
def place_on(line, rules, s):
    """Return a place along the line as it will be written."""
    x, y = line[0] + s * line[2], line[1] + s * line[3]
    if rules[GRID] > 0.0:
        x, y = round(x / rules[GRID]) * rules[GRID], round(y / rules[GRID]) * rules[GRID]
    return x, y


@kernel(f"void({_R}, {_R}, float64, float64, float64, float64, float64, float64, float64)", counts=False)
def fill(row, rules, s, x, y, tip, facet, u, v):
    """Set a row to what is touched, on both sides."""
    row[S], row[X], row[Y], row[Z], row[NEW], row[TRUE_Z], row[MET] = s, x, y, written(tip, rules), 0.0, tip, s
    row[FACET], row[U], row[V] = facet, u, v
    row[LEFT], row[LEFT_U], row[LEFT_V] = facet, u, v


@kernel(f"void({TREE}, {_R}, {_R}, {_R}, float64, int64, {_R}, {_R}, {DESK})", counts=False)
def touched_at(tree, shape, line, rules, s, whose, found, row, desk):
    """Set a row to what is touched at a place along the line, near what was `found` last; whose: as in `quick_one`."""
    # Rounded before it is asked: what was proven is the very place that is written.
    found[0], found[1] = place_on(line, rules, s)
    quick_one(tree, shape, whose, rules[SLACK], rules[FINE], found, desk)
    fill(row, rules, s, found[0], found[1], found[2], found[3], found[4], found[5])


@kernel(f"void({_R}, {_R})", counts=False)
def copy_point(row, target):
    """Set a row to another one."""
    for c in range(COLUMNS):
        target[c] = row[c]


@kernel(f"int64({TREE}, {_R}, int64)", counts=False)
def owner_of(tree, row, column):
    """Return the surface of the facet in a column of a row, NONE where there is none."""
    return tree[OWNER][int(row[column])] if row[column] >= 0.0 else NONE
