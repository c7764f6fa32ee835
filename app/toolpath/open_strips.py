"""Areas beside open lines, on one side of them: what a cutter machines whose edge is no closed contour.

Such an area is what lies within reach of a line, without what lies on its other side: past the line's ends it turns
round them, where nothing is known of an edge, so that a cutter may go on as far as the end.

Where lines bend back or come near one another, one area is made beside all of them together: what lies within reach of
any, without the metal, which is a band behind each line as wide as half of that, up to the next line. Each ring round
what is left goes along lines and, from the end of one to the beginning of the next, through the open. A line that is
not whole on a ring has another one's metal where its cutter would be: no drawing can mean that, and it is told.
"""

from __future__ import annotations

import math
from collections import Counter
from collections.abc import Iterator, Sequence
from dataclasses import replace
from itertools import pairwise
from typing import NamedTuple

import numpy as np
import shapely
import shapely.ops
from numpy.typing import NDArray

from ..core.errors import GeometryError
from ..core.tolerances import WELD
from ..core.wording import in_plane
from ..geometry.outlines import reversed_contour
from ..geometry.primitives import contour_rows, sample
from ..model.curves import Line, Primitive
from ..model.finding import Finding, FindingKind
from ..model.operation import SideStrip
from ..model.part import Contour
from .leads.contour_path import headings_at

Floats = NDArray[np.float64]

_CHORD = 1e-3
"""mm; only what is far from the line depends on it."""

_QUARTER = 8
"""Chords of a quarter turn round the ends of lines."""


_LAP = 1e-4
"""Radians by which the metal behind corners laps over that behind the chords beside them."""

_SKIN = 1e-6
"""mm; bounds of an area that are nearer to a line lie on it."""


class StripsBesideLines(NamedTuple):
    """Closed contours of the areas, what of them no line bounds, and lines beside which there is no area."""

    contours: list[Contour]
    bare: list[Contour]
    findings: tuple[Finding, ...] = ()


class _EdgeLine(NamedTuple):
    """A line in the direction in which its area lies on the left.

    Attributes:
        drawn: as it is drawn. turned: in this direction. points: (n, 2) of its chords, mm.
    """

    drawn: Contour
    turned: Contour
    points: Floats


def strips(lines: Sequence[Contour], strip: SideStrip) -> StripsBesideLines:
    """Return the areas beside open lines.

    Raises:
        GeometryError: there is none, as each line comes within reach of itself or of another one.
    """
    ways = [_way(line, strip) for line in lines]
    made = [_strip(way, strip) for way in ways]
    alone = [each for each in made if each is not None]
    if len(alone) < len(made) or not _apart(alone):
        return _together(ways, [each is not None for each in made], strip)
    return StripsBesideLines([each.contours[0] for each in alone], [bare for each in alone for bare in each.bare])


def _apart(made: Sequence[StripsBesideLines]) -> bool:
    """Tell whether no two areas meet: each is judged by its own line."""
    shapes = [shapely.Polygon(sample(contour_rows(each.contours[0]), _CHORD)) for each in made]
    if len(shapes) < 2:
        return True
    one, other = shapely.STRtree(shapes).query(shapes, predicate="intersects")
    return not (one < other).any()


def _way(line: Contour, strip: SideStrip) -> _EdgeLine:
    turned = line if strip.left else reversed_contour(line)
    rows = contour_rows(turned)
    return _EdgeLine(line, turned, np.concatenate([sample(rows, _CHORD), rows[-1:, 2:4]]))


def _strip(way: _EdgeLine, strip: SideStrip) -> StripsBesideLines | None:
    """Return the area on the left of a line; None where it bends back within reach."""
    points = way.points
    ahead = headings_at(contour_rows(way.turned)[[0, -1]], np.array([0.0, 1.0]))
    right = np.column_stack([ahead[:, 1], -ahead[:, 0]])
    first, last = points[[0, -1]] + 2 * strip.reach * right
    across = shapely.LineString([first, *points, last])
    around = shapely.buffer(shapely.LineString(points), strip.reach, quad_segs=_QUARTER)
    sides = shapely.get_parts(shapely.ops.split(around, across)) if across.is_simple else ()
    rest = next(_beyond(sides, points), None)
    if len(sides) != 2 or rest is None:
        return None
    back = _chords(np.array([points[-1], *rest, points[0]]))
    bounds = replace(way.turned, primitives=(*way.turned.primitives, *back), closed=True)
    return StripsBesideLines([bounds], [Contour(back, closed=False)])


