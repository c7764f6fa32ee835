# mypy: allow-untyped-defs
"""Compiled: a cutter along one line over surfaces: points so near that every chord is proven, and where surfaces
change.

On one patch the path goes from touch to touch by Newton's method, as far as the chord's middle allows, and many chords
are proven together: nearly all of a path is made so. Where that proof fails, or a patch ends, the path is taken up from
the last chord that is proven and goes on with care: all facets are asked at every point, changes of surface are solved
for, and chords are proven one by one.
"""

from __future__ import annotations

import math

import numpy as np

from ...core.jit import kernel
from ..cutter_contact.drop_kernels import drop_one
from ..cutter_contact.facet_tree_kernels import ANY, CHORDS, CONTROL, DESK, PATCH, PLACES, TREE, new_desk
from ..cutter_contact.quick_kernels import quick_one
from ..cutter_contact.touch_kernels import tip_over, touch_within
from .meet_kernels import FOUND, OTHER, mark, meet
from .point_kernels import (
    ALLOWED,
    BEGINS,
    BOUNDARY,
    COLUMNS,
    CORNER,
    DS,
    FACET,
    FINE,
    LEAST,
    LEFT,
    LEFT_U,
    LEFT_V,
    NEW,
    SLACK,
    TOLERANCE,
    TRUE_Z,
    S,
    U,
    V,
    X,
    Y,
    Z,
    copy_point,
    fill,
    owner_of,
    place_on,
    touched_at,
    written,
)
from .way_kernels import way_clear

_R, _MANY = "float64[::1]", "float64[:, ::1]"
_STACK = 256
"""Places ahead that wait, at most: a chord that is halved so often has no length left."""
_TIE = 1e-9
"""mm; surfaces that lie no farther above one another coincide."""
_SAG, _RISE, _MORE, _SHORTER = 0.85, 0.9, 1.5, 0.7
"""Chords are made so long that they are off by about so much of what is allowed, and tolerated; times the last one's
length at most, or, if a line's last chord (4 LEAST or more) was too long, times it: so that the next one does not end
there again, for ever.
"""
_SLOW, _FEW = 16, 4
"""Most chords that are made with care before the quick way is tried again; it begins with a group of _FEW."""
_CLOSE = 0.02
"""mm; a chord as short as this that is not proven suggests that something was missed at its ends."""
_BESIDE = 20.0
"""Times LEAST that a boundary point may lie beside two places between which the surface changes: where surfaces meet at
a small angle, their heights are written as the same beside it.
"""
_TAKEN, _JUMPS, _SPLIT, _AGAIN = 0, 1, 2, 3
"""What becomes of a chord: it is taken, by way of a corner, or it is split, or looked at again."""
NO_PROOF, NO_ROOM = -2, -1
"""What `follow` returns where it cannot return a number of points."""


@kernel(f"boolean({TREE}, {_R}, {_R}, {_R}, {_R}, float64, {_R})", counts=False)
def _onward(tree, shape, line, rules, left, s, right):
    """Set `right` to what is touched further on the patch that is touched on the left; False where that is not
    known.
    """
    if left[FACET] < 0.0 or left[U] != left[U]:
        return False
    patch = tree[PATCH][int(left[FACET])]
    if patch < 0:
        return False
    x, y = place_on(line, rules, s)
    # The last touch is where Newton begins: a short way on, on the same patch, it is near.
    tip, u, v = touch_within(tree[CONTROL], patch, left[U], left[V], x, y, shape)
    fill(right, rules, s, x, y, tip, left[FACET], u, v)
    return tip > -math.inf


@kernel(f"float64({TREE}, {_R}, {_R}, {_R}, {_R})", counts=False)
def _spare(tree, shape, rules, left, right):
    """Return how many times as long a chord on one patch could be, by how low the tip comes over the patch in its
    middle; 0: unknown.
    """
    span, rise = right[S] - left[S], right[Z] - left[Z]
    x, y, z = 0.5 * (left[X] + right[X]), 0.5 * (left[Y] + right[Y]), 0.5 * (left[Z] + right[Z])
    u, v = 0.5 * (left[U] + right[U]), 0.5 * (left[V] + right[V])
    patch = tree[PATCH][int(left[FACET])]
    low = tip_over(tree[CONTROL], patch, u, v, x, y, shape)
    if low == -math.inf:  # a cutter's rim touches elsewhere
        low, u, v = touch_within(tree[CONTROL], patch, u, v, x, y, shape)
    if low == -math.inf:
        return 0.0
    deep = (low - z) * span / math.sqrt(span * span + rise * rise)
    most = _SAG * rules[ALLOWED] if deep > 0.0 else _RISE * rules[TOLERANCE]
    # A chord of length l is off by about l² / (8 r): its length may grow by the root of what its error may.
    return math.sqrt(most / max(abs(deep), 1e-12))


