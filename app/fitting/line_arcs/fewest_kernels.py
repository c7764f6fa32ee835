# mypy: allow-untyped-defs
"""Compiled: the fewest lines and arcs along a polyline, by a shortest path over places where they may meet.

States are points of the polyline, each with a few places beside it where a joint may be, its own the first: of paths
that are as good the first one stays. A piece runs from a place of one to a place of another. All circles through two
places are one family, told by the tangent t of a quarter of the sweep, left of the chord positive: t is also the height
of the arc over its chord in halves of the chord. What a polyline allows of it is an interval, so the directions in
which a piece may leave and arrive are intervals, too, and so is what a chain of pieces may arrive in: carried along,
they hold every choice that is left open, and a bend limit costs no search of its own.

Paths are kept as entries of their last place, all of the same number of pieces, the fewest: the lowest and the highest
direction of arrival, and the entry that it goes on from. Paths of one piece more that arrive in other directions are
dropped; keeping them took twice the time and found nothing.

References:
    Drysdale, Rote and Sturm (2008), "Approximation of an open polygonal curve with a minimum number of circular arcs
    and biarcs": the tolerance boundary of a fixed pair of ends as an interval, and the shortest path over all pairs.
"""

from __future__ import annotations

import math

import numpy as np

from ...core.jit import kernel

_SAMPLES, _STATES, _COUNTS = "float64[:, ::1]", "float64[:, ::1]", "int64[:, ::1]"
_DIRECTIONS, _ENTRIES = "float64[:, :, ::1]", "int64[:, ::1]"
_STEEPEST = math.tan(1.0)
"""Tangent of a quarter of the widest sweep, 4 radians: well below a full turn, which an arc with nearly the same ends
may be taken for.
"""
_COARSE = 8
"""So many samples are looked at before all others: hopeless pairs fail at once."""
_RELAXED = 2.0
"""Joints are off the polyline by the limit at most, so that an arc between places on it keeps to twice the limit at
about most.
"""
_PATIENCE = 6
"""After so many states in a row that no piece reaches none farther on is tried: noise hides what short pieces are."""
_LEAST_CHORDS = 3
"""An arc stands for so many chords at least: two points and a bend between them are no evidence of one."""
_EVEN = 0.5
"""An arc is over chords of so much of its own at most: a long side with crumbs at its ends stays a side."""
_SHORTEST = 2.0
"""A piece whose ends are moved is so many limits long at least: else it may be turned round."""
_ALIKE = 1e-9
"""Radians; directions that are so near are the same."""
MOST = 6
"""Entries that a place keeps."""
PIECES, USED = 0, 1
"""Columns of a place's counts."""
X, Y, LEFT_X, LEFT_Y, BEND, CHORD = 0, 1, 2, 3, 4, 5
"""Columns of a state: its place, the left normal times the farthest distance of a joint, by how much pieces may turn
there, the longest chord since the state before.
"""


@kernel("UniTuple(float64, 2)(float64, float64, float64, float64, float64)", counts=False)
def narrowed(low, high, x, y, off):
    """Return which of the heights between two arcs over the chord from (-1, 0) to (1, 0) have that pass a point within
    `off` of it.

    A circle of height t has the centre (0, (t - 1 / t) / 2) and the radius (t + 1 / t) / 2. The lowest passes the point
    `off` below it, where (y + off) t^2 + b t - (y - off) = 0 with b = 1 + off^2 - x^2 - y^2, the highest above it,
    where off is -off; the other root of each is the rest of the same circle. Both have one discriminant. Where the
    outer heights are within already, which the signs of the two polynomials and of their slopes tell, no root is drawn.
    """
    if (abs(x) - 1.0) ** 2 + y * y <= off * off:
        return low, high
    b, over, under = 1.0 + off * off - x * x - y * y, y + off, y - off
    rises, falls = over * low, under * high
    if (rises + b) * low >= under and 2.0 * rises + b >= 0.0 and (falls + b) * high <= over and 2.0 * falls + b >= 0.0:
        return low, high
    square = b * b + 4.0 * over * under
    if square < 0.0:  # beside an end: any circle through that is about as near
        return low, high
    if b <= 0.0 and abs(y) <= off:  # beyond an end, in line with the chord: only what is nearly a full circle comes by
        return 1.0, -1.0
    root = b + math.sqrt(square)
    return max(low, 2.0 * under / root), min(high, 2.0 * over / root)


