# mypy: allow-untyped-defs
"""Compiled: the words of a line of any kind that needs no jump, no name and no subroutine."""

from __future__ import annotations

import math

import numpy as np

from ...core.jit import kernel
from .plain_kernels import _ABSENT, _POINT, _after_comment, _number

_G, _M = ord("G") - 65, ord("M") - 65
"""Letters with codes, as places in the alphabet."""

_MOST_CODES, _MOST_SETTINGS = 12, 8
"""G and M codes of a line, and parameters that it sets; a line with more is left to the reader."""

_LARGEST_CODE = 200.0
"""No code is as large."""

_LINE = "Tuple((float64[::1], int64[::1], int64[::1], float64[:, ::1], int64[::1], int64[::1], float64[:, ::1]))"
"""A line: values by letter (26,), how each is written (26,), codes (12,) as G 100 times their number, M less 100,000 of
that, settings (8, 2) of number and value, how many codes and settings there are (2,); and room for its motion (8,), (3,
8).
"""

M_CODES = 100_000
"""Taken off the code of an M word, so that it is told from that of a G word."""

_TAKEN = "XYZIJKRFSTPLQ"
"""Letters of words that are known here beside G, M and N."""

_KNOWN = tuple(chr(65 + k) in _TAKEN for k in range(26))
"""Whether the lane reads a word of each letter of the alphabet."""


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
    i, numbered, worded = start, False, False
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
            if numbered or worded or i >= len(data) or not 48 <= data[i] <= 57:
                return -1
            i, _, written = _number(data, i)
            i, numbered = (i if written != _ABSENT else -1), True
        elif 65 <= c <= 90:
            i, worded = _word(data, i + 1, c - 65, parameters, line, values, waiting, computes), True
        else:
            return -1
        if i < 0 or i - start > longest:
            return -1
    return min(i + 1, len(data))


# Compiled: the value of a word, a number or an expression of RS274/NGC, as `expression.Values` has it.
#
# What is not surely right has no value here, and is then read by `expression`, which says what is wrong.


_BYTES = "Array(uint8, 1, 'C', True)"

_VALUE = f"Tuple((int64, float64, int64))({_BYTES}, int64, float64[::1], float64[::1], int64[::1])"

_MOST = 30
"""Operators and brackets that may wait for their operands: fewer than brackets may go deep."""

_LARGEST, _ALIKE = 1e15, 1e-4
"""A larger value is left to the reader; values that differ by less are equal, as in LinuxCNC."""

_POWER, _TIMES, _DIVIDED, _MODULO, _PLUS, _MINUS, _EQ, _NE, _GT, _GE, _LT, _LE, _AND, _OR, _XOR = range(1, 16)
"""Operators by number, as they wait on the stack."""

_RANKS = np.array([0, 5, 4, 4, 4, 3, 3, 2, 2, 2, 2, 2, 2, 1, 1, 1])
"""How strongly each operator binds, 0: none."""

_BRACKET, _PARAMETER, _NEGATIVE, _SECOND = 20, 21, 22, 23  # _SECOND: the second bracket of ATAN

_FUNCTION = 30
"""Added to the number of a function, so that on the stack it is told from operators."""


def _letters(word: str) -> int:
    """Return letters as one number, five bits each."""
    number = 0
    for letter in word:
        number = 32 * number + ord(letter) - 96
    return number


_FUNCTIONS = ("abs", "acos", "asin", "cos", "exp", "fix", "fup", "round", "ln", "sin", "sqrt", "tan", "atan")

_NAMES = np.array([_letters(word) for word in _FUNCTIONS])

_ABS, _ACOS, _ASIN, _COS, _EXP, _FIX, _FUP, _ROUND, _LN, _SIN, _SQRT, _TAN, _ATAN = range(13)
"""Functions by number."""

_WORDS = np.array([_letters(word) for word in ["mod", "eq", "ne", "gt", "ge", "lt", "le", "and", "or", "xor"]])

_WORD_OPERATORS = np.array([_MODULO, _EQ, _NE, _GT, _GE, _LT, _LE, _AND, _OR, _XOR])

_RADIANS, _DEGREES = math.pi / 180.0, 180.0 / math.pi
"""Factors of angles: expressions have degrees."""


@kernel(f"int64({_BYTES}, int64)")
def past_blanks(data, i):
    """Return the offset of the first byte at or behind an offset that is no blank; the length of the text where there
    is none.
    """
    while i < len(data) and (data[i] == 32 or data[i] == 9):
        i += 1
    return i


