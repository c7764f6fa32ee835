# mypy: allow-untyped-defs
"""Compiled core of `arcs`: the blocks of many meant arcs, one arc after the other."""

from __future__ import annotations

import cmath
import math

import numpy as np

from ...core.jit import kernel

SAMPLES = 8
"""Places along an arc, in parts of it, at which what is written is held against what is meant."""
DEEPEST = 1000
"""So many halves of halves are no arc that a machine makes, but numbers that are none."""
FARTHEST_ROUNDED = math.sqrt(0.5)
"""How far a point may be from the nearest grid point, in steps of the last decimal."""
NEIGHBOURS = np.array(((0, 0), (1, 0), (0, 1), (-1, 0), (0, -1), (1, 1), (-1, 1), (-1, -1), (1, -1)))
"""Last digits of a centre that are tried about the rounded one, the nearest first."""

_START_RADIUS, _END_RADIUS, _ANGLE, _SWEEP = range(4)  # columns of a shape
_STEP, _SCALE, _CENTRE_SCALE, _TOLERANCE, _LARGEST_SWEEP, _LEAST, _MOST, _MISMATCH = range(8)  # of the rules
_X, _Y, _I, _J, _ROUND = range(5)  # columns of a piece

_F, _WHOLE, _SPANS, _TABLE = "float64[::1]", "int64[::1]", "float64[:, ::1]", "int64[:, ::1]"


@kernel(f"complex128(complex128, {_F}, float64)", counts=False)
def _at(centre, shape, fraction):
    """Return the point of an arc at a fraction of its sweep."""
    radius = shape[_START_RADIUS] + (shape[_END_RADIUS] - shape[_START_RADIUS]) * fraction
    return centre + cmath.rect(radius, shape[_ANGLE] + shape[_SWEEP] * fraction)


@kernel(f"float64(complex128, {_F}, float64, float64, float64, {_WHOLE})", counts=False)
def _between(centre, shape, begin, stop, scale, point):
    """Write the grid point nearest to the middle of a stretch; return how far along the arc it is by its own angle."""
    middle = (begin + stop) / 2
    place = _at(centre, shape, middle)
    point[0], point[1] = np.int64(np.rint(place.real * scale)), np.int64(np.rint(place.imag * scale))
    # rounding moved the point along the arc too; its fraction is told from its own angle
    from_centre = complex(point[0] / scale, point[1] / scale) - centre
    beyond = cmath.phase(from_centre / cmath.rect(1.0, shape[_ANGLE] + shape[_SWEEP] * middle))
    fraction = middle + beyond / shape[_SWEEP]
    return fraction if begin < fraction < stop else middle


@kernel(f"float64(complex128, {_F}, complex128, {_F}, float64, float64)", counts=False)
def _largest_distance(written_centre, written, centre, shape, begin, stop):
    """Return an upper bound of the distance between two arcs swept in step, the second over a stretch of it.

    The distance vector is sampled; between two samples it leaves their chord by at most h^2 / 8 times its second
    derivative. That is at most sweep^2 times the distance itself, which goes to the other side of the inequality, and
    what the difference of centres, of sweeps and of radii adds.
    """
    size, largest = stop - begin, 0.0
    for k in range(SAMPLES + 1):
        gap = abs(_at(written_centre, written, k / SAMPLES) - _at(centre, shape, begin + size * k / SAMPLES))
        largest = max(largest, gap)
    sweep, turn, shift = shape[_SWEEP] * size, written[_SWEEP], abs(written_centre - centre)
    grows, meant_grows = written[_END_RADIUS] - written[_START_RADIUS], shape[_END_RADIUS] - shape[_START_RADIUS]
    spiral = 2 * (abs(turn * grows) + abs(shape[_SWEEP] * meant_grows))
    bend = (
        turn * turn * shift + abs(turn * turn - sweep * sweep) * max(shape[_START_RADIUS], shape[_END_RADIUS]) + spiral
    )
    return (largest + bend / (8 * SAMPLES**2)) / (1 - turn * turn / (8 * SAMPLES**2))


