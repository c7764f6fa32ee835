"""What is wrong with a drawing within a tolerance: tiny curves, duplicates, overlaps, gaps."""

from __future__ import annotations

import math
from collections import defaultdict
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from enum import Enum
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from ...core.progress import NO_PROGRESS, Progress
from ...core.tolerances import WELD
from ...geometry.sample import bounds, sample
from ...model.curves import Arc, Circle, Curve, Line, Point, reversed_curve
from ...model.part import Part
from ..curves.shapes import middle_of

_LOOKS = 8
"""So many pieces of two curves are compared to tell whether they are one."""


class DefectKind(Enum):
    """What a fault is."""

    TINY = "tiny curve"
    DUPLICATE = "duplicate"
    OVERLAP = "overlap"
    GAP = "gap"


@dataclass(frozen=True, slots=True)
class Defect:
    """One fault.

    Attributes:
        ids: of the curves that have it; of duplicates and overlaps the one that stays comes first.
        place: where to look, mm.
        size: length of a tiny curve or of an overlap, distance of duplicates, width of a gap, mm.
    """

    kind: DefectKind
    ids: tuple[int, ...]
    place: Point
    size: float


def find_defects(part: Part, tolerance: float, progress: Progress = NO_PROGRESS) -> tuple[Defect, ...]:
    """Return every fault of the curves that are seen and not locked, kind by kind.

    What is tiny or drawn twice is not looked at again, so that one mistake is one fault. Overlaps are found among
    lines, and among arcs and circles; duplicates and gaps among all curves.

    Args:
        part: the drawing.
        tolerance: lengths up to this count as nothing, mm, > 0.
        progress: looked at for Cancel.
    """
    from .select import reachable

    curves = {e.id: e.curve for e in reachable(part)}
    found = list[Defect]()
    for share, look in enumerate((tiny_curves, duplicates, overlaps, gaps)):
        progress.step(share / 4, "Looking")
        here = look(curves, tolerance)
        found += here
        gone = {
            number
            for fault in here
            if fault.kind in (DefectKind.TINY, DefectKind.DUPLICATE)
            for number in (fault.ids if fault.kind is DefectKind.TINY else fault.ids[1:])
        }
        curves = {number: curve for number, curve in curves.items() if number not in gone}
    return tuple(found)


def tiny_curves(curves: Mapping[int, Curve], tolerance: float) -> list[Defect]:
    """Return the curves that fit into a box no larger than the tolerance."""
    found = []
    for number, curve in curves.items():
        x0, y0, x1, y1 = bounds(curve)
        if (size := math.hypot(x1 - x0, y1 - y0)) <= tolerance:
            found.append(Defect(DefectKind.TINY, (number,), ((x0 + x1) / 2, (y0 + y1) / 2), size))
    return found


def duplicates(curves: Mapping[int, Curve], tolerance: float) -> list[Defect]:
    """Return the curves that lie within the tolerance of an earlier one of their kind, all along."""
    first_of, gone, found = dict[Curve, int](), set[int](), list[Defect]()
    for number in sorted(curves):
        curve = curves[number]
        known = first_of.get(curve) or first_of.get(reversed_curve(curve))
        if known is None:
            first_of[curve] = number
        else:
            found.append(Defect(DefectKind.DUPLICATE, (known, number), middle_of(curve), 0.0))
    numbers = sorted(first_of.values())
    for first, second in (
        (numbers[a], numbers[b]) for a, b in _pairs([_mark(curves[number]) for number in numbers], 3 * tolerance)
    ):
        if gone & {first, second} or type(curves[first]) is not type(curves[second]):
            continue
        between = curve_distance(curves[first], curves[second])
        if between <= tolerance:
            gone.add(second)
            found.append(Defect(DefectKind.DUPLICATE, (first, second), middle_of(curves[second]), between))
    return found


def _mark(curve: Curve) -> tuple[float, float, float]:
    """Return a place and a size that two curves share when they are one in whichever direction."""
    if isinstance(curve, Circle):
        return (*curve.centre, curve.radius)
    if isinstance(curve, Line | Arc):
        return (*middle_of(curve), math.dist(curve.start, curve.end))
    x0, y0, x1, y1 = bounds(curve)
    return ((x0 + x1) / 2, (y0 + y1) / 2, math.hypot(x1 - x0, y1 - y0))


