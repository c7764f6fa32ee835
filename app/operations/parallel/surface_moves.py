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
        rows += _milled(family, number, clearance, approach)
    count = len(rows)
    kind = np.array([row.kind for row in rows], np.uint8)
    moves = Moves(
        np.array([row.end for row in rows]).reshape(-1, 3),
        np.full((count, 2), np.nan),
        kind,
        np.array([row.purpose for row in rows], np.uint8),
        np.array([row.operation for row in rows], np.int16),
        np.array([row.tool for row in rows], np.int16),
        np.zeros(count, np.int32),
        np.array([row.feed for row in rows]),
        np.zeros(count, np.int32),
    )
    return SurfaceMoves(moves, np.array([row.surface for row in rows], np.int64))


@dataclass(frozen=True, slots=True)
class _Row:
    end: tuple[float, float, float]
    kind: MoveKind
    purpose: Purpose
    operation: int
    tool: int
    feed: float
    surface: int = NO_SURFACE


def _milled(family: PassFamily, number: int, clearance: float, approach: float) -> Iterator[_Row]:
    """Yield the moves of one family."""
    tool = family.tool
    at: Floats | None = None

    def rapid(place: Floats, z: float) -> _Row:
        x, y = place[:2].tolist()
        return _Row((x, y, z), MoveKind.RAPID, Purpose.RAPID, number, tool.number, 0.0)

    def line(point: Sequence[float], purpose: Purpose, surface: int = NO_SURFACE, steep: bool = False) -> _Row:
        feed = (
            tool.plunge_rate
            if purpose is Purpose.PLUNGE
            else min(tool.feed_rate, tool.plunge_rate)
            if steep
            else tool.feed_rate
        )
        x, y, z = point
        return _Row((x, y, z), MoveKind.LINE, purpose, number, tool.number, feed, surface)

    for run in _ordered(family.path.runs, family.strategy):
        z = float(run.points[0, 2])
        way = _link(family, at, run.points[0])
        if way is not None:
            down = plunging(way).tolist()
            yield from (
                line(point, Purpose.LINK, steep=steep) for point, steep in zip(way[1:].tolist(), down, strict=True)
            )
        else:
            if at is not None:
                yield rapid(at, clearance)
            yield rapid(run.points[0], clearance)
            yield rapid(run.points[0], max(approach, z))
            if z < approach:
                yield line(run.points[0].tolist(), Purpose.PLUNGE)
        owner = run.owner.tolist()
        cuts = zip(run.points[1:].tolist(), owner, plunging(run.points).tolist(), strict=True)
        yield from (line(point, Purpose.CONTOUR, surface, steep) for point, surface, steep in cuts)
        at = run.points[-1]
    if at is not None:
        yield rapid(at, clearance)


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
