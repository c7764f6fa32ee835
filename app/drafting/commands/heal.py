"""The command `heal`: tiny curves and duplicates go, what overlaps becomes one, gaps are closed.

No point moves farther than a tolerance.
"""

from __future__ import annotations

import math
from collections import Counter, defaultdict
from collections.abc import Sequence
from dataclasses import dataclass, field, replace

from ...core.errors import InputError
from ...core.tolerances import WELD
from ...model.curves import Arc, Circle, Curve, Ellipse, Line, Point, Spline
from ..expressions.arguments import Arguments
from .command import DraftingSession, check_ids
from .defects import (
    Defect,
    DefectKind,
    End,
    common_turn,
    curve_distance,
    duplicates,
    meetings,
    overlaps,
    point_of,
    tiny_curves,
    turn_of,
)
from .join import brought_to
from .properties import properties_of, with_property
from .select import reachable

_LARGEST = 10.0
"""mm; a wider gap is drawn on purpose."""
_ROUNDS = 4
"""Rounds at most: what one has mended may touch what it could not mend."""
_WORDS = {
    DefectKind.TINY: ("tiny curve removed", "tiny curves removed"),
    DefectKind.DUPLICATE: ("duplicate removed", "duplicates removed"),
    DefectKind.OVERLAP: ("overlap removed", "overlaps removed"),
    DefectKind.GAP: ("gap closed", "gaps closed"),
}
_SHARE = 2.0
"""To look for faults, time and again, costs so many times what it costs to take the curves apart."""


@dataclass(frozen=True, slots=True)
class Heal:
    """Put a drawing's curves where they are, instead.

    Attributes:
        curves: by number, those that stay, some of them changed; None for those that go.
        counts: what was put right.
    """

    curves: dict[int, Curve | None]
    counts: dict[DefectKind, int]
    name: str = "Heal"

    @property
    def reply(self) -> str:
        """A short sentence for the log."""
        counts = self.counts
        reported = [
            f"{counts[kind]} {one if counts[kind] == 1 else many}"
            for kind, (one, many) in _WORDS.items()
            if kind in counts
        ]
        return f"{', '.join(reported)}." if reported else "Nothing to mend."

    def carried_out(self, session: DraftingSession) -> DraftingSession:
        """Return the session with the curves put right."""
        if not self.curves:
            return session
        part, now = session.part, self.curves
        entities = tuple(
            replace(e, curve=curve) if (curve := now.get(e.id, e.curve)) is not e.curve and curve is not None else e
            for e in part.entities
            if now.get(e.id, e.curve) is not None
        )
        return session.with_part(replace(part, entities=entities, used_id=part.next_id() - 1))


