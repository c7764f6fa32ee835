"""Numbers as people type them: arithmetic and units."""

from __future__ import annotations

import re

_PLAIN = re.compile(r"-?\d{1,7}(\.\d+)?", re.ASCII)
"""Numbers that need no grammar, whose parser takes as long to import as a small job to run."""


def length(text: str, plain: float = 1.0) -> float:
    """Return the length that a text such as `12.5`, `1in + 8mm`, `1/4in` or `(3+4)*2` states, mm.

    A number without a unit counts in `plain` mm; a unit right after a fraction of plain numbers belongs to the
    fraction.

    Raises:
        CommandError: not a number, an unknown unit, a division by zero, or beyond 10 km.
    """
    if _PLAIN.fullmatch(text):
        return float(text) * plain
    from .evaluate import length_of
    from .grammar import read_value
    from .units import LENGTH_UNITS
    from .values import Scope

    return float(length_of(read_value(text), Scope(units=LENGTH_UNITS, plain=plain)))


def angle(text: str) -> float:
    """Return the angle that a text such as `45`, `180/7` or `0.5rad` states, degrees.

    Raises:
        CommandError: as for `length`.
    """
    from .evaluate import number_of
    from .grammar import read_value
    from .units import ANGLE_UNITS
    from .values import Scope

    return number_of(read_value(text), Scope(units=ANGLE_UNITS))
