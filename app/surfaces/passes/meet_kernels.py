# mypy: allow-untyped-defs
"""Compiled: boundary points: where a cutter on its line touches two surfaces at once."""

from __future__ import annotations

import math

from ...core.jit import kernel
from ..cutter_contact.facet_tree_kernels import ANY, DESK, NONE, TREE
from ..cutter_contact.quick_kernels import quick_one
from .point_kernels import (
    BOUNDARY,
    COLUMNS,
    FACET,
    GRID,
    LEFT,
    LEFT_U,
    LEFT_V,
    MET,
    NEW,
    SLACK,
    TRUE_Z,
    S,
    U,
    V,
    X,
    Y,
    Z,
    owner_of,
    touched_at,
)

_R, _MANY = "float64[::1]", "float64[:, ::1]"
_ROOTS = 80
"""Places at most that are asked for one root."""
_MET, _EQUAL, _FINEST = 1e-7, 1e-11, 1e-10
"""mm; heights over both surfaces are equal for a boundary point, and so near that none is looked for any more; how
near facets stand for surfaces meanwhile.
"""
FOUND, PAIR, OTHER = 0, 1, 3
"""Rows to work on: what was touched last; what is touched on both surfaces; what is touched elsewhere."""


@kernel(f"float64({TREE}, {_R}, {_R}, {_R}, float64, int64, {_R}, {DESK})", counts=False)
def _tip(tree, shape, line, rules, s, whose, found, desk):
    """Return the tip's height over one surface, at a place that is not rounded."""
    found[0], found[1] = line[0] + s * line[2], line[1] + s * line[3]
    quick_one(tree, shape, whose, rules[SLACK], _FINEST, found, desk)
    return found[2]


@kernel(f"UniTuple(float64, 3)({TREE}, {_R}, {_R}, {_R}, {_R}, {_R}, float64, {_MANY}, {DESK})", counts=False)
def _balance(tree, shape, line, rules, left, right, beyond, pair, desk):
    """Return where the tip is as high over the surface on the left as over that on the right, and both heights; NaN if
    nowhere.

    Args:
        beyond: so far beyond both places it may be. pair: (2, 6) to work in; out: what is touched on both.
    """
    mine, its = owner_of(tree, left, FACET), owner_of(tree, right, LEFT)
    pair[0, 3], pair[0, 4], pair[0, 5] = left[FACET], left[U], left[V]
    pair[1, 3], pair[1, 4], pair[1, 5] = right[LEFT], right[LEFT_U], right[LEFT_V]
    begin, stop = left[S] - beyond, right[S] + beyond
    low, high, at_low, at_high, s, over = begin, stop, math.inf, -math.inf, 0.5 * (begin + stop), math.inf
    a, b = 0.0, 0.0
    for n in range(_ROOTS):
        if n < 2:
            s = low if n == 0 else high
        # Twice the secant, then a half: fast where heights are smooth, and no more than three times a bisection's
        # steps where they are not. Left is above at `low`, below at `high`, all along.
        elif at_low < math.inf and at_high > -math.inf and n % 3 > 0:
            s = low + (high - low) * at_low / (at_low - at_high)
        else:
            s = 0.5 * (low + high)
        a = _tip(tree, shape, line, rules, s, mine, pair[0], desk)
        b = _tip(tree, shape, line, rules, s, its, pair[1], desk)
        if a == -math.inf and b == -math.inf:
            return math.nan, a, b
        over = math.inf if b == -math.inf else (-math.inf if a == -math.inf else a - b)
        if n == 0:
            at_low = over
        elif n == 1:
            at_high = over
            if not at_low >= 0.0 >= at_high:
                return math.nan, a, b
        elif over >= 0.0:
            low, at_low = s, over
        else:
            high, at_high = s, over
        if n > 1 and (abs(over) <= _EQUAL or high - low <= 1e-13 * (1.0 + abs(high))):
            break
    return (s if abs(over) <= _MET and begin < s < stop else math.nan), a, b


@kernel(f"boolean({TREE}, {_R}, {_R}, {_R}, {_R}, {_R}, float64, {_R}, {_MANY}, {DESK})", counts=False)
def meet(tree, shape, line, rules, left, right, beyond, middle, rows, desk):
    """Set `middle` to the boundary point between two places, or so far beyond them; False if there is none."""
    pair = rows[PAIR : PAIR + 2, :6]
    s, a, b = _balance(tree, shape, line, rules, left, right, beyond, rows[PAIR : PAIR + 2], desk)
    rows[OTHER, 3] = NONE
    if s != s or _tip(tree, shape, line, rules, s, ANY, rows[OTHER], desk) > max(a, b) + _MET:
        return False  # or a third one is above both
    x, y, z = line[0] + s * line[2], line[1] + s * line[3], max(a, b)
    middle[S], middle[X], middle[Y], middle[Z], middle[NEW], middle[TRUE_Z], middle[MET] = s, x, y, z, BOUNDARY, z, s
    middle[LEFT], middle[LEFT_U], middle[LEFT_V] = pair[0, 3], pair[0, 4], pair[0, 5]
    middle[FACET], middle[U], middle[V] = pair[1, 3], pair[1, 4], pair[1, 5]
    if rules[GRID] > 0.0:  # the path goes where it can be written
        touched_at(tree, shape, line, rules, s, ANY, rows[FOUND], rows[OTHER], desk)
        middle[X], middle[Y], middle[Z] = rows[OTHER, X], rows[OTHER, Y], rows[OTHER, Z]
    return True


@kernel(f"void({_R}, {_R})", counts=False)
def mark(middle, right):
    """Make `right` a boundary point so near to it that no other point is made for it; it is written where it was."""
    for c in range(FACET, COLUMNS):
        right[c] = middle[c]