@kernel(f"boolean(complex128, {_F}, float64, float64, complex128, complex128, complex128, {_F}, {_F})", counts=False)
def _fits(centre, shape, begin, stop, start, end, written_centre, rules, written):
    """Tell whether the control's arc round a written centre keeps to the rules; `written` is room for its shape."""
    first, last = start - written_centre, end - written_centre
    written[_START_RADIUS], written[_END_RADIUS] = abs(first), abs(last)
    least, most = min(abs(first), abs(last)), max(abs(first), abs(last))
    if least < rules[_LEAST] or most > rules[_MOST] or most - least > rules[_MISMATCH]:
        return False
    turn = (cmath.phase(last) - cmath.phase(first)) % math.tau
    written[_ANGLE], written[_SWEEP] = cmath.phase(first), turn if shape[_SWEEP] > 0 else turn - math.tau
    if written[_SWEEP] == 0:
        return False
    return _largest_distance(written_centre, written, centre, shape, begin, stop) <= rules[_TOLERANCE]


@kernel(f"boolean(complex128, {_F}, float64, float64, {_WHOLE}, {_WHOLE}, {_F}, {_F}, {_WHOLE})", counts=False)
def _one_arc(centre, shape, begin, stop, first, last, rules, written, offset):
    """Write I and J of an arc that fits a stretch; False where there is none.

    Tried is the point equally far from both rounded ends and nearest to the meant centre, rounded; then its neighbours.
    """
    scale, finer = rules[_SCALE], rules[_CENTRE_SCALE]
    start, end = complex(first[0] / scale, first[1] / scale), complex(last[0] / scale, last[1] / scale)
    chord = end - start
    if chord == 0:
        return False
    middle, length = (start + end) / 2, abs(chord)
    normal = complex(-chord.imag / length, chord.real / length)
    away = centre - middle
    along = away.real * normal.real + away.imag * normal.imag
    # equally far from both ends means: on the bisector of the chord
    solved = middle + along * normal - start
    i, j = np.int64(np.rint(solved.real * finer)), np.int64(np.rint(solved.imag * finer))
    for k in range(len(NEIGHBOURS)):
        offset[0], offset[1] = i + NEIGHBOURS[k, 0], j + NEIGHBOURS[k, 1]
        if _fits(
            centre,
            shape,
            begin,
            stop,
            start,
            end,
            start + complex(offset[0] / finer, offset[1] / finer),
            rules,
            written,
        ):
            return True
    return False


@kernel(f"boolean({_F}, float64, float64, {_F})", counts=False)
def _flat(shape, begin, stop, rules):
    """Tell whether a stretch bulges so little from its chord that a line is as good."""
    half = abs(shape[_SWEEP]) * (stop - begin) / 2
    # 1 - cos h = 2 sin^2(h / 2), which loses no digits of a small bulge
    sine = math.sin(half / 2)
    bulge = max(shape[_START_RADIUS], shape[_END_RADIUS]) * 2 * (sine * sine)
    return bulge < min(0.5 * rules[_STEP], rules[_TOLERANCE] - FARTHEST_ROUNDED * rules[_STEP])


@kernel("void(float64[:, ::1], int64[:, ::1], int64, float64, float64, int64[::1], int64[::1])", counts=False)
def _put(spans, places, row, begin, stop, start, end):
    """Write a stretch that is to come: its fractions, and where it begins and ends."""
    spans[row, 0], spans[row, 1] = begin, stop
    places[row, 0], places[row, 1], places[row, 2], places[row, 3] = start[0], start[1], end[0], end[1]