@kernel(
    f"UniTuple(float64, 2)({_SAMPLES}, int64, int64, float64, float64, float64, float64, float64, int64[::1])",
    counts=False,
)
def _window(samples, first, last, ax, ay, bx, by, widened, hardest):
    """Return between which heights arcs from a to b keep near samples first to last; the lower one above the other:
    none does.

    Samples near an end hold nothing, so that the height is kept to that of the highest and the lowest sample, too.

    Args:
        samples: (m, 3) place, and how far an arc may be from it, mm.
        widened: times so much.
        hardest: (1,) the sample that arcs failed at last, looked at first: neighbouring pairs fail alike.
    """
    dx, dy = 0.5 * (bx - ax), 0.5 * (by - ay)
    square = dx * dx + dy * dy
    if square == 0.0:
        return 1.0, -1.0
    # Divided by half the chord, as complex numbers, the chord becomes that from (-1, 0) to (1, 0).
    mx, my, ux, uy, scale = 0.5 * (ax + bx), 0.5 * (ay + by), dx / square, dy / square, widened / math.sqrt(square)
    low, high, lowest, highest, widest = -_STEEPEST, _STEEPEST, 0.0, 0.0, 0.0
    step, k = max(1, (last - first) // _COARSE), hardest[0]
    if not first <= k <= last:
        k = first
    fresh = True  # sample k stands alone
    while True:
        while k <= last:
            px, py, off = samples[k, 0] - mx, samples[k, 1] - my, scale * samples[k, 2]
            y = py * ux - px * uy
            lowest, highest, widest = min(lowest, y), max(highest, y), max(widest, off)
            low, high = narrowed(low, high, px * ux + py * uy, y, off)
            if low > high:
                hardest[0] = k
                return 1.0, -1.0
            k = first if fresh else k + step
            fresh = False
        if step == 1:
            return max(low, lowest - widest), min(high, highest + widest)
        # The coarse samples let some heights through: now each one is looked at.
        step, k = 1, first


@kernel("UniTuple(float64, 2)(float64, float64, float64, boolean, float64)", counts=False)
def _halves(low, high, size, bent, limit):
    """Return the halves of the sweep, left positive, that heights are; of a line alone where there may be no arc."""
    # An arc of height t over its chord, to the left, sweeps 4 atan t to the right.
    least, most = -2.0 * math.atan(high), -2.0 * math.atan(low)
    if not bent:
        return (0.0, 0.0) if least <= 0.0 <= most else (1.0, -1.0)
    if size < 2.0 * limit:  # no radius below the limit
        widest = math.asin(0.5 * size / limit)
        return max(least, -widest), min(most, widest)
    return least, most


@kernel(f"void({_COUNTS}, {_DIRECTIONS}, {_ENTRIES}, int64, int64, float64, float64, int64)", counts=False)
def _keep(counts, directions, before, at, pieces, low, high, entry):
    """Keep a path to place `at` that goes on from an entry, unless there is one of fewer pieces, or one that may arrive
    likewise.

    It takes the room of one that arrives in some of its directions alone; else, where there is none left, of the
    narrowest.
    """
    if pieces < counts[at, PIECES]:
        counts[at, PIECES], counts[at, USED] = pieces, 0
    free, least = counts[at, USED], high - low
    for e in range(counts[at, USED]):
        if directions[at, e, 0] <= low + _ALIKE and directions[at, e, 1] >= high - _ALIKE:
            return
        if directions[at, e, 0] >= low and directions[at, e, 1] <= high:
            free, least = e, 0.0
        elif counts[at, USED] == MOST and directions[at, e, 1] - directions[at, e, 0] < least:
            free, least = e, directions[at, e, 1] - directions[at, e, 0]
    if free == MOST:
        return
    counts[at, USED] = max(counts[at, USED], free + 1)
    directions[at, free, 0], directions[at, free, 1], before[at, free] = low, high, entry


@kernel(f"void({_COUNTS}, {_DIRECTIONS}, {_ENTRIES}, int64, int64, float64, float64, float64, float64)", counts=False)
def _extend(counts, directions, before, source, at, chord, least, most, bend):
    """Extend all paths to place `source` by a piece to place `at` with halves of its sweep between two.

    It leaves in the direction chord - half, which is no farther than `bend` from that in which the path arrives.
    """
    for e in range(counts[source, USED]):
        low, high = least, most
        if bend < math.pi:
            arrives = 0.5 * (directions[source, e, 0] + directions[source, e, 1])
            # Directions are known but for whole turns: the chord's is taken within half a turn of the arrival's.
            turned = chord - 2.0 * math.pi * round((chord - arrives) / (2.0 * math.pi))
            low = max(low, turned - directions[source, e, 1] - bend)
            high = min(high, turned - directions[source, e, 0] + bend)
        if low <= high:
            _keep(
                counts, directions, before, at, counts[source, PIECES] + 1, chord + low, chord + high, source * MOST + e
            )


@kernel(
    f"boolean({_SAMPLES}, int64[::1], {_STATES}, float64[::1], int64, int64, float64, float64, {_COUNTS}, "
    f"{_DIRECTIONS}, {_ENTRIES}, int64[::1])"
)
def _reach(samples, at, states, aside, i, j, longest, limit, counts, directions, before, hardest):
    """Extend all paths to state i by a piece to state j, an arc where no chord is too long; tell whether the points
    allow about one.
    """
    first, last = at[i] + 1, at[j] - 1
    low, high = _window(samples, first, last, states[i, X], states[i, Y], states[j, X], states[j, Y], _RELAXED, hardest)
    if low > high:
        return False
    ways = len(aside)
    for k in range(ways):
        source = i * ways + k
        if counts[source, USED] == 0:
            continue
        ax, ay = states[i, X] + aside[k] * states[i, LEFT_X], states[i, Y] + aside[k] * states[i, LEFT_Y]
        for n in range(ways if j < len(states) - 1 else 1):
            there = j * ways + n
            if counts[there, PIECES] <= counts[source, PIECES]:
                continue
            bx, by = states[j, X] + aside[n] * states[j, LEFT_X], states[j, Y] + aside[n] * states[j, LEFT_Y]
            size = math.hypot(bx - ax, by - ay)
            if k + n > 0 and size < _SHORTEST * limit:
                continue
            low, high = _window(samples, first, last, ax, ay, bx, by, 1.0, hardest)
            if low <= high:
                least, most = _halves(low, high, size, longest <= _EVEN * size, limit)
                if least <= most:
                    _extend(
                        counts,
                        directions,
                        before,
                        source,
                        there,
                        math.atan2(by - ay, bx - ax),
                        least,
                        most,
                        states[i, BEND],
                    )
    return True


@kernel(
    f"void({_SAMPLES}, int64[::1], {_STATES}, int64[::1], float64[::1], float64, {_COUNTS}, {_DIRECTIONS}, {_ENTRIES})"
)
def search(samples, at, states, points, aside, limit, counts, directions, before):
    """Find the paths of the fewest pieces from the first state to all others.

    Args:
        samples: (m, 3) places of the polyline, and how far pieces may be from each, mm.
        at: (n,) of each state its sample, rising.
        states: (n, 6) see X to CHORD.
        points: (n,) of each state its point: pieces over few chords are lines.
        aside: (w,) of the places beside a point their shares of the way to the left, the point itself first.
        limit: how far pieces may be from the points, mm.
        counts: (n w, 2) of each place the pieces of its paths, and its entries; of the first place one is given.
        directions: (n w, MOST, 2) of each entry the lowest and the highest direction of arrival, radians.
        before: (n w, MOST) the entry that it goes on from.
    """
    count, ways, hardest = len(states), len(aside), np.zeros(1, np.int64)
    # Pieces run forward: all paths to state i are there when its turn comes, so one pass finds the fewest.
    for i in range(count - 1):
        missed, longest, j, paths = 0, 0.0, i + 1, counts[i * ways : (i + 1) * ways, USED].sum()
        while paths > 0 and j < count and missed < _PATIENCE:
            longest = max(longest, states[j, CHORD])
            chord = longest if points[j] - points[i] >= _LEAST_CHORDS else np.inf
            missed = (
                0
                if _reach(samples, at, states, aside, i, j, chord, limit, counts, directions, before, hardest)
                else missed + 1
            )
            j += 1


@kernel("float64(float64, float64, float64, float64, float64)", counts=False)
def _chosen(low, high, size, largest, slight):
    """Return one of the halves of a sweep between two: their middle, or a line's where that is as good as one, or
    flatter than may be.
    """
    half = 0.5 * (low + high)
    flattest = math.asin(min(0.5 * size / largest, 1.0))
    if low <= 0.0 <= high and (abs(half) < flattest or 0.5 * size * math.tan(0.5 * abs(half)) <= slight):
        return 0.0
    if abs(half) >= flattest:
        return half
    side = 1.0 if half > 0.0 else -1.0
    return side * flattest if abs(high if half > 0.0 else low) >= flattest else 0.0


@kernel(
    f"int64({_STATES}, float64[::1], float64, float64, {_COUNTS}, {_DIRECTIONS}, {_ENTRIES}, int64[::1], float64[::1], "
    "float64[::1])"
)
def trace(states, aside, largest, slight, counts, directions, before, rows, left, half):
    """Write the path of the fewest pieces to the last state, from its end on, and return how many they are; 0: there is
    none.

    Args:
        largest: radius, mm: what is flatter is a line. slight: so is an arc no higher over its chord, where it may, mm.
        rows: (n,) out: the state where each piece begins. left: (n,) out: that joint's share of the farthest to the
            left.
        half: (n,) out: half of each sweep, radians, positive to the left; 0 a line.
    """
    ways, best = len(aside), 0
    at = (len(states) - 1) * ways
    if counts[at, USED] == 0:
        return 0
    pieces, low, high = counts[at, PIECES], -np.inf, np.inf
    for n in range(pieces):
        source, e = before[at, best] // MOST, before[at, best] % MOST
        i, j, share, other = source // ways, at // ways, aside[source % ways], aside[at % ways]
        dx = states[j, X] + other * states[j, LEFT_X] - states[i, X] - share * states[i, LEFT_X]
        dy = states[j, Y] + other * states[j, LEFT_Y] - states[i, Y] - share * states[i, LEFT_Y]
        chord, size = math.atan2(dy, dx), math.hypot(dx, dy)
        least, most = max(low, directions[at, best, 0]) - chord, min(high, directions[at, best, 1]) - chord
        rows[n], left[n], half[n] = i, share, _chosen(least, most, size, largest, slight)
        leaves, bend = chord - half[n], states[i, BEND]
        turned = (
            2.0
            * math.pi
            * round((0.5 * (directions[source, e, 0] + directions[source, e, 1]) - leaves) / (2.0 * math.pi))
        )
        # Now that this piece's way out is chosen, the one before must arrive within a bend of it.
        low, high = (leaves + turned - bend, leaves + turned + bend) if bend < math.pi else (-np.inf, np.inf)
        at, best = source, e
    return pieces