@kernel(f"int64({TREE}, {_R}, {_R}, {_MANY}, int64, int64, {DESK})", counts=False)
def _proven(tree, shape, rules, out, first, count, desk):
    """Return how many of the chords from a row on, all on one patch, are proven; none of them goes into other surfaces
    at all.
    """
    for n in range(count + 1):
        for c in range(3):
            desk[PLACES][n, c] = out[first + n, X + c]
    return way_clear(tree, shape, count, owner_of(tree, out[first + 1], FACET), rules[ALLOWED], desk)


@kernel(f"float64({TREE}, {_R}, {_R}, float64, float64)", counts=False)
def _low(tree, row, shape, x, y):
    """Return how low the tip comes at (x, y) over the place that a row touches; -inf where that place is not known."""
    if row[FACET] < 0.0 or row[U] != row[U]:
        return -math.inf
    return tip_over(tree[CONTROL], tree[PATCH][int(row[FACET])], row[U], row[V], x, y, shape)


@kernel(f"void({TREE}, {_R}, {_R}, {_R}, {_R}, {_R}, {_MANY}, {DESK})", counts=False)
def _stay(tree, shape, line, rules, left, right, rows, desk):
    """Where surfaces coincide, stay on the one that the path came on."""
    if left[FACET] < 0.0 or right[FACET] < 0.0 or right[NEW] != 0.0:
        return
    mine = owner_of(tree, left, FACET)
    if mine != owner_of(tree, right, LEFT):
        touched_at(tree, shape, line, rules, right[S], mine, rows[FOUND], rows[OTHER], desk)
        if rows[OTHER, Z] >= right[Z] - _TIE:
            copy_point(rows[OTHER], right)


@kernel(f"boolean({TREE}, {_R}, {_R}, {_R}, {DESK})", counts=False)
def _missed(tree, shape, rules, row, desk):
    """Set a row to what is touched higher there, if something was missed."""
    tip, touched = drop_one(tree, shape, row[X], row[Y], ANY, rules[FINE], desk)
    if not tip > row[Z] + rules[FINE]:
        return False
    row[Z] = written(tip, rules)
    if row[NEW] == BOUNDARY:  # what it touches is known; it is written elsewhere
        return True
    # Which place of the patch is touched, the search over facets does not tell: not a number, until it is asked.
    row[TRUE_Z], row[FACET], row[LEFT] = tip, touched, touched
    row[U] = row[V] = row[LEFT_U] = row[LEFT_V] = math.nan
    return True


@kernel(f"boolean({TREE}, {_R}, {_R}, {_R}, {_R}, {DESK})", counts=False)
def _clear(tree, shape, rules, left, right, desk):
    """Return whether the chord between two places is proven."""
    for c in range(3):
        desk[PLACES][0, c], desk[PLACES][1, c] = left[X + c], right[X + c]
    return way_clear(tree, shape, 1, ANY, rules[ALLOWED], desk) == 1


@kernel(f"float64({TREE}, {_R}, {_R}, float64, float64, {_R}, {_MANY}, {DESK})", counts=False)
def _lowest_amid(tree, shape, rules, x, y, middle, rows, desk):
    """Return how low the tip comes in a chord's middle (x, y); `middle` is that place as it would be written.

    On a steep way half a step of the grid aside is a height of many tolerances: by that height every chord would be
    split, down to the shortest.
    """
    if middle[X] == x and middle[Y] == y:
        return middle[TRUE_Z]
    rows[FOUND, 0], rows[FOUND, 1] = x, y
    quick_one(tree, shape, ANY, rules[SLACK], rules[FINE], rows[FOUND], desk)
    return rows[FOUND, 2]