@dataclass
class _HealJob:
    """Curves that are being put right.

    Attributes:
        curves, drawn, layers: by number: as they are now, as they were drawn, where they are.
        tolerance: no curve is led farther from where it was drawn, mm.
        counts: what was put right. ends: of curves that are merged, where those that they are made of ended.
    """

    curves: dict[int, Curve]
    drawn: dict[int, Curve]
    layers: dict[int, str]
    tolerance: float
    counts: Counter[DefectKind] = field(default_factory=Counter)
    ends: dict[int, list[Point]] = field(default_factory=dict)

    def once(self) -> None:
        """Put right what is wrong now; closing a gap may bring up another fault."""
        for kind, look in ((DefectKind.TINY, tiny_curves), (DefectKind.DUPLICATE, duplicates)):
            for fault in look(self.curves, self.tolerance):
                del self.curves[fault.ids[-1]]
                self.counts[kind] += 1
        self._part(overlaps(self.curves, self.tolerance))
        for meeting in meetings(self.curves, self.tolerance):
            self.counts[DefectKind.GAP] += self._close(meeting)

    def _part(self, faults: list[Defect]) -> None:
        """Make one of two that overlap, or cut one of them where that cannot be."""
        into, taken = dict[int, int](), _CurveEnds(self.curves, self.tolerance) if faults else None
        for fault in faults:
            long, short = (_followed(into, number) for number in fault.ids)
            if long == short or taken is None or long not in self.curves or short not in self.curves:
                continue
            if self._merge(long, short, taken):
                into[short] = long
                self.counts[DefectKind.OVERLAP] += 1
            elif (long, short) == fault.ids:
                self.counts[DefectKind.OVERLAP] += self._cut(long, short)

    def _merge(self, long: int, short: int, taken: _CurveEnds) -> bool:
        """Put one curve in the place of two of a layer, unless another curve ends where an end of theirs would be no
        more.
        """
        stays, goes = self.curves[long], self.curves[short]
        if (
            self.layers[long] != self.layers[short]
            or isinstance(stays, Ellipse | Spline)
            or isinstance(goes, Ellipse | Spline)
        ):
            return False
        ends = [
            p
            for number in (long, short)
            for p in self.ends.get(number, (self.curves[number].start, self.curves[number].end))
        ]
        made = merged(stays, goes, ends, self.tolerance)
        if made is None:
            return False
        within = [p for p in ends if min(math.dist(p, made.start), math.dist(p, made.end)) > WELD]
        if any(taken.by_others(point, {long, short}) for point in within):
            return False
        self.curves[long] = self.drawn[long] = made
        self.ends[long] = ends
        del self.curves[short]
        return True

    def _cut(self, long: int, short: int) -> bool:
        """Cut the shorter of two that overlap down to what the longer one leaves of it; return whether anything
        changed.
        """
        stays, goes = self.curves[long], self.curves[short]
        left: Curve | None = goes
        if isinstance(stays, Line) and isinstance(goes, Line):
            left = _line_left(stays, goes, self.tolerance)
        elif isinstance(stays, Arc | Circle) and isinstance(goes, Arc | Circle):
            left = _arc_left(stays, goes, self.tolerance)
        if left is None:
            del self.curves[short]
        elif left is not goes:
            self.curves[short] = self.drawn[short] = left
        return left is not goes

    def _close(self, meeting: list[End]) -> bool:
        """Move ends to one point; return whether they were apart. Ends that cannot move, of ellipses, are where the
        others go.
        """
        points = [point_of(self.curves[number], last) for number, last in meeting]
        if all(point == points[0] for point in points):
            return False
        fixed = {
            point
            for point, (number, _) in zip(points, meeting, strict=True)
            if "end" not in properties_of(self.curves[number])
        }
        middle = (sum(p[0] for p in points) / len(points), sum(p[1] for p in points) / len(points))
        to = next(iter(fixed), middle)
        return len(fixed) <= 1 and brought_to(to, self.curves, meeting, self._with_end)

    def _with_end(self, number: int, last: bool, to: Point) -> Curve | None:
        """Return a curve with an end elsewhere; None where that would take it farther from where it was drawn than the
        tolerance.
        """
        curve = self.curves[number]
        if point_of(curve, last) == to:
            return curve
        try:
            made: Curve = with_property(curve, "end" if last else "start", to)
        except InputError:
            return None
        return made if curve_distance(self.drawn[number], made) <= self.tolerance else None


class _CurveEnds:
    """Where curves end."""

    def __init__(self, curves: dict[int, Curve], tolerance: float) -> None:
        self._size = tolerance
        self._at = defaultdict[tuple[int, int], list[tuple[Point, int]]](list)
        for number, curve in curves.items():
            for point in (curve.start, curve.end):
                self._at[self._cell(point)].append((point, number))

    def _cell(self, point: Point) -> tuple[int, int]:
        return math.floor(point[0] / self._size), math.floor(point[1] / self._size)

    def by_others(self, point: Point, these: set[int]) -> bool:
        """Return whether a curve that is none of these ends within the tolerance of a point."""
        i, j = self._cell(point)
        near = (pair for x in (i - 1, i, i + 1) for y in (j - 1, j, j + 1) for pair in self._at.get((x, y), ()))
        return any(number not in these and math.dist(other, point) <= self._size for other, number in near)


def _followed(into: dict[int, int], number: int) -> int:
    """Return the curve that one has become part of, or itself."""
    while number in into:
        number = into[number]
    return number


def _line_left(stays: Line, goes: Line, tolerance: float) -> Line | None:
    """Return what of a line lies beyond a longer one that it overlaps; None where nothing does."""
    size = math.dist(stays.start, stays.end)
    ux, uy = (stays.end[0] - stays.start[0]) / size, (stays.end[1] - stays.start[1]) / size
    beyond = []
    for end, (x, y) in enumerate((goes.start, goes.end)):
        way = (x - stays.start[0]) * ux + (y - stays.start[1]) * uy
        if not -tolerance <= way <= size + tolerance:
            beyond.append((end, stays.start if way < 0 else stays.end))
    if not beyond:
        return None
    end, edge = beyond[0]
    return goes if len(beyond) > 1 else Line(edge, goes.end) if end else Line(goes.start, edge)


