# mypy: allow-untyped-defs
"""The compiled lane: line by line through a program, plain ones at once, others word by word, until one is not surely
right.

Nothing of such a line is done; the reader's core does it, exactly and with words for what is wrong.
"""

from __future__ import annotations

import math

import numpy as np

from ...core.jit import kernel
from .cycle_kernels import bore, note
from .lane_fields import (
    ABSOLUTE,
    ARC_ABSOLUTE,
    BARE,
    CHANGES,
    COMPUTES,
    COUNT,
    CYCLE,
    DWELL,
    DWELL_POINT,
    DWELL_WHOLE,
    EVENTS,
    EXTENDED,
    FEED,
    FLOOD,
    INTS,
    KNOWN,
    LENGTH_FREE,
    LINE,
    LINES_LEFT,
    LINUXCNC,
    LONGEST,
    MIST,
    MOTION,
    OFFSET,
    OPTIONAL_STOP,
    PLACE,
    PLANE,
    REALS,
    RETRACT,
    ROWS,
    SCALE,
    SELECTED,
    SHIFT,
    SPEED,
    SPINDLE,
    STATE,
    STATE_FIELDS,
    STATES,
    STOP,
    SURFACE,
    TOOL,
    TOOL_CHANGE,
    TOOL_CHANGES,
    UNITS,
    WORK_OFFSET,
)
from .plain_kernels import _ABSENT, _COLUMNS, _FASTEST, _WHOLE, _arc, _reach, _write, run_plain
from .word_kernels import _LINE, M_CODES, read_block

_INTS, _REALS, _RECORDS = "int64[::1]", "float64[::1]", "float64[:, ::1]"
_F, _I, _J, _K, _L, _P, _Q, _R, _S, _T, _X = (ord(letter) - 65 for letter in "FIJKLPQRSTX")
"""Letters as places in the alphabet."""
(
    _MOTION,
    _PLANE,
    _DISTANCE,
    _ARC_DISTANCE,
    _FEED_MODE,
    _ONCE,
    _RETURN,
    _STOP,
    _TOOL,
    _SPINDLE,
    _MIST,
    _FLOOD,
    _DRY,
    _SAME,
) = range(14)
_SLOTS = 14
"""What a block's codes are about; of _SAME are those that change nothing, as far as they are known here."""
_NEVER_PLAIN = (35, 77, 83, 84, 109, 115, 116)
"""What lines begin with that are surely more than plain ones: #, M, S, T."""
_CYCLES = (73, 81, 82, 83, 85, 89)
"""G codes of cycles that the lane carries out."""
_NO_MOTION = 80
"""G80."""
_FASTEST_SPINDLE, _MOST_TOOLS, _LONGEST_DWELL = 1e7, 1e8, 1e6
"""rpm, numbers of tools, seconds: beyond, a line is left to the reader, which says what is wrong."""


