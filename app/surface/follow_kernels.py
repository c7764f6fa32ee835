"""Compiled: a cutter along one line over surfaces: points so near that every chord is proven, and where surfaces change.

On one patch the path goes from touch to touch by Newton's method, as far as the chord's middle allows, and many chords are
proven together: nearly all of a path is made so. Where that proof fails, or a patch ends, the path is taken up from the last
chord that is proven and goes on with care: all facets are asked at every point, changes of surface are solved for, and chords
are proven one by one.
"""

from __future__ import annotations

import math

import numpy as np

from app.jit import kernel
from app.surface.desk_kernels import ANY, CHORDS, CONTROL, DESK, NONE, OWNER, PATCH, PLACES, TREE, new_desk
from app.surface.drop_kernels import drop_one
from app.surface.quick_kernels import quick_one
from app.surface.touch_kernels import tip_over, touch_within
from app.surface.way_kernels import way_clear

_R, _MANY = "float64[::1]", "float64[:, ::1]"
S, X, Y, Z, FACET, U, V, LEFT, LEFT_U, LEFT_V, NEW, TRUE_Z = range(12)
"""Columns of points: place along the line, x, y, tip, what is touched there and where; what is touched on the side that the line
comes from, which differs at boundary points; what it is (see BEGINS); the tip before it was rounded."""
COLUMNS = 12
BEGINS, CORNER, BOUNDARY = 1.0, 2.0, 3.0
"""NEW of a point where a run begins, of a jump's corner, of a boundary point; 0 of others."""
DS, TOLERANCE, ALLOWED, LEAST, GRID, SLACK, FINE = range(7)
_STACK, _ROOTS = 256, 80
_TIE, _MET, _EQUAL, _FINEST = 1e-9, 1e-7, 1e-11, 1e-10
_SAG, _RISE, _MORE, _SHORTER = 0.85, 0.9, 1.5, 0.7
"""Chords are made so long that they are off by about so much of what is allowed, and tolerated; times the last one's length at most,
or, if a line's last chord (4 LEAST or more) was too long, times it: so that the next one does not end there again, for ever."""
_SLOW, _FEW = 16, 4
"""Most chords that are made with care before the quick way is tried again; it begins with a group of _FEW."""
_CLOSE = 0.02
"""mm; a chord as short as this that is not proven suggests that something was missed at its ends."""
_TAKEN, _JUMPS, _SPLIT, _AGAIN = 0, 1, 2, 3
"""What becomes of a chord: it is taken, by way of a corner, or it is split, or looked at again."""
_FOUND, _PAIR, _OTHER = 0, 1, 3
"""Rows to work on."""
NO_PROOF, NO_ROOM = -2, -1


@kernel(f"float64(float64, {_R})", counts=False)
def _written(z, rules):  # type: ignore[no-untyped-def]
    """Return a height as it will be written: rounded up."""
    return math.ceil(z / rules[GRID] - 1e-6) * rules[GRID] if rules[GRID] > 0.0 and z > -math.inf else z


@kernel(f"UniTuple(float64, 2)({_R}, {_R}, float64)", counts=False)
def _place(line, rules, s):  # type: ignore[no-untyped-def]
    """Return a place along the line as it will be written."""
    x, y = line[0] + s * line[2], line[1] + s * line[3]
    if rules[GRID] > 0.0:
        x, y = round(x / rules[GRID]) * rules[GRID], round(y / rules[GRID]) * rules[GRID]
    return x, y


@kernel(f"void({_R}, {_R}, float64, float64, float64, float64, float64, float64, float64)", counts=False)
def _fill(row, rules, s, x, y, tip, facet, u, v):  # type: ignore[no-untyped-def]
    """Set a row to what is touched, on both sides."""
    row[S], row[X], row[Y], row[Z], row[NEW], row[TRUE_Z] = s, x, y, _written(tip, rules), 0.0, tip
    row[FACET], row[U], row[V] = facet, u, v
    row[LEFT], row[LEFT_U], row[LEFT_V] = facet, u, v


