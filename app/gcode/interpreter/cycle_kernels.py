# mypy: allow-untyped-defs
"""Compiled: the canned cycles of LinuxCNC in which the spindle turns on, as `holes` and `cycles` do them, motion by
motion.
"""

from __future__ import annotations

import math

from ...core.jit import kernel
from .cycles import CHIP_CLEARANCE_MM, SAME_HEIGHT
from .lane_fields import (
    ABSOLUTE,
    COUNT,
    CYCLE,
    CYCLE_P,
    CYCLE_Q,
    CYCLE_R,
    CYCLE_Z,
    CYCLED,
    EVENTS,
    FEED,
    INITIAL,
    KNOWN,
    LINE,
    MOST_UNROLLED,
    PLACE,
    PLANE,
    RETRACT,
    ROWS,
    SCALE,
    SHIFT,
    STATE,
    UNROLLED,
)
from .plain_kernels import _ABSENT, _COLUMNS, _write

_INTS, _REALS, _EVENTS = "int64[::1]", "float64[::1]", "float64[:, ::1]"
_L, _P, _Q, _R, _X = 11, 15, 16, 17, 23
_DWELL = 0
_MOST_PECKS, _MOST_REPEATS = 1000, 1000
_RAPID, _LINE_KIND = 0, 1
_FINEST = 1e9
_AXES = ((0, 1, 2), (2, 0, 1), (1, 2, 0))


@kernel("float64(float64)")
def _rounded(value):
    """Return a value to nine decimals, NaN where it lies half way between two."""
    scaled = value * _FINEST
    whole = math.floor(scaled + 0.5) if abs(scaled) < 1e13 else math.nan
    # Half way between two decimals the reader in Python could round the other way, so that is left to it.
    return whole / _FINEST if abs(scaled - whole) < 0.49 else math.nan


@kernel(f"float64({_REALS}, int64)")
def _here(reals, axis):
    """Return where the point is along an axis, program coordinates and units, without the noise of its way through the
    offsets.
    """
    return _rounded((reals[PLACE + axis] - reals[SHIFT + axis]) / reals[SCALE])


@kernel(f"boolean({_INTS}, {_REALS}, {_COLUMNS}, int64, float64, float64, float64)")
def _go(ints, reals, columns, kind, first, second, height):
    """Go to a place of the plane at a height, units of the program; return whether there is room for that."""
    row = ints[COUNT]
    if row >= ints[ROWS] or ints[UNROLLED] >= ints[MOST_UNROLLED]:
        return False
    u, v, w = _AXES[ints[PLANE]]
    # straight motions have no centre
    columns[2][row, 0] = columns[2][row, 1] = columns[2][row, 2] = math.nan
    end = columns[1][row]
    for axis, value in ((u, first), (v, second), (w, height)):
        end[axis] = value * reals[SCALE] + reals[SHIFT + axis]
    _write(
        columns,
        row,
        reals[PLACE : PLACE + 3],
        end,
        columns[2][row],
        reals[FEED],
        (kind, ints[PLANE], ints[LINE], ints[STATE]),
    )
    for axis in range(3):
        reals[PLACE + axis] = end[axis]
    ints[COUNT], ints[UNROLLED] = row + 1, ints[UNROLLED] + 1
    return True


@kernel(f"void({_INTS}, {_EVENTS}, int64, float64)")
def note(ints, events, kind, value):
    """Note an event before the next motion."""
    row = ints[EVENTS]
    events[row, 0], events[row, 1], events[row, 2], events[row, 3] = kind, ints[COUNT], ints[LINE], value
    ints[EVENTS] = row + 1


@kernel(f"boolean({_INTS}, {_REALS}, {_COLUMNS}, {_EVENTS}, UniTuple(float64, 5))")
def _bored(ints, reals, columns, events, hole):
    """Do what a cycle does from R on: the place in the plane, R, bottom and clearance of a hole; return whether there
    was room.
    """
    first, second, r, bottom, clear = hole
    code, peck = ints[CYCLE], reals[CYCLE_Q]
    # G73 and G83 go down a peck at a time: G73 lifts by the clearance alone to break the chip, G83 to R and back again.
    depth = r - peck if code == 73 or code == 83 else bottom
    while depth > bottom:
        above = depth + CHIP_CLEARANCE_MM / reals[SCALE]
        if not _go(ints, reals, columns, _LINE_KIND, first, second, depth):
            return False
        if code == 83 and not _go(ints, reals, columns, _RAPID, first, second, r):
            return False
        if not _go(ints, reals, columns, _RAPID, first, second, above):
            return False
        depth -= peck
    if not _go(ints, reals, columns, _LINE_KIND, first, second, bottom):
        return False
    if code == 82 or code == 89:
        if ints[EVENTS] >= len(events) - 1:
            return False
        note(ints, events, _DWELL, reals[CYCLE_P])
    # G85 and G89 come out at the feed, which leaves the bore clean; the others with a rapid
    if code == 85 and not _go(ints, reals, columns, _LINE_KIND, first, second, r):
        return False
    return _go(ints, reals, columns, _LINE_KIND if code == 89 else _RAPID, first, second, clear)