@kernel(f"int64(int64, {_INTS})", counts=False)
def _slot_of_g(code, ints):
    """Return what a G code is about, -1 where it is not known here; code: a hundred times its number."""
    if code in (0, 100, 200, 300):
        return _MOTION
    if code % 100 == 0 and (code // 100 in _CYCLES or code == 100 * _NO_MOTION):
        return _MOTION if ints[LINUXCNC] != 0 else -1
    if code in (1700, 1800, 1900):
        return _PLANE
    if code == 9000 or code == 9100:
        return _DISTANCE
    # Of the controls beside LinuxCNC grbl has G91.1 alone, and those with more codes are not alike.
    if ints[LINUXCNC] != 0 and code == 9010:
        return _ARC_DISTANCE
    if code == 9110 and (ints[LINUXCNC] != 0 or ints[EXTENDED] == 0):
        return _ARC_DISTANCE
    if code == 9400:
        return _FEED_MODE
    if code == 400:
        return _ONCE
    if (code == 9800 or code == 9900) and ints[EXTENDED] != 0:
        return _RETURN
    same = (
        code == ints[UNITS]
        or code == ints[WORK_OFFSET]
        or code == 4000
        or (code == 4900 and ints[LENGTH_FREE] != 0)
        or (code == 9700 and ints[EXTENDED] != 0 and ints[SURFACE] == 0)
    )
    return _SAME if same else -1


@kernel(f"int64(int64, {_INTS})", counts=False)
def _slot_of_m(number, ints):
    """Return what an M code is about, -1 where it is not known here; number: a hundred times its own."""
    if number in (0, 100, 6000):
        return _STOP
    if number == 600:
        return _TOOL if ints[TOOL_CHANGES] != 0 else -1
    if number in (300, 400, 500):
        return _SPINDLE
    if number in (700, 800, 900):
        return _MIST if number == 700 else _FLOOD if number == 800 else _DRY
    return -1


@kernel(f"boolean({_INTS}, {_LINE}, {_INTS})", counts=False)
def _sorted(ints, line, slots):
    """Put a block's codes where they belong, G and M numbers times a hundred; return whether all are known and none
    excludes another.
    """
    slots[:] = -1
    for k in range(line[4][0]):
        code = line[2][k]
        number = code if code >= 0 else code + M_CODES
        slot = _slot_of_g(code, ints) if code >= 0 else _slot_of_m(number, ints)
        if slot < 0 or slots[slot] >= 0:
            return False
        slots[slot] = number
    if ints[LINUXCNC] != 0 and slots[_MIST] >= 0 and slots[_FLOOD] >= 0:
        return False
    return slots[_DRY] < 0 or (slots[_MIST] < 0 and slots[_FLOOD] < 0)


@kernel(f"boolean({_INTS}, {_REALS}, {_LINE}, {_INTS})", counts=False)
def _set_rates(ints, reals, line, slots):
    """Obey feed mode, F, S and T; return whether they are surely right."""
    words, given = line[0], line[1]
    if slots[_FEED_MODE] >= 0 and ints[LINUXCNC] != 0:
        # LinuxCNC forgets F where the feed mode is named, even if it is the same one
        reals[FEED] = math.nan
    if given[_F] != _ABSENT:
        reals[FEED] = words[_F] * reals[SCALE]
        if not 0.0 < reals[FEED] <= _FASTEST:
            return False
    if given[_S] != _ABSENT:
        if not 0.0 <= words[_S] < _FASTEST_SPINDLE:
            return False
        reals[SPEED] = words[_S]
    if given[_T] != _ABSENT:
        whole = math.floor(words[_T] + 0.5)
        if abs(words[_T] - whole) > 1e-4 or not 0.0 <= whole < _MOST_TOOLS:
            return False
        ints[SELECTED] = int(whole)
    return True


@kernel(f"boolean({_INTS}, {_REALS}, {_LINE}, {_INTS}, {_RECORDS})", counts=False)
def _set_modes(ints, reals, line, slots, events):
    """Obey what comes before the motion; return whether it is surely right."""
    if ints[EVENTS] + 4 > len(events) or not _set_rates(ints, reals, line, slots):
        return False
    if slots[_TOOL] >= 0:
        ints[TOOL], ints[SPINDLE] = ints[SELECTED], 0
        note(ints, events, TOOL_CHANGE, float(ints[TOOL]))
    if slots[_SPINDLE] >= 0:
        ints[SPINDLE] = 1 if slots[_SPINDLE] == 300 else -1 if slots[_SPINDLE] == 400 else 0
    if slots[_MIST] >= 0 or slots[_DRY] >= 0:
        # M9 stands for both coolants; M7 and M8 leave the other one as it is
        ints[MIST] = slots[_MIST] >= 0
    if slots[_FLOOD] >= 0 or slots[_DRY] >= 0:
        ints[FLOOD] = slots[_FLOOD] >= 0
    if slots[_ONCE] >= 0:
        given = line[1]
        if (
            given[_P] == _ABSENT
            or given[_X] + given[_X + 1] + given[_X + 2] + given[_I] + given[_J] + given[_K] + given[_R] != _ABSENT
        ):
            return False
        seconds = line[0][_P] * reals[DWELL_WHOLE if given[_P] == _WHOLE else DWELL_POINT]
        if not 0.0 <= seconds <= _LONGEST_DWELL:
            return False
        note(ints, events, DWELL, seconds)
    if slots[_PLANE] >= 0:
        ints[PLANE] = (slots[_PLANE] - 1700) // 100
    if slots[_DISTANCE] >= 0:
        ints[ABSOLUTE] = slots[_DISTANCE] == 9000
    if slots[_ARC_DISTANCE] >= 0:
        ints[ARC_ABSOLUTE] = slots[_ARC_DISTANCE] == 9010
    if slots[_RETURN] >= 0:
        ints[RETRACT] = slots[_RETURN] == 9900
    return True


@kernel(f"void({_INTS}, {_REALS}, {_RECORDS})", counts=False)
def _take_state(ints, reals, states):
    """Make what is in force the state of the motions to come."""
    count = ints[STATES]
    if count > 0:
        # programs repeat S and M words: what is not new makes no state
        same = states[count - 1, len(STATE_FIELDS)] == reals[SPEED]
        for k in range(len(STATE_FIELDS)):
            same = same and states[count - 1, k] == ints[STATE_FIELDS[k]]
        if same:
            ints[STATE] = count - 1
            return
    for k in range(len(STATE_FIELDS)):
        states[count, k] = ints[STATE_FIELDS[k]]
    states[count, len(STATE_FIELDS)] = reals[SPEED]
    ints[STATE], ints[STATES] = count, count + 1


@kernel(f"boolean({_INTS}, {_REALS}, {_LINE}, {_COLUMNS})", counts=False)
def _straight_or_arc(ints, reals, line, columns):
    """Add the motion of G0 to G3; return whether it is surely right."""
    given, lengths, centre, end = line[5], line[6][0], line[6][1, :3], line[6][2, :3]
    centre[:] = math.nan
    for k, letter in enumerate((_X, _X + 1, _X + 2, _I, _J, _K, _R)):
        given[k], lengths[k] = line[1][letter], line[0][letter] * reals[BARE if line[1][letter] == _WHOLE else SCALE]
    kind, row = ints[MOTION], ints[COUNT]
    start, shift, known = reals[PLACE : PLACE + 3], reals[SHIFT : SHIFT + 3], ints[KNOWN : KNOWN + 6]
    if (
        row >= ints[ROWS]
        or (kind > 0 and math.isnan(reals[FEED]))
        or not _reach(lengths, shift, ints[ABSOLUTE] != 0, start, given, end)
    ):
        return False
    if kind >= 2 and not _arc(kind, ints[PLANE], ints[ARC_ABSOLUTE] != 0, lengths, shift, given, start, end, centre):
        return False
    _write(columns, row, start, end, centre, reals[FEED], (kind, ints[PLANE], ints[LINE], ints[STATE]))
    for axis in range(3):
        entry = axis if ints[ABSOLUTE] != 0 else 3 + axis
        if given[axis] != _ABSENT and known[axis] < 0 and known[entry] < 0:
            known[entry] = row
        start[axis] = end[axis]
    ints[COUNT] = row + 1
    return True


@kernel(f"boolean({_INTS}, {_LINE}, {_INTS})", counts=False)
def _words_fit(ints, line, slots):
    """Tell whether the motion takes what words there are."""
    given, motion = line[1], ints[MOTION]
    cycle, arc = motion >= 73 and motion != _NO_MOTION, motion == 2 or motion == 3
    dwells = motion == 82 or motion == 89
    round_words = given[_I] + given[_J] + given[_K]
    return (
        # P belongs to G4, or to a cycle that dwells; one word may not serve two codes
        (given[_P] == _ABSENT or slots[_ONCE] >= 0 or dwells)
        and (given[_L] == _ABSENT or cycle)
        and (given[_Q] == _ABSENT or motion == 73 or motion == 83)
        and (round_words == _ABSENT or arc)
        and (given[_R] == _ABSENT or cycle or arc)
        and not (slots[_ONCE] >= 0 and (cycle or arc))
    )


@kernel(f"boolean({_INTS}, {_REALS}, {_LINE}, {_INTS}, {_COLUMNS}, Tuple(({_RECORDS}, {_RECORDS})))", counts=False)
def _moved(ints, reals, line, slots, columns, records):
    """Obey a block's motion, its own or the one in force; return whether it is surely right."""
    given, named = line[1], slots[_MOTION] >= 0
    if named:
        ints[MOTION] = slots[_MOTION] // 100
    axes = given[_X] + given[_X + 1] + given[_X + 2] != _ABSENT
    arc = ints[MOTION] == 2 or ints[MOTION] == 3
    others = given[_I] + given[_J] + given[_K] + given[_R] + given[_L] + given[_Q] != _ABSENT
    goes = axes or named or (arc and given[_I] + given[_J] + given[_K] != _ABSENT)
    if not goes:
        return not others and (given[_P] == _ABSENT or slots[_ONCE] >= 0)
    if ints[MOTION] < 0 or not _words_fit(ints, line, slots):
        return False
    if ints[MOTION] == _NO_MOTION:
        ints[CYCLE] = 0
        return not axes
    if ints[MOTION] > 3:
        _take_state(ints, reals, records[0])
        return bore(ints, reals, ints[MOTION], line[0], given, columns, records[1])
    ints[CYCLE] = 0
    # G0 to G3 named without a place: other controls than LinuxCNC take the mode and do not move
    if not axes and not arc and ints[LINUXCNC] == 0:
        return True
    _take_state(ints, reals, records[0])
    return _straight_or_arc(ints, reals, line, columns)


@kernel(f"void({_INTS}, {_REALS}, Array(uint8, 1, 'C', True), {_COLUMNS}, {_RECORDS})")
def _do_plain(ints, reals, data, columns, states):
    """Do all plain lines that come next."""
    before, rows = ints[STATES], ints[COUNT]
    _take_state(ints, reals, states)
    motion = ints[MOTION] if 0 <= ints[MOTION] <= 3 else -1
    lines = min(ints[LINES_LEFT], ints[ROWS] - rows)
    first = ints[LINE]
    modes = (
        ints[OFFSET],
        first,
        rows,
        motion,
        lines,
        ints[PLANE],
        ints[STATE],
        ints[ABSOLUTE],
        ints[ARC_ABSOLUTE],
        1,
        ints[LONGEST],
    )
    places = reals[PLACE : PLACE + 3], reals[SHIFT : SHIFT + 3], ints[KNOWN : KNOWN + 6]
    ints[OFFSET], ints[LINE], ints[COUNT], motion, reals[FEED] = run_plain(
        data, (reals[SCALE], reals[BARE], reals[FEED]), modes, places, columns
    )
    ints[LINES_LEFT] -= ints[LINE] - first
    if motion >= 0:
        ints[MOTION], ints[CYCLE] = motion, 0
    # no motion was made, so the state that was put down for some is taken back
    if ints[COUNT] == rows:
        ints[STATES] = before


@kernel("void(int64[::1], float64[::1], int64[::1], float64[::1])", counts=False)
def _copy(ints, reals, to_ints, to_reals):
    """Copy a state; number by number, see `geometry.kernels.enlarged`."""
    for k in range(INTS):
        to_ints[k] = ints[k]
    for k in range(REALS):
        to_reals[k] = reals[k]


@kernel(
    f"void(Array(uint8, 1, 'C', True), {_INTS}, {_REALS}, float64[::1], {_COLUMNS}, Tuple(({_RECORDS}, {_RECORDS})))"
)
def run_lines(data, ints, reals, parameters, columns, records):
    """Do lines until one is not surely right, the text ends or enough are done.

    Args:
        data: the text.
        ints, reals: what is in force, see `lane_fields`; changed.
        parameters: by their numbers, NaN = not set; changed.
        columns: of the motions, with room for ROWS.
        records: out, states and events, of which there is room for one more than lines.
    """
    line = (
        np.zeros(26),
        np.zeros(26, np.int64),
        np.zeros(12, np.int64),
        np.zeros((8, 2)),
        np.zeros(2, np.int64),
        np.zeros(8, np.int64),
        np.zeros((3, 8)),
    )
    values, waiting, slots = np.zeros(34), np.zeros(34, np.int64), np.zeros(_SLOTS, np.int64)
    old_ints, old_reals = np.zeros(INTS, np.int64), np.zeros(REALS)
    while ints[LINES_LEFT] > 0 and ints[OFFSET] < len(data):
        if data[ints[OFFSET]] not in _NEVER_PLAIN:
            _do_plain(ints, reals, data, columns, records[0])
        if ints[LINES_LEFT] <= 0 or ints[OFFSET] >= len(data):
            break
        # a line that is not surely right is done by the reader instead: of it nothing may be left behind
        _copy(ints, reals, old_ints, old_reals)
        behind = read_block(data, ints[OFFSET], ints[LONGEST], parameters, line, values, waiting, ints[COMPUTES] != 0)
        known = (
            behind >= 0
            and _sorted(ints, line, slots)
            and _set_modes(ints, reals, line, slots, records[1])
            and _moved(ints, reals, line, slots, columns, records)
        )
        if not known:
            _copy(old_ints, old_reals, ints, reals)
            break
        if slots[_STOP] >= 0:
            note(ints, records[1], OPTIONAL_STOP if slots[_STOP] == 100 else STOP, 0.0)
        for k in range(line[4][1]):
            key, value = int(line[3][k, 0]), line[3][k, 1]
            if parameters[key] != value:  # not set is NaN, which differs from all
                parameters[key] = value
                ints[CHANGES] += 1
        ints[OFFSET], ints[LINE], ints[LINES_LEFT] = behind, ints[LINE] + 1, ints[LINES_LEFT] - 1
