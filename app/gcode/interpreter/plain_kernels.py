# mypy: allow-untyped-defs
"""The compiled lane of the reader: blocks of G0 to G3, X Y Z I J K R F N with plain numbers, and comments.

Whatever is not surely plain ends the run before its line; nothing of that line is then done.
"""

from __future__ import annotations

import math

import numpy as np

from ...core.jit import kernel
from .arc_kernels import centre_by_radius, radii

_X, _Y, _Z, _I, _J, _K, _R, _F = range(8)
"""Letters that the lane reads, as places of `words`."""
_RAPID, _LINE, _CW, _CCW = range(4)
"""Codes of motion, G0 to G3."""
_ABSENT, _WHOLE, _POINT = range(3)  # how a number is written; _WHOLE: without a decimal point
# exact, so that digits / power rounds once, as float(text) does
_POWERS = np.array([float(f"1e{k}") for k in range(23)])
_DIGITS_BOUND = 10**15  # whole numbers below it are exact as floats
_LARGEST_NUMBER = 999_999_999
"""Of an N word; beyond, an int32 overflows."""
_FARTHEST, _FASTEST = 1e6, 1e7  # mm, mm/min
_LEAST_RADIUS, _RADII_ALIKE, _SLACK = 0.01, 0.0045, 1e-6  # mm; no control asks for more


@kernel("Tuple((int64, float64, int64))(Array(uint8, 1, 'C', True), int64)")
def _number(data, i):
    """Return (offset after it, value, how it is written) of the number at offset i; _ABSENT where there is no plain
    one.
    """
    n = len(data)
    negative, signed, pointed = False, False, False
    mantissa = digits = decimals = 0
    while i < n:
        c = data[i]
        if 48 <= c <= 57:
            mantissa = mantissa * 10 + c - 48
            digits += 1
            decimals += pointed
            if mantissa >= _DIGITS_BOUND or decimals > 22:
                return i, 0.0, _ABSENT
        elif c == 46 and not pointed:  # .
            pointed = True
        elif (c == 43 or c == 45) and not (signed or digits or pointed):  # + -
            signed, negative = True, c == 45
        elif c != 32 and c != 9:
            break
        i += 1
    value = mantissa / _POWERS[decimals]
    return i, -value if negative else value, _ABSENT if digits == 0 else _POINT if pointed else _WHOLE


@kernel("UniTuple(int64, 2)(Array(uint8, 1, 'C', True), int64)")
def _whole_number(data, i):
    """Return (offset after it, value) of the number without sign and point at offset i; value -1 where there is
    none.
    """
    value = -1
    while i < len(data) and (48 <= data[i] <= 57 or data[i] == 32 or data[i] == 9):
        if data[i] >= 48:
            value = max(value, 0) * 10 + data[i] - 48
            if value > _LARGEST_NUMBER:
                return i, -1
        i += 1
    return i, value


@kernel("int64(Array(uint8, 1, 'C', True), int64, int64)")
def _after_comment(data, i, end):
    """Return the offset after a comment whose text begins at offset i and that the character `end` ends; -1: not plain.

    A comment to the end of the line ends before it.
    """
    while i < len(data) and data[i] != end:
        c = data[i]
        if (c < 32 and c != 9) or (end == 41 and c == 40):  # control characters; a comment in a comment
            return -1
        i += 1
    if end == 10:
        return i
    return i + 1 if i < len(data) else -1


@kernel("int64(uint8)")
def _column(c):
    """Return the column of a letter's number, -1 if the lane does not know the letter."""
    if 88 <= c <= 90:  # X Y Z
        return _X + c - 88
    if 73 <= c <= 75:  # I J K
        return _I + c - 73
    return _R if c == 82 else _F if c == 70 else -1


@kernel("UniTuple(int64, 2)(Array(uint8, 1, 'C', True), int64, int64, boolean, float64[::1], int64[::1])")
def _read_line(data, start, longest, semicolons, words, given):
    """Read a line into words and how each is written; return (offset of the next line, G number or -1); (-1, -1): not
    plain.
    """
    given[:] = _ABSENT
    motion, i, seen = -1, start, False
    while i < len(data) and data[i] != 10:
        c = data[i] & 0xDF if data[i] >= 96 else data[i]  # in capitals
        if c == 32 or c == 9:
            i += 1
        elif c == 40:  # (
            i = _after_comment(data, i + 1, 41)
        elif c == 59 and semicolons:  # ;
            i = _after_comment(data, i + 1, 10)
        elif c == 71 or (c == 78 and not seen):  # G, or N first in the line
            i, value = _whole_number(data, i + 1)
            if value < 0 or (c == 71 and (value > _CCW or motion >= 0)):
                return -1, -1
            motion = value if c == 71 else motion
        else:
            column = _column(c)
            if column < 0 or given[column] != _ABSENT:
                return -1, -1
            i, words[column], given[column] = _number(data, i + 1)
            if given[column] == _ABSENT:
                return -1, -1
        if i < 0 or i - start > longest:
            return -1, -1
        seen = seen or (c != 32 and c != 9)
    return min(i + 1, len(data)), motion