def _arc_left(stays: Arc | Circle, goes: Arc | Circle, tolerance: float) -> Curve | None:
    """Return what of an arc lies beyond another of its circle; None where nothing does, the arc itself where it is cut
    in two.
    """
    both = common_turn(goes, stays)
    if both is None or isinstance(goes, Circle):
        return None if both is not None else goes
    whole, r = abs(goes.sweep), goes.radius
    begins = goes.start_angle if goes.ccw else goes.start_angle + goes.sweep
    before = (both[0] - begins) % math.tau
    behind = whole - before - both[1]
    if max(before, behind) * r <= tolerance:
        return None
    if min(before, behind) * r > tolerance:
        return goes
    ahead = math.degrees(behind if behind > before else before)
    from_end = (behind > before) == goes.ccw
    kept = Arc(goes.end, goes.start, goes.centre, not goes.ccw) if from_end else goes
    made = with_property(kept, "sweep", ahead)
    return Arc(made.end, made.start, made.centre, not made.ccw) if from_end else made


def heal(words: Arguments, session: DraftingSession) -> Heal:
    """Put right what is wrong within a tolerance, with some curves or with all that are seen and not locked."""
    tolerance = words.length("the tolerance")
    if not WELD < tolerance <= _LARGEST:
        raise InputError(f"The tolerance is {tolerance:g} mm; it must be greater than 0 and at most {_LARGEST:g} mm.")
    ids = frozenset(words.ids())
    check_ids(session.part, ids)
    before = {e.id: e.curve for e in reachable(session.part) if not ids or e.id in ids}
    words.takes(before.values(), _SHARE)
    work = _HealJob(dict(before), dict(before), {e.id: e.layer for e in session.part.entities}, tolerance)
    for _ in range(_ROUNDS):
        was = dict(work.curves)
        work.once()
        if work.curves == was:
            break
    changed = {
        number: work.curves.get(number) for number, curve in before.items() if work.curves.get(number) is not curve
    }
    return Heal(changed, {kind: count for kind, count in work.counts.items() if count})


_WHOLE = math.tau - 1e-9
"""Radians; an arc that sweeps more is a whole circle."""


def merged(
    stays: Line | Arc | Circle, goes: Line | Arc | Circle, ends: Sequence[Point], tolerance: float
) -> Line | Arc | Circle | None:
    """Return the curve that two which overlap are together, in the direction of the first; None where they are not one.

    Args:
        ends: of the curves that both have been made of, mm; none may lie farther from the one curve than the tolerance.
        tolerance: mm.
    """
    if isinstance(stays, Line) and isinstance(goes, Line):
        return _line(stays, goes, ends, tolerance)
    if isinstance(stays, Line) or isinstance(goes, Line):
        return None
    return _round(stays, goes, ends, tolerance)


def _line(stays: Line, goes: Line, ends: Sequence[Point], tolerance: float) -> Line | None:
    (x, y), size = stays.start, math.dist(stays.start, stays.end)
    ux, uy = (stays.end[0] - x) / size, (stays.end[1] - y) / size

    def way(point: Point) -> float:
        return (point[0] - x) * ux + (point[1] - y) * uy

    along = sorted((stays.start, stays.end, goes.start, goes.end), key=way)
    made = Line(along[0], along[-1])
    long, dx, dy = math.dist(made.start, made.end), made.end[0] - made.start[0], made.end[1] - made.start[1]
    off = max(abs((px - made.start[0]) * dy - (py - made.start[1]) * dx) / long for px, py in ends)
    apart = min(way(goes.start), way(goes.end)) > size + tolerance or max(way(goes.start), way(goes.end)) < -tolerance
    return made if off <= tolerance and not apart else None


def _round(stays: Arc | Circle, goes: Arc | Circle, ends: Sequence[Point], tolerance: float) -> Arc | Circle | None:
    from ...geometry.arcs.arcs import equally_far  # not when the window opens

    (first, turn), (other, there) = turn_of(stays), turn_of(goes)
    ahead, behind = (other - first) % math.tau, (first - other) % math.tau
    if ahead <= turn:
        from_stays, to_stays, whole = True, ahead + there <= turn, max(turn, ahead + there)
    elif behind <= there:
        from_stays, to_stays, whole = False, behind + turn >= there, max(there, behind + turn)
    else:
        return None
    if whole > _WHOLE:
        return Circle(stays.centre, stays.radius, stays.ccw)
    begin, end = _begin(stays if from_stays else goes), _end(stays if to_stays else goes)
    centre = equally_far(begin, end, stays.centre)
    made = Arc(begin, end, centre) if stays.ccw else Arc(end, begin, centre, ccw=False)
    off = max(abs(math.dist(p, made.centre) - made.radius) for p in ends)
    return made if max(off, math.dist(made.centre, stays.centre)) <= tolerance else None


def _begin(curve: Arc | Circle) -> Point:
    """Return where a curve begins counter-clockwise."""
    return curve.start if curve.ccw else curve.end


def _end(curve: Arc | Circle) -> Point:
    return curve.end if curve.ccw else curve.start
