# mypy: allow-untyped-defs
"""Compiled: which lines of a program say no more than where a straight feed move goes, and whether it goes there."""

from __future__ import annotations

from ...core.jit import kernel

_BYTES, _INTS, _FLAGS = "Array(uint8, 1, 'C', True)", "int64[::1]", "boolean[::1]"
_SAME = 1e-7
"""mm; a place that words say is that of the motion where they are no farther apart."""
# ASCII; & _UPPER clears the bit that tells small letters from capitals.
_SPACE, _ZERO, _NINE, _DOT, _PLUS, _MINUS, _UPPER = 32, 48, 57, 46, 43, 45, 0xDF
_LETTERS = (88, 89, 90, 70)
"""X, Y, Z, F."""
_G, _N = 71, 78
"""Letters, as bytes."""


@kernel("boolean(uint8)", counts=False)
def _blank(byte):
    """Tell whether a byte is a space, a tab, a vertical one, a form or line feed, a return or a separator of files to
    units.
    """
    return byte == _SPACE or 9 <= byte <= 13 or 28 <= byte <= 31


@kernel("boolean(uint8)", counts=False)
def _digit(byte):
    return _ZERO <= byte <= _NINE


@kernel(f"int64({_BYTES}, int64, int64)", counts=False)
def _past_blanks(text, at, stop):
    while at < stop and _blank(text[at]):
        at += 1
    return at


@kernel(f"int64({_BYTES}, int64, int64)", counts=False)
def _past_number(text, at, stop):
    """Return where the line's number, if it begins with one, and the blanks round it end."""
    at = _past_blanks(text, at, stop)
    if at + 1 < stop and text[at] & _UPPER == _N and _digit(text[at + 1]):
        at += 1
        while at < stop and _digit(text[at]):
            at += 1
    return _past_blanks(text, at, stop)


@kernel(f"int64({_BYTES}, int64, int64)", counts=False)
def _past_code(text, at, stop):
    """Return where a G1 that begins here ends, `at` itself where there is none."""
    end = at + 1
    if at >= stop or text[at] & _UPPER != _G:
        return at
    if end < stop and text[end] == _ZERO:
        end += 1
    # G1 and G01, but not G10 to G19 or G1.5, which are other words.
    if end >= stop or text[end] != _ZERO + 1 or (end + 1 < stop and (_digit(text[end + 1]) or text[end + 1] == _DOT)):
        return at
    return end + 1


@kernel(f"Tuple((int64, float64))({_BYTES}, int64, int64)", counts=False)
def _number(text, at, stop):
    """Return where a decimal number that begins here ends, and its value; `at` itself where there is none."""
    # No exponent: in NC text E is an address of its own.
    begin, sign = at, 1.0
    if at < stop and (text[at] == _PLUS or text[at] == _MINUS):
        sign = -1.0 if text[at] == _MINUS else 1.0
        at += 1
    value, digits, scale = 0.0, 0, 1.0
    while at < stop and _digit(text[at]):
        value, digits, at = 10.0 * value + (text[at] - _ZERO), digits + 1, at + 1
    if at < stop and text[at] == _DOT:
        at += 1
        while at < stop and _digit(text[at]):
            value, digits, scale, at = 10.0 * value + (text[at] - _ZERO), digits + 1, 10.0 * scale, at + 1
    return (at, sign * value / scale) if digits > 0 else (begin, 0.0)


@kernel(f"boolean({_BYTES}, int64, int64, float64[::1], float64[::1], float64, int64[::1])", counts=False)
def _says(text, at, stop, end, shift, unit, feed):
    """Tell whether words X, Y, Z and F, each once, are all that is left of a line, and say where it ends.

    Args:
        end: (3,) of the motion, mm. shift: (3,) what is added to what words say, mm. unit: of them, mm.
        feed: (2,) out: where the F word's number begins and ends, -1: there is none.
    """
    feed[0] = feed[1] = -1
    seen, places = 0, 0
    while at < stop:
        which = -1
        for k in range(4):
            if text[at] & _UPPER == _LETTERS[k]:
                which = k
        # `seen` has a bit a letter: a word said twice has two meanings, which are not this one's to choose between.
        if which < 0 or seen & (1 << which):
            return False
        seen |= 1 << which
        begin = _past_blanks(text, at + 1, stop)
        at, value = _number(text, begin, stop)
        if at == begin:
            return False
        if which == 3:
            feed[0], feed[1] = begin, at
        # Written so that a place that is not a number fails, too.
        elif not abs(value * unit + shift[which] - end[which]) <= _SAME:
            return False
        else:
            places += 1
        at = _past_blanks(text, at, stop)
    return places > 0


@kernel(
    f"void({_BYTES}, {_INTS}, {_INTS}, float64[:, ::1], {_INTS}, float64[:, ::1], float64[::1], {_FLAGS}, {_FLAGS}, "
    f"{_FLAGS}, int64[:, ::1])"
)
def read_moves(text, begins, lines, ends, states, shifts, units, plain, coded, numbered, feeds):
    """Read the lines of n straight moves.

    Args:
        text: bytes. begins: of each line of it its first byte, and one behind the last line feed.
        lines: (n,) number of each move's line, from 0 on. ends: (n, 3) where it ends, mm.
        states: (n,) index into shifts (s, 3), mm, and units (s,), mm, in force.
        plain: (n,) out: whether the line says where the move ends, maybe G1 and a feed, and nothing else.
        coded: (n,) out: whether it says G1. numbered: (n,) out: whether it has a number.
        feeds: (n, 2) out: where the F word's number begins and ends, -1: there is none.
    """
    for row in range(len(lines)):
        begin, stop = begins[lines[row]], begins[lines[row] + 1] - 1
        at = _past_number(text, begin, stop)
        numbered[row] = at > _past_blanks(text, begin, stop)
        code = _past_code(text, at, stop)
        coded[row] = code > at
        at = _past_blanks(text, code, stop)
        state = states[row]
        plain[row] = _says(text, at, stop, ends[row], shifts[state], units[state], feeds[row])


@kernel(f"int64({_BYTES}, {_INTS}, {_INTS})")
def read_lines(text, begins, filled):
    """Write where each line begins, and behind the last one; and how many lines with something in them are before each,
    and in all.

    Args:
        text: bytes, its last one a line feed. begins, filled: (m + 1,) out, of m lines.
    """
    line, some, count = 0, False, 0
    begins[0] = filled[0] = 0
    for k in range(len(text)):
        if text[k] == 10:
            count += some
            line, some = line + 1, False
            begins[line], filled[line] = k + 1, count
        elif not _blank(text[k]):
            some = True
    return count