def _chords(points: Floats) -> tuple[Line, ...]:
    """Return the lines from each of points (n, 2) to the next."""
    return tuple(Line(tuple(a), tuple(b)) for a, b in pairwise(_welded(points).tolist()))


def _welded(points: Floats) -> Floats:
    """Return points (n, 2) without those that are one with the point before or with the last: where the ways across
    meet corners of the round ends, two may lie 1e-16 mm apart, and lines shorter than `WELD` are none.
    """
    kept = [points[0]]
    for point in points[1:-1]:
        if min(np.hypot(*(point - kept[-1])), np.hypot(*(point - points[-1]))) > WELD:
            kept.append(point)
    return np.array([*kept, points[-1]])


def _beyond(sides: Sequence[shapely.Polygon], points: Floats) -> Iterator[Floats]:
    """Yield the corners, after the last point of a way and before its first, of shapes that have it on their bounds and
    lie on its left.
    """
    for side in sides:
        corners = shapely.get_coordinates(shapely.geometry.polygon.orient(side).exterior)[:-1]
        found = np.flatnonzero((corners == points[0]).all(axis=1))
        if len(found) == 1 and not len(side.interiors):
            turned = np.roll(corners, -int(found[0]), axis=0)
            if len(turned) > len(points) and np.array_equal(turned[: len(points)], points):
                yield turned[len(points) :]


# One area beside all lines.


class _Link(NamedTuple):
    """What of a ring round an area runs through the open.

    Attributes:
        points: (n, 2) mm, the area on the left.
        after, before: numbers of the lines at its ends; None where it begins or ends within a line. Both are where the
            whole ring is in the open, and then its last point is the first.
        broken: numbers of the lines within which it begins or ends.
    """

    points: Floats
    after: int | None = None
    before: int | None = None
    broken: frozenset[int] = frozenset()


def _together(ways: Sequence[_EdgeLine], alone: Sequence[bool], strip: SideStrip) -> StripsBesideLines:
    """Return the areas on the left of lines that may be near one another, but for those that are not whole on a ring.

    Args:
        alone: for each line whether it has an area where no other is.

    Raises:
        GeometryError: no line has one.
    """
    other = {True: "another open line of the same operation", False: "itself"}
    try:
        areas = _air(ways, strip.reach)
    except shapely.errors.GEOSException as error:  # nearly parallel edges of bands that rounding alone tells apart
        raise _too_near(ways[0].drawn, strip, other[alone[0]]) from error
    kept = list(range(len(ways)))
    while True:
        tree = shapely.STRtree([shapely.LineString(ways[number].points) for number in kept])
        links = [_links(area, ways, kept, tree) for area in areas]
        whole = _whole(links)
        if whole >= set(kept):
            break
        kept = [number for number in kept if number in whole]
    errors = {k: _too_near(ways[k].drawn, strip, other[alone[k]]) for k in range(len(ways)) if k not in kept}
    if not kept:
        raise errors[0]
    findings = tuple(_left_out(ways[k].drawn, error) for k, error in errors.items())
    found = [each for each in links if any(link.after is not None for link in each)]
    contours = [contour for each in found for contour in _bounds(each, ways)]
    bare = [Contour(_chords(link.points), link.after is None) for each in found for link in each]
    return StripsBesideLines(contours, bare, findings)


def _whole(links: Sequence[Sequence[_Link]]) -> set[int]:
    """Return the numbers of the lines that are followed from end to end, once, round one area.

    Args:
        links: of each area.
    """
    begun: Counter[int | None] = Counter(link.before for each in links for link in each)
    ended: Counter[int | None] = Counter(link.after for each in links for link in each)
    within = {number for each in links for link in each for number in link.broken}
    in_one = set[int | None]().union(*({a.after for a in each} & {b.before for b in each} for each in links))
    return {k for k in in_one if k is not None and begun[k] == ended[k] == 1} - within


