# mypy: allow-untyped-defs
"""Compiled core of `blocks`: the text of motions, one block after the other, each with the words that the control
lacks.
"""

from __future__ import annotations

import numpy as np

from ...core.jit import kernel

UNKNOWN = -(2**62)
"""A position that nobody knows, and as an end: where the tool is already."""
NO_FEED = -1
"""In place of a feed rate: nothing is said of it; what is in force is unknown."""
NO_MOTION = -1
"""Instead of a kind of motion: none is in force."""
LONGEST_NUMBER = 32
"""A word is no longer, its letter, its sign, its point and the space before it included."""
WORDS = 8
"""Words that a block may have."""

_MOTION, _FEED, _NUMBER = 3, 4, 5  # columns of what is in force
_POSITION_DECIMALS, _CENTRE_DECIMALS, _FEED_DECIMALS, _ZEROS, _FEED_POINT = 0, 3, 4, 5, 6  # columns of the form
_ABSOLUTE, _MODAL, _STEP, _START, _LAST = 7, 8, 9, 10, 11
"""Places in `form`: whether ends are absolute and motions modal; step, first and last number of blocks."""
_LINE = 1  # kinds above it are arcs
_LETTERS = np.frombuffer(b"XYZIJFNG", np.uint8)
_IJ, _F, _N, _G = 3, 5, 6, 7  # places in it
_DROPPED, _KEPT, _PUT = range(3)  # a point that has no digits behind it: never; where the word has decimals; always
_SPACE, _POINT, _MINUS, _ZERO, _LINE_FEED = 32, 46, 45, 48, 10
"""Bytes of text."""

_BYTES, _COLUMN, _TABLE = "uint8[::1]", "int64[::1]", "int64[:, ::1]"


@kernel(f"int64({_BYTES}, int64, int64, int64, boolean, int64)", counts=False)
def _number(out, at, count, decimals, zeros, point):
    """Write a count of the last decimal as a number; return the offset behind it.

    Args:
        out: the text. at: offset of the number.
        zeros: write those at its end too.
        point: what becomes of a point without digits behind it.
    """
    if count < 0:
        out[at] = _MINUS
        at, count = at + 1, -count
    behind = decimals
    while not zeros and behind and count % 10 == 0:
        count //= 10
        behind -= 1
    digits, rest = 1, count // 10
    while rest:
        digits, rest = digits + 1, rest // 10
    digits = max(digits, behind + 1)
    pointed = behind > 0 or point == _PUT or (point == _KEPT and decimals > 0)
    end = at + digits + pointed
    place = end - 1
    for k in range(digits):
        if pointed and k == behind:
            out[place] = _POINT
            place -= 1
        out[place] = _ZERO + count % 10
        count //= 10
        place -= 1
    return end


@kernel(f"int64({_BYTES}, int64, {_COLUMN}, {_COLUMN}, boolean)", counts=False)
def _block_number(out, at, state, form, used):
    """Write the N word and the space behind it, if blocks have one; return the offset behind it."""
    if not used:
        return at
    out[at] = _LETTERS[_N]
    at = _number(out, at + 1, state[_NUMBER], 0, True, _DROPPED)
    state[_NUMBER] += form[_STEP]
    if state[_NUMBER] > form[_LAST]:
        state[_NUMBER] = form[_START]
    out[at] = _SPACE
    return at + 1


@kernel(f"int64({_BYTES}, int64, int64, int64, {_COLUMN})", counts=False)
def _word(out, at, word, count, form):
    """Write a word other than G and N; return the offset behind it."""
    out[at] = _LETTERS[word]
    if word == _F:
        return _number(out, at + 1, count, form[_FEED_DECIMALS], False, _PUT if form[_FEED_POINT] else _DROPPED)
    return _number(out, at + 1, count, form[min(word, _CENTRE_DECIMALS)], form[_ZEROS] != 0, _KEPT)


@kernel(f"void(int64, {_COLUMN}, {_COLUMN}, int64, {_COLUMN}, {_COLUMN}, {_COLUMN}, {_COLUMN})", counts=False)
def _values(motion, end, centre, feed, state, form, value, said):
    """Write the count of each word, and which words a block says; none says nothing but G and F."""
    arc = motion > _LINE
    for axis in range(3):
        value[axis] = end[axis]
        said[axis] = end[axis] != UNKNOWN and (end[axis] != state[axis] or (arc and axis < 2))
    for axis in range(2):
        value[_IJ + axis], said[_IJ + axis] = centre[axis], arc
        if form[_ABSOLUTE] and state[axis] != UNKNOWN:
            value[_IJ + axis] += state[axis] * 10 ** (form[_CENTRE_DECIMALS] - form[_POSITION_DECIMALS])
    value[_F], said[_F] = feed, feed != NO_FEED and feed != state[_FEED]


@kernel(f"int64({_TABLE}, int64, int64, {_COLUMN}, {_BYTES}, {_TABLE}, {_COLUMN}, {_COLUMN}, {_BYTES}, {_COLUMN})")
def write_blocks(rows, first, stop, order, motions, spans, form, state, out, lines):
    """Write the blocks of motions; one that says no word but G and F is left out, and changes nothing.

    Args:
        rows: (n, 7) kind of the motion (0 rapid, 1 line, 2 and 3 arcs); X, Y, Z where it ends, counts of the last
            decimal, or UNKNOWN; I and J from its start, counts; F, counts, or NO_FEED.
        first, stop: which of them.
        order: places in "XYZIJFNG" of the words in the order of writing.
        motions: the texts of the four G words behind one another. spans: (4, 3) where each begins and ends in it, and
            what it is known by: NO_MOTION for none.
        form: (12,) decimals of X, Y, Z, I, F; whether zeros at the end are written, F always has a point, I and J are
            absolute, G is modal; step of the N words, 0 = there are none, their first and their last one.
        state: (6,) what is in force: X, Y, Z or UNKNOWN, the motion, F, the next N word. It is changed.
        out: (m,) the answer: the text, each block with a line feed behind it; long enough.
        lines: (stop - first,) the answer: how many blocks there are behind each motion.

    Returns:
        The length of the text.
    """
    at, count = 0, 0
    value, said, centre, end = (
        np.zeros(WORDS, np.int64),
        np.zeros(WORDS, np.int64),
        np.empty(2, np.int64),
        np.empty(3, np.int64),
    )
    for row in range(first, stop):
        kind, feed = rows[row, 0], rows[row, 6]
        end[0], end[1], end[2], centre[0], centre[1] = (
            rows[row, 1],
            rows[row, 2],
            rows[row, 3],
            rows[row, 4],
            rows[row, 5],
        )
        _values(kind, end, centre, feed, state, form, value, said)
        if said[0] or said[1] or said[2] or said[_IJ]:
            said[_G] = spans[kind, 2] != state[_MOTION] or not form[_MODAL]
            at, spaced = _block_number(out, at, state, form, form[_STEP] != 0), False
            for word in order:
                if not said[word]:
                    continue
                if spaced:
                    out[at] = _SPACE
                    at += 1
                spaced = True
                if word == _G:
                    for k in range(spans[kind, 0], spans[kind, 1]):
                        out[at] = motions[k]
                        at += 1
                    continue
                at = _word(out, at, word, value[word], form)
            out[at] = _LINE_FEED
            at, count = at + 1, count + 1
            state[0], state[1], state[2], state[_MOTION] = end[0], end[1], end[2], spans[kind, 2]
            if said[_F]:
                state[_FEED] = feed
        lines[row - first] = count
    return at
