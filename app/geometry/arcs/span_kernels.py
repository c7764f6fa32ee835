# mypy: allow-untyped-defs
"""Compiled: spans of a plane curve, each replaced by a line or by two arcs that meet without a bend, and how far these
are off.

A row tells a span: its two parameters, where what replaces it begins, meets and ends, centre and turn (+1
counter-clockwise, -1 clockwise, 0 a line) of both parts, and how many of them there are.
"""

from __future__ import annotations

import math

import numpy as np

from ...core import tolerances
from ...core.jit import kernel
from .bezier_kernels import cut, direction, off_circle, off_line, place
from .biarc_kernels import LINE, NONE, from_tangent, meeting

_CONTROL, _PIECE, _FOUND = "float64[:, :, ::1]", "float64[:, ::1]", "float64[::1]"
FIRST, LAST, X0, Y0, X1, Y1, X2, Y2, CX, CY, TURN, DX, DY, DTURN, PARTS = range(15)
"""Columns of a row; D stands for the second part."""
COLUMNS = 15
_PART_START, _PART_END, _PART_CENTRE, _PART_TURN = 0, 2, 4, 6
"""Numbers of one part of a row: two each of its start, its end and its centre, and its turn."""
_SMALLEST = 1e-9
"""A stretch of parameter below which a corner that no arc can follow becomes a line."""
_TURNS_BACK = 0.6
"""A chord of less than so much of its span's length turns back."""
_SAMPLES, _EACH = 16, 8
"""Parts that a span is cut in to be measured, and that a piece is, whichever are more."""
_TRIALS, _BISECTIONS, _PARTS = 60, 48, 6
"""Spans that are tried for one; halvings of a span for the place where its parts meet; parts of it that are bounded
one by one, as short ones are bounded more tightly.
"""


@kernel("float64(float64, float64, float64, float64, float64, float64, float64, float64, float64)", counts=False)
def _apart(x, y, ax, ay, bx, by, cx, cy, turn):
    """Return the distance of a place from a line or arc from a to b."""
    px, py = x - ax, y - ay
    if turn == 0.0:
        dx, dy = bx - ax, by - ay
        share = min(max((px * dx + py * dy) / max(dx * dx + dy * dy, 1e-300), 0.0), 1.0)
        return math.hypot(px - share * dx, py - share * dy)
    ox, oy, rx, ry = px - (cx - ax), py - (cy - ay), ax - cx, ay - cy
    ex, ey = bx - cx, by - cy
    sweep = (turn * math.atan2(rx * ey - ry * ex, rx * ex + ry * ey)) % (2.0 * math.pi)
    if (turn * math.atan2(rx * oy - ry * ox, rx * ox + ry * oy)) % (2.0 * math.pi) <= sweep:
        # |o|² - |r|² = |p|² + 2 p·r over |o| + |r|: large radii are not taken from each other.
        return abs(px * px + py * py + 2.0 * (px * rx + py * ry)) / (math.hypot(ox, oy) + math.hypot(rx, ry))
    return min(math.hypot(px, py), math.hypot(x - bx, y - by))


@kernel(f"boolean({_FOUND}, float64, float64, float64, float64)", counts=False)
def _put_biarc(row, out_x, out_y, in_x, in_y):
    """Write the line or the two arcs between a row's ends that leave and arrive in unit directions; tell whether there
    are any.
    """
    start, end = (row[X0], row[Y0]), (row[X2], row[Y2])
    exists, x, y = meeting(start, (out_x, out_y), end, (in_x, in_y))
    if not exists:
        return False
    first, row[CX], row[CY], row[TURN] = from_tangent(start, (out_x, out_y), (x, y))
    last, row[DX], row[DY], back = from_tangent(end, (-in_x, -in_y), (x, y))
    if first == NONE or last == NONE:
        return False
    row[X1], row[Y1], row[DTURN], row[PARTS] = x, y, -back, 2.0
    off = abs((end[0] - start[0]) * out_y - (end[1] - start[1]) * out_x)
    if first == LINE and last == LINE and off < tolerances.WELD:
        row[PARTS] = 1.0
    return True