@kernel(f"boolean({_INTS}, {_REALS}, int64, {_REALS}, {_INTS})")
def _worded(ints, reals, code, words, given):
    """Take the words of a cycle, and those that stay from the one before; return whether they are surely right."""
    same, any_before = ints[CYCLE] == code, ints[CYCLE] > 0
    w = _AXES[ints[PLANE]][2]
    dwells = code == 82 or code == 89
    for entry, letter, stays in (
        (CYCLE_Z, _X + w, same),
        (CYCLE_R, _R, same),
        (CYCLE_Q, _Q, same),
        (CYCLE_P, _P, same or (any_before and not dwells)),
    ):
        if given[letter] != _ABSENT:
            reals[entry] = words[letter]
        elif not stays:
            reals[entry] = math.nan
    if (
        math.isnan(reals[CYCLE_Z])
        or math.isnan(reals[CYCLE_R])
        or reals[CYCLE_P] < 0.0
        or (dwells and math.isnan(reals[CYCLE_P]))
    ):
        return False
    ints[CYCLE], ints[CYCLED] = code, 1
    return (code != 73 and code != 83) or reals[CYCLE_Q] > 0.0


@kernel(f"int64({_REALS}, {_INTS})")
def _repeats(words, given):
    """Return how often a cycle is done; 0: it is not surely right."""
    if given[_L] == _ABSENT:
        return 1
    whole = math.floor(words[_L] + 0.5)
    return int(whole) if abs(words[_L] - whole) < 1e-4 and 1 <= whole <= _MOST_REPEATS else 0


@kernel("float64(float64, int64, float64, int64)")
def _moved(word, given, at, absolute):
    """Return a coordinate of the next hole."""
    if given == _ABSENT:
        return at
    return word if absolute != 0 else at + word


@kernel(f"boolean({_INTS}, {_REALS}, int64, {_REALS}, {_INTS}, {_COLUMNS}, {_EVENTS})")
def bore(ints, reals, code, words, given, columns, events):
    """Do the holes of a block of a canned cycle; return whether all of it is surely right.

    Args:
        ints, reals: what is in force, see `lane_fields`; changed.
        code: 73, 81 and so on. words, given: of the block, by letter.
        columns, events: out.
    """
    u, v, w = _AXES[ints[PLANE]]
    first, second, height = _here(reals, u), _here(reals, v), _here(reals, w)
    if math.isnan(first + second + height + reals[FEED]):
        return False
    if ints[CYCLE] == 0:
        reals[INITIAL] = height
    repeats = _repeats(words, given)
    if not _worded(ints, reals, code, words, given) or repeats == 0:
        return False
    for axis in range(3):
        entry = axis if ints[ABSOLUTE] != 0 else 3 + axis
        if given[_X + axis] != _ABSENT and ints[KNOWN + axis] < 0 and ints[KNOWN + entry] < 0:
            ints[KNOWN + entry] = ints[COUNT]
    r, bottom, initial = reals[CYCLE_R], reals[CYCLE_Z], reals[INITIAL]
    if ints[ABSOLUTE] == 0:
        r, bottom = initial + r, initial + r + bottom
    pecks = (code == 73 or code == 83) and r - bottom > _MOST_PECKS * reals[CYCLE_Q]
    if r < bottom or pecks:
        return False
    # A cycle that begins below R lifts to R first, and returns to R, whatever G98 says.
    if initial < r:
        height = initial = r
        if not _go(ints, reals, columns, _RAPID, first, second, r):
            return False
    clear = r if ints[RETRACT] != 0 else initial
    for _ in range(repeats):
        first = _moved(words[_X + u], given[_X + u], first, ints[ABSOLUTE])
        second = _moved(words[_X + v], given[_X + v], second, ints[ABSOLUTE])
        height = clear if height <= r + SAME_HEIGHT else height
        if not _go(ints, reals, columns, _RAPID, first, second, height):
            return False
        if abs(height - r) > SAME_HEIGHT and not _go(ints, reals, columns, _RAPID, first, second, r):
            return False
        if not _bored(ints, reals, columns, events, (first, second, r, bottom, clear)):
            return False
        height = clear
    return True
