# mypy: allow-untyped-defs
"""Compiled: the topmost of many pieces of section curves on one plane, and where it passes from surface to surface.

Between two neighbouring ends of pieces every piece is a smooth function. Those whose chords, with how far off these
are, could be topmost are asked exactly, on their surfaces; where two of them are, the place at which they are equally
high is solved for.
"""

from __future__ import annotations

import math

import numpy as np

from ...core.jit import kernel
from ...geometry.sort_kernels import sort_numbers
from ..patches.patch_kernels import place
from .section_kernels import ERROR, S0, S1, U0, U1, V0, V1, Z0, Z1

_R, _MANY, _NETS, _INTS = "float64[::1]", "float64[:, ::1]", "float64[:, :, :, ::1]", "int64[::1]"
SPANS, MARKS = 5, 11
"""How many columns both have."""
FROM, TO, PIECE, Z_FROM, Z_TO = range(5)
"""Columns of spans: where one begins and ends along the plane, its piece, and the heights there."""
AT, HERE, UNTIL, THERE, BEFORE, AFTER, BU, BV, AU, AV, KIND = range(11)
"""Columns of marks: along the plane and height; those on the next surface; pieces; parameters on both; kind."""
CROSSING, EDGE, JUMP, TANGENT = range(4)
"""Where one piece is topmost after another: they cross, one ends, one is higher at once, or they touch."""
COUNT, MARKED, CURRENT, TIED, TIED_FROM, TIED_UNTIL = range(6)
"""What is known on the way: spans and marks so far, the surface that is topmost, the one that lies on it, and from
where to where.
"""
_TIE = 1e-9
"""mm; pieces are equally high."""
_SHORT = 1e-11
"""mm; a shorter stretch of the plane is none."""
_SAME = 1e-8
"""mm; ends are one place."""
_MOST, _DEEP = 64, 48
"""Pieces that may be topmost in one stretch, and stretches that wait while one is halved, at most."""
_STEP = 1e-6
"""Of a patch's parameters, by which slopes are told."""
_ROOTS = 80
"""Places at most that are asked for one root."""


@kernel(f"UniTuple(float64, 3)({_NETS}, int64, {_MANY}, int64, {_R}, float64)", counts=False)
def over(control, patch, pieces, k, plane, s):
    """Return height and parameters of a piece of a section curve at a place along the plane (its place and direction,
    4).
    """
    width = pieces[k, S1] - pieces[k, S0]
    share = min(max((s - pieces[k, S0]) / width, 0.0), 1.0) if width > 0.0 else 0.0
    z, u = (
        pieces[k, Z0] + share * (pieces[k, Z1] - pieces[k, Z0]),
        pieces[k, U0] + share * (pieces[k, U1] - pieces[k, U0]),
    )
    v = pieces[k, V0] + share * (pieces[k, V1] - pieces[k, V0])
    if patch < 0 or share == 0.0 or share == 1.0:
        return z, u, v
    x, y = plane[0] + s * plane[2], plane[1] + s * plane[3]
    best, best_z, best_u, best_v = math.inf, z, u, v
    for _ in range(8):
        ax, ay, az = place(control, patch, u, v)
        off = abs(ax - x) + abs(ay - y)
        if off < best:
            best, best_z, best_u, best_v = off, az, u, v
        if off <= 1e-13 * (1.0 + abs(x) + abs(y)):
            break
        bx, by, _ = place(control, patch, u + _STEP, v)
        cx, cy, _ = place(control, patch, u, v + _STEP)
        bx, by, cx, cy = (bx - ax) / _STEP, (by - ay) / _STEP, (cx - ax) / _STEP, (cy - ay) / _STEP
        base = bx * cy - by * cx
        # Newton in the plane's x and y: seen from above an upright place has no inverse, and the best so far stays.
        if base == 0.0:
            break
        u = u + ((x - ax) * cy - (y - ay) * cx) / base
        v = v + ((y - ay) * bx - (x - ax) * by) / base
        if not (-0.1 < u < 1.1 and -0.1 < v < 1.1):
            break
    return best_z, best_u, best_v


@kernel(f"int64({_R}, {_INTS}, int64, {_INTS}, int64)", counts=False)
def _highest(heights, chosen, count, owner, current):
    """Return which of some pieces is topmost: of equally high ones that of the current surface, else of the first
    one.
    """
    best = 0
    for n in range(1, count):
        if heights[n] > heights[best]:
            best = n
    found = best
    for n in range(count):
        if heights[n] >= heights[best] - _TIE:
            mine, its = owner[chosen[n]], owner[chosen[found]]
            # Surfaces that coincide would take turns at each rounding: the one that the path is on keeps it.
            if (mine == current and its != current) or (its != current and mine < its):
                found = n
    return found


