# mypy: allow-untyped-defs
"""Compiled inner loops of the tour: who comes after whom so that the tool travels little between strokes.

Stroke 0 is the place where the tool is before the first one; the others are 1 … n. `ends` (n + 1, 4) holds where each
begins and ends, x0, y0, x1, y1. `order` (n + 1,) lists the strokes, 0 first; `place` (n + 1,) tells where each stands
in it. With `mirrored` a stroke may be travelled from its end to its beginning: whatever turns a run of strokes round
also swaps their ends, and `turned` (n + 1,) remembers that.

A tour is (ends, order, place, turned, near, rules, queue, log, state): `near` (n + 1, m) strokes near each one, -1
where there are fewer; `rules`, who must be cut before whom; `queue` (2 (n + 1),) strokes that wait to be looked at, in
a ring, and for each stroke whether it waits; `log` (m, 2) the turns made; `state` (6,) the number from which chance
goes on, first in the queue, how many wait, how many turns are in the log, work done, mirrored.

Rules are two lists of lists, (after_first, after, before_first, before): those of stroke a are
after[after_first[a]:after_first[a + 1]], who must all be cut later than a, and earlier in the other.
"""

from __future__ import annotations

import math

import numpy as np

from ...core.jit import kernel

_LEAST = 1e-9
"""mm; what shortens the tour by less is rounding."""

_RUN = 3
"""Strokes that move to another place together (Or-opt)."""

_KICK = 50
"""Strokes at most in each of the two runs that a kick swaps."""

_WAITING, _TURNS, _WORK, _MIRRORED = 2, 3, 4, 5
"""Numbers of `state`: strokes in the queue, turns in the log, the work done so far, whether strokes may be
turned round.
"""

_RULES = "Tuple((int64[::1], int64[::1], int64[::1], int64[::1]))"
_BUCKETS = "Tuple((int64[:, ::1], int64[::1], float64[::1]))"
_TOUR = (
    f"Tuple((float64[:, ::1], int64[::1], int64[::1], boolean[::1], int64[:, ::1], {_RULES}, int64[::1], int64[:, "
    "::1], int64[::1]))"
)


@kernel("float64(float64[:, ::1], int64, int64, int64, int64)", counts=False)
def _gap(ends, a, side_a, b, side_b):
    """Return how far one end (0 begin, 2 end) of stroke a is from one of stroke b; beyond the last stroke, b < 0,
    nothing is.
    """
    if b < 0:
        return 0.0
    dx, dy = ends[b, side_b] - ends[a, side_a], ends[b, side_b + 1] - ends[a, side_a + 1]
    return math.sqrt(dx * dx + dy * dy)


@kernel("int64(int64[::1], int64)", counts=False)
def _at(order, p):
    return order[p] if p < len(order) else -1


@kernel("float64(float64[:, ::1], int64[::1], int64, int64)", counts=False)
def _way(ends, order, p, q):
    """Return the travel from the stroke at place p to the one at place q."""
    return _gap(ends, order[p], 2, _at(order, q), 0)


@kernel("float64(float64[:, ::1], int64[::1])")
def travel(ends, order):
    """Return the whole travel of an order, mm."""
    total = 0.0
    for p in range(len(order) - 1):
        total += _way(ends, order, p, p + 1)
    return total


@kernel(f"Tuple((float64, int64))({_BUCKETS}, float64[:, ::1], int64[::1], int64, int64, int64, int64, float64, int64)")
def _nearest_in(buckets, ends, waiting, a, row, first, last, best, chosen):
    """Return how far the end of stroke a is from the nearest stroke that may be cut and begins in some buckets of a
    row, and which it is; what was found before where that is nearer, or as near and a lower number.
    """
    starts, strokes = buckets[0], buckets[1]
    for k in range(starts[row, max(first, 0)], starts[row, min(last, starts.shape[1] - 2) + 1]):
        b = strokes[k]
        if waiting[b] == 0:
            d = _gap(ends, a, 2, b, 0)
            if d < best or (d == best and b < chosen):
                best, chosen = d, b
    return best, chosen


