"""Cutter compensation, G41 and G42: the programmed contour becomes the path of the tool's centre, one move behind.

As LinuxCNC has it: each line and arc is offset to its side; at an outer corner an arc rolls round the programmed point,
at an inner one both are cut off where they meet; the first move leads to beside its own end, and after G40 the next one
starts there. On Fanuc and Haas the first move leads to beside the start of the next one: their
type A. Their type B is the same at an inner corner, and at an outer one a way farther from the contour.
"""

from __future__ import annotations

import cmath
import math
from dataclasses import dataclass, replace

from ...model.motion import MotionKind, Plane
from .program import BlockFault, Motion, MotionColumns, Place

SMOOTH = 0.05
"""A corner of less, radians, is taken for none, and one of so much less than half a turn for an outer one, as LinuxCNC
has it.
"""
_NO_ROOM = "the tool does not reach into the inner corner before this move without cutting into the contour."
SLACK = 1e-9
"""Where two offset curves meet may lie so far beyond the end of one, as a part of it."""


@dataclass(slots=True)
class OffsetMove:
    """An offset move in its plane, as complex numbers.

    Attributes:
        motion: the move.
        start, end: of the offset curve. centre: None of a line.
        ccw: sense of an arc.
        leaving, arriving: unit directions of the programmed move at its start and its end.
        corner: the programmed end.
        leads_in: it is the first one.
    """

    motion: Motion
    start: complex
    end: complex
    centre: complex | None
    ccw: bool
    leaving: complex
    arriving: complex
    corner: complex
    leads_in: bool = False

    def fraction(self, point: complex) -> float:
        """Return how far along the offset curve a point on it lies, 0 at the start and 1 at the end."""
        if self.centre is None:
            way = self.end - self.start
            return ((point - self.start) * way.conjugate()).real / abs(way) ** 2
        turn = 1 if self.ccw else -1
        first = cmath.phase(self.start - self.centre)
        whole = (cmath.phase(self.end - self.centre) - first) * turn % math.tau or math.tau
        part = (cmath.phase(point - self.centre) - first) * turn % math.tau
        return (part - math.tau if part > math.tau - SLACK else part) / whole