@kernel(f"void({TREE}, {_R}, {_R}, {_R}, float64, int64, {_R}, {_R}, {DESK})", counts=False)
def _at(tree, shape, line, rules, s, whose, found, row, desk):  # type: ignore[no-untyped-def]
    """Set a row to what is touched at a place along the line, near what was `found` last; whose: as in `quick_one`."""
    found[0], found[1] = _place(line, rules, s)
    quick_one(tree, shape, whose, rules[SLACK], rules[FINE], found, desk)
    _fill(row, rules, s, found[0], found[1], found[2], found[3], found[4], found[5])


@kernel(f"boolean({TREE}, {_R}, {_R}, {_R}, {_R}, float64, {_R})", counts=False)
def _onward(tree, shape, line, rules, left, s, right):  # type: ignore[no-untyped-def]
    """Set `right` to what is touched further on the patch that is touched on the left; False where that is not known."""
    if left[FACET] < 0.0 or left[U] != left[U]:
        return False
    patch = tree[PATCH][int(left[FACET])]
    if patch < 0:
        return False
    x, y = _place(line, rules, s)
    tip, u, v = touch_within(tree[CONTROL], patch, left[U], left[V], x, y, shape)
    _fill(right, rules, s, x, y, tip, left[FACET], u, v)
    return tip > -math.inf


@kernel(f"float64({TREE}, {_R}, {_R}, {_R}, {_R})", counts=False)
def _spare(tree, shape, rules, left, right):  # type: ignore[no-untyped-def]
    """Return how many times as long a chord on one patch could be, by how low the tip comes over the patch in its middle; 0: unknown."""
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
    return math.sqrt(most / max(abs(deep), 1e-12))


@kernel(f"void({_R}, {_R})", counts=False)
def _copy(row, target):  # type: ignore[no-untyped-def]
    for c in range(COLUMNS):
        target[c] = row[c]


@kernel(f"int64({TREE}, {_R}, int64)", counts=False)
def _owner(tree, row, column):  # type: ignore[no-untyped-def]
    return tree[OWNER][int(row[column])] if row[column] >= 0.0 else NONE


@kernel(f"int64({TREE}, {_R}, {_R}, {_MANY}, int64, int64, {DESK})", counts=False)
def _proven(tree, shape, rules, out, first, count, desk):  # type: ignore[no-untyped-def]
    """Return how many of the chords from a row on, all on one patch, are proven; none of them goes into other surfaces at all."""
    for n in range(count + 1):
        for c in range(3):
            desk[PLACES][n, c] = out[first + n, X + c]
    return way_clear(tree, shape, count, _owner(tree, out[first + 1], FACET), rules[ALLOWED], desk)


@kernel(f"float64({TREE}, {_R}, {_R}, float64, float64)", counts=False)
def _low(tree, row, shape, x, y):  # type: ignore[no-untyped-def]
    """Return how low the tip comes at (x, y) over the place that a row touches; -inf where that place is not known."""
    if row[FACET] < 0.0 or row[U] != row[U]:
        return -math.inf
    return tip_over(tree[CONTROL], tree[PATCH][int(row[FACET])], row[U], row[V], x, y, shape)


@kernel(f"float64({TREE}, {_R}, {_R}, {_R}, float64, int64, {_R}, {DESK})", counts=False)
def _tip(tree, shape, line, rules, s, whose, found, desk):  # type: ignore[no-untyped-def]
    """Return the tip's height over one surface, at a place that is not rounded."""
    found[0], found[1] = line[0] + s * line[2], line[1] + s * line[3]
    quick_one(tree, shape, whose, rules[SLACK], _FINEST, found, desk)
    return found[2]


