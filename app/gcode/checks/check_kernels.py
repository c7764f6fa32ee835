"""Compiled core of `blocks`: which lines of a text surely say nothing but where to move."""

from __future__ import annotations

import numpy as np

from ...core.jit import kernel

_LETTERS = np.frombuffer(b"NXYZIJFRQnxyzijfrq", np.uint8)
_G, _POINT, _ZERO, _NINE, _PLUS, _MINUS, _LINE_FEED = (71, 103), 46, 48, 57, 43, 45, 10
_SPACES = (32, 9, 13)

_BYTES, _TABLE = "Array(uint8, 1, 'C', True)", "int64[:, ::1]"


@kernel(f"int64({_BYTES}, int64)", counts=False)
def _after_number(data, i):
    """Return the offset behind the plain number at offset i; -1 where there is none."""
    if i < len(data) and (data[i] == _PLUS or data[i] == _MINUS):
        i += 1
    digits, pointed = 0, False
    while i < len(data):
        if _ZERO <= data[i] <= _NINE:
            digits += 1
        elif data[i] == _POINT and not pointed:
            pointed = True
        else:
            break
        i += 1
    return i if digits else -1


@kernel(f"int64({_BYTES}, int64, {_BYTES}, {_TABLE})", counts=False)
def _after_code(data, i, codes, spans):
    """Return the offset behind the number of a G word, where it is one of some codes with zeros before it or none; else
    -1.
    """
    end = i
    while end < len(data) and (_ZERO <= data[end] <= _NINE or data[end] == _POINT):
        end += 1
    for code in range(len(spans)):
        length = spans[code, 1] - spans[code, 0]
        alike = length <= end - i
        for k in range(i, end):
            # aligned at the right: what is longer than the code may only be zeros before it (G01 is G1)
            own = k - (end - length)
            alike = alike and data[k] == (codes[spans[code, 0] + own] if own >= 0 else _ZERO)
        if alike:
            return end
    return -1


@kernel(f"int64({_BYTES}, {_BYTES}, {_TABLE}, int64[::1])")
def lines_with_more(data, codes, spans, lines):
    """Write which lines may hold more than words that move: X Y Z I J F R Q N with plain numbers, some G words, spaces.

    Args:
        data: the text.
        codes: numbers of the G words behind one another, without zeros before them. spans: (k, 2) where each begins and
            ends in it.
        lines: the answer, 1-based; as long as there are lines.

    Returns:
        How many lines are written.
    """
    i, line, found = 0, 1, 0
    while i < len(data):
        c = data[i]
        if c == _LINE_FEED:
            i, line = i + 1, line + 1
            continue
        after = -1
        if c in _SPACES:
            after = i + 1
        elif c in _G:
            after = _after_code(data, i + 1, codes, spans)
        else:
            for letter in _LETTERS:
                if c == letter:
                    after = _after_number(data, i + 1)
        if after < 0:
            # anything that is not surely harmless makes the line one to look at; nothing is decided here
            lines[found] = line
            found += 1
            while i < len(data) and data[i] != _LINE_FEED:
                i += 1
        else:
            i = after
    return found