@kernel(f"int64({_BUCKETS}, float64[:, ::1], int64[::1], int64)")
def _nearest_waiting(buckets, ends, waiting, a):
    """Return the stroke that begins nearest to the end of stroke a of those that may be cut, of several the one of the
    lowest number; -1 where there is none.

    Rings of buckets round the end are looked through, until the next ring is farther than what was found.
    """
    starts, grid = buckets[0], buckets[2]
    rows, columns, side = starts.shape[0], starts.shape[1] - 1, grid[2]
    x, y = ends[a, 2] - grid[0], ends[a, 3] - grid[1]
    # outside of the grid an end is as if in the bucket beside it, and then no bucket is nearer than that
    column, row = min(max(math.floor(x / side), 0), columns - 1), min(max(math.floor(y / side), 0), rows - 1)
    best, chosen = math.inf, -1
    for ring in range(max(rows, columns)):
        # how far the nearest bucket is that was not looked at: on the sides where there are any
        room = x - (column - ring + 1) * side if column >= ring else math.inf
        room = min(room, (column + ring) * side - x) if column + ring < columns else room
        room = min(room, y - (row - ring + 1) * side) if row >= ring else room
        room = min(room, (row + ring) * side - y) if row + ring < rows else room
        if chosen >= 0 and room > best + _LEAST:
            break
        for r in range(max(row - ring, 0), min(row + ring, rows - 1) + 1):
            if r in (row - ring, row + ring):
                best, chosen = _nearest_in(buckets, ends, waiting, a, r, column - ring, column + ring, best, chosen)
                continue
            if column - ring >= 0:
                left = column - ring
                best, chosen = _nearest_in(buckets, ends, waiting, a, r, left, left, best, chosen)
            if column + ring < columns:
                right = column + ring
                best, chosen = _nearest_in(buckets, ends, waiting, a, r, right, right, best, chosen)
    return chosen


@kernel(f"void(float64[:, ::1], {_RULES}, {_BUCKETS}, int64[::1], int64[::1], int64, int64)")
def greedy(ends, rules, buckets, waiting, order, first, last):
    """Write places first … last - 1 of an order that always goes on to the stroke that begins nearest; -1 where none
    may be cut.

    Args:
        buckets: strokes by the square that they begin in: first of each square (rows, columns + 1), the strokes square
            by square, and (x0, y0, a square's side). Those that are in the order already are taken out now and then.
        waiting: (n + 1,) how many strokes each one still waits for; -1 = it is in the order already.
    """
    after_first, after = rules[0], rules[1]
    for p in range(first, last):
        chosen = _nearest_waiting(buckets, ends, waiting, order[p - 1])
        order[p] = chosen
        if chosen < 0:
            return
        waiting[chosen] = -1
        for k in range(after_first[chosen], after_first[chosen + 1]):
            waiting[after[k]] -= 1


@kernel("float64(float64[:, ::1], int64[::1], int64, int64, boolean)", counts=False)
def _more_within(ends, order, i, j, mirrored):
    """Return by how much the travel within places i … j grows when they are gone through the other way."""
    more = 0.0
    # where strokes may be travelled either way, their ends swap with the order and nothing within changes
    if not mirrored:
        for p in range(i, j):
            more += _way(ends, order, p + 1, p) - _way(ends, order, p, p + 1)
    return more


@kernel("float64(float64[:, ::1], int64[::1], int64, int64, boolean)", counts=False)
def _turn_gain(ends, order, i, j, mirrored):
    """Return by how much the tour is shortened when places i … j are gone through the other way (2-opt)."""
    behind, a, b, ahead = order[i - 1], order[i], order[j], _at(order, j + 1)
    gain = _way(ends, order, i - 1, i) + _way(ends, order, j, j + 1)
    if mirrored:
        return gain - _gap(ends, behind, 2, b, 2) - _gap(ends, a, 0, ahead, 0)
    gain -= _gap(ends, behind, 2, b, 0) + _gap(ends, a, 2, ahead, 0)
    return gain - _more_within(ends, order, i, j, mirrored) if gain > _LEAST else 0.0


