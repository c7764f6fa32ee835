# mypy: allow-untyped-defs
"""Compiled: the tree of facets that cutters are held against, and the rows that facets are quartered on."""

from __future__ import annotations

import math

import numpy as np

from ...core.jit import kernel
from ..patches.patch_kernels import copy_row

_R, _MANY, _NETS, _INTS = "float64[::1]", "float64[:, ::1]", "float64[:, :, :, ::1]", "int64[::1]"
TREE = f"Tuple(({_MANY}, {_MANY}, {_MANY}, {_INTS}, {_R}, {_INTS}, {_NETS}, int64, {_MANY}))"
BOXES, TRIANGLES, CORNERS, PATCH, ERROR, OWNER, CONTROL, LEAF, BULGE = range(9)
"""Of what `FacetTree.held` gives: its arrays, and how many facets a leaf has. PATCH is NONE of facets that stand for
themselves.
"""
DESK = f"Tuple(({_MANY}, {_MANY}, {_INTS}, {_R}, {_INTS}, {_R}, {_MANY}, {_MANY}))"
WORK, SHAPES, NODES, BOUNDS, WHICH, HEIGHTS, PLACES, GROUPS = range(8)
"""Of what `new_desk` makes to work on: rows of facets; two cutters' shapes; nodes that wait and their bounds; facets
that may be touched and their heights; the tip's places along a way, and its chords in groups (see `way_kernels`).
"""
DEEPEST = 64
"""Nodes that wait, at most: one a level of the tree, and no tree is so deep."""
ROOM = 96
"""Rows of WORK: facets that wait, four for the quarters that are being sorted, one for what is quartered."""
QUARTERS, LAST = ROOM - 4, ROOM - 5
"""The first of the rows for quarters, and the row of what is quartered."""
LIKELY = 64
"""Facets that may be touched at one place and are remembered, the highest of them."""
OFF, HIGHEST, GROUP = 15, 16, 16
"""Columns of WORK behind corners (9) and parameters (6): how far the facet is off at most, and what the tip comes down
to, or the group of chords that it is held against.
"""
WIDENED, RISE, COLUMNS = 17, 26, 27
"""Columns of WORK: a triangle that nothing of the part is farther from than what stands in RISE; how many columns there
are.
"""
CHORDS = 32
"""Most chords of a way that are proven together."""
NONE = -1
"""No facet, no surface."""
ANY = -1
"""Owner that stands for all."""


@kernel(f"{DESK}()")
def new_desk():
    """Return arrays to work on."""
    # Made once for a whole line or a band of places: arrays made for each place would cost more than the search.
    return (
        np.empty((ROOM, COLUMNS)),
        np.empty((2, 5)),
        np.empty(DEEPEST, np.int64),
        np.empty(DEEPEST),
        np.empty(LIKELY, np.int64),
        np.empty(LIKELY),
        np.empty((CHORDS + 1, 3)),
        np.empty((2 * CHORDS, 9)),
    )


@kernel(f"void({TREE}, int64, {_MANY})", counts=False)
def lay(tree, n, work):
    """Lay a facet on row 1 of `work`, with nothing known of its height."""
    for c in range(9):
        work[1, c] = tree[TRIANGLES][n, c]
    for c in range(6):
        work[1, 9 + c] = tree[CORNERS][n, c]
    work[1, OFF], work[1, HIGHEST] = tree[ERROR][n], math.inf


@kernel(f"int64({_MANY}, int64, float64)", counts=False)
def put_quarters(work, depth, known):
    """Put the quarters that could be above `known` on rows `depth` on, the highest last; return how far that goes."""
    for _ in range(4):
        low = QUARTERS
        for k in range(QUARTERS + 1, ROOM):
            if work[k, HIGHEST] < work[low, HIGHEST]:
                low = k
        if known < work[low, HIGHEST] < math.inf:
            copy_row(work, low, depth)
            depth += 1
        # Taken: the next round finds the lowest of the others.
        work[low, HIGHEST] = math.inf
    return depth