@kernel(f"UniTuple(float64, 3)({_MANY}, int64, float64, float64)", counts=False)
def _chord(pieces, k, a, b):
    """Return the heights of a piece's chord at two places, and how far off it the piece may be there."""
    slope = (pieces[k, Z1] - pieces[k, Z0]) / (pieces[k, S1] - pieces[k, S0])
    # ERROR is square to the chord, heights are upright.
    off = 2.0 * pieces[k, ERROR] * math.sqrt(1.0 + slope * slope)
    return pieces[k, Z0] + slope * (a - pieces[k, S0]), pieces[k, Z0] + slope * (b - pieces[k, S0]), off


@kernel(f"UniTuple(int64, 2)({_MANY}, float64, float64, {_INTS}, int64, {_INTS})", counts=False)
def _candidates(pieces, a, b, active, actives, chosen):
    """Forget pieces that end before a; choose those that could be topmost from a to b; return how many are active, and
    chosen.
    """
    kept, floor = 0, -math.inf
    for n in range(actives):
        k = active[n]
        if pieces[k, S1] > a + _SHORT:
            active[kept] = k
            kept += 1
            at_a, at_b, off = _chord(pieces, k, a, b)
            floor = max(floor, min(at_a, at_b) - off)
    count = 0
    for n in range(kept):
        at_a, at_b, off = _chord(pieces, active[n], a, b)
        # Some piece is nowhere lower than `floor`: what stays below that is not topmost anywhere here.
        if max(at_a, at_b) + off + _TIE >= floor and count < _MOST:
            chosen[count] = active[n]
            count += 1
    return kept, count


@kernel(f"void({_NETS}, {_MANY}, {_INTS}, {_R}, {_INTS}, int64, float64, {_R})", counts=False)
def _rise(control, pieces, patch, plane, chosen, count, s, heights):
    """Set the heights of the chosen pieces at a place."""
    for n in range(count):
        heights[n] = over(control, patch[chosen[n]], pieces, chosen[n], plane, s)[0]


@kernel(f"float64({_MANY}, {_INTS}, int64, {_INTS}, int64, int64, float64, float64)", counts=False)
def _hidden(heights, chosen, count, owner, first, stop, a, b):
    """Return where another surface could come up between a and b and go down again, by parabolas; NaN if nowhere."""
    split, mine = math.nan, owner[chosen[first]]
    middle = 0
    for n in range(count):
        if heights[1, n] > heights[1, middle]:
            middle = n
    for n in range(count):
        if owner[chosen[n]] != mine:
            at_a, at_b = heights[0, first] - heights[0, n], heights[2, stop] - heights[2, n]
            between = heights[1, middle] - heights[1, n]
            bend, lean = at_a - 2.0 * between + at_b, at_b - at_a
            # The parabola through both ends and the middle, over -1 to 1: it is least at -lean / (2 bend), if that is
            # within, and there between - lean² / (8 bend).
            if bend > 0.0 and abs(lean) < 2.0 * bend and between - lean * lean / (8.0 * bend) < -_TIE:
                split = 0.5 * (a + b) - 0.5 * (b - a) * lean / (2.0 * bend)
    return split if split - a > _SHORT and b - split > _SHORT else math.nan


@kernel(f"float64({_NETS}, {_MANY}, {_INTS}, {_R}, int64, int64, float64, float64, float64, float64)", counts=False)
def _equal(control, pieces, patch, plane, i, j, low, high, at_low, at_high):
    """Return where two pieces are equally high; at_low, at_high: how far i is above j at both ends."""
    at = low if at_low <= 0.0 else high
    if at_low <= 0.0 or at_high >= 0.0:
        return at
    for n in range(_ROOTS):
        # Twice the secant, then a half: what changes its sign stays between `low` and `high`.
        at = low + (high - low) * at_low / (at_low - at_high) if n % 3 < 2 else 0.5 * (low + high)
        apart = over(control, patch[i], pieces, i, plane, at)[0] - over(control, patch[j], pieces, j, plane, at)[0]
        if abs(apart) <= 1e-13 or high - low <= 1e-14 * (1.0 + abs(high)):
            break
        if apart > 0.0:
            low, at_low = at, apart
        else:
            high, at_high = at, apart
    return at


@kernel(f"boolean({_NETS}, {_MANY}, {_INTS}, {_R}, {_INTS}, int64, int64, int64, float64)", counts=False)
def _covered(control, pieces, patch, plane, chosen, count, i, j, s):
    """Return whether a third piece is above both where two meet."""
    both = max(over(control, patch[i], pieces, i, plane, s)[0], over(control, patch[j], pieces, j, plane, s)[0])
    highest = both
    for n in range(count):
        highest = max(highest, over(control, patch[chosen[n]], pieces, chosen[n], plane, s)[0])
    return highest > both + _TIE


