# mypy: allow-untyped-defs
"""Compiled core of `blocks`: which lines of a text surely say nothing but where to move."""

from __future__ import annotations

import math

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


# Compiled inner loop of the arc check: how far a written motion leaves its stretch of a meant arc, both swept in step.


SAMPLES = 8


@kernel("void(float64[:, ::1], float64[:, ::1], float64[:, ::1], float64[:, ::1], float64[::1])")
def in_step(written, ends, meant, span, distance):
    """Write an upper bound of the distance between each written motion and its stretch of a meant arc, in the plane.

    The distance vector is sampled; between two samples it leaves their chord by at most h^2 / 8 times its second
    derivative. That is at most sweep^2 times the distance itself, which goes to the other side of the inequality, and
    what the difference of centres, of sweeps and of radii adds.

    Args:
        written, meant: (m, 6) centre x and y, radius at the start and at the end, angle of the start, sweep; radians.
        ends: (m, 4) start and end of the written motion; it is straight where the written sweep is 0.
        span: (m, 2) which fractions of the meant arc it stands for.
        distance: (m,) the answer.
    """
    for i in range(len(written)):
        first, size = span[i, 0], span[i, 1] - span[i, 0]
        sweep, own = meant[i, 5] * size, written[i, 5]
        largest = 0.0
        for k in range(SAMPLES + 1):
            t = k / SAMPLES
            if own == 0.0:
                x, y = ends[i, 0] + (ends[i, 2] - ends[i, 0]) * t, ends[i, 1] + (ends[i, 3] - ends[i, 1]) * t
            else:
                radius, angle = written[i, 2] + (written[i, 3] - written[i, 2]) * t, written[i, 4] + own * t
                x, y = written[i, 0] + radius * math.cos(angle), written[i, 1] + radius * math.sin(angle)
            f = first + size * t
            radius, angle = meant[i, 2] + (meant[i, 3] - meant[i, 2]) * f, meant[i, 4] + meant[i, 5] * f
            x, y = x - meant[i, 0] - radius * math.cos(angle), y - meant[i, 1] - radius * math.sin(angle)
            largest = max(largest, math.sqrt(x * x + y * y))
        radius, spiral = max(meant[i, 2], meant[i, 3]), 2.0 * abs(sweep * size * (meant[i, 3] - meant[i, 2]))
        # second derivative of a spiral: sweep² radius, and 2 sweep times how fast the radius grows
        bend = sweep * sweep * radius + spiral
        if own != 0.0:
            # both turn alike but for the difference of centres and sweeps, which is all that bends their difference
            shift = math.hypot(written[i, 0] - meant[i, 0], written[i, 1] - meant[i, 1])
            spiral += 2.0 * abs(own * (written[i, 3] - written[i, 2]))
            bend = own * own * shift + abs(own * own - sweep * sweep) * radius + spiral
        distance[i] = (largest + bend / (8.0 * SAMPLES * SAMPLES)) / max(
            0.1, 1.0 - own * own / (8.0 * SAMPLES * SAMPLES)
        )
