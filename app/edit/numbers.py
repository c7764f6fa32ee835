"""Numbers and points as people type them: arithmetic and units."""

from __future__ import annotations

from dataclasses import replace

from app.edit.evaluate import number_of, point_of
from app.edit.grammar import read_value
from app.edit.units import ANGLE_UNITS, LENGTH_UNITS
from app.edit.values import Scope
from app.model.curves import Point


def length(text: str) -> float:
    """Return the length that a text such as `12.5`, `1in + 8mm`, `1/4in` or `(3+4)*2` states, mm.

    A number without a unit counts in mm; a unit right after a fraction of plain numbers belongs to the fraction.

    Raises:
        CommandError: not a number, an unknown unit, a division by zero, or beyond 10 km.
    """
    return number_of(read_value(text), Scope(units=LENGTH_UNITS))


def angle(text: str) -> float:
    """Return the angle that a text such as `45`, `180/7` or `0.5rad` states, degrees.

    Raises:
        CommandError: as for `length`.
    """
    return number_of(read_value(text), Scope(units=ANGLE_UNITS))


def read_point(text: str, base: Point, scope: Scope | None = None) -> Point:
    """Return the point that `x,y`, `r<angle`, `@dx,dy` or `@r<angle` (degrees) names, mm.

    Args:
        base: where relative coordinates start from, mm.
        scope: names that the text may use.

    Raises:
        CommandError: the text is no point.
    """
    within = scope or Scope(units=LENGTH_UNITS)
    return point_of(read_value(text), replace(within, last=base))
