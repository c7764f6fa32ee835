"""Lines and arcs for points of one plane: of two ways to find few of them the better one, proven."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np

from ...core.progress import NO_PROGRESS, Progress
from ...model.motion import Floats, Plane
from ..fitted import FittedPath, arcs_between
from ..point_curves.space_curve import curve_of_motions
from ..point_curves.tube import ToleranceTube, TubeAnswer, judge
from .fewest import FewestPieces
from .tangent import PlanarPolyline, TangentFit, TangentPath

_MOVED = (0.999, 0.9)
"""Of the tolerance, that joints are moved in: between the samples that they are held to a little more is used."""
_SEARCHED = (0.99, 0.93)
"""Of the tolerance, that joints are searched in."""
_AS_SHARP = 2.0
"""Where the points bend pieces may by so many times as much, too."""
_FINE = 0.01
"""Of the tolerance: of a coarser last digit no more is taken for rounding, as points on a wide grid may be meant to be
there.
"""
_MOST_DIGITS = 8
"""Decimals that a last digit is looked for in, and one less of them: finer ones are rounding."""
_SAME = 1e-6
"""Radians: bends are held to their limit but for the digits that they are reckoned in."""


@dataclass(frozen=True, eq=False)
class FlatPath:
    """Pieces in a plane, proven.

    Attributes:
        path: they. bend: by how much it turns at most where one meets the next, radians.
    """

    path: FittedPath
    bend: float

    def __len__(self) -> int:
        return len(self.path.motions)

    def better(self, other: FlatPath | None) -> FlatPath:
        """Return the one of fewer pieces, of equally many the one that bends less."""
        return self if other is None or (len(self), self.bend) < (len(other), other.bend) else other


@dataclass(frozen=True, eq=False)
class FlatFit:
    """Points of one plane between two corners, and what may stand for them.

    Attributes:
        points: (n, 3) mm, n >= 3, all of one plane, no two in a row alike.
        plane: that plane.
        tube: the region that pieces keep to.
        reach: over so much of the path bends are looked at, mm.
        largest: radius of arcs, mm.
    """

    points: Floats
    plane: Plane
    tube: ToleranceTube
    reach: float
    largest: float

    @cached_property
    def line(self) -> PlanarPolyline:
        """The points in their plane."""
        points = self.points[:, list(self.plane.axes[:2])]
        return PlanarPolyline(points, self.reach, min(_last_digit(points), _FINE * self.tube.radius))

    def fewest(self, bend: float, fewer_than: int) -> FlatPath | None:
        """Return the fewest pieces that the shortest path over places for joints finds; None where these are not fewer,
        or not proven.

        Args:
            bend: pieces may turn by so much where they meet, radians, or by twice as much as the points do there.
            fewer_than: so many pieces or more are of no use.
        """
        allowed = self._allowed(bend)
        for share in _SEARCHED:
            limit = share * self.tube.radius
            rough = self.line.nearest(self._tangent(limit, bend).longest().s)
            rough[0], rough[-1] = 0, len(self.points) - 1
            chain = FewestPieces(self.line, limit, allowed, self.largest, self.tube.swell).chain(np.unique(rough))
            if chain is None or len(chain) >= fewer_than:
                return None
            turns = self._turns(chain)
            if np.any(turns > allowed[self.line.nearest(chain.s)] + _SAME):
                return None
            if (made := self._proven(chain, turns)) is not None:
                return made
        return None

    def moved(self, bend: float, fewer_than: int, progress: Progress = NO_PROGRESS) -> FlatPath | None:
        """Return the longest pieces whose joints were moved until they meet without a bend; None where these are not
        fewer, or not proven.

        Args:
            bend: pieces may turn by so much where they meet, radians, or by twice as much as the points do along them.
            fewer_than: so many pieces or more are of no use.
            progress: told of how much is done.

        Raises:
            Cancelled: the job was asked to stop.
        """
        for share in _MOVED:
            chain = self._tangent(share * self.tube.radius, bend).chain(fewer_than, progress)
            if chain is None:
                return None
            if (made := self._proven(chain, self._turns(chain))) is not None:
                return made
        return None

    def _tangent(self, limit: float, bend: float) -> TangentFit:
        return TangentFit(self.line, limit, bend, self.largest, self.tube.swell)

    def _allowed(self, bend: float) -> Floats:
        """Return by how much pieces may turn at each point (n,), radians."""
        turns = self.line.turns
        beside = np.concatenate([turns[:1], turns, turns[-1:]])
        there = np.maximum(np.maximum(beside[:-2], beside[2:]), turns)
        allowed: Floats = np.maximum(bend, np.minimum(_AS_SHARP * there, turns.max()))
        return allowed

    def _turns(self, chain: TangentPath) -> Floats:
        """Return by how much a chain turns at each joint (m + 1,), radians."""
        from . import tangent_kernels as kernels

        turns = np.empty(len(chain) + 1)
        kernels.bends(self.line.joints(chain), chain.half, turns)
        return turns

    def _proven(self, chain: TangentPath, turns: Floats) -> FlatPath | None:
        """Return the pieces, None where they are not proven to keep to the tube."""
        z, axes = self.line.joints(chain), self.plane.axes
        places = np.empty((len(z), 3))
        places[:, axes[0]], places[:, axes[1]], places[:, axes[2]] = z.real, z.imag, self.points[0, axes[2]]
        places[0], places[-1] = self.points[0], self.points[-1]
        motions = arcs_between(places, chain.half, np.full(len(chain), self.plane, np.uint8))
        if judge(curve_of_motions(motions), self.points, self.tube).answer is not TubeAnswer.INSIDE:
            return None
        return FlatPath(FittedPath(motions, self.line.nearest(chain.s[1:])), float(turns.max()))


def _last_digit(points: Floats) -> float:
    """Return the step of the last digit, of mm or of inches, that all points are written with, mm; 0 where there is
    none.
    """
    for digits in range(_MOST_DIGITS):
        for unit in (1.0, 25.4):
            counted = points / (unit * 10.0**-digits)
            if np.all(np.abs(counted - np.round(counted)) < 1e-6 + 1e-12 * np.abs(counted)):
                return float(unit * 10.0**-digits)
    return 0.0