@kernel("float64(float64[:, ::1], int64[::1], int64, int64, int64, int64, boolean, float64)", counts=False)
def _swap_gain(ends, order, kind, i, j, k, mirrored, least):
    """Return by how much the tour is shortened when places i … j and j + 1 … k change places; no more than `least`
    where it is surely not by more: most changes are ruled out by the first of the three new ways.

    kind: 0 both are gone through as before, 1 the first one the other way, 2 the second one the other way.
    """
    # three ways go, three come: before - b, b - a, a - after
    a0, a1, b0, b1 = order[i], order[j], order[j + 1], order[k]
    in_a, out_a, in_b, out_b = 0, 2, 0, 2
    gain = _way(ends, order, i - 1, i) + _way(ends, order, j, j + 1) + _way(ends, order, k, k + 1)
    if kind == 1:
        a0, a1 = a1, a0
        gain -= _more_within(ends, order, i, j, mirrored)
        if mirrored:
            in_a, out_a = 2, 0
    if kind == 2:
        b0, b1 = b1, b0
        gain -= _more_within(ends, order, j + 1, k, mirrored)
        if mirrored:
            in_b, out_b = 2, 0
    gain -= _gap(ends, order[i - 1], 2, b0, in_b)
    if gain <= least:
        return gain
    gain -= _gap(ends, b1, out_b, a0, in_a)
    if gain <= least:
        return gain
    return gain - _gap(ends, a1, out_a, _at(order, k + 1), 0)


@kernel(f"boolean({_TOUR}, int64, int64)", counts=False)
def _may_turn(tour, i, j):
    """Tell whether none of places i … j has to come before another of them."""
    order, place, after_first, after = tour[1], tour[2], tour[5][0], tour[5][1]
    for p in range(i, j + 1):
        for m in range(after_first[order[p]], after_first[order[p] + 1]):
            # later than p anyway, as the order keeps the rules: so it stands in the run
            if place[after[m]] <= j:
                return False
    return True


@kernel(f"boolean({_TOUR}, int64, int64, int64)", counts=False)
def _may_swap(tour, i, j, k):
    """Tell whether none of places i … j has to come before one of j + 1 … k; the shorter run is asked."""
    order, place, rules = tour[1], tour[2], tour[5]
    after_first, after, before_first, before = rules
    if j - i < k - j:
        for p in range(i, j + 1):
            for m in range(after_first[order[p]], after_first[order[p] + 1]):
                if j < place[after[m]] <= k:
                    return False
        return True
    for p in range(j + 1, k + 1):
        for m in range(before_first[order[p]], before_first[order[p] + 1]):
            if i <= place[before[m]] <= j:
                return False
    return True


@kernel(f"void({_TOUR}, int64, int64)", counts=False)
def _turn(tour, i, j):
    """Go through places i … j the other way."""
    ends, order, place, turned, state = tour[0], tour[1], tour[2], tour[3], tour[8]
    state[_WORK] += (j - i) // 4
    if state[_MIRRORED]:
        for p in range(i, j + 1):
            a = order[p]
            turned[a] = not turned[a]
            ends[a, 0], ends[a, 1], ends[a, 2], ends[a, 3] = ends[a, 2], ends[a, 3], ends[a, 0], ends[a, 1]
    while i < j:
        order[i], order[j] = order[j], order[i]
        place[order[i]], place[order[j]] = i, j
        i, j = i + 1, j - 1


@kernel(f"void({_TOUR}, int64, int64)", counts=False)
def _log_and_turn(tour, i, j):
    log, state = tour[7], tour[8]
    log[state[_TURNS], 0], log[state[_TURNS], 1] = i, j
    state[_TURNS] += 1
    _turn(tour, i, j)


@kernel(f"void({_TOUR}, int64)", counts=False)
def _note(tour, a):
    """Put a stroke at the end of the queue unless it waits there already."""
    queue, state = tour[6], tour[8]
    size = len(queue) // 2
    if a >= 0 and queue[size + a] == 0:
        queue[size + a] = 1
        queue[(state[1] + state[_WAITING]) % size] = a
        state[_WAITING] += 1


@kernel(f"int64({_TOUR})", counts=False)
def _next(tour):
    """Take the first stroke out of the queue."""
    queue, state = tour[6], tour[8]
    size = len(queue) // 2
    a = queue[state[1]]
    queue[size + a] = 0
    state[1] = (state[1] + 1) % size
    state[_WAITING] -= 1
    return a