@kernel("float64(int64, float64)")
def _applied(function, a):
    """Return a function's value; NaN or infinite where there is none."""
    if function == _ABS:
        return abs(a)
    if function in (_ACOS, _ASIN):
        if not -1.0 <= a <= 1.0:
            return math.nan
        return (math.acos(a) if function == _ACOS else math.asin(a)) * _DEGREES
    if function == _COS:
        return math.cos(a * _RADIANS)
    if function == _EXP:
        return math.exp(a)
    if function == _FIX:
        return np.floor(a) + 0.0
    if function == _FUP:
        return np.ceil(a) + 0.0
    if function == _ROUND:
        return math.copysign(np.floor(abs(a) + 0.5), a)
    if function == _SIN:
        return math.sin(a * _RADIANS)
    if function == _TAN:
        return math.tan(a * _RADIANS)
    if a < 0.0 or (a == 0.0 and function == _LN):
        return math.nan
    return math.log(a) if function == _LN else math.sqrt(a)


@kernel("float64(int64, float64, float64)")
def _compared(operator, a, b):
    """Return what a comparison or a logical operator makes of two values: 1 or 0."""
    alike = abs(a - b) < _ALIKE
    holds = (
        (operator == _EQ and alike)
        or (operator == _NE and not alike)
        or (operator == _GT and a > b)
        or (operator == _GE and a >= b)
        or (operator == _LT and a < b)
        or (operator == _LE and a <= b)
        or (operator == _AND and a != 0.0 and b != 0.0)
        or (operator == _OR and (a != 0.0 or b != 0.0))
        or (operator == _XOR and (a != 0.0) != (b != 0.0))
    )
    return 1.0 if holds else 0.0


@kernel("float64(int64, float64, float64)")
def _joined(operator, a, b):
    """Return what an operator makes of two values; NaN or infinite where that is nothing."""
    if operator == _PLUS:
        return a + b
    if operator == _MINUS:
        return a - b
    if operator == _TIMES:
        return a * b
    if operator == _POWER:
        return a**b if not (a == 0.0 and b < 0.0) else math.nan
    if operator == _DIVIDED:
        return a / b if b != 0.0 else math.nan
    if operator == _MODULO:
        if b == 0.0:
            return math.nan
        rest = np.fmod(a, b)
        return rest + (abs(b) if rest < 0.0 else 0.0)
    return _compared(operator, a, b)


@kernel(f"UniTuple(int64, 2)({_BYTES}, int64)")
def _operator(data, i):
    """Return (offset behind it, operator) of the operator at an offset; 0: there is none."""
    c = data[i]
    if c == 42:
        behind = past_blanks(data, i + 1)
        return (behind + 1, _POWER) if behind < len(data) and data[behind] == 42 else (i + 1, _TIMES)
    if c == 47 or c == 43 or c == 45:
        return i + 1, (_DIVIDED if c == 47 else _PLUS if c == 43 else _MINUS)
    number = 0
    for _ in range(3):
        i = past_blanks(data, i)
        if i >= len(data) or not 97 <= (data[i] | 32) <= 122:
            return i, 0
        number = 32 * number + (data[i] | 32) - 96
        i += 1
        for k in range(len(_WORDS)):
            if number == _WORDS[k]:
                return i, _WORD_OPERATORS[k]
    return i, 0


@kernel(f"UniTuple(int64, 2)({_BYTES}, int64)")
def _function(data, i):
    """Return (offset behind its bracket, function) of the function at an offset; -1: there is none."""
    number = 0
    # the longest name, round, has five letters, and a bracket follows it
    for _ in range(6):
        i = past_blanks(data, i)
        if i >= len(data):
            return i, -1
        if data[i] == 91:
            for k in range(len(_NAMES)):
                if number == _NAMES[k]:
                    return i + 1, k
            return i, -1
        if not 97 <= (data[i] | 32) <= 122:
            return i, -1
        number = 32 * number + (data[i] | 32) - 96
        i += 1
    return i, -1


@kernel("int64(float64[::1], int64[::1], int64, int64, float64[::1])")
def _prefixes(values, waiting, top, count, parameters):
    """Apply what waits before a whole value: minus, and # for a parameter. Return how much still waits; -1: it has no
    value.
    """
    while top > 0 and (waiting[top - 1] == _NEGATIVE or waiting[top - 1] == _PARAMETER):
        value = values[count - 1]
        if waiting[top - 1] == _NEGATIVE:
            values[count - 1] = -value
        else:
            key = np.floor(value + 0.5)
            if abs(value - key) > _ALIKE or not 0.0 < key < len(parameters):
                return -1
            kept = parameters[int(key)]
            values[count - 1] = 0.0 if math.isnan(kept) else kept
        top -= 1
    return top