def curve_distance(a: Curve, b: Curve) -> float:
    """Return how far two curves of one kind are from one another, mm, by points at equal shares of their ways."""
    if isinstance(a, Circle) and isinstance(b, Circle):
        return math.dist(a.centre, b.centre) + abs(a.radius - b.radius)
    if isinstance(a, Line) and isinstance(b, Line):
        return min(
            max(math.dist(a.start, b.start), math.dist(a.end, b.end)),
            max(math.dist(a.start, b.end), math.dist(a.end, b.start)),
        )
    one, other = _shares(a), _shares(b)
    return float(min(np.hypot(*(one - other).T).max(), np.hypot(*(one - other[::-1]).T).max()))


def _shares(curve: Curve) -> NDArray[np.float64]:
    points = sample(curve)
    way = np.concatenate([[0.0], np.cumsum(np.hypot(*np.diff(points, axis=0).T))])
    at = np.linspace(0.0, way[-1], _LOOKS + 1)
    return np.column_stack([np.interp(at, way, points[:, 0]), np.interp(at, way, points[:, 1])])


def overlaps(curves: Mapping[int, Curve], tolerance: float) -> list[Defect]:
    """Return pairs of lines on one straight line, and of arcs and circles on one circle, that share more than the
    tolerance.
    """
    lines = {number: curve for number, curve in curves.items() if isinstance(curve, Line)}
    rounds = {number: curve for number, curve in curves.items() if isinstance(curve, Arc | Circle)}
    return [*_of_lines(lines, tolerance), *_of_rounds(rounds, tolerance)]


def _of_lines(lines: Mapping[int, Line], tolerance: float) -> list[Defect]:
    """Compare each line with shorter ones that have an end on it, as of two that overlap the shorter one has."""
    if len(lines) < 2:
        return []
    numbers = sorted(lines)
    ends = np.array([(lines[number].start, lines[number].end) for number in numbers])
    sizes = np.hypot(*(ends[:, 1] - ends[:, 0]).T)
    low, high = ends[:, :, 0].min(axis=1), ends[:, :, 0].max(axis=1)
    order = np.argsort(low, kind="stable")
    sorted_low, reach, found = low[order], float((high - low).max()), list[Defect]()
    for at, number in enumerate(numbers):
        first = np.searchsorted(sorted_low, low[at] - reach - tolerance)
        near = order[first : np.searchsorted(sorted_low, high[at] + tolerance, side="right")]
        near = near[(sizes[near] < sizes[at]) | ((sizes[near] == sizes[at]) & (near > at))]
        away, way = ends[near] - ends[at, 0], (ends[at, 1] - ends[at, 0]) / sizes[at]
        on = (np.abs(away[:, :, 0] * way[1] - away[:, :, 1] * way[0]) <= tolerance).all(axis=1)
        along_it = np.sort(away[on] @ way, axis=1).clip(0.0, sizes[at])
        for other, (begin, end) in zip(near[on], along_it, strict=True):
            if end - begin > tolerance:
                place = along(lines[number], (begin + end) / 2)
                found.append(Defect(DefectKind.OVERLAP, (number, numbers[other]), place, float(end - begin)))
    return found


def along(line: Line, way: float) -> Point:
    """Return the point of a line at a way from its start, mm."""
    share = float(way) / math.dist(line.start, line.end)
    return (
        line.start[0] + (line.end[0] - line.start[0]) * share,
        line.start[1] + (line.end[1] - line.start[1]) * share,
    )


def _of_rounds(rounds: Mapping[int, Arc | Circle], tolerance: float) -> list[Defect]:
    numbers, found = sorted(rounds), list[Defect]()
    for a, b in _pairs([(*rounds[n].centre, rounds[n].radius) for n in numbers], tolerance):
        long, short = sorted((numbers[a], numbers[b]), key=lambda n: -turn_of(rounds[n])[1])
        both = common_turn(rounds[long], rounds[short])
        if both is None:
            continue
        first, turn = both
        curve = rounds[long]
        if (size := turn * curve.radius) > tolerance:
            middle = first + turn / 2
            place = (
                curve.centre[0] + curve.radius * math.cos(middle),
                curve.centre[1] + curve.radius * math.sin(middle),
            )
            found.append(Defect(DefectKind.OVERLAP, (long, short), place, size))
    return found