@kernel(f"boolean({_MANY}, {_INTS}, int64, float64, float64)", counts=False)
def _ends(pieces, owner, number, s, z):
    """Return whether the section of a surface ends at a place: one of its pieces does, and no other goes on or back
    from there.
    """
    count = 0
    for k in range(len(pieces)):
        if owner[k] == number:
            count += abs(pieces[k, S0] - s) <= _SAME and abs(pieces[k, Z0] - z) <= _SAME
            count += abs(pieces[k, S1] - s) <= _SAME and abs(pieces[k, Z1] - z) <= _SAME
    # An inner end is one of two pieces of the surface, and counted twice.
    return count == 1


@kernel(
    f"void({_NETS}, {_MANY}, {_INTS}, {_INTS}, {_R}, int64, int64, float64, float64, int64, {_MANY}, {_R})",
    counts=False,
)
def _mark(control, pieces, patch, owner, plane, i, j, start, stop, kind, marks, state):
    """Write a mark between pieces: i until `start`, j from `stop`."""
    mark = marks[int(state[MARKED])]
    before, after = over(control, patch[i], pieces, i, plane, stop), over(control, patch[j], pieces, j, plane, stop)
    if kind == CROSSING and (
        _ends(pieces, owner, owner[i], stop, before[0]) or _ends(pieces, owner, owner[j], stop, after[0])
    ):
        kind = EDGE
    mark[AT], mark[HERE], mark[UNTIL], mark[THERE] = start, before[0], stop, after[0]
    if start != stop:  # they lie on each other from there on
        mark[HERE] = over(control, patch[j], pieces, j, plane, max(start, pieces[j, S0]))[0]
    mark[BEFORE], mark[AFTER], mark[KIND] = i, j, kind
    mark[BU], mark[BV], mark[AU], mark[AV] = before[1], before[2], after[1], after[2]
    state[MARKED] += 1.0


@kernel(f"void({_NETS}, {_MANY}, {_INTS}, {_INTS}, {_R}, int64, float64, {_MANY}, {_MANY}, {_R})", counts=False)
def _change(control, pieces, patch, owner, plane, i, a, spans, marks, state):
    """Where piece i begins to be topmost, and the one before it, of another surface, came as far as that: mark it."""
    count = int(state[COUNT])
    if state[CURRENT] < 0.0 or count == 0 or state[CURRENT] == owner[i] or spans[count - 1, TO] < a - _SHORT:
        return
    k = int(spans[count - 1, PIECE])
    apart = over(control, patch[k], pieces, k, plane, a)[0] - over(control, patch[i], pieces, i, plane, a)[0]
    # As high where one takes over, they cross; else the upper one ends there, and the tip falls or is lifted.
    kind, start = CROSSING if abs(apart) <= _TIE else JUMP, a
    if (
        kind == CROSSING
        and state[TIED] == owner[i]
        and state[TIED_UNTIL] >= a - _SHORT
        and a - state[TIED_FROM] > _SHORT
    ):
        kind, start = TANGENT, state[TIED_FROM]
    _mark(control, pieces, patch, owner, plane, k, i, start, a, kind, marks, state)


@kernel(f"void({_MANY}, {_INTS}, int64, {_INTS}, int64, float64, float64, {_R})", counts=False)
def _tie(heights, chosen, count, owner, first, a, at, state):
    """Remember how far another surface has been lying on the topmost one."""
    tie = -1
    for n in range(count):
        apart = max(abs(heights[0, n] - heights[0, first]), abs(heights[1, n] - heights[1, first]))
        if owner[chosen[n]] != owner[chosen[first]] and apart <= _TIE:
            tie = owner[chosen[n]]
    if tie >= 0 and (tie != state[TIED] or state[TIED_UNTIL] < a - _SHORT):
        state[TIED_FROM] = a
    state[TIED], state[TIED_UNTIL] = tie, at


@kernel(f"void({_MANY}, int64, float64, float64, {_R})", counts=False)
def _span(spans, i, a, b, state):
    """Write that piece i is topmost from a to b."""
    if b - a <= _SHORT:
        return
    count = int(state[COUNT])
    if count > 0 and spans[count - 1, PIECE] == i and spans[count - 1, TO] == a:
        spans[count - 1, TO] = b
        return
    spans[count, FROM], spans[count, TO], spans[count, PIECE] = a, b, i
    state[COUNT] += 1.0


