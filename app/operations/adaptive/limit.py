"""Closed forms of the engaged angle of a cutter that goes round a centre.

A point of the rim's front half, theta from the direction away from the centre, has the distance t from the centre with
t^2 = rho^2 + r^2 + 2 rho r cos theta, which falls as theta rises (rho: radius of the path, r: of the cutter). So where
all ground within s of the centre is clear, nothing beyond the theta of t = s is engaged, anywhere along the path.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

_FINENESS = 8e-4
"""mm that a clear disc is taken to be smaller than it is when a path is paid for with it: what the digits of an NC
program move path and disc at most, both together."""

_SPARE, _COARSE_SPARE = math.radians(0.15), math.radians(0.35)
"""Radians that the limit is not used by, with fine digits and with coarse ones: in tight corners digits move the angle
the most, and proofs need some room.
"""

_LESS = math.radians(0.15)
"""Radians less than planned, for arcs that are not quite the way along the edge of the metal."""

_ASIDE = 3e-4
"""mm by which fine digits move one end of a row beside the other at most, both rounded in x and y, and as much again
as the row before it, whose side is clear, is turned as well.
"""

_LEAST_CENTRE = 0.002
"""mm; the least radius of a path that all controls know as an arc is 0.005 mm, and the tip of a corner needs a few."""


@dataclass(frozen=True)
class DigitGrid:
    """The places that the digits of a program can say.

    Circles whose centres lie on it, and whose radii are a whole number of steps, are written as they are: half turns of
    a spiral that touch then touch as written. Where they do not, slivers of metal as thin as a digit stand between them
    over a length that goes with the root of it, and the angle with that.

    Attributes:
        step: mm from one to the next.
        zero: where the program has its zero, mm.
    """

    step: float
    zero: tuple[float, float] = (0.0, 0.0)

    def nearest(self, place: tuple[float, float]) -> tuple[float, float]:
        """Return the place on it that is nearest to one, mm."""
        x, y = (zero + self.step * round((at - zero) / self.step) for at, zero in zip(place, self.zero, strict=True))
        return x, y

    def within(self, length: float) -> float:
        """Return the longest whole number of steps that is no longer than a length, mm."""
        return self.step * math.floor(length / self.step + 1e-3)

    def mirrored(self) -> DigitGrid:
        """Return it in a mirror, x to -x."""
        return DigitGrid(self.step, (-self.zero[0], self.zero[1]))


@dataclass(frozen=True)
class EngagementLimit:
    """What a cutter may be engaged.

    Attributes:
        radius: of the cutter, mm, > 0.
        angle: of its rim that may be in metal, radians, in (0, pi / 2].
        coarser: how many times coarser than 0.0001 mm the digits of the program are.
        grid: of these digits; None = they are fine enough for paths to lie anywhere.
    """

    radius: float
    angle: float
    coarser: float = 1.0
    grid: DigitGrid | None = None

    @property
    def slack(self) -> float:
        """By how much less than it is a clear disc is taken to be, mm."""
        return _FINENESS * self.coarser + (0.75 * self.grid.step if self.grid is not None else 0.0)

    @property
    def planned(self) -> float:
        """The angle that paths are planned with, radians."""
        return self.angle - (_COARSE_SPARE if self.grid is not None or self.coarser > 1.0 else _SPARE)

    @property
    def pursued(self) -> float:
        """The angle that ways along the metal's edge are planned with, radians: arcs are not quite these ways."""
        return self.planned - _LESS

    def written(self, length: float) -> float:
        """Return the angle that a row so long, mm, may have as it is planned, radians: digits turn a short one, and the
        angle with it.
        """
        return self.angle - _ASIDE * self.coarser / max(length, _ASIDE)

    @property
    def depth(self) -> float:
        """Radial depth of a straight cut along a side that is engaged by as much, mm."""
        return self.radius * (1 - math.cos(self.planned))

    @property
    def scallop(self) -> float:
        """Height of the scallops that may stand along walls before the last way round, mm."""
        return 0.4 * self.depth

    @property
    def least_turn(self) -> float:
        """The least radius of a path that goes round a centre, mm: below, digits move the angle too much."""
        return max(_LEAST_CENTRE * self.coarser, 2.5 * self.slack / (1 - math.cos(self.planned)))

    def clear_needed(self, turn: float) -> float:
        """Return how far round its centre ground must be clear for a path round it, mm, the slack counted.

        Args:
            turn: radius of the path, mm.
        """
        r, cosine = self.radius, math.cos(self.planned)
        return math.sqrt(turn * turn + r * r + 2 * turn * r * cosine) + self.slack

    def growth(self, turn: float) -> float:
        """Return by how much the radius may grow from one half turn of a spiral to the next, mm; 0 where it cannot.

        With e so much, the half turn goes round a centre e beside that of the one before, and finds (radius of the
        ground cleared so far - e) clear.
        """
        r, cosine = self.radius, math.cos(self.planned)
        # turn + r - e = clear_needed(turn + e), squared: what is left of e is linear
        clear = turn + r - self.slack
        grown = clear * clear - turn * turn - r * r - 2 * turn * r * cosine
        return max(0.0, grown / (2 * (clear + turn + r * cosine)))