def _air(ways: Sequence[_EdgeLine], reach: float) -> list[shapely.Polygon]:
    """Return what lies within reach of lines, without the metal behind them, the area on the left of its rings."""
    lines = [shapely.LineString(way.points) for way in ways]
    around = shapely.union_all(shapely.buffer(lines, reach, quad_segs=_QUARTER))
    metal = shapely.union_all(_metal([way.points for way in ways], reach / 2))
    parts = shapely.get_parts(shapely.orient_polygons(shapely.difference(around, metal)))
    return [each for each in parts.tolist() if each.geom_type == "Polygon"]


def _metal(lines: Sequence[Floats], width: float) -> list[shapely.Geometry]:
    """Return bands on the right of lines: a box behind each chord, a fan behind each corner to the left, of each what
    is seen from the line.
    """
    starts, ends = (np.concatenate([points[part] for points in lines]) for part in (slice(-1), slice(1, None)))
    ahead = (ends - starts) / np.hypot(*(ends - starts).T)[:, None]
    back = width * np.column_stack([ahead[:, 1], -ahead[:, 0]])
    chords = shapely.linestrings(np.stack([starts, ends], axis=1))
    boxes = shapely.polygons(np.stack([starts, starts + back, ends + back, ends], axis=1))
    turn = _turns(ahead, [len(points) - 1 for points in lines])
    bent = np.flatnonzero(turn > 0).tolist()
    fans = [_fan(ends[k], back[k], float(turn[k])) for k in bent]
    tree = shapely.STRtree(chords)
    far = [np.array([-x, -y, 0.0]) for x, y in back.tolist()]
    corners = [np.array([x, y, 1.0]) for x, y in ends.tolist()]
    seen = [_seen(box, chords[_near(tree, box, [k])], far[k]) for k, box in enumerate(boxes)]
    return seen + [
        _seen(fan, chords[_near(tree, fan, [k, k + 1])], corners[k]) for k, fan in zip(bent, fans, strict=True)
    ]


def _turns(ahead: Floats, counts: Sequence[int]) -> Floats:
    """Return by how much (n - 1,) lines turn to the left behind each of n chords, radians; 0 behind the last of a line.

    Args:
        ahead: (n, 2) directions of the chords of all lines. counts: of each line.
    """
    across = ahead[:-1, 0] * ahead[1:, 1] - ahead[:-1, 1] * ahead[1:, 0]
    turn: Floats = np.arctan2(across, (ahead[:-1] * ahead[1:]).sum(axis=1))
    turn[np.cumsum(counts)[:-1] - 1] = 0.0
    return turn


def _near(tree: shapely.STRtree, shape: shapely.Polygon, but: Sequence[int]) -> NDArray[np.int64]:
    """Return the numbers of the chords that reach into a shape, but for some."""
    return np.setdiff1d(tree.query(shape, predicate="intersects"), but)


def _seen(shape: shapely.Polygon, chords: NDArray[np.object_], eye: Floats) -> shapely.Geometry:
    """Return a shape without what chords in it hide.

    Args:
        eye: (3,) x, y, 1 of the place from which it is seen; of one that is infinitely far away minus the direction in
            which it looks, and 0.
    """
    for chord in shapely.intersection(chords, shape).tolist():
        if chord.geom_type == "LineString" and not chord.is_empty:
            ends = shapely.get_coordinates(chord)[[0, -1]]
            away = eye[2] * ends - eye[:2]
            behind = ends + away * (shape.length / np.maximum(np.hypot(*away.T), _SKIN)[:, None])
            shape = shapely.difference(shape, shapely.convex_hull(shapely.MultiPoint([*ends, *behind])))
    return shape


def _fan(corner: Floats, back: Floats, turn: float) -> shapely.Polygon:
    """Return the part of a disc round a corner from a radius on, through an angle > 0, and a little of the boxes on
    both sides, so that there is no crack between them.
    """
    angle = np.linspace(-_LAP, turn + _LAP, 2 + int(turn / (math.pi / 2) * _QUARTER))
    rim = np.outer(np.cos(angle), back) + np.outer(np.sin(angle), [-back[1], back[0]])
    return shapely.Polygon([corner, *(corner + rim)])