@kernel(f"UniTuple(float64, 3)({TREE}, {_R}, {_R}, {_R}, {_R}, {_R}, {_MANY}, {DESK})", counts=False)
def _balance(tree, shape, line, rules, left, right, pair, desk):  # type: ignore[no-untyped-def]
    """Return where the tip is as high over the surface on the left as over that on the right, and both heights; NaN if nowhere.

    Args:
        pair: (2, 6) to work in; out: what is touched on both.
    """
    mine, its = _owner(tree, left, FACET), _owner(tree, right, LEFT)
    pair[0, 3], pair[0, 4], pair[0, 5] = left[FACET], left[U], left[V]
    pair[1, 3], pair[1, 4], pair[1, 5] = right[LEFT], right[LEFT_U], right[LEFT_V]
    low, high, at_low, at_high, s, over = left[S], right[S], math.inf, -math.inf, 0.5 * (left[S] + right[S]), math.inf
    a, b = 0.0, 0.0
    for n in range(_ROOTS):
        if n < 2:
            s = low if n == 0 else high
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
    return (s if abs(over) <= _MET and left[S] < s < right[S] else math.nan), a, b


@kernel(f"boolean({TREE}, {_R}, {_R}, {_R}, {_R}, {_R}, {_R}, {_MANY}, {DESK})", counts=False)
def _meet(tree, shape, line, rules, left, right, middle, rows, desk):  # type: ignore[no-untyped-def]
    """Set `middle` to the boundary point between two places; False if there is none."""
    pair = rows[_PAIR : _PAIR + 2, :6]
    s, a, b = _balance(tree, shape, line, rules, left, right, rows[_PAIR : _PAIR + 2], desk)
    rows[_OTHER, 3] = NONE
    if s != s or _tip(tree, shape, line, rules, s, ANY, rows[_OTHER], desk) > max(a, b) + _MET:
        return False  # or a third one is above both
    x, y, z = line[0] + s * line[2], line[1] + s * line[3], max(a, b)
    middle[S], middle[X], middle[Y], middle[Z], middle[NEW], middle[TRUE_Z] = s, x, y, z, BOUNDARY, z
    middle[LEFT], middle[LEFT_U], middle[LEFT_V] = pair[0, 3], pair[0, 4], pair[0, 5]
    middle[FACET], middle[U], middle[V] = pair[1, 3], pair[1, 4], pair[1, 5]
    if rules[GRID] > 0.0:  # the path goes where it can be written
        _at(tree, shape, line, rules, s, ANY, rows[_FOUND], rows[_OTHER], desk)
        middle[X], middle[Y], middle[Z] = rows[_OTHER, X], rows[_OTHER, Y], rows[_OTHER, Z]
    return True


@kernel(f"void({TREE}, {_R}, {_R}, {_R}, {_R}, {_R}, {_MANY}, {DESK})", counts=False)
def _stay(tree, shape, line, rules, left, right, rows, desk):  # type: ignore[no-untyped-def]
    """Where surfaces coincide, stay on the one that the path came on."""
    if left[FACET] < 0.0 or right[FACET] < 0.0 or right[NEW] != 0.0:
        return
    mine = _owner(tree, left, FACET)
    if mine != _owner(tree, right, LEFT):
        _at(tree, shape, line, rules, right[S], mine, rows[_FOUND], rows[_OTHER], desk)
        if rows[_OTHER, Z] >= right[Z] - _TIE:
            _copy(rows[_OTHER], right)


@kernel(f"boolean({TREE}, {_R}, {_R}, {_R}, {DESK})", counts=False)
def _missed(tree, shape, rules, row, desk):  # type: ignore[no-untyped-def]
    """Set a row to what is touched higher there, if something was missed."""
    tip, touched = drop_one(tree, shape, row[X], row[Y], ANY, rules[FINE], desk)
    if not tip > row[Z] + rules[FINE]:
        return False
    row[Z] = _written(tip, rules)
    if row[NEW] == BOUNDARY:  # what it touches is known; it is written elsewhere
        return True
    row[TRUE_Z], row[FACET], row[LEFT] = tip, touched, touched
    row[U] = row[V] = row[LEFT_U] = row[LEFT_V] = math.nan
    return True


