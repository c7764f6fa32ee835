"""A way along metal at a constant engaged angle: the point of the rim at that angle runs along the metal's edge.

From each place the direction of travel follows: the rim is met by metal from its right up to the angle, so the cutter
goes on at a quarter turn to the left of where the angle begins. Errors die out, as the edge is ahead of the cutter. The
way ends where the cutter has just room left to turn along the wall in a small arc.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from ...geometry.primitives import Rows
from .cleared_discs import Point, WallClearance
from .front import MetalFront

_STEP, _FIRST, _GROWS = 0.06, 0.04, 0.08
"""Radii of the cutter from one place to the next: at most, and at first, where the way bends the most; and by what
share of what is gone they grow.
"""

_SHORT = 0.03
"""Radii of the cutter; a place that is so near to the last one is left out: digits turn short arcs."""

_RIGHT = 1.0
"""Radii of the cutter; the least radius of a turn to the right, where metal draws back."""

_LONGEST = 400
"""Radii of the cutter; a longer way is none."""

_HALVINGS = 30
"""Of the last step of a way, for where it reaches the angle: a billionth of the step is left."""

_TOLERANCE, _TURNED = 0.001, 2e-3
"""mm that arcs leave the places of a way by, and radians that they turn off it: the angle changes by as many."""

_SAME = 1e-6
"""mm, and radians: rounding."""


@dataclass(frozen=True)
class Heading:
    """A place and a direction of travel, radians."""

    x: float
    y: float
    ahead: float

    @property
    def place(self) -> Point:
        """Where, mm."""
        return self.x, self.y

    def on(self, length: float, ahead: float) -> Point:
        """Return the place so far on in a direction."""
        return self.x + length * math.cos(ahead), self.y + length * math.sin(ahead)

    def left(self, radius: float) -> Point:
        """Return the centre of the circle that turns to the left from here."""
        return self.x - radius * math.sin(self.ahead), self.y + radius * math.cos(self.ahead)


@dataclass(frozen=True)
class Pursuit:
    """Ways along metal.

    Attributes:
        front: the metal.
        room: distances from walls.
        turns: radius of the arc in which the cutter turns along a wall, and mm from the walls that its centre keeps.
        aim: the angle, radians.
    """

    front: MetalFront
    room: WallClearance
    turns: tuple[float, float]
    aim: float

    def along(self, start: Heading) -> list[Heading]:
        """Return places of a way that begins at the limit, up to where it turns along a wall; empty where there is no
        such way.
        """
        radius, way, gone = self.front.limit.radius, [start], 0.0
        while gone < _LONGEST * radius:
            step = min(_STEP * radius, max(_FIRST * radius, _GROWS * gone))
            after = self._next(way[-1], step)
            if after is None:
                return []
            if self._over(after) > 0.0:
                last = self._last(way[-1], step)
                near = len(way) > 1 and math.dist(way[-1].place, last.place) < _SHORT * radius
                return [*(way[:-1] if near else way), last]
            way.append(after)
            gone += step
        return []

    def _over(self, at: Heading) -> float:
        """Return by how much the turn from here goes over a wall, mm."""
        turn, inner = self.turns
        return inner + turn - self.room.at(at.left(turn)) - self.room.leave - _SAME

    def _last(self, at: Heading, step: float) -> Heading:
        low, high, found = 0.0, step, at
        for _ in range(_HALVINGS):
            middle = (low + high) / 2
            after = self._next(at, middle)
            if after is None or self._over(after) > 0.0:
                high = middle
            else:
                low, found = middle, after
        return found

    def _next(self, at: Heading, step: float) -> Heading | None:
        """Return the place a step on, by the direction half way."""
        half = self._ahead(at.on(step / 2, at.ahead), at.ahead, step / 2)
        if half is None:
            return None
        place = at.on(step, half)
        ahead = self._ahead(place, half, step / 2)
        return Heading(*place, ahead) if ahead is not None else None

    def _ahead(self, place: Point, ahead: float, step: float) -> float | None:
        """Return the direction in which the limit is met at a place, or as far to the right as may be."""
        radius = self.front.limit.radius
        least = ahead - step / (_RIGHT * radius)
        met = self.front.met(place, ahead)
        if met is None:
            return least
        if met > math.pi - _SAME:
            return None
        return max(least, ahead + met - self.aim)


def arcs_through(way: list[Heading]) -> Rows:
    """Return arcs (n, 8) that touch one another and stay near places of a way: as few as a greedy search finds."""
    rows: list[tuple[float, ...]] = []
    k = 0
    while k < len(way) - 1:
        low, found, reach = k + 1, biarc(way[k], way[k + 1]), 2
        while k + reach < len(way):
            tried = _fitting(way, k, k + reach)
            if tried is None:
                break
            low, found, reach = k + reach, tried, 2 * reach
        high = min(k + reach, len(way))
        while high - low > 1:
            middle = (low + high) // 2
            tried = _fitting(way, k, middle)
            if tried is None:
                high = middle
            else:
                low, found = middle, tried
        rows += found
        k = low
    return np.array(rows).reshape(-1, 8)


def _fitting(way: list[Heading], first: int, last: int) -> list[tuple[float, ...]] | None:
    """Return the two arcs between two places of a way, None where they leave those between them, or turn off."""
    rows = biarc(way[first], way[last])
    between = np.array([(each.x, each.y, each.ahead) for each in way[first + 1 : last]])
    off, turned = zip(*(_beside(row, between) for row in rows), strict=True)
    which, each = np.argmin(off, axis=0), np.arange(len(between))
    fits = np.array(off)[which, each].max() <= _TOLERANCE and np.array(turned)[which, each].max() <= _TURNED
    return rows if fits else None


def _beside(row: tuple[float, ...], places: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Return how far places (n, 3) are from a row that goes on beyond its ends, mm, and by how much it turns off their
    directions, radians.
    """
    x0, y0, x1, y1, cx, cy, radius, turn = row
    x, y, ahead = places.T
    if turn != 0:
        off, along = np.abs(np.hypot(x - cx, y - cy) - radius), np.arctan2(y - cy, x - cx) + turn * math.pi / 2
    else:
        long = max(math.hypot(x1 - x0, y1 - y0), 1e-12)
        off = np.abs((x - x0) * (y1 - y0) - (y - y0) * (x1 - x0)) / long
        along = np.full(len(x), math.atan2(y1 - y0, x1 - x0))
    return off, np.abs((along - ahead + math.pi) % math.tau - math.pi)