@kernel(
    "boolean(int64, int64, boolean, float64[::1], float64[::1], int64[::1], float64[::1], float64[::1], float64[::1])"
)
def _arc(motion, plane, arc_absolute, lengths, shift, given, start, end, centre):
    """Write the centre of an arc; return whether it is surely one that every control takes."""
    u, v, w = (0, 1, 2) if plane == 0 else (2, 0, 1) if plane == 1 else (1, 2, 0)
    a, b = given[_I + u] != _ABSENT, given[_I + v] != _ABSENT
    if given[_I + w] != _ABSENT or (given[_R] != _ABSENT and (a or b)):
        return False
    if given[_R] == _ABSENT and (not (a or b) or (arc_absolute and not (a and b))):
        return False
    centre[w] = start[w]
    if given[_R] != _ABSENT:
        turn = 1.0 if motion == _CCW else -1.0
        centre[u], centre[v] = centre_by_radius(start[u], start[v], end[u], end[v], lengths[_R], turn, _SLACK)
    else:
        for k in (u, v):
            offset = lengths[_I + k] if given[_I + k] != _ABSENT else 0.0
            centre[k] = offset + shift[k] if arc_absolute else start[k] + offset
    first, last = radii(start[u], start[v], end[u], end[v], centre[u], centre[v])
    return _LEAST_RADIUS <= first <= _FARTHEST and abs(first - last) <= _RADII_ALIKE


_COLUMNS = (
    "Tuple((float64[:, ::1], float64[:, ::1], float64[:, ::1], uint8[::1], uint8[::1], int32[::1], float64[::1], "
    "int32[::1], int32[::1]))"
)


@kernel("boolean(float64[::1], float64[::1], boolean, float64[::1], int64[::1], float64[::1])")
def _reach(lengths, shift, absolute, start, given, end):
    """Write where the axis words lead; return whether it is near enough to be meant."""
    near = True
    for axis in range(3):
        end[axis] = start[axis]
        if given[axis] != _ABSENT:
            end[axis] = lengths[axis] + shift[axis] if absolute else start[axis] + lengths[axis]
            near = near and abs(end[axis]) <= _FARTHEST
    return near


@kernel(f"void({_COLUMNS}, int64, float64[::1], float64[::1], float64[::1], float64, UniTuple(int64, 4))")
def _write(columns, row, start, end, centre, feed, numbers):
    """Write a motion. numbers: kind, plane, line, state."""
    starts, ends, centres, kinds, planes, turns, feeds, lines, states = columns
    for axis in range(3):
        starts[row, axis], ends[row, axis], centres[row, axis] = start[axis], end[axis], centre[axis]
    kinds[row], planes[row], lines[row], states[row] = numbers
    turns[row] = numbers[0] >= _CW
    feeds[row] = 0.0 if numbers[0] == _RAPID else feed


@kernel(
    "Tuple((int64, int64, int64, int64, float64))(Array(uint8, 1, 'C', True), UniTuple(float64, 3), UniTuple(int64, "
    f"11), Tuple((float64[::1], float64[::1], int64[::1])), {_COLUMNS})"
)
def run_plain(data, factors, modes, places, columns):
    """Do plain lines until one is not plain, the text ends or enough are done; return (offset, line, count, motion,
    feed).

    Args:
        factors: mm per unit of numbers with a decimal point, of others, and the feed in mm/min (NaN = not known).
        modes: offset, line, count of motions, motion, most lines, plane, state, absolute, arc_absolute, semicolons,
            bytes that a line may have.
        places: position and shift, mm; (6,) first row that commands each axis, by an absolute word and, where none has
            yet, by an incremental one. Position and rows are changed.
        columns: of the motions, with room for a motion a line.
    """
    scale, bare_scale, feed = factors
    offset, line, count, motion, lines_left, plane, state, absolute, arc_absolute, semicolons, longest = modes
    position, shift, known = places
    words, lengths, given = np.zeros(8), np.zeros(8), np.zeros(8, np.int64)
    end, centre = np.zeros(3), np.zeros(3)
    while lines_left > 0 and offset < len(data):
        following, named = _read_line(data, offset, longest, semicolons != 0, words, given)
        moves = given[_X] + given[_Y] + given[_Z] != _ABSENT
        round_words = given[_I] + given[_J] + given[_K] + given[_R] != _ABSENT
        kind = named if named >= 0 else motion
        new_feed = words[_F] * scale if given[_F] != _ABSENT else feed
        if following < 0 or (given[_F] != _ABSENT and not 0.0 < new_feed <= _FASTEST):
            break
        if moves or named >= 0 or round_words:
            for k in range(_F):
                lengths[k] = words[k] * (scale if given[k] == _POINT else bare_scale)
            if not moves or kind < 0 or (kind < _CW and round_words) or (kind > _RAPID and math.isnan(new_feed)):
                break
            if not _reach(lengths, shift, absolute != 0, position, given, end):
                break
            centre[:] = math.nan
            if kind >= _CW and not _arc(kind, plane, arc_absolute != 0, lengths, shift, given, position, end, centre):
                break
            _write(columns, count, position, end, centre, new_feed, (kind, plane, line, state))
            for axis in range(3):
                entry = axis if absolute != 0 else 3 + axis  # by an absolute word, or from where the reading began
                if given[axis] != _ABSENT and known[axis] < 0 and known[entry] < 0:
                    known[entry] = count
                position[axis] = end[axis]
            motion, count = kind, count + 1
        feed, offset, line, lines_left = new_feed, following, line + 1, lines_left - 1
    return offset, line, count, motion, feed
