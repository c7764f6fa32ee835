"""Discs and rings as one path: arcs that cut, and smooth ways over clear ground between them."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, field
from itertools import pairwise

import numpy as np
from numpy.typing import NDArray

from ...geometry.distance import DistanceField
from ...geometry.primitives import Rows, distances, lengths, within_half_turn
from ...toolpath.build import split_row
from ...toolpath.linking.bridge import foot, fraction_at
from .chips import DiscArc, feed_pieces
from .cleared_discs import ClearedDisc, ClearedDiscs, Point
from .front import MetalFront
from .limit import EngagementLimit
from .link import Circle, PathPose, Row, smooth_way, way_in
from .wall_stretches import WallStretch

_NOTHING = 1e-6
"""mm, instead of a radius of 0, which has no direction."""


@dataclass(frozen=True, eq=False)
class CutRun:
    """A path that is cut without going up to the height of travel.

    Attributes:
        rows: (n, 8), each beginning where the one before ends.
        clear: (n,) True where the ground is clear: the cutter may be lifted a little, and go fast.
        times: (n,) of the tool's feed, where less is engaged than at the limit; else 1.
    """

    rows: Rows
    clear: NDArray[np.bool_]
    times: NDArray[np.float64]


@dataclass
class PathBuilder:
    """Puts runs together.

    Attributes:
        limit, discs: of the part.
        farthest: mm that the cutter goes over clear ground at most before it goes through the air instead.
        fastest: times the tool's feed at most, where less is engaged than at the limit.
        front: what is clear, where more is than the discs; ways over clear ground are then proven by it.
        runs: that are done. _rows, _clear, _times: of the one in the making, see `CutRun`.
        _pose, _in: where it ends, and the number of the disc there.
    """

    limit: EngagementLimit
    discs: ClearedDiscs
    farthest: float
    fastest: float = 1.0
    front: MetalFront | None = None
    runs: list[CutRun] = field(default_factory=list)
    _rows: list[Row] = field(default_factory=list)
    _clear: list[bool] = field(default_factory=list)
    _times: list[float] = field(default_factory=list)
    _pose: PathPose | None = None
    _in: int = 0
    _stretches: list[WallStretch] = field(default_factory=list)

    def begin(self, spiral: Rows) -> None:
        """Begin with the spiral that clears the first disc."""
        for row in spiral.tolist():
            self._cut(tuple(row))
        x, y, _, _ = spiral[-1, [2, 3, 4, 5]]
        self._stand((float(x), float(y)), 0)

    def go_on(self, rows: Rows, clear: NDArray[np.bool_], pose: PathPose) -> None:
        """Go along rows (n, 8), n >= 1, that begin where the path ends, (n,) of them over clear ground, up to a pose.

        The cutter stands then in the disc that lies the farthest round the last place.
        """
        for row, air in zip(rows.tolist(), clear.tolist(), strict=True):
            self._cut(tuple(row), clear=air)
        self._pose, self._in = pose, int(np.argmax(self.discs.depth_in((pose.x, pose.y))))

    def leave_for(self, stretches: Sequence[WallStretch]) -> None:
        """Take stretches along walls, each to be cut as soon as the disc before it is clear."""
        self._stretches = list(stretches)

    def slice(self, number: int) -> None:
        """Clear a disc by the arc that its payer leaves of its circle; nothing is to do where it is clear."""
        disc = self.discs.each[number]
        if disc.swept:
            return
        paying = self.discs.each[disc.payer]
        turn = disc.reach - self.limit.radius
        half = _half(disc, paying, self.limit)
        if half <= 0:
            return
        ahead = math.atan2(disc.y - paying.y, disc.x - paying.x)
        a = _on(disc.centre, turn, ahead - half)
        self._go(PathPose(*a, ahead - half, turn), disc.payer)
        arc = DiscArc(
            math.dist(disc.centre, paying.centre), turn, half, paying.reach - self.limit.slack, self.limit.radius
        )
        for piece in feed_pieces(arc, self.limit.angle, self.fastest):
            if piece.end - piece.begin > 0.9 * math.pi:
                middle = _on(disc.centre, turn, ahead + (piece.begin + piece.end) / 2)
                self._cut((*a, *middle, *disc.centre, turn, 1.0), piece.times)
                a = middle
            b = _on(disc.centre, turn, ahead + piece.end)
            self._cut((*a, *b, *disc.centre, turn, 1.0), piece.times)
            a = b
        self._stand(a, number)
        if self.front is not None:
            self.front.add_disc(*disc.centre, disc.reach)
        self._along_walls(number)

    def _along_walls(self, number: int) -> None:
        """Cut the stretches along walls for which a disc was the last that had to be clear."""
        for stretch in [each for each in self._stretches if each.after == number]:
            if self._stretch(stretch, self.limit.planned):
                self._stretches.remove(stretch)

    def _stretch(self, stretch: WallStretch, most: float) -> bool:
        """Cut a stretch, if no more than an angle is engaged there so far, radians; tell whether it was cut."""
        assert self.front is not None
        if any(self.front.bound(row, most) > most for row in stretch.rows):
            return False
        begin, end = stretch.poses
        self._go(begin, self._in, begin.circle(1.0))
        for row in stretch.rows:
            self._cut(row.tolist())
        self.front.sweep(stretch.rows)
        self._pose = end
        return True

    def finish(self) -> list[Point]:
        """Cut the stretches along walls that are left; return where those begin that the limit cannot be kept on."""
        waiting, self._stretches = self._stretches, []
        return [each.place for each in waiting if not self._stretch(each, self.limit.angle)]

    def ring(self, path: Rows) -> bool:
        """Go along a ring, from where a disc that was cleared touches it; False where none does."""
        found = self._touching(path)
        if found is None:
            return False
        number, row, part = found
        rows = list(path[row:]) + list(path[:row])
        if part > 0.0:
            first, second = split_row(rows[0], part)
            rows = [second, *rows[1:], first]
        disc = self.discs.each[number]
        x, y = rows[0][:2].tolist()
        angle = math.atan2(y - disc.y, x - disc.x)
        self._go(PathPose(x, y, angle, disc.reach - self.limit.radius), number)
        for each in rows:
            self._cut(each.tolist())
        self._stand((x, y), number)
        return True

    def done(self) -> list[CutRun]:
        """Return the runs, the last one ended."""
        self._end()
        return self.runs

    def _touching(self, path: Rows) -> tuple[int, int, float] | None:
        """Return (disc, row of a ring, fraction of it) where a disc touches the ring; the largest one."""
        rows = within_half_turn(path)
        away, near = DistanceField.of(rows).nearest(self.discs.table[:, :2])
        out = np.abs(away - (self.discs.table[:, 2] - self.limit.radius))
        step = self.limit.grid.step if self.limit.grid is not None else 0.0  # a disc's radius may be shorter by one
        near_enough = out <= self.limit.slack / 8 + step
        if not near_enough.any():
            return None
        number = int(np.argmax(np.where(near_enough, self.discs.table[:, 2], 0.0)))
        place = foot(rows[near[number]][None], self.discs.table[number : number + 1, :2])[0]
        row = int(np.argmin(distances(path, np.broadcast_to(place, (len(path), 2)))))
        return number, row, fraction_at(path[row], place)

    def _stand(self, place: Point, number: int) -> None:
        disc = self.discs.each[number]
        angle = math.atan2(place[1] - disc.y, place[0] - disc.x)
        self._pose, self._in = PathPose(*place, angle, max(math.dist(place, disc.centre), _NOTHING)), number

    def _cut(self, row: Sequence[float], times: float = 1.0, clear: bool = False) -> None:
        self._rows.append(tuple(row))  # type: ignore[arg-type]
        self._clear.append(clear)
        self._times.append(times)

    def _go(self, pose: PathPose, number: int, into: Circle | None = None) -> None:
        """Bring the cutter to a pose within a disc: over discs that overlap, or through the air.

        Args:
            into: the circle in which its centre may be where the way comes in; None = the disc's.
        """
        if self._pose is None:
            return
        room = into or self._room(number)
        rows = self._way(pose, number, room)
        if rows is None:
            self._end()
            rows = way_in(pose, room)
        self._rows += rows
        self._clear += [True] * len(rows)
        self._times += [1.0] * len(rows)

    def _way(self, pose: PathPose, number: int, room: Circle) -> list[Row] | None:
        """Return the way over clear ground to a pose, None where through the air is quicker."""
        assert self._pose is not None
        over = self._over(self._in, number)
        if self.front is not None:
            ways = (smooth_way(self._pose, pose, stops, room) for stops in ((), over))
            return next((rows for rows in ways if self._is_way(rows, self.front)), None)
        stops = [(self._pose.x, self._pose.y), *over, (pose.x, pose.y)]
        if sum(math.dist(a, b) for a, b in pairwise(stops)) > self.farthest:
            return None
        return smooth_way(self._pose, pose, over, room)

    def _is_way(self, rows: list[Row], front: MetalFront) -> bool:
        """Tell whether rows are over clear ground, and no longer than a way through the air."""
        way = np.array(rows).reshape(-1, 8)
        return float(lengths(way).sum()) <= self.farthest and all(front.is_air(row) for row in way)

    def _end(self) -> None:
        if self._rows:
            self.runs.append(CutRun(np.array(self._rows), np.array(self._clear), np.array(self._times)))
        self._rows, self._clear, self._times, self._pose = [], [], [], None

    def _room(self, number: int) -> Circle:
        disc = self.discs.each[number]
        return disc.x, disc.y, disc.reach - self.limit.radius

    def _over(self, start: int, end: int) -> list[Point]:
        """Return the centres over which the cutter goes from one disc to another: each lies in the disc before it."""
        if start == end:
            return []
        chain = self._chain(start, end)
        within = [self._room(number) for number in chain]
        over = [(x, y) for x, y, _ in within]
        assert self._pose is not None
        kept: list[Point] = [(self._pose.x, self._pose.y)]
        k = 0
        while k < len(over):
            # as far on as one disc holds both ends of a straight way
            far = k
            for ahead in range(k + 1, len(over)):
                if any(_holds(circle, kept[-1]) and _holds(circle, over[ahead]) for circle in within):
                    far = ahead
                else:
                    break
            kept.append(over[far])
            k = far + 1
        return kept[1:]

    def _chain(self, start: int, end: int) -> list[int]:
        """Return the discs from one to another along those that have paid for them."""
        up, down = self._payers(start), self._payers(end)
        common = set(up) & set(down)
        there = next(number for number in up if number in common)
        return up[: up.index(there) + 1] + down[: down.index(there)][::-1]

    def _payers(self, number: int) -> list[int]:
        found = [number]
        while (number := self.discs.each[number].payer) >= 0:
            found.append(number)
        return found


def _half(disc: ClearedDisc, paying: ClearedDisc, limit: EngagementLimit) -> float:
    """Return half the sweep of the arc about a disc's centre that lies beyond where its payer is clear, radians."""
    turn, away = disc.reach - limit.radius, math.dist(disc.centre, paying.centre)
    inner = paying.reach - limit.slack - limit.radius
    if away + turn <= inner or turn <= 0:
        return 0.0
    if away <= 0:
        return math.pi
    return math.acos(max(-1.0, min(1.0, (inner * inner - away * away - turn * turn) / (2 * away * turn))))


def _on(centre: Point, radius: float, angle: float) -> Point:
    return centre[0] + radius * math.cos(angle), centre[1] + radius * math.sin(angle)


def _holds(circle: Circle, place: Point) -> bool:
    return math.dist(circle[:2], place) <= circle[2]