def biarc(start: Heading, end: Heading) -> list[tuple[float, ...]]:
    """Return two rows that touch, from one place and direction to another: their tangents are of one length."""
    vx, vy = end.x - start.x, end.y - start.y
    ax, ay, bx, by = math.cos(start.ahead), math.sin(start.ahead), math.cos(end.ahead), math.sin(end.ahead)
    tx, ty = ax + bx, ay + by
    square, across, inner = vx * vx + vy * vy, vx * tx + vy * ty, 2 * (1 - ax * bx - ay * by)
    if inner < 1e-12:
        length = square / max(2 * across, 1e-12)
    else:
        length = (math.sqrt(across * across + inner * square) - across) / inner
    middle = (
        (start.x + end.x + length * (ax - bx)) / 2,
        (start.y + end.y + length * (ay - by)) / 2,
    )
    return [_touching(start, middle, 1.0), _touching(end, middle, -1.0)]


def _touching(at: Heading, other: Point, way: float) -> tuple[float, ...]:
    """Return the row that touches a direction at a place, on to another place (way 1) or from there (-1)."""
    dx, dy = other[0] - at.x, other[1] - at.y
    side = dy * math.cos(at.ahead) - dx * math.sin(at.ahead)
    square = dx * dx + dy * dy
    ends = (at.x, at.y, *other) if way > 0 else (*other, at.x, at.y)
    if abs(side) < 1e-9 * max(square, 1e-3):
        return (*ends, 0.0, 0.0, 0.0, 0.0)
    radius = square / (2 * side)
    cx, cy = at.left(radius)
    return (*ends, cx, cy, abs(radius), math.copysign(1.0, side))
