"""Where the letters of a line of words stand: on a straight line, or along curves."""

from __future__ import annotations

import cmath
import math
from collections.abc import Sequence
from dataclasses import dataclass, replace
from itertools import accumulate
from typing import Protocol

from ...core.tolerances import WELD
from ...geometry.transform import Similarity, turn
from ...model.curves import Arc, Line, Point
from .intersections import nearest_point
from .shapes import curve_length


class Baseline(Protocol):
    """What words stand on.

    Its length is infinite where there is always room.
    """

    @property
    def start(self) -> Point:
        """Where it begins, mm."""

    @property
    def length(self) -> float:
        """How much room there is, mm."""

    def placed(self, along: float, advance: float, scale: float) -> Similarity:
        """Return where a letter goes.

        Args:
            along: from the beginning of the baseline to the letter's origin, mm.
            advance: from there to the next letter, mm.
            scale: mm a unit of the letter's curves.
        """


@dataclass(frozen=True, slots=True)
class StraightBaseline:
    """A ray from a point on.

    Attributes:
        start: where it begins, mm. angle: degrees.
    """

    start: Point
    angle: float = 0.0

    @property
    def length(self) -> float:
        """There is always room."""
        return math.inf

    def placed(self, along: float, advance: float, scale: float) -> Similarity:
        """Return where a letter goes: turned as the ray is."""
        turned = turn(self.start, self.angle)
        return Similarity(turned.a * scale, complex(*turned((self.start[0] + along, self.start[1]))))


@dataclass(frozen=True, slots=True)
class CurvedBaseline:
    """Lines and arcs of which each begins where the one before ends.

    A letter stands upright on the tangent under the middle of its advance. On arcs that is exact.

    Attributes:
        pieces: in the direction of the words. ends: length up to the end of each, mm.
        closed: the last piece ends where the first begins, and words may go on beyond it.
        lift: of the letters to the left of the curves, mm.
    """

    pieces: tuple[Line | Arc, ...]
    ends: tuple[float, ...]
    closed: bool = False
    lift: float = 0.0

    @staticmethod
    def of(pieces: Sequence[Line | Arc], closed: bool = False, lift: float = 0.0) -> CurvedBaseline:
        """Return the baseline along pieces."""
        return CurvedBaseline(tuple(pieces), tuple(accumulate(map(curve_length, pieces))), closed, lift)

    @property
    def start(self) -> Point:
        """Where the first piece begins, mm."""
        return self.pieces[0].start

    @property
    def length(self) -> float:
        """That of all pieces, mm."""
        return self.ends[-1]

    def placed(self, along: float, advance: float, scale: float) -> Similarity:
        """Return where a letter goes: upright on the tangent under the middle of its advance."""
        foot, way = self._at(along + advance / 2)
        return Similarity(way * scale, foot + way * complex(-advance / 2, self.lift))

    def nearest(self, point: Point) -> float:
        """Return how far along the place lies that is nearest to a point, mm."""
        feet = [nearest_point(piece, point) for piece in self.pieces]
        k = min(range(len(feet)), key=lambda k: math.dist(feet[k], point))
        piece, begun = self.pieces[k], self.ends[k - 1] if k else 0.0
        if isinstance(piece, Line) or math.dist(feet[k], piece.start) < WELD:
            return begun + math.dist(piece.start, feet[k])
        return begun + curve_length(replace(piece, end=feet[k]))

    def _at(self, along: float) -> tuple[complex, complex]:
        """Return the point so far along, and the direction of travel there, of length 1."""
        along = along % self.length if self.closed else along
        k = next((k for k, end in enumerate(self.ends) if along <= end), len(self.ends) - 1)
        piece, begun = self.pieces[k], self.ends[k - 1] if k else 0.0
        start = complex(*piece.start)
        if isinstance(piece, Line):
            way = complex(*piece.end) - start
            way /= abs(way)
            return start + (along - begun) * way, way
        centre = complex(*piece.centre)
        sense = 1 if piece.ccw else -1
        spoke = (start - centre) * cmath.exp(1j * sense * (along - begun) / piece.radius)
        return centre + spoke, 1j * sense * spoke / abs(spoke)