@kernel("UniTuple(int64, 2)(float64[::1], int64[::1], int64, int64, int64)")
def _reduced(values, waiting, top, count, rank):
    """Do the operators that wait and bind at least as a rank; return (what still waits, values left), -1: there is no
    value.
    """
    # two operators of one rank are done from the left, as >= says
    while top > 0 and waiting[top - 1] <= _XOR and _RANKS[waiting[top - 1]] >= rank:
        values[count - 2] = _joined(waiting[top - 1], values[count - 2], values[count - 1])
        if not math.isfinite(values[count - 2]):
            return -1, 0
        count, top = count - 1, top - 1
    return top, count


@kernel(f"Tuple((int64, int64, int64))({_BYTES}, int64, float64[::1], int64[::1], int64, int64)")
def _closed(data, i, values, waiting, top, count):
    """Close a bracket; return (offset behind it, what still waits, values left), -1 waiting: there is no value.

    Behind ATAN[...] comes a second bracket, which is open then.
    """
    top, count = _reduced(values, waiting, top, count, 1)
    if top <= 0 or waiting[top - 1] != _BRACKET:
        return i, -1, count
    top -= 1
    # a plain bracket: its value stays where it is
    if top == 0 or waiting[top - 1] < _SECOND:
        return i, top, count
    if waiting[top - 1] == _SECOND:
        values[count - 2] = math.atan2(values[count - 2], values[count - 1]) * _DEGREES
        return i, top - 1, count - 1
    function = waiting[top - 1] - _FUNCTION
    if function == _ATAN:
        i = past_blanks(data, i)
        behind = past_blanks(data, i + 1)
        if behind >= len(data) or data[i] != 47 or data[behind] != 91:
            return i, -1, count
        waiting[top - 1], waiting[top] = _SECOND, _BRACKET
        return behind + 1, top + 1, count
    values[count - 1] = _applied(function, values[count - 1])
    return i, (top - 1 if math.isfinite(values[count - 1]) else -1), count


@kernel(f"Tuple((int64, int64, int64))({_BYTES}, int64, float64[::1], int64[::1], int64, int64)")
def _operand(data, i, values, waiting, top, count):
    """Take what stands where an operand does; return (offset behind it, what waits, values), -1 waiting: it is none."""
    c = data[i]
    if c == 91 or c == 35:  # [ #
        waiting[top] = _BRACKET if c == 91 else _PARAMETER
        return i + 1, top + 1, count
    # a sign belongs to a number where one follows, else it waits for what comes: -[...], -sin[...]
    if 48 <= c <= 57 or c == 46 or c == 43 or c == 45:
        behind, value, written = _number(data, i)
        if written != _ABSENT:
            values[count] = value
            return behind, top, count + 1
        if c != 43 and c != 45:
            return i, -1, count
        waiting[top] = _NEGATIVE
        return i + 1, top + (c == 45), count
    i, function = _function(data, i)
    if function < 0:
        return i, -1, count
    waiting[top], waiting[top + 1] = _FUNCTION + function, _BRACKET
    return i, top + 2, count


@kernel(_VALUE)
def read_value(data, i, parameters, values, waiting):
    """Return (offset behind it, value, how it is written) of the value at an offset; _ABSENT: there is surely no plain
    one.

    Args:
        data: the text.
        parameters: by their numbers, NaN = not set.
        values, waiting: room to work in, of 32 each.
    """
    behind, number, written = _number(data, i)
    if written != _ABSENT:
        return behind, number, written
    top, count, operand = 0, 0, True
    while True:
        i = past_blanks(data, i)
        if i >= len(data) or data[i] == 10 or top >= _MOST or count >= _MOST:
            return i, 0.0, _ABSENT
        before = count
        if operand:
            i, top, count = _operand(data, i, values, waiting, top, count)
            operand = count == before
        elif data[i] == 93:  # ]
            i, top, count = _closed(data, i + 1, values, waiting, top, count)
            operand = data[i - 1] == 91
        else:
            i, operator = _operator(data, i)
            top, count = _reduced(values, waiting, top, count, _RANKS[operator]) if operator > 0 else (-1, 0)
            if top >= 0:
                waiting[top], top, operand = operator, top + 1, True
        if top >= 0 and not operand:
            top = _prefixes(values, waiting, top, count, parameters)
        if top < 0:
            return i, 0.0, _ABSENT
        if top == 0 and not operand:
            return i, values[0], (_POINT if abs(values[0]) < _LARGEST else _ABSENT)
