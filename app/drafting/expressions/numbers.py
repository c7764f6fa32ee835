"""Numbers as people type them: arithmetic and units."""

from __future__ import annotations

import math
import re
from collections.abc import Mapping

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
    from .values import Scope

    return float(length_of(read_value(text), Scope(units=LENGTH_UNITS, plain=plain)))


def angle(text: str) -> float:
    """Return the angle that a text such as `45`, `180/7` or `0.5rad` states, degrees.

    Raises:
        CommandError: as for `length`.
    """
    from .evaluate import number_of
    from .grammar import read_value
    from .values import Scope

    return number_of(read_value(text), Scope(units=ANGLE_UNITS))


LENGTH_UNITS: Mapping[str, float] = {
    "mm": 1.0,
    "cm": 10.0,
    "m": 1000.0,
    "um": 1e-3,
    "µm": 1e-3,
    "in": 25.4,
    '"': 25.4,
    "ft": 304.8,
    "thou": 0.0254,
    "mil": 0.0254,
}
"""Size of each length unit, mm."""

ANGLE_UNITS: Mapping[str, float] = {"deg": 1.0, "°": 1.0, "rad": 180.0 / math.pi}
"""Size of each angle unit, degrees."""

ALL_UNITS: Mapping[str, float] = {**LENGTH_UNITS, **ANGLE_UNITS}