@kernel(f"float64({_CONTROL}, float64, float64, float64, {_PIECE}, {_PIECE}, {_FOUND})")
def _trial(control, first, last, still, work, places, row):
    """Write what replaces a span, its chord where it turns back; return its greatest distance from samples, mm."""
    count, length = max(_SAMPLES, _EACH * math.ceil(last - first)), 0.0
    found = places[len(places) - 1]
    for k in range(count + 1):
        place(control, first + k * ((last - first) / count) if k < count else last, work, found)
        places[k, 0], places[k, 1] = found[0], found[1]
        length += math.hypot(places[k, 0] - places[k - 1, 0], places[k, 1] - places[k - 1, 1]) if k > 0 else 0.0
    row[FIRST], row[LAST], row[X0], row[Y0], row[X2], row[Y2] = (
        first,
        last,
        places[0, 0],
        places[0, 1],
        places[count, 0],
        places[count, 1],
    )
    row[TURN], row[PARTS] = 0.0, 1.0
    # Where the span turns back its tangents say nothing about a biarc: its chord stands for it, and is off as it is.
    if math.hypot(row[X2] - row[X0], row[Y2] - row[Y0]) > _TURNS_BACK * length:
        out_x, out_y = direction(control, first, True, still, work, found)
        in_x, in_y = direction(control, last, False, still, work, found)
        if not _put_biarc(row, out_x, out_y, in_x, in_y):
            row[TURN], row[PARTS] = 0.0, 1.0
    worst = 0.0
    for k in range(1, count):
        x, y = places[k, 0], places[k, 1]
        if row[PARTS] == 1.0:
            off = _apart(x, y, row[X0], row[Y0], row[X2], row[Y2], 0.0, 0.0, 0.0)
        else:
            off = min(
                _apart(x, y, row[X0], row[Y0], row[X1], row[Y1], row[CX], row[CY], row[TURN]),
                _apart(x, y, row[X1], row[Y1], row[X2], row[Y2], row[DX], row[DY], row[DTURN]),
            )
        worst = max(worst, off)
    return worst


@kernel(f"float64({_CONTROL}, float64, float64, float64, float64, float64, {_PIECE}, {_PIECE}, {_FOUND}, {_FOUND})")
def _longest(control, first, last, step, target, still, work, places, trial, row):
    """Write about the longest span from a parameter on that stays within the target; return a step to try next.

    The error of a biarc grows with the third power of its length, so few trials find the length.
    """
    held, end = False, last
    for _ in range(_TRIALS):
        end = last if first + step * 1.05 >= last else first + step
        error = _trial(control, first, end, still, work, places, trial)
        factor = 0.95 * (target / max(error, target * 1e-3)) ** (1.0 / 3.0)
        if error <= target:
            for c in range(COLUMNS):
                row[c] = trial[c]
            # `held`: a shorter span has been good, and stands in the row; the next failure ends the search.
            if end == last or factor < 1.2 or held:
                return (end - first) * min(max(factor, 0.7), 2.0)
            held, step = True, (end - first) * min(factor, 2.0)
            continue
        if held:
            return row[LAST] - row[FIRST]
        step = (end - first) * min(max(factor, 0.1), 0.7)
        if step < _SMALLEST:
            break
    for c in range(COLUMNS):
        row[c] = trial[c]
    # Not even the shortest stretch is near an arc: a corner, which its chord passes; beyond it steps begin small.
    row[TURN], row[PARTS] = 0.0, 1.0
    return 1e-3


@kernel(f"int64({_CONTROL}, {_FOUND}, float64, float64, float64, {_PIECE})")
def cover(control, state, last, target, still, rows):
    """Cover a curve with spans, each about the longest within a target, until they end or the rows are full; return how
    many there are.

    Args:
        state: (2,) the parameter that they begin at, and a step to try; both out: where to go on.
        last: the parameter that they end at. target: mm.
        still: a chord no longer than this, mm, has no direction.
        rows: (k, COLUMNS) out.
    """
    work, trial = np.empty((control.shape[1], 3)), np.zeros(COLUMNS)
    # Its last row is where `place` writes before x and y are taken over.
    places, count = np.empty((max(_SAMPLES, _EACH * math.ceil(last - state[0] + 1.0)) + 2, 4)), 0
    while state[0] < last and count < len(rows):
        state[1] = _longest(control, state[0], last, state[1], target, still, work, places, trial, rows[count])
        state[0] = rows[count, LAST]
        count += 1
    return count