@kernel(f"boolean({TREE}, {_R}, {_R}, {_R}, {_R}, {DESK})", counts=False)
def _clear(tree, shape, rules, left, right, desk):  # type: ignore[no-untyped-def]
    """Return whether the chord between two places is proven."""
    for c in range(3):
        desk[PLACES][0, c], desk[PLACES][1, c] = left[X + c], right[X + c]
    return way_clear(tree, shape, 1, ANY, rules[ALLOWED], desk) == 1


@kernel(f"int64({TREE}, {_R}, {_R}, {_R}, {_R}, {_R}, {_R}, {_MANY}, {DESK})", counts=False)
def _judge(tree, shape, line, rules, left, right, middle, rows, desk):  # type: ignore[no-untyped-def]
    """Return what becomes of the chord between two places; `middle` is the place at which it is split."""
    span, least = right[S] - left[S], rules[LEAST]
    here, there = left[Z] > -math.inf, right[Z] > -math.inf
    if not here and not there:
        return _TAKEN
    half = 0.5 * (left[S] + right[S])
    if here != there:
        if span <= least:
            return _TAKEN
        _at(tree, shape, line, rules, half, ANY, rows[_FOUND], middle, desk)
        return _SPLIT
    if span <= least:
        jumps = abs(right[Z] - left[Z]) > 2.0 * span
        doubtful = jumps or not _clear(tree, shape, rules, left, right, desk)
        if doubtful and (_missed(tree, shape, rules, left, desk) or _missed(tree, shape, rules, right, desk)):
            return _AGAIN
        return _JUMPS if jumps else _TAKEN
    length = math.sqrt(span * span + (right[Z] - left[Z]) ** 2)
    x, y, z = 0.5 * (left[X] + right[X]), 0.5 * (left[Y] + right[Y]), 0.5 * (left[Z] + right[Z])
    most = rules[TOLERANCE] * length / span
    lowest = max(_low(tree, left, shape, x, y), _low(tree, right, shape, x, y))
    asked = lowest < z - most
    if asked:
        _at(tree, shape, line, rules, half, ANY, rows[_FOUND], middle, desk)
        lowest = middle[Z]
    if z - most <= lowest <= z + 2.0 * rules[ALLOWED] * length / span:
        if _owner(tree, left, FACET) != _owner(tree, right, LEFT):
            if _meet(tree, shape, line, rules, left, right, middle, rows, desk):
                return _SPLIT
            asked = False
        else:
            if _clear(tree, shape, rules, left, right, desk):
                return _TAKEN
            if span <= _CLOSE and (_missed(tree, shape, rules, left, desk) or _missed(tree, shape, rules, right, desk)):
                return _AGAIN
    if not asked:
        _at(tree, shape, line, rules, half, ANY, rows[_FOUND], middle, desk)
    return _SPLIT


@kernel(f"int64({_R}, {_R}, boolean, {_MANY}, int64)", counts=False)
def _emit(left, right, corner, out, count):  # type: ignore[no-untyped-def]
    """Write a chord's end, and the corner of a jump before it; return how many points there are then."""
    if corner:  # up before it goes on, or on before it goes down
        _copy(left if right[Z] > left[Z] else right, out[count])
        out[count, Z], out[count, NEW] = max(left[Z], right[Z]), CORNER
        count += 1
    if right[Z] > -math.inf:
        if left[Z] == -math.inf:
            right[NEW] = BEGINS
        _copy(right, out[count])
        count += 1
    return count


