"""The paths of cutters over surfaces as one program's moves: passes there and back or one way, joined over the surface
or in the air.
"""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from ...model.moves import MoveKind, Moves, Purpose
from ...model.scene import Strategy
from ...model.tool import Tool
from ...surfaces.passes.path import Follower
from ...surfaces.sections.compound import NO_SURFACE, CompoundSurface, SectionRun

Floats = NDArray[np.float64]

PLUNGE_ANGLE = math.radians(60.0)
"""To the level; descents that are steeper go at the plunge rate, as a ball's middle cuts there."""

LEAST_PLUNGE = 0.1
"""mm; steep descents of less, one after the other, are none: of so short a way no control makes a slower one."""


@dataclass(frozen=True, eq=False)
class PassFamily:
    """One family of passes, ready to be milled.

    Attributes:
        path: of the cutter. follower: that made it, for the ways between passes.
        tool: with the feeds and the speed to be used.
        strategy: order of passes. link_gap: ends nearer than this are joined over the surface, mm.
    """

    path: CompoundSurface
    follower: Follower
    tool: Tool
    strategy: Strategy
    link_gap: float


@dataclass(frozen=True, eq=False)
class SurfaceMoves:
    """Moves, and the surface that each is on.

    Attributes:
        moves: `operation` counts the families of passes.
        surface: (n,) number of the surface that the cutter touches; NO_SURFACE of those in the air and of plunges.
    """

    moves: Moves
    surface: NDArray[np.int64]


def surface_moves(families: Sequence[PassFamily], clearance: float, approach: float) -> SurfaceMoves:
    """Return everything that is milled, in order.

    Args:
        clearance: height at which the tool travels, mm. approach: down to which rapids go; from there it plunges.
    """
    rows: list[_Row] = []
    for number, family in enumerate(families):
        rows += _FamilyMoves(family, number, clearance, approach).all()
    count = len(rows)
    kind = np.array([row.kind for row in rows], np.uint8)
    moves = Moves(
        end=np.array([row.end for row in rows]).reshape(-1, 3),
        centre=np.full((count, 2), np.nan),
        kind=kind,
        purpose=np.array([row.purpose for row in rows], np.uint8),
        operation=np.array([row.operation for row in rows], np.int16),
        tool=np.array([row.tool for row in rows], np.int16),
        region=np.zeros(count, np.int32),
        feed=np.array([row.feed for row in rows]),
        line=np.zeros(count, np.int32),
    )
    return SurfaceMoves(moves, np.array([row.surface for row in rows], np.int64))


@dataclass(frozen=True, slots=True)
class _Row:
    """A move in the making.

    Attributes:
        end: mm. feed: mm/min; 0 = rapid. operation: by index. tool: by number.
        surface: of the compound that is cut there.
    """

    end: tuple[float, float, float]
    kind: MoveKind
    purpose: Purpose
    operation: int
    tool: int
    feed: float
    surface: int = NO_SURFACE


@dataclass(frozen=True, eq=False)
class _FamilyMoves:
    """Makes the moves of one family of passes.

    Attributes:
        number: of the family, from 0 on.
        clearance, approach: heights that the tool travels at, and from which it goes down slowly, mm.
    """

    family: PassFamily
    number: int
    clearance: float
    approach: float

    def all(self) -> Iterator[_Row]:
        """Yield the moves."""
        at: Floats | None = None
        for run in _ordered(self.family.path.runs, self.family.strategy):
            way = _link(self.family, at, run.points[0])
            if way is not None:
                yield from self._along(way, Purpose.LINK, [NO_SURFACE] * (len(way) - 1))
            else:
                yield from self._through_air(at, run.points[0])
            yield from self._along(run.points, Purpose.CONTOUR, run.owner.tolist())
            at = run.points[-1]
        if at is not None:
            yield self._rapid(at, self.clearance)

    def _through_air(self, at: Floats | None, to: Floats) -> Iterator[_Row]:
        """Yield the way from one place to another, over the clearance height and down."""
        if at is not None:
            yield self._rapid(at, self.clearance)
        yield self._rapid(to, self.clearance)
        yield self._rapid(to, max(self.approach, float(to[2])))
        if to[2] < self.approach:
            yield self._line(to.tolist(), Purpose.PLUNGE, self.family.tool.plunge_rate)

    def _along(self, points: Floats, purpose: Purpose, owner: Sequence[int]) -> Iterator[_Row]:
        """Yield straight moves from the first of some points to all others, down no faster than a plunge."""
        tool = self.family.tool
        slow = min(tool.feed_rate, tool.plunge_rate)
        for point, surface, steep in zip(points[1:].tolist(), owner, plunging(points).tolist(), strict=True):
            yield self._line(point, purpose, slow if steep else tool.feed_rate, surface)

    def _rapid(self, place: Floats, z: float) -> _Row:
        x, y = place[:2].tolist()
        return _Row((x, y, z), MoveKind.RAPID, Purpose.RAPID, self.number, self.family.tool.number, 0.0)

    def _line(self, point: Sequence[float], purpose: Purpose, feed: float, surface: int = NO_SURFACE) -> _Row:
        x, y, z = point
        return _Row((x, y, z), MoveKind.LINE, purpose, self.number, self.family.tool.number, feed, surface)


def plunging(points: Floats) -> NDArray[np.bool_]:
    """Return which of the ways (n - 1,) from point to point (n, 3) go down more steeply than PLUNGE_ANGLE, together by
    LEAST_PLUNGE.
    """
    way = np.diff(points, axis=0)
    steep = -way[:, 2] > math.tan(PLUNGE_ANGLE) * np.hypot(way[:, 0], way[:, 1])
    group = np.cumsum(np.diff(steep, prepend=False))
    down = np.bincount(group, np.where(steep, -way[:, 2], 0.0))
    return np.asarray(steep & (down[group] >= LEAST_PLUNGE))


def _ordered(runs: Sequence[SectionRun], strategy: Strategy) -> Iterator[SectionRun]:
    """Yield runs plane by plane; there and back, every other plane is run backwards."""
    planes = sorted({run.plane for run in runs})
    for turn, plane in enumerate(planes):
        here = [run for run in runs if run.plane == plane]
        if strategy is Strategy.ZIGZAG and turn % 2:
            yield from (SectionRun(run.plane, run.points[::-1], run.owner[::-1]) for run in reversed(here))
        else:
            yield from here


def _link(family: PassFamily, at: Floats | None, to: Floats) -> Floats | None:
    """Return the way (n, 3) over the surface to the next pass; None where it is too far, or has a gap."""
    if at is None or not 0 < math.dist(at[:2], to[:2]) <= family.link_gap:
        return None
    (x0, y0), (x1, y1) = at[:2].tolist(), to[:2].tolist()
    way = family.follower.between((x0, y0), (x1, y1))
    return None if way is None else np.concatenate([at[None], way, to[None]])
