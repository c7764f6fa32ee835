"""Wide places: cleared by ways along the metal at a constant angle, from wall to wall, in place of discs.

A disc's arc is engaged by the limit in one place, and by two thirds of it on average. Here the cutter follows a wall
until so much is engaged as may be, turns away in an arc, and follows the edge of the metal (`pursuit`) until it comes
to a wall again. All of a part is cleared so in which there is room for the arcs in which it turns along walls; corners
and necks are left to discs. Each row is bounded before it counts; where one has too much, its way is given up, and
discs clear what stands there.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

from ...core.progress import Progress
from ...geometry.primitives import Rows, boxes, lengths
from .cleared_discs import Point, WallClearance
from .front import MetalFront
from .limit import EngagementLimit
from .link import PathPose, smooth_way
from .pursuit import Heading, Pursuit, arcs_through
from .wall_path import WallPath

Flags = NDArray[np.bool_]
Floats = NDArray[np.float64]

_BEFORE = (0.1, 0.3, 0.7)
"""Radii of the cutter: so far before metal the cutter comes to the wall; what is clear enough is taken."""

_CLEAR = 0.5
"""Radii of the cutter along a wall without metal, after which a way has ended."""

_SPARE = math.radians(0.1)
"""Radians that a bound may be above the planned angle."""

_AIMS = (0.0, math.radians(1.5), math.radians(5.0))
"""Radians less than planned that a way is tried with, one after the other."""

_IDLE = 4
"""Ways, one after the other, that need not bring the cutter farther along walls: they cut where metal is blunt."""

_MOST, _TURNS = 1500, 40
"""Ways in one part, and how often one leaves a wall."""

_TOUCH = math.radians(2.0)
"""Radians that may be engaged on a way to metal: slivers along walls."""

_ROUND = 1.3
"""Times as long as straight on the way along a clear wall is still taken: it needs no turns."""

_SHARE = 0.7
"""Of the way to metal that lies right ahead that the cutter goes on along a wall before it looks again."""

_NEAR, _HALVINGS = 1e-4, 40
"""Radians below the angle that are near enough to it."""

_SAME = 1e-5
"""mm along a wall: places that differ by no more are one."""

_WORTH, _LOOSE = 0.85, 0.05
"""Of the effort by discs alone for what is done that ways may take, and of all of it that they may take besides."""


class NotWithinLimit(Exception):
    """A way that cannot be proven, or does not come to its end."""


@dataclass(frozen=True)
class Stretch:
    """Metal along a wall: the path's number, and where it begins, mm from the path's beginning."""

    wall: int
    begin: float


@dataclass(frozen=True)
class WayWorth:
    """What clearing may cost.

    Attributes:
        effort: of what discs need for the same, mm at the tool's feed.
        faster: times that feed over clear ground.
    """

    effort: float
    faster: float

    def lost(self, rows: Sequence[Rows], clear: Sequence[bool], done: float) -> bool:
        """Tell whether rows, some over clear ground, have cost much more than the share that they have done."""
        size = lengths(np.array(rows)) / np.where(clear, self.faster, 1.0)
        return float(size.sum()) > (_WORTH * done + _LOOSE) * self.effort


@dataclass
class WideClearing:
    """Clears a wide part.

    Attributes:
        limit, room: of the part.
        turn: radius of the arcs in which the cutter turns along walls, mm.
        walls: the ways along them.
        front: what is clear.
        worth: what the path may cost.
        rows, clear: the path so far, and whether each row is over clear ground.
        refused: stretches that are left to discs, as no way there keeps the limit.
        _at: the wall that is followed, and where on it, mm. _aim: angle that is gone for, radians.
        _idle: rounds in a row that left as much uncut as before.
    """

    limit: EngagementLimit
    room: WallClearance
    turn: float
    walls: Sequence[WallPath]
    front: MetalFront
    worth: WayWorth
    rows: list[Rows] = field(default_factory=list)
    clear: list[bool] = field(default_factory=list)
    refused: list[Stretch] = field(default_factory=list)
    _uncut: list[Flags] = field(default_factory=list)
    _pose: PathPose | None = None
    _at: tuple[int, float] | None = None
    _aim: float = 0.0
    _idle: int = 0

    def cut(self, pose: PathPose, progress: Progress) -> PathPose | None:
        """Clear all that can be cleared; return where the path ends, None where discs are quicker.

        Args:
            pose: where it begins.

        Raises:
            Cancelled: by progress.
        """
        self._pose = pose
        everywhere = np.array([-math.inf, -math.inf, math.inf, math.inf])
        self._uncut = [wall.uncut(self.front, np.ones(len(wall.places), np.bool_), everywhere) for wall in self.walls]
        first, ways = max(1, self._left()), 0
        while ways < _MOST and self._one():
            ways += 1
            done = 1 - self._left() / first
            progress.step(done, "Clear along the axis")
            if self.rows and self.worth.lost(self.rows, self.clear, done):
                return None
        return self._pose

    @property
    def uncut(self) -> Floats:
        """(n, 2) places of the cutter along walls at which metal stands."""
        found = [wall.points[uncut] for wall, uncut in zip(self.walls, self._uncut, strict=True)]
        return np.concatenate([np.empty((0, 2)), *found])

    def _left(self) -> int:
        return sum(int(each.sum()) for each in self._uncut)

    def _one(self) -> bool:
        """Cut one way, or refuse it; tell whether there was one."""
        for less in _AIMS:
            before = len(self.rows), len(self.front.table), self._pose, self._at, self._uncut
            going = self._go()
            if going is None:
                return False
            self._aim = self.limit.pursued - less
            try:
                self._way(going[0].wall, going[1])
                self._look_again(before[0])
            except NotWithinLimit:
                del self.rows[before[0] :], self.clear[before[0] :]
                self.front.forget(before[1])
                _, _, self._pose, self._at, self._uncut = before
                if less == _AIMS[-1]:
                    self.refused.append(going[0])
            else:
                return True
        return True

    def _look_again(self, begin: int) -> None:
        """Look for metal along walls near the rows from one on.

        Raises:
            NotWithinLimit: as much stands as some ways before.
        """
        before, around = self._left(), boxes(np.array(self.rows[begin:]))
        near = np.array([*(around[:, :2].min(axis=0)), *(around[:, 2:].max(axis=0))])
        near += np.array([-1, -1, 1, 1]) * 2 * self.limit.radius
        self._uncut = [wall.uncut(self.front, each, near) for wall, each in zip(self.walls, self._uncut, strict=True)]
        self._idle = self._idle + 1 if self._left() >= before else 0
        if self._idle > _IDLE:
            raise NotWithinLimit

    def _stretches(self) -> list[Stretch]:
        found = []
        for k, (wall, uncut) in enumerate(zip(self.walls, self._uncut, strict=True)):
            begins = np.flatnonzero(uncut & ~np.roll(uncut, 1))
            if uncut.all():
                # no more than touched so far: where least stands
                begins = np.array([np.argmin([self.front.bare(at.place, at.ahead) for at in wall.headings])])
            found += [Stretch(k, float(wall.places[j])) for j in begins]
        return [each for each in found if each not in self.refused]

    def _go(self) -> tuple[Stretch, float] | None:
        """Go to the nearest metal that can be gone to over clear ground; None where there is none."""
        found = self._stretches()
        found.sort(key=lambda each: min(self._away(each), self._on(each)))
        for stretch in found:
            on = self._on(stretch)
            if on <= _ROUND * self._away(stretch):
                return stretch, self._along_clear(stretch, on)
            start = self._across(stretch)
            if start is not None:
                return stretch, start
            if on < math.inf:
                return stretch, self._along_clear(stretch, on)
        return None

    def _away(self, stretch: Stretch) -> float:
        assert self._pose is not None
        return math.dist((self._pose.x, self._pose.y), self.walls[stretch.wall].heading(stretch.begin).place)

    def _on(self, stretch: Stretch) -> float:
        """Return how far it is along the wall on which the cutter stands, mm; inf where that is not clear."""
        if self._at is None or self._at[0] != stretch.wall:
            return math.inf
        wall, start = self.walls[stretch.wall], self._at[1]
        long = (stretch.begin - start) % wall.length
        gone = (wall.places - start) % wall.length
        return math.inf if self._uncut[stretch.wall][gone < long - _SAME].any() else long

    def _along_clear(self, stretch: Stretch, long: float) -> float:
        """Go along a clear wall up to metal; return where that is."""
        assert self._at is not None
        start = self._at[1]
        stop = start + max(0.0, long - _BEFORE[0] * self.limit.radius)
        rows = self.walls[stretch.wall].span(start, stop)
        self.rows += list(rows)
        self.clear += [True] * len(rows)
        return stop

    def _across(self, stretch: Stretch) -> float | None:
        """Go straight to metal; return at which place of its wall the cutter comes to it, None where it cannot."""
        for share in _BEFORE:
            start = stretch.begin - share * self.limit.radius
            way = self._link(self.walls[stretch.wall].heading(start))
            if way is not None:
                for row in way:
                    self._link_row(row)
                return start
        return None

    def _link(self, end: Heading) -> Rows | None:
        """Return a way to a wall, over clear ground but for its last row, None where there is none."""
        assert self._pose is not None
        pose = PathPose(end.x, end.y, end.ahead - math.pi / 2, self.turn)
        rows = np.array(smooth_way(self._pose, pose, (), (*end.left(self.turn), self.turn))).reshape(-1, 8)
        if any(self.front.bound(row, _TOUCH) > _TOUCH for row in rows[:-1]):
            return None
        return rows if not len(rows) or self.front.bound(rows[-1], self.limit.planned) <= self.limit.planned else None

    def _link_row(self, row: Rows) -> None:
        air = self.front.is_air(row)
        if not air:
            self.front.sweep(row[None])
        self.rows.append(row)
        self.clear.append(air)

    def _way(self, number: int, start: float) -> None:
        """Cut along a wall and along the metal in turns, until a wall is clear."""
        wall, at = self.walls[number], start
        for _ in range(_TURNS):
            end, met = self._follow(wall, at)
            # before the span is cut: where the cutter has stood its whole rim counts as clear
            away = self._most(wall.heading(end))[1]
            self._cut(wall.span(at, end))
            if not met:
                self._stand(wall.heading(end))
                self._at = (number, end)
                return
            number, at = self._pursue(self._turned(wall.heading(end), away))
            wall = self.walls[number]
        raise NotWithinLimit

    def _follow(self, wall: WallPath, start: float) -> tuple[float, bool]:
        """Return up to where the cutter may follow a wall, and whether it must turn away there."""
        at, last, free, before, step = start, start, start, start, wall.spacing / 2
        while at - last < _CLEAR * self.limit.radius or (last == start and at - start < self.limit.radius):
            if at - start > wall.length:
                return start + wall.length, False
            most = self._most(wall.heading(at))[0]
            if most > self._aim:
                return self._where(wall, before, at), True
            if self._met(wall, at) > 0.0:
                last = at
            elif free <= last:
                free = at
            before = at
            at += max(step, self._on_to(most)) if most > 0.0 else step
        return max(free, start + step), False

    def _on_to(self, most: float) -> float:
        """Return how far the cutter may go on, mm, that is engaged by an angle, at least: its arc comes so much nearer
        to metal that lies ahead.
        """
        r, turn = self.limit.radius, self.turn
        clear = [math.sqrt(turn * turn + r * r + 2 * turn * r * math.cos(angle)) for angle in (most, self._aim)]
        return _SHARE * (clear[0] - clear[1])

    def _most(self, start: Heading) -> tuple[float, Heading]:
        """Return the greatest angle along the arc in which the cutter turns away from a wall, and where that is."""
        cx, cy = start.left(self.turn)
        most, ahead = self.front.most((cx, cy), self.turn, start.ahead)
        return most, Heading(cx + self.turn * math.sin(ahead), cy - self.turn * math.cos(ahead), ahead)

    def _turned(self, start: Heading, end: Heading) -> Heading:
        """Cut along the arc in which the cutter turns away from a wall, up to a place on it; return that."""
        if math.dist(start.place, end.place) > _SAME:
            self._cut(np.array([[*start.place, *end.place, *start.left(self.turn), self.turn, 1.0]]))
        return end

    def _met(self, wall: WallPath, at: float) -> float:
        here = wall.heading(at)
        return self.front.met(here.place, here.ahead) or 0.0

    def _where(self, wall: WallPath, low: float, high: float) -> float:
        """Return where along a wall the cutter must turn away: at the aim, and not above."""
        below, above = (self._most(wall.heading(at))[0] - self._aim for at in (low, high))
        for k in range(_HALVINGS):
            if high - low < _SAME or -_NEAR <= below <= 0.0:
                break
            share = 0.5 if k % 3 == 2 else min(0.98, max(0.02, (below + _NEAR / 2) / (below - above)))
            middle = low + share * (high - low)
            found = self._most(wall.heading(middle))[0] - self._aim
            if found > 0.0:
                high, above = middle, found
            else:
                low, below = middle, found
        return low

    def _pursue(self, start: Heading) -> tuple[int, float]:
        """Cut along the metal; return the wall path to which it comes, and where."""
        inner = self.room.leave + self.limit.radius
        way = Pursuit(self.front, self.room, (self.turn, inner), self._aim).along(start)
        if not way:
            raise NotWithinLimit
        last = way[-1]
        self._cut(arcs_through(way))
        cx, cy = last.left(self.turn)
        number, at = self._arrival((cx, cy), last)
        end = self.walls[number].heading(at)
        row = np.array([last.x, last.y, end.x, end.y, cx, cy, self.turn, 1.0])
        if math.dist(last.place, end.place) > 1e-6:
            self._cut(row[None])
        return number, at

    def _arrival(self, centre: Point, last: Heading) -> tuple[int, float]:
        """Return (wall path, mm along it) where the turn along a wall comes to it."""
        found = []
        for k, wall in enumerate(self.walls):
            at, away = wall.nearest(centre)
            if abs(away - self.turn) < 1e-4:
                found.append((k, at))
        if not found:
            raise NotWithinLimit
        first = last.ahead - math.pi / 2
        return min(found, key=lambda each: (self._seen(each, centre) - first + 1e-6) % math.tau)

    def _seen(self, each: tuple[int, float], centre: Point) -> float:
        x, y = self.walls[each[0]].heading(each[1]).place
        return math.atan2(y - centre[1], x - centre[0])

    def _cut(self, rows: Rows) -> None:
        """Take rows as cut, each proven.

        Raises:
            NotWithinLimit: one is not.
        """
        for row, length in zip(rows, lengths(rows).tolist(), strict=True):
            most = min(self.limit.planned + _SPARE, self.limit.written(length))
            if self.front.bound(row, most) > most:
                raise NotWithinLimit
            self.front.sweep(row[None])
            self.rows.append(row)
            self.clear.append(False)

    def _stand(self, at: Heading) -> None:
        self._pose = PathPose(at.x, at.y, at.ahead - math.pi / 2, self.turn)