@kernel(f"int64({TREE}, {_R}, {_R}, {_R}, {_R}, {_R}, {_R}, {_MANY}, {DESK})", counts=False)
def _judge(tree, shape, line, rules, left, right, middle, rows, desk):
    """Return what becomes of the chord between two places; `middle` is the place at which it is split."""
    span, least = right[S] - left[S], rules[LEAST]
    here, there = left[Z] > -math.inf, right[Z] > -math.inf
    if not here and not there:
        return _TAKEN
    half = 0.5 * (left[S] + right[S])
    if here != there:
        if span <= least:
            return _TAKEN
        touched_at(tree, shape, line, rules, half, ANY, rows[FOUND], middle, desk)
        return _SPLIT
    if span <= least:
        jumps = abs(right[Z] - left[Z]) > 2.0 * span
        doubtful = jumps or not _clear(tree, shape, rules, left, right, desk)
        if doubtful and (_missed(tree, shape, rules, left, desk) or _missed(tree, shape, rules, right, desk)):
            return _AGAIN
        changes = right[NEW] == 0.0 and owner_of(tree, left, FACET) != owner_of(tree, right, LEFT)
        if changes and meet(tree, shape, line, rules, left, right, _BESIDE * least, middle, rows, desk):
            mark(middle, right)
        return _JUMPS if jumps else _TAKEN
    length = math.sqrt(span * span + (right[Z] - left[Z]) ** 2)
    x, y, z = 0.5 * (left[X] + right[X]), 0.5 * (left[Y] + right[Y]), 0.5 * (left[Z] + right[Z])
    # Both limits are square to the chord; heights are compared, so they are stretched by its steepness.
    most = rules[TOLERANCE] * length / span
    lowest = max(_low(tree, left, shape, x, y), _low(tree, right, shape, x, y))
    asked = lowest < z - most
    over = 2.0 * rules[ALLOWED] * length / span
    if asked:
        touched_at(tree, shape, line, rules, half, ANY, rows[FOUND], middle, desk)
        lowest = middle[Z]
        if not z - most <= lowest <= z + over:
            lowest = _lowest_amid(tree, shape, rules, x, y, middle, rows, desk)
    if z - most <= lowest <= z + over:
        if owner_of(tree, left, FACET) != owner_of(tree, right, LEFT):
            if meet(tree, shape, line, rules, left, right, 0.0, middle, rows, desk):
                return _SPLIT
            asked = False
        else:
            if _clear(tree, shape, rules, left, right, desk):
                return _TAKEN
            if span <= _CLOSE and (_missed(tree, shape, rules, left, desk) or _missed(tree, shape, rules, right, desk)):
                return _AGAIN
    if not asked:
        touched_at(tree, shape, line, rules, half, ANY, rows[FOUND], middle, desk)
    return _SPLIT


@kernel(f"int64({_R}, {_R}, boolean, {_MANY}, int64)", counts=False)
def _emit(left, right, corner, out, count):
    """Write a chord's end, and the corner of a jump before it; return how many points there are then."""
    if corner:  # up before it goes on, or on before it goes down
        copy_point(left if right[Z] > left[Z] else right, out[count])
        out[count, Z], out[count, NEW] = max(left[Z], right[Z]), CORNER
        count += 1
    if right[Z] > -math.inf:
        if left[Z] == -math.inf:
            right[NEW] = BEGINS
        copy_point(right, out[count])
        count += 1
    return count


@kernel(f"UniTuple(int64, 2)({_R}, {_MANY}, int64, {_MANY}, int64)", counts=False)
def _back(left, waiting, depth, out, count):
    """Where `left` has been raised, have the chord to it looked at again; return how many points there are then, and
    how many wait.
    """
    if count == 0 or not left[Z] > out[count - 1, Z]:
        return count, depth
    if count == 1 or left[NEW] == BEGINS:
        copy_point(left, out[count - 1])
        return count, depth
    left[NEW] = left[NEW] if left[NEW] == BOUNDARY else 0.0
    copy_point(left, waiting[depth])
    count -= 1
    # A corner is written with the chord that jumps, and goes with it.
    while out[count - 1, NEW] == CORNER:
        count -= 1
    copy_point(out[count - 1], left)
    return count, depth + 1