@kernel(f"float64({_CONTROL}, {_FOUND}, {_PIECE}, {_FOUND})", counts=False)
def _share(control, row, work, found):
    """Return the parameter where a span's two parts share it: where the curve crosses their common normal."""
    low, high = row[FIRST], row[LAST]
    x, y = row[X1] - row[X0], row[Y1] - row[Y0]
    if row[TURN] != 0.0:
        # Square to the radius, in the arc's own sense: before the joint the curve's offset along it is negative.
        x, y = -row[TURN] * (row[Y1] - row[CY]), row[TURN] * (row[X1] - row[CX])
    for _ in range(_BISECTIONS):
        middle = (low + high) / 2
        place(control, middle, work, found)
        if (found[0] - row[X1]) * x + (found[1] - row[Y1]) * y < 0.0:
            low = middle
        else:
            high = middle
    return (low + high) / 2


@kernel(f"float64({_CONTROL}, float64, float64, {_FOUND}, {_CONTROL}, {_PIECE}, {_PIECE})", counts=False)
def _bound(control, first, last, part, products, work, piece):
    """Return a bound of how far a curve between two parameters is from a line or arc: start, end, centre, turn.

    It is cut in a few parts, and wherever a piece ends.
    """
    worst, at, n = 0.0, first, 1
    while at < last or n == 1:
        even = first + n * (last - first) / _PARTS if n < _PARTS else last
        # Bernstein form speaks of one piece: parts end where pieces do, and what is left of an even part comes next.
        until = min(even, math.floor(at) + 1.0, last)
        n += until >= even
        cut(control, at, until, work, piece)
        x, y = part[_PART_START], part[_PART_START + 1]
        if part[_PART_TURN] == 0.0:
            worst = max(worst, off_line(piece, x, y, part[_PART_END], part[_PART_END + 1]))
        else:
            worst = max(worst, off_circle(piece, x, y, part[_PART_CENTRE], part[_PART_CENTRE + 1], products))
        at = until
    return worst


@kernel(f"void({_FOUND}, int64, int64, int64, {_FOUND})")
def _take(row, start, end, centre, part):
    """Write the piece of a row that begins, ends and has its centre and turn from these columns on: x0, y0, x1, y1, cx,
    cy, turn. Number by number, see `geometry.kernels.enlarged`.
    """
    for k in range(2):
        part[_PART_START + k], part[_PART_END + k] = row[start + k], row[end + k]
    for k in range(3):  # the turn stands behind the centre
        part[_PART_CENTRE + k] = row[centre + k]


@kernel(f"void({_CONTROL}, {_PIECE}, {_CONTROL}, {_FOUND})")
def bounds(control, rows, products, found):
    """Write for each row (k, COLUMNS) a bound of its distance from the span that it replaces, both ways, mm.

    Args:
        products: see `off_circle`. found: (k,) out.
    """
    work, piece, part, here = np.empty((control.shape[1], 3)), np.empty((control.shape[1], 3)), np.empty(7), np.empty(4)
    for k in range(len(rows)):
        row = rows[k]
        _take(row, X0, X2, CX, part)
        if row[PARTS] == 1.0:
            part[_PART_TURN] = 0.0
            found[k] = _bound(control, row[FIRST], row[LAST], part, products, work, piece)
            continue
        shared = _share(control, row, work, here)
        _take(row, X0, X1, CX, part)
        found[k] = _bound(control, row[FIRST], shared, part, products, work, piece)
        _take(row, X1, X2, DX, part)
        found[k] = max(found[k], _bound(control, shared, row[LAST], part, products, work, piece))