@kernel(f"void({_TOUR}, int64, int64, int64, int64)", counts=False)
def _apply(tour, kind, i, j, k):
    """Make a change and log it: 0 to 2 swap i … j with j + 1 … k (see `_swap_gain`), 3 turns i … j. Who has new
    neighbours waits.
    """
    order = tour[1]
    for p in (i - 1, i, j, j + 1):
        _note(tour, _at(order, p))
    if kind < 3:
        _note(tour, order[k])
        _note(tour, _at(order, k + 1))
        # turning a run twice leaves it as it was: both runs and then the whole turned is a swap of the two
        if kind != 1:
            _log_and_turn(tour, i, j)
        if kind != 2:
            _log_and_turn(tour, j + 1, k)
        j = k
    _log_and_turn(tour, i, j)


@kernel("float64(float64[:, ::1], int64, int64, boolean)", counts=False)
def _apart(ends, a, c, mirrored):
    """Return the shortest way from one of two strokes to the other."""
    least = min(_gap(ends, a, 2, c, 0), _gap(ends, c, 2, a, 0))
    return min(least, _gap(ends, a, 2, c, 2), _gap(ends, a, 0, c, 0)) if mirrored else least


@kernel(f"float64({_TOUR}, float64, int64[::1], int64, int64, int64, int64)", counts=False)
def _better(tour, best, change, kind, i, j, k):
    """Return what a change gains when it is allowed and gains more than the best so far, and write it; else the best so
    far.
    """
    order, state = tour[1], tour[8]
    mirrored = state[_MIRRORED] != 0
    state[_WORK] += 1
    if not 1 <= i <= j or (kind < 3 and j >= k) or max(j, k) >= len(order):
        return best
    gain = (
        _turn_gain(tour[0], order, i, j, mirrored)
        if kind == 3
        else _swap_gain(tour[0], order, kind, i, j, k, mirrored, best)
    )
    if gain <= best or (kind < 3 and not _may_swap(tour, i, j, k)):
        return best
    if (kind in (1, 3) and not _may_turn(tour, i, j)) or (kind == 2 and not _may_turn(tour, j + 1, k)):
        return best
    change[0], change[1], change[2], change[3] = kind, i, j, k
    return gain


@kernel(f"float64({_TOUR}, float64, int64[::1], int64, int64)", counts=False)
def _runs_beside(tour, best, change, p, q):
    """Look at moving the run of up to three strokes that begins or ends at place p beside the stroke at place q
    (Or-opt).
    """
    for run in range(_RUN):
        for side in range(4 if run else 2):
            # the runs that begin at p, then those that end there; one stroke alone is the same both ways
            s, e = (p, p + run) if side < 2 else (p - run, p)
            if s <= q <= e:
                continue
            if q > e:
                i, j, k, other = s, e, q - side % 2, 1
            else:
                i, j, k, other = q + 1 - side % 2, s - 1, e, 2
            best = _better(tour, best, change, 0, i, j, k)
            best = _better(tour, best, change, other, i, j, k)
    return best


@kernel(f"float64({_TOUR}, float64, int64[::1], int64, int64)", counts=False)
def _swaps_after(tour, best, change, p, q):
    """Look at swaps of runs of any length that bring the stroke at place q behind the one at place p (3-opt without
    turning).
    """
    order, place, near = tour[1], tour[2], tour[4]
    if p + 1 >= len(order):
        return best
    for y in near[order[p + 1]]:
        if y < 0:
            break
        t = place[y]
        if q > p + 1 and t >= q:
            best = _better(tour, best, change, 0, p + 1, q - 1, t)
        elif q <= t < p:
            best = _better(tour, best, change, 0, q, t, p)
    return best


@kernel(f"float64({_TOUR}, int64, int64[::1])", counts=False)
def _improve(tour, a, change):
    """Make the best change that brings stroke a beside one of those near it; return by how much it shortens the tour,
    or 0.
    """
    ends, order, place, near, state = tour[0], tour[1], tour[2], tour[4], tour[8]
    p, best = place[a], _LEAST
    out = _way(ends, order, p, p + 1)
    longest = max(out, _way(ends, order, p - 1, p) if p else 0.0)
    change[0] = -1
    for c in near[a]:
        if c < 0:
            break
        state[_WORK] += 1
        # a change must make one of a's own ways shorter; a stroke as far as both of them cannot
        if _apart(ends, a, c, state[_MIRRORED] != 0) >= longest:
            continue
        q = place[c]
        low, high = min(p, q), max(p, q)
        best = _better(tour, best, change, 3, low + 1, high, 0)
        best = _better(tour, best, change, 3, low, high - 1, 0)
        best = _runs_beside(tour, best, change, p, q)
        if _gap(ends, a, 2, c, 0) < out:
            best = _swaps_after(tour, best, change, p, q)
    if change[0] < 0:
        return 0.0
    _apply(tour, change[0], change[1], change[2], change[3])
    return best


