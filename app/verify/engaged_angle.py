"""A bound of a cutter's engaged angle, all along a written program: what a limit of it is proven by.

Only the motions that were read back count, and what these motions themselves have cleared; all else is metal. Nothing
is known here of how the path was made. Cleared ground is kept as discs and sectors: an arc round c clears the ring
between rho - r and rho + r in its sector, so where the ground within rho - r of c is clear already the whole sector is,
and where sectors and discs that hold c cover a circle round it there is nothing left inside. Other arcs and lines
clear convex pieces of what they sweep (`swath_shapes`). Along an arc no more of
the rim can be engaged than lies farther from c than the ground is clear all round; lines, and arcs for which that is
too much, are bounded piece by piece (`rim_kernels`).

Ways down into metal engage the whole rim, and at their foot the hole is as wide as the cutter: the first turn that
widens it, of at most WIDENING mm, belongs to the entry. So does what is level for no longer than that between two ways
down, as the digits of a program take no notice of what a short piece falls. Entries are measured, not limited.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, field
from itertools import pairwise

import numpy as np
from numpy.typing import NDArray

from ..core.progress import NO_PROGRESS, Progress
from ..geometry.primitives import lengths, points_at, sweeps
from ..model.motion import MotionKind
from ..toolpath.engagement.rim_kernels import bound_along, clear_radius, covers_disc
from ..toolpath.engagement.swath_shapes import swath_shapes

Floats = NDArray[np.float64]

WIDENING = 0.2
"""mm; the largest radius of the first turn at the foot of an entry that counts as part of it, and the longest level
way within one.
"""

_LEVEL = 1e-6
"""mm; what is no lower than this below the top is above the metal."""
_STEEP = 5e-4
"""Slope of a way down, at least; what falls less is a cut."""

_COARSE, _FINEST = 0.1, 1e-6
"""Length of the first pieces in radii of the cutter, and of the last ones, mm."""

_CRACK = 4e-3
"""mm by which a sector counts as wider than its arc: the cutter is round at both ends of the arc. Where an arc goes on
in another one, as much may be between their centres: two of the coarsest digits each way."""

_WHOLE = 1e-4
"""mm; a disc that is smaller by less than what its arcs sweep needs no sectors beside it."""

_SQUARE = 2e-4
"""mm; half the side of squares that are not divided to see whether the cutter stands on clear ground."""

_TIGHT = math.radians(0.02)
"""Radians below the greatest angle so far: what is bounded by less is not looked at more closely."""


@dataclass(frozen=True, eq=False)
class CutterPath:
    """Motions of one cutter, n of them, in program coordinates, mm.

    Attributes:
        start, end: (n, 3).
        centre: (n, 2) of arcs.
        kind: (n,) MotionKind.
        radius: of the cutter, mm.
        top: height of the stock's top, mm.
    """

    start: Floats
    end: Floats
    centre: Floats
    kind: NDArray[np.uint8]
    radius: float
    top: float


@dataclass(frozen=True)
class EngagedPlace:
    """How much is engaged at a motion.

    Attributes:
        angle: a bound of it, radians.
        motion: index; -1 = none.
        x, y: where, mm, program coordinates.
    """

    angle: float
    motion: int
    x: float
    y: float


@dataclass(frozen=True)
class EngagementProof:
    """What is proven of a path.

    Attributes:
        greatest: no place of the path, entries apart, has more than this.
        above: motions whose bound is more than the limit, each with it.
        entry_mm: length of the ways into metal.
        entries: how many there are.
    """

    greatest: EngagedPlace
    above: tuple[EngagedPlace, ...]
    entry_mm: float
    entries: int


def prove_engagement(path: CutterPath, limit: float, progress: Progress = NO_PROGRESS) -> EngagementProof:
    """Return a bound of the engaged angle along a path in metal that nobody has cut before.

    Args:
        limit: radians; bounds are made no better than it asks for.

    Raises:
        Cancelled: by progress.
    """
    return _Prover(path, limit).proven(progress)


@dataclass
class _Clear:
    """Shapes that are clear down to one height, see `rim_kernels`.

    Attributes:
        shapes: (m, 9), mm, m as many as there is room for; the first `count` are in use.
    """

    shapes: Floats = field(default_factory=lambda: np.empty((64, 9)))
    count: int = 0

    @property
    def table(self) -> Floats:
        return self.shapes[: self.count]

    def add(self, shapes: Floats) -> None:
        while self.count + len(shapes) > len(self.shapes):
            self.shapes = np.concatenate([self.shapes, np.empty_like(self.shapes)])
        self.shapes[self.count : self.count + len(shapes)] = shapes
        self.count += len(shapes)

    def add_disc(self, x: float, y: float, radius: float) -> None:
        """Take a disc as clear; what lies in it is forgotten."""
        table = self.table
        kept = np.hypot(table[:, 0] - x, table[:, 1] - y) + table[:, 2] > radius + 1e-9
        table = table[kept]
        self.shapes[: len(table)] = table
        self.count = len(table)
        self.add(_disc(x, y, radius))


class _Prover:
    def __init__(self, path: CutterPath, limit: float) -> None:
        self._path, self._limit, self._radius = path, limit, path.radius
        self._levels: dict[float, _Clear] = {}
        self._greatest = EngagedPlace(0.0, -1, math.nan, math.nan)
        self._above: list[EngagedPlace] = []
        self._entry, self._entries, self._entering = 0.0, 0, False
        self._foot: tuple[float, float, float] | None = None
        self._still_down = _still_down(path)

    def proven(self, progress: Progress) -> EngagementProof:
        path = self._path
        for k in range(len(path.kind)):
            if k % 64 == 0:
                progress.step(k / len(path.kind), "Prove the engaged angle")
            if max(path.start[k, 2], path.end[k, 2]) >= path.top - _LEVEL and self._above_stock(k):
                continue
            self._motion(k)
        progress.step(1.0)
        return EngagementProof(self._greatest, tuple(self._above), self._entry, self._entries)

    def _above_stock(self, k: int) -> bool:
        """Tell whether a motion stays above the stock."""
        return bool(min(self._path.start[k, 2], self._path.end[k, 2]) >= self._path.top - _LEVEL)

    def _motion(self, k: int) -> None:
        path = self._path
        low, fall = float(min(path.start[k, 2], path.end[k, 2])), float(path.start[k, 2] - path.end[k, 2])
        if fall <= _LEVEL and self._foot is not None:
            x, y, z = self._foot
            self._level(z).add(_disc(x, y, self._radius))
            self._foot = None
        row = _row(path, k)
        size = float(lengths(row[None])[0])
        if size < 1e-9:
            if fall > _LEVEL:
                self._down(path.end[k], size + fall)
            return
        shapes = self._near(row, size, low)
        if self._in_air(row, shapes):
            return
        if fall > _STEEP * size or (self._entering and self._still_down[k]):
            self._down(path.end[k], math.hypot(size, fall))
            return
        bound, share, clear = self._bound(row, size, shapes)
        x, y = points_at(row[None], np.array([share]))[0].tolist()
        if bound > self._limit and self._entering and 0 < row[6] <= WIDENING:
            self._entry += size
        else:
            self._entering = False
            found = EngagedPlace(bound, k, x, y)
            if bound > self._greatest.angle:
                self._greatest = found
            if bound > self._limit:
                self._above.append(found)
        if abs(fall) <= _LEVEL and row[7] != 0:
            self._clear_by_arc(row, low, shapes, clear)
        elif abs(fall) <= _LEVEL:
            self._level(low).add(swath_shapes(row[None], self._radius))

    def _down(self, end: Floats, size: float) -> None:
        """Take a way down, straight or along a slope: at its end the cutter stands in a hole of its own size."""
        x, y, z = end.tolist()
        if covers_disc(self._shapes(z), (x, y, self._radius - _CRACK), _SQUARE):
            return
        self._entries += not self._entering
        self._entering = True
        self._entry += size
        self._foot = x, y, z

    def _level(self, z: float) -> _Clear:
        return self._levels.setdefault(round(z / _LEVEL) * _LEVEL, _Clear())

    def _shapes(self, z: float) -> Floats:
        """Return what is clear down to a height, or deeper."""
        tables = [clear.table for level, clear in self._levels.items() if level <= z + 2 * _LEVEL]
        return np.concatenate([np.empty((0, 9)), *tables])

    def _near(self, row: Floats, size: float, z: float) -> Floats:
        shapes = self._shapes(z)
        middle = points_at(row[None], np.array([0.5]))[0]
        away = np.hypot(shapes[:, 0] - middle[0], shapes[:, 1] - middle[1])
        return np.ascontiguousarray(shapes[away < shapes[:, 2] + self._radius + size / 2])

    def _in_air(self, row: Floats, shapes: Floats) -> bool:
        """Tell whether one disc holds the cutter all along: both ends of a line, or the whole circle of an arc."""
        discs = shapes[(shapes[:, 3:5] == 0).all(axis=1) & (shapes[:, 6:8] == 0).all(axis=1)]
        room = discs[:, 2] - self._radius
        if row[7] != 0:
            held = np.hypot(discs[:, 0] - row[4], discs[:, 1] - row[5]) + row[6] <= room
        else:
            held = np.hypot(discs[:, 0] - row[0], discs[:, 1] - row[1]) <= room
            held &= np.hypot(discs[:, 0] - row[2], discs[:, 1] - row[3]) <= room
        return bool(held.any())

    def _bound(self, row: Floats, size: float, shapes: Floats) -> tuple[float, float, float]:
        """Return (bound of the engaged angle, fraction of the row where it is, so far round the centre is it clear)."""
        clear, bound, share = 0.0, math.pi, 0.5
        if row[7] != 0:
            reach = float(row[6]) + self._radius
            clear = clear_radius(shapes, (float(row[4]), float(row[5]), reach))
            cosine = (clear**2 - row[6] ** 2 - self._radius**2) / (2 * row[6] * self._radius)
            bound = math.acos(min(1.0, max(-1.0, float(cosine))))
        enough = max(self._greatest.angle - _TIGHT, _TIGHT)
        if bound > self._limit or (row[7] == 0 and bound > enough):
            turn = float(sweeps(row[None])[0])
            limits = (min(enough, self._limit), _COARSE * self._radius, _FINEST, math.inf)
            closer, at = bound_along(shapes, row, self._radius, (turn, size), limits)
            if closer > self._limit >= enough:
                limits = (self._limit, _COARSE * self._radius, _FINEST, math.inf)
                closer, at = bound_along(shapes, row, self._radius, (turn, size), limits)
            if closer < bound:
                bound, share = closer, at
        return bound, share, clear

    def _clear_by_arc(self, row: Floats, z: float, shapes: Floats, clear: float) -> None:
        """Take as clear what an arc has swept: sectors and discs where it is clear within, else shapes of the ring."""
        x, y, turn = row[4:7].tolist()
        if clear < turn - self._radius + _CRACK:
            self._level(z).add(swath_shapes(row[None], self._radius))
            return
        sectors = _sectors(row, self._radius, max(clear, self._radius - turn))
        reach = turn + self._radius
        whole = clear_radius(np.concatenate([shapes, sectors]), (x, y, reach))
        level = self._level(z)
        if whole > clear + 1e-9:
            level.add_disc(x, y, whole)
        if whole < reach - _WHOLE:
            level.add(sectors)


def _still_down(path: CutterPath) -> NDArray[np.bool_]:
    """Return (n,) which motions are level, with ways down before and behind them that are no farther than WIDENING mm
    apart.
    """
    rows = np.array([_row(path, k) for k in range(len(path.kind))]).reshape(-1, 8)
    size, fall = lengths(rows), path.start[:, 2] - path.end[:, 2]
    level, gone = np.abs(fall) <= _LEVEL, np.concatenate([np.zeros(1), np.cumsum(size)])
    down = np.flatnonzero(fall > np.maximum(_STEEP * size, _LEVEL))
    other = np.flatnonzero(~level)
    found = np.zeros(len(rows), np.bool_)
    for first, second in pairwise(other.tolist()):
        if second - first > 1 and gone[second] - gone[first + 1] <= WIDENING:
            found[first + 1 : second] = np.isin((first, second), down).all()
    return found


def _row(path: CutterPath, k: int) -> Floats:
    """Return a motion as a line or an arc in the plane."""
    x0, y0, x1, y1 = *path.start[k, :2], *path.end[k, :2]
    if path.kind[k] not in (MotionKind.ARC_CW, MotionKind.ARC_CCW):
        return np.array([x0, y0, x1, y1, 0.0, 0.0, 0.0, 0.0])
    cx, cy = path.centre[k]
    radius = (math.hypot(x0 - cx, y0 - cy) + math.hypot(x1 - cx, y1 - cy)) / 2
    return np.array([x0, y0, x1, y1, cx, cy, radius, 1.0 if path.kind[k] == MotionKind.ARC_CCW else -1.0])


def _disc(x: float, y: float, radius: float) -> Floats:
    return np.array([[x, y, radius, 0.0, 0.0, math.inf, 0.0, 0.0, math.inf]])


def _sectors(row: Floats, radius: float, core: float) -> Floats:
    """Return the sectors (n, 9) that an arc sweeps round its centre, each at most half a turn.

    Args:
        core: so far round the centre it is clear anyway, mm.
    """
    x, y, turn = row[4:7].tolist()
    sweep = float(sweeps(row[None])[0])
    first = math.atan2(row[1] - y, row[0] - x)
    if sweep < 0:
        first, sweep = first + sweep, -sweep
    count = math.ceil(sweep / math.pi - 1e-6)
    made = []
    for k in range(count):
        a, b = first + sweep * k / count, first + sweep * (k + 1) / count
        # beside the arc's ends the cutter is round: a narrow strip there is swept too, but for a hair at its end
        crack = _CRACK if core * math.sin((b - a) / 2) >= _CRACK else 0.0
        reach = turn + radius - crack * crack / radius
        n, m = (math.sin(a), -math.cos(a)), (-math.sin(b), math.cos(b))
        made.append([x, y, reach, *n, n[0] * x + n[1] * y + crack, *m, m[0] * x + m[1] * y + crack])
    return np.array(made).reshape(-1, 9)