@kernel(
    f"float64({_NETS}, {_MANY}, {_INTS}, {_INTS}, {_R}, {_INTS}, int64, float64, float64, boolean, {_MANY}, {_MANY}, "
    f"{_MANY}, {_R})",
    counts=False,
)
def _stretch(control, pieces, patch, owner, plane, chosen, count, a, b, splits, heights, spans, marks, state):
    """Write what is topmost from a to b; or return where that stretch must be split to know, if it may be; else NaN."""
    one = True
    for n in range(1, count):
        one = one and owner[chosen[n]] == owner[chosen[0]]
    if count == 1 or one:
        _rise(control, pieces, patch, plane, chosen, count if count > 1 else 0, 0.5 * (a + b), heights[1])
        i = chosen[_highest(heights[1], chosen, count, owner, int(state[CURRENT]))] if count > 1 else chosen[0]
        _change(control, pieces, patch, owner, plane, i, a, spans, marks, state)
        state[TIED], state[TIED_UNTIL], state[CURRENT] = -1.0, b, owner[i]
        _span(spans, i, a, b, state)
        return math.nan
    for n in range(3):
        _rise(control, pieces, patch, plane, chosen, count, a + 0.5 * n * (b - a), heights[n])
    first = _highest(heights[0], chosen, count, owner, int(state[CURRENT]))
    here = owner[chosen[first]]
    middle, stop = _highest(heights[1], chosen, count, owner, here), _highest(heights[2], chosen, count, owner, here)
    i, j, at, met = chosen[first], chosen[stop], b, False
    if splits and owner[i] == owner[j]:
        if owner[chosen[middle]] != owner[i]:
            return 0.5 * (a + b)
        split = _hidden(heights, chosen, count, owner, first, stop, a, b)
        if split == split:
            return split
    elif splits:
        # Two surfaces, one topmost at each end: between them they are equally high somewhere, maybe below a third
        # one.
        at = _equal(
            control,
            pieces,
            patch,
            plane,
            i,
            j,
            a,
            b,
            heights[0, first] - heights[0, stop],
            heights[2, first] - heights[2, stop],
        )
        met = True
        if at - a > _SHORT and b - at > _SHORT and _covered(control, pieces, patch, plane, chosen, count, i, j, at):
            return at
    _change(control, pieces, patch, owner, plane, i, a, spans, marks, state)
    _tie(heights, chosen, count, owner, first, a, at, state)
    _span(spans, i, a, at, state)
    state[CURRENT] = owner[i]
    if met:
        apart = (heights[2, first] - heights[0, first]) - (heights[2, stop] - heights[0, stop])
        kind = TANGENT if abs(apart) <= 1e-6 * (b - a) else CROSSING
        _mark(control, pieces, patch, owner, plane, i, j, at, at, kind, marks, state)
        _span(spans, j, at, b, state)
        state[CURRENT] = owner[j]
    return math.nan


@kernel(f"UniTuple(int64, 2)({_MANY}, {_INTS}, {_INTS}, {_NETS}, {_R}, {_MANY}, {_MANY})")
def envelope(pieces, patch, owner, control, plane, spans, marks):
    """Set the spans of the topmost along a plane and the marks where surfaces change; return how many of both, -1 for
    no room.

    Args:
        pieces: (m, 9) by where they begin. patch, owner: (m,) of each. plane: (4,) a place and the direction.
        spans: (k, SPANS). marks: (l, MARKS).
    """
    m = len(pieces)
    events = np.empty(2 * m)
    for k in range(m):
        events[k], events[m + k] = pieces[k, S0], pieces[k, S1]
    sort_numbers(events)
    active, chosen = np.empty(m, np.int64), np.empty(_MOST, np.int64)
    heights, waiting = np.empty((3, _MOST)), np.empty(_DEEP + 1)
    state = np.array([0.0, 0.0, -1.0, -1.0, 0.0, 0.0])
    actives, upcoming, last = 0, 0, -math.inf
    for e in range(2 * m - 1):
        a, b = max(events[e], last), events[e + 1]
        if b - a <= _SHORT:
            continue
        last = b
        # A sweep over sorted ends: between two neighbours the active pieces stay the same.
        while upcoming < m and pieces[upcoming, S0] <= a + _SHORT:
            active[actives] = upcoming
            actives += 1
            upcoming += 1
        actives, count = _candidates(pieces, a, b, active, actives, chosen)
        depth = 1 if actives > 0 else 0
        waiting[0] = b
        while depth > 0:
            if state[COUNT] + 2.0 > len(spans) or state[MARKED] + 2.0 > len(marks):
                return -1, -1
            b = waiting[depth - 1]
            splits = depth < _DEEP and b - a > _SHORT
            split = _stretch(
                control, pieces, patch, owner, plane, chosen, count, a, b, splits, heights, spans, marks, state
            )
            if split == split:
                waiting[depth] = split
                depth += 1
            else:
                a = b
                depth -= 1
    found = int(state[COUNT])
    for n in range(found):
        k = int(spans[n, PIECE])
        spans[n, Z_FROM] = over(control, patch[k], pieces, k, plane, spans[n, FROM])[0]
        spans[n, Z_TO] = over(control, patch[k], pieces, k, plane, spans[n, TO])[0]
    return found, int(state[MARKED])