@kernel(f"float64({_TOUR}, int64, int64[::1])", counts=False)
def _settle(tour, until, change):
    """Improve round the strokes in the queue until none is left, the log is full or the work is done; return by how
    much in all.
    """
    log, state, total = tour[7], tour[8], 0.0
    while state[_WAITING] > 0 and state[_TURNS] + 3 <= len(log) and state[_WORK] < until:
        a = _next(tour)
        gain = _improve(tour, a, change)
        if gain > 0:
            total += gain
            _note(tour, a)
    return total


@kernel(f"void({_TOUR}, int64)")
def settle(tour, until):
    """Shorten a tour round the strokes in the queue, until none is left there or so much work is done."""
    state, change = tour[8], np.empty(4, np.int64)
    while state[_WAITING] > 0 and state[_WORK] < until:
        state[_TURNS] = 0
        _settle(tour, until, change)


@kernel("int64(int64[::1], int64)", counts=False)
def _chance(state, count):
    """Return a number in [0, count), the same ones in the same order every time (Lehmer's generator)."""
    state[0] = state[0] * 48271 % 2147483647
    return state[0] % count


@kernel(f"void({_TOUR}, int64)")
def kick(tour, until):
    """Swap two runs somewhere, settle, and take it all back if the tour is longer then; again until so much work is
    done.
    """
    order, log, state, change = tour[1], tour[7], tour[8], np.empty(4, np.int64)
    n = len(order) - 1
    while n > 1 and state[_WORK] < until:
        first, second = 1 + _chance(state, min(_KICK, n // 2)), 1 + _chance(state, min(_KICK, n // 2))
        i = 1 + _chance(state, n + 1 - first - second)
        j, k = i + first - 1, i + first + second - 1
        # kicks that the rules forbid count as work too, else a job of nothing but rules would never end
        state[_WORK] += 10
        if not _may_swap(tour, i, j, k):
            continue
        state[_TURNS] = 0
        gain = _swap_gain(tour[0], order, 0, i, j, k, state[_MIRRORED] != 0, -math.inf)
        _apply(tour, 0, i, j, k)
        gain += _settle(tour, 1 << 62, change)
        while state[_WAITING] > 0:  # the log is full
            _next(tour)
        if gain < 0:
            for m in range(state[_TURNS] - 1, -1, -1):
                _turn(tour, log[m, 0], log[m, 1])


@kernel("float64(float64[:, ::1], int64[::1], boolean, int64[::1], boolean[::1])")
def shortest(ends, needed, mirrored, order, turned):
    """Write the shortest order of few strokes, 16 at most, and which of them are turned; return its travel.

    Args:
        needed: (n + 1,) bits of the strokes, 1 << (stroke - 1), that each one comes after.

    References:
        Held and Karp's dynamic programme over the sets of strokes that are done.
    """
    n, ways = len(order) - 1, 2 if mirrored else 1
    best, came = np.full((1 << n, 2 * n), math.inf), np.zeros((1 << n, 2 * n), np.int64)
    for done in range(1 << n):
        for last in range(2 * n if done else 1):
            so_far = best[done, last] if done else 0.0
            if so_far == math.inf:
                continue
            # an even last is a stroke gone through forwards, left at its end (2); an odd one backwards, at its
            # beginning (0)
            a, out = (1 + last // 2, 2 - 2 * (last % 2)) if done else (0, 2)
            for b in range(1, n + 1):
                bit = 1 << (b - 1)
                if done & bit or needed[b] & ~done:
                    continue
                for way in range(ways):
                    total = so_far + _gap(ends, a, out, b, 2 * way)
                    if total < best[done | bit, 2 * (b - 1) + way]:
                        best[done | bit, 2 * (b - 1) + way], came[done | bit, 2 * (b - 1) + way] = total, last
    done = (1 << n) - 1
    last = int(np.argmin(best[done]))
    total = best[done, last]
    order[0] = 0
    for p in range(n, 0, -1):
        order[p], turned[1 + last // 2] = 1 + last // 2, last % 2 == 1
        done, last = done & ~(1 << (last // 2)), came[done, last]
    return total
