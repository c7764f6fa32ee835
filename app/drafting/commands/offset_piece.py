"""Lines and arcs of a parallel, and which way they run."""

from __future__ import annotations

import math
from dataclasses import dataclass

from ...model.curves import Arc, Line, Point


@dataclass(frozen=True, slots=True)
class OffsetPiece:
    """A line or arc of a parallel.

    Attributes:
        source: number of the curve that it goes along, or round whose end it goes.
        corner: the corner that it goes round, else None.
    """

    curve: Line | Arc
    source: int
    corner: Point | None = None


def direction(curve: Line | Arc, at: Point) -> complex:
    """Return the unit vector, x + iy, in which a line or arc runs at a point of it."""
    if isinstance(curve, Line):
        size = math.dist(curve.start, curve.end)
        return complex(curve.end[0] - curve.start[0], curve.end[1] - curve.start[1]) / size
    spoke = complex(at[0] - curve.centre[0], at[1] - curve.centre[1])
    return spoke / abs(spoke) * (1j if curve.ccw else -1j)