def turn_of(curve: Arc | Circle) -> tuple[float, float]:
    """Return where an arc begins counter-clockwise, and how far it goes, radians."""
    if isinstance(curve, Circle):
        return 0.0, math.tau
    return (curve.start_angle, curve.sweep) if curve.ccw else (curve.start_angle + curve.sweep, -curve.sweep)


def common_turn(a: Arc | Circle, b: Arc | Circle) -> tuple[float, float] | None:
    """Return the longest stretch of angles that two arcs of one circle share: its beginning, and how far it goes,
    radians.
    """
    (first, turn), (other, there) = turn_of(a), turn_of(b)
    ahead = (other - first) % math.tau
    best = (ahead, min(there, turn - ahead)) if ahead < turn else (0.0, 0.0)
    behind = ahead + there - math.tau
    if min(behind, turn) > best[1]:
        best = (0.0, min(behind, turn))
    return (first + best[0], best[1]) if best[1] > 0 else None


def gaps(curves: Mapping[int, Curve], tolerance: float) -> list[Defect]:
    """Return the places where ends of curves come within the tolerance of one another and do not meet."""
    found = []
    for meeting in meetings(curves, tolerance):
        points = [point_of(curves[number], last) for number, last in meeting]
        size = max(math.dist(p, q) for p in points for q in points)
        if size > WELD:
            place = (sum(p[0] for p in points) / len(points), sum(p[1] for p in points) / len(points))
            found.append(Defect(DefectKind.GAP, tuple(dict.fromkeys(number for number, _ in meeting)), place, size))
    return found


class End(NamedTuple):
    """An end of a curve, by its number: its first point or its last one."""

    number: int
    last: bool


def point_of(curve: Curve, last: bool) -> Point:
    """Return the first or last point of a curve."""
    return curve.end if last else curve.start


def meetings(curves: Mapping[int, Curve], tolerance: float) -> list[list[End]]:
    """Return groups of ends of different curves, none farther from another of its group than the tolerance; nearest
    first.
    """
    at = defaultdict[tuple[int, int], list[End]](list)
    for number, curve in curves.items():
        if math.dist(curve.start, curve.end) > tolerance:
            for last in (False, True):
                x, y = point_of(curve, last)
                at[round(x / WELD), round(y / WELD)].append(End(number, last))
    groups = [_EndGroup([point_of(curves[ends[0].number], ends[0].last)], ends) for ends in at.values()]
    group, places = list(groups), [each.places[0] for each in groups]
    for a, b in sorted(_pairs(places, tolerance), key=lambda pair: math.dist(places[pair[0]], places[pair[1]])):
        one, other = group[a], group[b]
        if one is not other and one.can_take(other, tolerance):
            one.places += other.places
            one.ends += other.ends
            group = [one if each is other else each for each in group] if len(other.places) > 1 else group
            group[b] = group[b] if group[b] is one else one
    return [each.ends for each in {id(each): each for each in group}.values() if len(each.ends) > 1]


@dataclass
class _EndGroup:
    """Ends that are to meet, and the places where they are."""

    places: list[Point]
    ends: list[End]

    def can_take(self, other: _EndGroup, tolerance: float) -> bool:
        if {number for number, _ in self.ends} & {number for number, _ in other.ends}:
            return False
        return all(math.dist(p, q) <= tolerance for p in self.places for q in other.places)


def _pairs(places: Sequence[tuple[float, ...]], tolerance: float) -> list[tuple[int, int]]:
    """Return the pairs of places, by their numbers in order, that are within the tolerance of one another."""
    if len(places) < 2:
        return []
    from scipy.spatial import cKDTree  # not when the window opens

    return sorted((int(a), int(b)) for a, b in cKDTree(np.array(places)).query_pairs(tolerance, output_type="ndarray"))