@kernel(f"UniTuple(int64, 2)({_R}, {_MANY}, int64, {_MANY}, int64)", counts=False)
def _back(left, waiting, depth, out, count):  # type: ignore[no-untyped-def]
    """Where `left` has been raised, have the chord to it looked at again; return how many points there are then, and how many wait."""
    if count == 0 or not left[Z] > out[count - 1, Z]:
        return count, depth
    if count == 1 or left[NEW] == BEGINS:
        _copy(left, out[count - 1])
        return count, depth
    left[NEW] = left[NEW] if left[NEW] == BOUNDARY else 0.0
    _copy(left, waiting[depth])
    count -= 1
    while out[count - 1, NEW] == CORNER:
        count -= 1
    _copy(out[count - 1], left)
    return count, depth + 1


@kernel(f"Tuple((int64, float64, boolean))({TREE}, {_R}, {_R}, {_R}, float64, {_MANY}, int64, {_R}, {DESK})", counts=False)
def _quickly(tree, shape, line, rules, ds, out, count, row, desk):  # type: ignore[no-untyped-def]
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
                _copy(row, out[count])
                count += 1
            continue
        if waiting == 0:
            return count, ds, True
        good = _proven(tree, shape, rules, out, sure, waiting, desk)
        sure += good
        if good < waiting:
            return sure + 1, out[sure + 1, S] - out[sure, S], False
        group = min(2 * group, CHORDS)


@kernel(f"Tuple((int64, float64))({TREE}, {_R}, {_R}, {_R}, float64, int64, {_R}, {_MANY}, int64, {_MANY}, {_MANY}, {DESK})", counts=False)
def _carefully(tree, shape, line, rules, ds, times, left, out, count, waiting, rows, desk):  # type: ignore[no-untyped-def]
    """Go on by so many chords at most from `left`, which goes along; return how many points there are then, or why it ends, and `ds`.

    Args:
        waiting: (k, COLUMNS) to work in: places beyond the chord that is looked at. rows: (4, COLUMNS) to work in.
    """
    least, last, middle = rules[LEAST], line[5], waiting[_STACK]
    for _ in range(times):
        if left[S] >= last:
            break
        depth = 1
        _at(tree, shape, line, rules, left[S] + ds if left[S] + ds < last - least else last, ANY, rows[_FOUND], waiting[0], desk)
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
                _copy(middle, waiting[depth])
                depth += 1
                continue
            count = _emit(left, right, fate == _JUMPS, out, count)
            ds = min(1.5 * max(right[S] - left[S], least), rules[DS])
            _copy(right, left)
            depth -= 1
    return count, ds


@kernel(f"int64({TREE}, {_R}, {_R}, {_R}, {_MANY})")
def follow(tree, shape, line, rules, out):  # type: ignore[no-untyped-def]
    """Follow surfaces along a line; return how many points there are, NO_ROOM in `out` for them, or NO_PROOF of a chord.

    Args:
        line: x, y, direction x, y, first and last place along it.
        rules: (7,) longest chord; how far the tip may be above where it could be, in the middle of chords; how deep it may go into
            surfaces; shortest chord; grid that places are rounded to, or 0; SLACK and FINE of `quick_one`; all mm.
        out: (k, COLUMNS).
    """
    desk, waiting, rows, left = new_desk(), np.empty((_STACK + 1, COLUMNS)), np.full((4, COLUMNS), -1.0), np.empty(COLUMNS)
    _at(tree, shape, line, rules, line[4], ANY, rows[_FOUND], left, desk)
    left[NEW] = BEGINS
    count, ds, slow = 0, rules[DS], 1
    if left[Z] > -math.inf:
        _copy(left, out[0])
        count = 1
    while left[S] < line[5]:
        if left[Z] > -math.inf:
            before = count
            count, ds, good = _quickly(tree, shape, line, rules, ds, out, count, waiting[0], desk)
            _copy(out[count - 1], left)
            slow = 1 if good or count > before else min(2 * slow, _SLOW)
        count, ds = _carefully(tree, shape, line, rules, ds, slow, left, out, count, waiting, rows, desk)
        if count < 0:
            return count
    return count