class Compensation:
    """A cutter compensation that is on.

    Attributes:
        waiting: moves whose end the next one decides; they belong behind those in the columns.
    """

    def __init__(self, radius: float, plane: Plane, place: Place, beside_next: bool = False) -> None:
        """Begin with the tool where it stands.

        Args:
            radius: mm; positive = the tool runs at the left of the contour.
            plane: of the contour.
            place: where the tool is.
            beside_next: the first move leads to beside the start of the next one, whatever their corner.
        """
        self._radius, self._plane, self._place, self._beside_next = radius, plane, place, beside_next
        self._before: OffsetMove | None = None
        self.waiting: list[Motion] = []

    @property
    def place(self) -> Place:
        """Where the tool is at the end of the last move."""
        return self.waiting[-1].end if self.waiting else self._place

    def take(self, motion: Motion, columns: MotionColumns) -> None:
        """Take a programmed move; write those before it whose end is now known.

        Raises:
            Fault: the tool cannot make the move without cutting into the contour.
        """
        u, v, _ = self._plane.axes
        start, end = complex(motion.start[u], motion.start[v]), complex(motion.end[u], motion.end[v])
        if start == end and motion.kind in (MotionKind.RAPID, MotionKind.LINE):
            self.waiting.append(replace(motion, start=self.place, end=self._over(self.place, motion.end)))
            return
        side = self._offset(motion, start, end)
        if self._before is None:
            self._enter(side, start)
        else:
            self._join(self._before, side, columns)
        self.flush(columns)
        moved = replace(motion, start=self.place, end=self._placed(side.end, motion.end))
        if side.centre is not None:
            moved.centre = self._placed(side.centre, motion.centre)
        self._before, self.waiting, side.motion = side, [moved], moved

    def flush(self, columns: MotionColumns) -> None:
        """Write all moves.

        Raises:
            Fault: two inner corners have turned a line round, so that the tool cannot get between them.
        """
        if self.waiting and self._turned_round():
            raise BlockFault(_NO_ROOM, letter="g")
        self.spill(columns)

    def spill(self, columns: MotionColumns) -> None:
        """Write all moves as they are."""
        for motion in self.waiting:
            columns.add(motion)
            self._place = motion.end
        self.waiting = []

    def _turned_round(self) -> bool:
        """Tell whether the line that waits runs against its own direction; the way in may."""
        side, moved = self._before, self.waiting[0]
        if side is None or side.centre is not None or side.leads_in or moved is not side.motion:
            return False
        u, v, _ = self._plane.axes
        way = complex(moved.end[u] - moved.start[u], moved.end[v] - moved.start[v])
        return (way * side.arriving.conjugate()).real < -SLACK

    def _offset(self, motion: Motion, start: complex, end: complex) -> OffsetMove:
        if motion.kind == MotionKind.SPLINE:
            raise BlockFault("cutter compensation follows no splines; write G40 before.", letter="g")
        if motion.kind not in (MotionKind.ARC_CW, MotionKind.ARC_CCW):
            way = (end - start) / abs(end - start)
            aside = way * 1j * self._radius
            return OffsetMove(motion, start + aside, end + aside, None, ccw=True, leaving=way, arriving=way, corner=end)
        u, v, _ = self._plane.axes
        centre, ccw = complex(motion.centre[u], motion.centre[v]), motion.kind == MotionKind.ARC_CCW
        inward = self._radius if ccw else -self._radius
        first, last = start - centre, end - centre
        if min(abs(first), abs(last)) - inward < SLACK:
            raise BlockFault(
                f"the tool (radius {abs(self._radius):g} mm) does not fit into an arc of radius {abs(first):g} mm.",
                letter="g",
            )
        turn = 1j if ccw else -1j
        return OffsetMove(
            motion=motion,
            start=start - first / abs(first) * inward,
            end=end - last / abs(last) * inward,
            centre=centre,
            ccw=ccw,
            leaving=first / abs(first) * turn,
            arriving=last / abs(last) * turn,
            corner=end,
        )

    def _enter(self, side: OffsetMove, start: complex) -> None:
        """Make a side the way in: from where the tool is to beside the move's end."""
        side.leads_in = True
        if self._beside_next:
            if side.centre is not None:
                raise BlockFault("cutter compensation begins on a straight move, not on an arc.", letter="g")
            return
        u, v, _ = self._plane.axes
        here = complex(self.place[u], self.place[v])
        if side.centre is None:
            if abs(side.corner - start) <= abs(self._radius) + SLACK:
                raise BlockFault(
                    "the first move under cutter compensation must be longer than the tool's radius.", letter="g"
                )
        else:
            radial, way = side.arriving * 1j, side.end - here
            across = (way * radial.conjugate()).real
            if abs(way) < SLACK or abs(across) < SLACK:
                raise BlockFault(
                    "this arc cannot lead the tool to beside its end; begin cutter compensation with a line.",
                    letter="g",
                )
            side.centre = side.end - radial * abs(way) ** 2 / (2 * across)
            side.start = here

    def _join(self, before: OffsetMove, side: OffsetMove, columns: MotionColumns) -> None:
        """Join a side to the one before: round an outer corner, or cut off at an inner one."""
        bend = cmath.phase(side.leaving / before.arriving)
        back = abs(bend) > math.pi - SMOOTH
        if abs(bend) <= SMOOTH:
            side.start = before.end
        elif before.leads_in and self._beside_next:
            self._end_at(side.start)
        elif (back and not self._between(before, side)) or (bend * self._radius < 0 and not back):
            self.flush(columns)
            self._roll(side, before.corner, columns)
        else:
            side.start = self._meeting(before, side)
            self._end_at(side.start)

    def _end_at(self, place: complex) -> None:
        """Let the move that waits, and what follows it straight up or down, end at a place of the plane."""
        for motion in self.waiting:
            if motion is not self.waiting[0]:
                motion.start = self._placed(place, motion.start)
            motion.end = self._placed(place, motion.end)

    def _between(self, before: OffsetMove, side: OffsetMove) -> bool:
        """Tell whether a turn straight back is an inner corner: between a line and the outside of an arc, where the
        tool would have to go round the arc to get to the line's other side.
        """
        arc = before if side.centre is None else side
        return arc.centre is not None and self._outside(arc)

    def _outside(self, arc: OffsetMove) -> bool:
        """Tell whether the tool runs round an arc rather than within it."""
        return arc.ccw == (self._radius < 0)

    def _roll(self, side: OffsetMove, corner: complex, columns: MotionColumns) -> None:
        """Go round an outer corner; straight if the next move is a rapid."""
        start = self._place
        end = self._placed(side.start, start)
        if side.motion.kind == MotionKind.RAPID:
            columns.add(replace(side.motion, start=start, end=end))
        else:
            kind = MotionKind.ARC_CW if self._radius > 0 else MotionKind.ARC_CCW
            columns.add(
                replace(side.motion, kind=kind, start=start, end=end, centre=self._placed(corner, start), turns=1)
            )
        self._place = end

    def _meeting(self, before: OffsetMove, side: OffsetMove) -> complex:
        """Return where two offset curves meet at an inner corner.

        As LinuxCNC has it: an arc must reach so far, and whether a line is turned round by that `flush` tells, when its
        other end is known.
        """
        points = _intersections(before, side)
        if (before.centre is None) != (side.centre is None):
            points = sorted(points, key=lambda point: _along(before, side, point))
            near = self._outside(side if before.centre is None else before)
            points = points[:1] if near == (before.centre is None) else points[-1:]
        points = [point for point in points if _on(before, point) and _on(side, point)]
        if not points:
            raise BlockFault(_NO_ROOM, letter="g")
        return min(points, key=lambda point: abs(point - before.corner))

    def _placed(self, point: complex, like: Place) -> Place:
        """Return a point of the plane at the height of a place."""
        u, v, w = self._plane.axes
        place = [0.0, 0.0, 0.0]
        place[u], place[v], place[w] = point.real, point.imag, like[w]
        return (place[0], place[1], place[2])

    def _over(self, place: Place, height: Place) -> Place:
        u, v, _ = self._plane.axes
        return self._placed(complex(place[u], place[v]), height)