@kernel(
    f"int64(complex128, {_F}, {_F}, {_SPANS}, {_TABLE}, {_TABLE}, {_F}, int64, {_F}, {_WHOLE}, {_WHOLE}, {_WHOLE})",
    counts=False,
)
def _stretch(centre, shape, rules, spans, places, pieces, fraction, count, written, start, end, point):
    """Write the blocks of the stretch that waits in row 0 behind those there are, as far as there is room.

    Returns:
        How many blocks there are now; -1: there is no room for them; -2: there is no end of halves.
    """
    waiting = 1
    while waiting:
        waiting -= 1
        begin, stop = spans[waiting, 0], spans[waiting, 1]
        start[0], start[1], end[0], end[1] = (
            places[waiting, 0],
            places[waiting, 1],
            places[waiting, 2],
            places[waiting, 3],
        )
        line = _flat(shape, begin, stop, rules)
        if line and start[0] == end[0] and start[1] == end[1]:
            continue
        if count == len(pieces):
            return -1
        point[0] = point[1] = 0
        if line or _one_arc(centre, shape, begin, stop, start, end, rules, written, point):
            pieces[count, _X], pieces[count, _Y], pieces[count, _I], pieces[count, _J] = (
                end[0],
                end[1],
                point[0],
                point[1],
            )
            pieces[count, _ROUND], fraction[count] = not line, stop
            count += 1
            continue
        if waiting + 2 > DEEPEST:
            return -2
        middle = _between(centre, shape, begin, stop, rules[_SCALE], point)
        _put(spans, places, waiting, middle, stop, point, end)
        _put(spans, places, waiting + 1, begin, middle, start, point)
        waiting += 2
    return count


@kernel("int64(float64[:, ::1], int64[:, ::1], float64[::1], int64, int64[:, ::1], float64[::1], int64[::1])")
def write_pieces(arcs, ends, rules, first, pieces, fraction, stops):
    """Write the blocks of arcs, from a first one on as far as there is room.

    A stretch is a line where it is flat, one arc where that fits, else it is its halves.

    Args:
        arcs: (n, 6) centre x and y, radius at the start and at the end, angle of the start, sweep; out units, radians.
        ends: (n, 4) counts of the last decimal of X and Y where each begins and ends.
        rules: (8,) step of the last decimal; counts of X and of I in an out unit; tolerance, largest sweep, smallest
            and largest radius, largest difference of two radii.
        first: index of an arc; those before it are written.
        pieces: (m, 5) the answer: where each block ends, counts; I and J, counts; 1 for an arc, 0 for a line.
        fraction: (m,) the answer: how much of the arc is done there.
        stops: (n,) the answer: how many blocks the arcs up to each one have.

    Returns:
        The first arc that is not written, n if there is none; -1 - its index where it has no end of halves.
    """
    # stretches to come, the next one on top
    spans, places = (
        np.empty((DEEPEST + 1, 2)),
        np.empty((DEEPEST + 1, 4), np.int64),
    )
    shape, written = np.empty(4), np.empty(4)
    at, to, point = np.empty(2, np.int64), np.empty(2, np.int64), np.empty(2, np.int64)
    start, end = np.empty(2, np.int64), np.empty(2, np.int64)
    count = stops[first - 1] if first else 0
    for n in range(first, len(arcs)):
        centre = complex(arcs[n, 0], arcs[n, 1])
        shape[0], shape[1], shape[2], shape[3] = arcs[n, 2], arcs[n, 3], arcs[n, 4], arcs[n, 5]
        parts = np.int64(np.ceil(abs(shape[_SWEEP]) / rules[_LARGEST_SWEEP]))
        begun, at[0], at[1] = 0.0, ends[n, 0], ends[n, 1]
        for part in range(parts):
            stop, to[0], to[1] = 1.0, ends[n, 2], ends[n, 3]
            if part < parts - 1:
                stop = _between(centre, shape, part / parts, (part + 2) / parts, rules[_SCALE], to)
            _put(spans, places, 0, begun, stop, at, to)
            count = _stretch(centre, shape, rules, spans, places, pieces, fraction, count, written, start, end, point)
            if count < 0:
                return n if count == -1 else -1 - n
            begun, at[0], at[1] = stop, to[0], to[1]
        stops[n] = count
    return len(arcs)