@kernel(
    f"Tuple((int64, float64, boolean))({TREE}, {_R}, {_R}, {_R}, float64, {_MANY}, int64, {_R}, {DESK})", counts=False
)
def _quickly(tree, shape, line, rules, ds, out, count, row, desk):
    """Go on from the last point on its patch, by Newton's method, as far as that goes and chords are proven.

    Return how many points there are then, how long the next chord should be, and whether all that was proven was good.
    """
    sure, group, least, last = count - 1, _FEW, rules[LEAST], line[5]  # chords up to row `sure` are proven
    while True:
        left, waiting = out[count - 1], count - 1 - sure
        s = left[S] + ds if left[S] + ds < last - least else last
        goes = waiting < group and count + 3 <= len(out) and s - left[S] >= 4.0 * least
        goes = goes and left[S] < last and _onward(tree, shape, line, rules, left, s, row)
        times = _spare(tree, shape, rules, left, row) if goes else 0.0
        if times > 0.0:
            ds = min((s - left[S]) * min(0.97 * times, _SHORTER if s == last and times < 1.0 else _MORE), rules[DS])
            if times >= 1.0:
                copy_point(row, out[count])
                count += 1
            continue
        if waiting == 0:
            return count, ds, True
        # Points were written on trust; those behind the first chord without a proof are forgotten.
        good = _proven(tree, shape, rules, out, sure, waiting, desk)
        sure += good
        if good < waiting:
            return sure + 1, out[sure + 1, S] - out[sure, S], False
        group = min(2 * group, CHORDS)


@kernel(
    f"Tuple((int64, float64))"
    f"({TREE}, {_R}, {_R}, {_R}, float64, int64, {_R}, {_MANY}, int64, {_MANY}, {_MANY}, {DESK})",
    counts=False,
)
def _carefully(tree, shape, line, rules, ds, times, left, out, count, waiting, rows, desk):
    """Go on by so many chords at most from `left`, which goes along; return how many points there are then, or why it
    ends, and `ds`.

    Args:
        waiting: (k, COLUMNS) to work in: places beyond the chord that is looked at. rows: (4, COLUMNS) to work in.
    """
    least, last, middle = rules[LEAST], line[5], waiting[_STACK]
    for _ in range(times):
        if left[S] >= last:
            break
        depth = 1
        touched_at(
            tree,
            shape,
            line,
            rules,
            left[S] + ds if left[S] + ds < last - least else last,
            ANY,
            rows[FOUND],
            waiting[0],
            desk,
        )
        # waiting[:depth] are places ahead, the nearest last; `left` is the last point written, proven up to it.
        while depth > 0:
            if count + 3 > len(out):
                return NO_ROOM, ds
            right = waiting[depth - 1]
            _stay(tree, shape, line, rules, left, right, rows, desk)
            fate = _judge(tree, shape, line, rules, left, right, middle, rows, desk)
            if fate == _AGAIN:
                if depth == _STACK:
                    return NO_PROOF, ds
                count, depth = _back(left, waiting, depth, out, count)
                continue
            if fate == _SPLIT:
                if depth == _STACK:
                    return NO_PROOF, ds
                copy_point(middle, waiting[depth])
                depth += 1
                continue
            count = _emit(left, right, fate == _JUMPS, out, count)
            ds = min(1.5 * max(right[S] - left[S], least), rules[DS])
            copy_point(right, left)
            depth -= 1
    return count, ds


@kernel(f"int64({TREE}, {_R}, {_R}, {_R}, {_MANY})")
def follow(tree, shape, line, rules, out):
    """Follow surfaces along a line; return how many points there are, NO_ROOM in `out` for them, or NO_PROOF of a
    chord.

    Args:
        line: x, y, direction x, y, first and last place along it.
        rules: (7,) longest chord; how far the tip may be above where it could be, in the middle of chords; how deep it
            may go into surfaces; shortest chord; grid that places are rounded to, or 0; SLACK and FINE of `quick_one`;
            all mm.
        out: (k, COLUMNS).
    """
    desk, waiting, rows, left = (
        new_desk(),
        np.empty((_STACK + 1, COLUMNS)),
        np.full((4, COLUMNS), -1.0),
        np.empty(COLUMNS),
    )
    touched_at(tree, shape, line, rules, line[4], ANY, rows[FOUND], left, desk)
    left[NEW] = BEGINS
    count, ds, slow = 0, rules[DS], 1
    if left[Z] > -math.inf:
        copy_point(left, out[0])
        count = 1
    while left[S] < line[5]:
        if left[Z] > -math.inf:
            before = count
            count, ds, good = _quickly(tree, shape, line, rules, ds, out, count, waiting[0], desk)
            copy_point(out[count - 1], left)
            # Where the quick way fails at once again and again, longer and longer stretches are made with care.
            slow = 1 if good or count > before else min(2 * slow, _SLOW)
        count, ds = _carefully(tree, shape, line, rules, ds, slow, left, out, count, waiting, rows, desk)
        if count < 0:
            return count
    return count