def _links(area: shapely.Polygon, ways: Sequence[_EdgeLine], kept: Sequence[int], tree: shapely.STRtree) -> list[_Link]:
    """Return what of the rings round an area runs through the open; islands of no width are none.

    Args:
        kept: numbers of the lines that may be followed. tree: of these as they are kept.
    """
    islands = [ring for ring in area.interiors if shapely.Polygon(ring).area > _SKIN * ring.length]
    found: list[_Link] = []
    for ring in (area.exterior, *islands):
        touched = np.sort(tree.query(ring, predicate="dwithin", distance=_SKIN)).tolist()
        points = shapely.get_coordinates(ring)
        found += _links_of(points, ways, [kept[k] for k in touched]) if touched else [_Link(points)]
    return found


def _links_of(ring: Floats, ways: Sequence[_EdgeLine], kept: Sequence[int]) -> Iterator[_Link]:
    """Yield what of a ring runs through the open, some lines being followed."""
    lines = [shapely.LineString(ways[k].points) for k in kept]
    places = np.stack([ring[:-1], (ring[:-1] + ring[1:]) / 2, ring[1:]])
    away = shapely.distance(shapely.MultiLineString(lines), shapely.points(places))
    follows = (away < _SKIN).all(axis=0)
    if not follows.any():
        yield _Link(ring)
        return
    starts = np.roll(ring[:-1], -int(np.argmax(follows)), axis=0)
    follows = np.roll(follows, -int(np.argmax(follows)))
    edges = np.flatnonzero(np.diff(np.concatenate([[True], follows, [True]]).astype(np.int8)))
    for a, b in edges.reshape(-1, 2).tolist():
        points = np.concatenate([starts[a:b], starts[[b % len(starts)]]])
        after, before = _end_at(points[0], ways, kept, -1), _end_at(points[-1], ways, kept, 0)
        within = [points[k] for k, end in ((0, after), (-1, before)) if end is None]
        near = [kept[int(np.argmin(shapely.distance(lines, shapely.Point(place))))] for place in within]
        yield _Link(points, after, before, frozenset(near))


def _end_at(place: Floats, ways: Sequence[_EdgeLine], kept: Sequence[int], end: int) -> int | None:
    """Return which line ends, or begins, at a place, if one does."""
    return next((k for k in kept if np.hypot(*(ways[k].points[end] - place)) < 2 * _SKIN), None)


def _bounds(links: Sequence[_Link], ways: Sequence[_EdgeLine]) -> Iterator[Contour]:
    """Yield the rings round one area: lines, and links from the end of one to the beginning of the next."""
    yield from (Contour(_chords(link.points), closed=True) for link in links if link.after is None)
    behind = {link.after: link for link in links if link.after is not None}
    while behind:
        first = number = min(behind)
        primitives: list[Primitive] = []
        ids: list[int] = []
        while number in behind:
            link = behind.pop(number)
            assert link.before is not None
            ends = ways[number].points[[-1]], ways[link.before].points[[0]]
            primitives += [
                *ways[number].turned.primitives,
                *_chords(np.concatenate([ends[0], link.points[1:-1], ends[1]])),
            ]
            ids += ways[number].drawn.entity_ids
            number = link.before
        yield replace(ways[first].turned, primitives=tuple(primitives), closed=True, entity_ids=tuple(ids))


def _left_out(line: Contour, error: GeometryError) -> Finding:
    return Finding(FindingKind.LEFT_OUT, str(error), *line.primitives[0].start, entity_ids=line.entity_ids)


def _too_near(line: Contour, strip: SideStrip, what: str) -> GeometryError:
    x, y = line.primitives[0].start
    return GeometryError(
        f"The open line that begins at {in_plane(x, y)} comes within {strip.reach:.3f} mm of {what}, so its edge "
        "cannot be told from that; close the line, or give each an operation of its own."
    )
