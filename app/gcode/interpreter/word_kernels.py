"""Compiled: the words of a line of any kind that needs no jump, no name and no subroutine."""

from __future__ import annotations

from ...core.jit import kernel
from .plain_kernels import _ABSENT, _after_comment, _number
from .value_kernels import past_blanks, read_value

_G, _M = ord("G") - 65, ord("M") - 65
_MOST_CODES, _MOST_SETTINGS = 12, 8
_LARGEST_CODE = 200.0

_LINE = "Tuple((float64[::1], int64[::1], int64[::1], float64[:, ::1], int64[::1], int64[::1], float64[:, ::1]))"
"""A line: values by letter (26,), how each is written (26,), codes (12,) as G 100 times their number, M less 100,000 of
that, settings (8, 2) of number and value, how many codes and settings there are (2,); and room for its motion (8,), (3,
8).
"""
M_CODES = 100_000
_TAKEN = "XYZIJKRFSTPLQ"
"""Letters of words that are known here beside G, M and N."""
_KNOWN = tuple(chr(65 + k) in _TAKEN for k in range(26))


@kernel("int64(float64)")
def _code(number):
    """Return a hundred times a code's number; -1 where it is none."""
    if not 0.0 <= number < _LARGEST_CODE:
        return -1
    code = int(number * 100.0 + 0.5)
    return code if abs(number * 100.0 - code) < 1e-6 else -1


@kernel(f"int64(Array(uint8, 1, 'C', True), int64, float64[::1], {_LINE}, float64[::1], int64[::1])")
def _setting(data, i, parameters, line, values, waiting):
    """Read what sets a parameter, from behind its #; return the offset behind it, -1: it is not known here."""
    i, number, written = read_value(data, i, parameters, values, waiting)
    key = int(number + 0.5) if written != _ABSENT and 0.0 < number < len(parameters) else 0
    i = past_blanks(data, i)
    count = line[4][1]
    if (
        abs(number - key) > 1e-4
        or not 0 < key < len(parameters)
        or count >= _MOST_SETTINGS
        or i >= len(data)
        or data[i] != 61
    ):
        return -1
    i, value, written = read_value(data, i + 1, parameters, values, waiting)
    line[3][count, 0], line[3][count, 1] = key, value
    line[4][1] = count + 1
    return i if written != _ABSENT else -1


@kernel(f"int64(Array(uint8, 1, 'C', True), int64, int64, float64[::1], {_LINE}, float64[::1], int64[::1], boolean)")
def _word(data, i, letter, parameters, line, values, waiting, computes):
    """Read the value of a letter's word; return the offset behind it, -1: it is not known here."""
    if computes:
        i, value, written = read_value(data, i, parameters, values, waiting)
    else:
        i, value, written = _number(data, i)
    if written == _ABSENT:
        return -1
    if letter in (_G, _M):
        code, count = _code(value), line[4][0]
        if code < 0 or count >= _MOST_CODES:
            return -1
        line[2][count] = code if letter == _G else code - M_CODES
        line[4][0] = count + 1
    elif not _KNOWN[letter] or line[1][letter] != _ABSENT:
        return -1
    else:
        line[0][letter], line[1][letter] = value, written
    return i


@kernel(f"int64(Array(uint8, 1, 'C', True), int64, int64, float64[::1], {_LINE}, float64[::1], int64[::1], boolean)")
def read_block(data, start, longest, parameters, line, values, waiting, computes):
    """Read a line; return the offset of the next one, -1: something in it is not known here.

    Args:
        data: the text. start: offset of the line. longest: bytes that it may have.
        parameters: by their numbers, NaN = not set.
        line: out, see `_LINE`.
        values, waiting: room for `read_value`.
        computes: whether expressions and parameters are known here.
    """
    line[1][:], line[4][:] = _ABSENT, 0
    i, numbered = start, False
    while i < len(data) and data[i] != 10:
        c = data[i] & 0xDF if data[i] >= 96 else data[i]  # in capitals
        if c == 32 or c == 9:
            i += 1
        elif c == 40:  # (
            i = _after_comment(data, i + 1, 41)
        elif c == 59:  # ;
            i = _after_comment(data, i + 1, 10)
        elif c == 35 and computes:  # #
            i = _setting(data, i + 1, parameters, line, values, waiting)
        elif c == 78:  # N
            i = past_blanks(data, i + 1)
            if numbered or i >= len(data) or not 48 <= data[i] <= 57:
                return -1
            i, _, written = _number(data, i)
            i, numbered = (i if written != _ABSENT else -1), True
        elif 65 <= c <= 90:
            i = _word(data, i + 1, c - 65, parameters, line, values, waiting, computes)
        else:
            return -1
        if i < 0 or i - start > longest:
            return -1
    return min(i + 1, len(data))