def _on(side: OffsetMove, point: complex) -> bool:
    """Tell whether a point is on an offset arc; any is on a line, whose ends both move."""
    return side.centre is None or -SLACK <= side.fraction(point) <= 1 + SLACK


def _along(one: OffsetMove, other: OffsetMove, point: complex) -> float:
    """Return how far along the line among two sides a point lies."""
    line = one if one.centre is None else other
    return ((point - line.start) * line.leaving.conjugate()).real


def _intersections(one: OffsetMove, other: OffsetMove) -> list[complex]:
    """Return where the line or circle of one side meets that of another."""
    if one.centre is None and other.centre is None:
        a, b = one.leaving, other.leaving
        cross = (a.conjugate() * b).imag
        gap = other.start - one.end
        return [one.end + a * (gap.conjugate() * b).imag / cross] if cross else []
    if one.centre is None or other.centre is None:
        line, arc = (one, other) if one.centre is None else (other, one)
        assert arc.centre is not None
        way = line.leaving
        foot = line.end + way * ((arc.centre - line.end) * way.conjugate()).real
        return _either_side(foot, way, abs(arc.end - arc.centre) ** 2 - abs(foot - arc.centre) ** 2)
    gap, r, s = other.centre - one.centre, abs(one.end - one.centre), abs(other.end - other.centre)
    if abs(gap) < SLACK:
        return [other.start] if abs(r - s) < SLACK else []
    along = (abs(gap) ** 2 + r**2 - s**2) / (2 * abs(gap))
    way = gap / abs(gap)
    return _either_side(one.centre + way * along, way * 1j, r**2 - along**2)


def _either_side(middle: complex, way: complex, square: float) -> list[complex]:
    """Return the two points at a distance, given by its square, from the middle of a chord."""
    if square < -SLACK:
        return []
    half = math.sqrt(max(square, 0.0))
    return [middle - way * half, middle + way * half]
