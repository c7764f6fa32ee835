"""Where a tool does not fit: regions too small for it, and necks that part a region for it."""

from __future__ import annotations

import math
from collections import Counter
from collections.abc import Sequence
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np
import shapely
from numpy.typing import NDArray

from ..core.pool import in_bands
from ..core.wording import in_plane
from ..geometry.distance import DistanceField
from ..geometry.offset.offset import OffsetLevel, Ring, offset_levels
from ..geometry.outlines import Outlines, polygons
from ..geometry.primitives import Indices, Primitives, boxes, sample
from ..model.finding import Finding, FindingKind
from ..model.job import Job
from ..model.operation import Operation
from ..model.part import Region
from ..model.tool import Tool
from .linking.bridge import BridgeForest, RingEdges, level_bridges
from .narrow_kernels import widest_way

_CHORD = 1e-3
"""mm by which chords may leave arcs."""

_SAME = 1e-6
"""mm; places are told apart by so much where shapes are compared: a thousandth of what is told of a disc."""

_WORTH_TWO_CORES = 32
"""Largest discs from which a second core is worth its start."""

_NARROWER = 1e-3
"""mm; a neck that a tool does not pass is told as at least so much narrower than the tool needs."""

_TELL = 20
"""Necks told one by one."""

_LOWER = 8
"""Levels below the tool's at which is looked for where parts come together."""

_REFINED = 3
"""How often the way is brought to the middle and made finer round its narrowest place."""

Floats = NDArray[np.float64]


@dataclass(frozen=True)
class ToolRoom:
    """The room that a tool needs.

    Attributes:
        tool: the tool.
        width: of a gap that it can pass, mm: for a pocket tool, its diameter and what the contour tool takes along both
            walls.
    """

    tool: Tool
    width: float

    @property
    def text(self) -> str:
        """Who needs how much."""
        why = (
            ""
            if self.width < self.tool.diameter + 1e-6
            else ": its diameter, and the strip that it leaves along each wall"
        )
        return f"T{self.tool.number} {self.tool.label} needs {self.width:.3f} mm{why}"


def finest(job: Job, operation: Operation) -> float:
    """Return the least width, mm, of a region that some operation of the job machines in the layers of this one, as
    deep, on its side; inf where none does.
    """

    alike = [
        each.cut
        for each in job.operations
        if each.cut.enabled
        and each.wall_side is operation.wall_side
        and set(each.cut.curves) == set(operation.cut.curves)
        and each.cut.floor >= operation.cut.floor
    ]
    return min((2 * (job.tool(cut.tool).radius + cut.stock_to_leave) for cut in alike), default=math.inf)


def too_small(regions: Sequence[Region], level: OffsetLevel, tool: Tool, least: float) -> list[Finding]:
    """Return a finding for each region in which a tool has no room at all.

    Args:
        level: the rings of the tool's centre.
        least: regions as wide as this are machined by others, mm, and count for nothing here; 0 = all are.
    """
    reached = {ring.region for ring in level.rings}
    need = ToolRoom(tool, 2 * level.distance)
    small = [region for region in regions if region.number not in reached]
    findings = []
    for region, (x, y, diameter) in zip(small, largest_discs(small).tolist(), strict=True):
        text = (
            f"Region {region.number} at {in_plane(x, y)} is too small: its largest disc is about {diameter:.3f} mm, "
            f"and {need.text}. Use a smaller tool for it."
        )
        counts = diameter < least or 0 < need.width <= least + 1e-9
        findings.append(
            Finding(
                FindingKind.REGION_TOO_SMALL, text, x, y, counts, amount=diameter, entity_ids=region.boundary.entity_ids
            )
        )
    return findings


def largest_discs(regions: Sequence[Region]) -> Floats:
    """Return x, y, diameter (n, 3), mm, of the largest disc in each region, within 0.005 mm; none where it begins if it
    has no area.
    """
    outlines = Outlines.of([contour for region in regions for contour in region.contours])
    group = np.repeat(np.arange(len(regions)), [1 + len(region.islands) for region in regions])
    found = np.zeros((len(regions), 3))
    found[:, :2] = np.array([region.boundary.primitives[0].start for region in regions]).reshape(-1, 2)
    number, shapes = polygons(outlines, group, _CHORD)
    wide = shapely.area(shapes) > 0
    number, shapes = number[wide], shapes[wide]
    corner, first, which = _alike(shapes)
    radii = np.concatenate(
        in_bands(
            lambda band: shapely.maximum_inscribed_circle(first[band], tolerance=_CHORD), len(first), _WORTH_TWO_CORES
        )
    )
    found[number, :2] = corner + shapely.get_coordinates(radii)[::2][which]
    found[number, 2] = 2 * shapely.length(radii)[which]
    return found


def _alike(shapes: NDArray[np.object_]) -> tuple[Floats, NDArray[np.object_], Indices]:
    """Return shapes that a translation brings onto one another within `_SAME`, as equal letters are, only once.

    Args:
        shapes: (n,) polygons, none empty.

    Returns:
        (n, 2) the first corner of each, mm; (m,) the different ones, about their first corners; (n,) which of these
        each is.
    """
    places, owner = shapely.get_coordinates(shapes, return_index=True)
    corner = places[np.searchsorted(owner, np.arange(len(shapes)))]
    about = np.round((places - corner[owner]) / _SAME) * _SAME + 0.0  # -0 is another number in the bytes compared
    moved = shapely.set_coordinates(shapes.copy(), about)
    number: dict[bytes, int] = {}
    which = np.array([number.setdefault(key, len(number)) for key in shapely.to_wkb(moved)], np.int64)
    return corner, moved[np.unique(which, return_index=True)[1]], which


def necks(level: OffsetLevel, primitives: Primitives, field: DistanceField, tool: Tool) -> list[Finding]:
    """Return a finding for each place where a region falls into parts because the tool does not fit through; one for
    all beyond some.

    The place is the narrowest one of the widest way between two parts next to each other.

    Args:
        level: the rings of the tool's centre.
        primitives, field: what bounds the regions, and distances from it.
    """
    need = ToolRoom(tool, 2 * level.distance)
    findings = []
    pairs = _nearest_pairs(level)
    lower = offset_levels(primitives, [level.distance * k / _LOWER for k in range(1, _LOWER)]) if pairs else ()
    outlines = [_Areas([ring for ring in each.rings if ring.area > 0]) for each in lower]
    for a, b, region in pairs[:_TELL]:
        (x, y), room = _narrowest(*_at_the_neck(a, b, outlines), field)
        width = min(2 * room, need.width - _NARROWER)
        text = f"Region {region} has a neck at {in_plane(x, y)}, about {width:.3f} mm wide; {need.text}."
        findings.append(Finding(FindingKind.NECK_TOO_NARROW, text, float(x), float(y), counts=False, amount=width))
    if len(pairs) > _TELL:
        x, y = (float(value) for value in (pairs[_TELL][0] + pairs[_TELL][1]) / 2)
        text = f"{len(pairs) - _TELL} more necks are too narrow; {need.text}."
        findings.append(
            Finding(FindingKind.NECK_TOO_NARROW, text, x, y, counts=False, amount=float(len(pairs) - _TELL))
        )
    return findings


def _nearest_pairs(level: OffsetLevel) -> list[tuple[Floats, Floats, int]]:
    """Return (ends of the shortest ways that join all parts of a region, region), one less than there are parts."""
    outer = [k for k, ring in enumerate(level.rings) if ring.area > 0]
    count = Counter(level.rings[k].region for k in outer)
    parts = [k for k in outer if count[level.rings[k].region] > 1]
    if not parts:
        return []
    tree = BridgeForest(len(level.rings))
    pairs = []
    for bridge, (a, b) in level_bridges(RingEdges(level.rings), parts, tree.group, level.distance / 2):
        tree.add(bridge)
        pairs.append((a, b, level.rings[bridge.a.ring].region))
    return pairs


def _outline(ring: Ring) -> shapely.Polygon:
    return (
        shapely.Polygon(sample(ring.rows, _CHORD))
        if len(ring.rows) > 2
        else shapely.Point(ring.rows[0, :2]).buffer(1e-6)
    )


class _Areas:
    """Areas within the outer rings of a level, whose outlines are made when they are asked for: of many, few are."""

    def __init__(self, rings: Sequence[Ring]) -> None:
        self._rings = rings
        self._made: dict[int, shapely.Geometry] = {}
        self._low, self._high = np.zeros((0, 2)), np.zeros((0, 2))
        if rings:
            first = np.cumsum([0, *(len(ring.rows) for ring in rings[:-1])])
            around = boxes(np.concatenate([ring.rows for ring in rings]))
            self._low = np.minimum.reduceat(around[:, :2], first) - 1e-6  # what stands for a point is so wide
            self._high = np.maximum.reduceat(around[:, 2:], first) + 1e-6

    def outline(self, k: int) -> shapely.Geometry:
        """Return the area within ring k."""
        if k not in self._made:
            self._made[k] = _outline(self._rings[k])
        return self._made[k]

    def nearest(self, point: Floats) -> int | None:
        """Return the area nearest to a point (2,), of those as near the smallest; None where there are none."""
        away = np.hypot(*np.maximum(np.maximum(self._low - point, point - self._high), 0.0).T)
        place, best = shapely.Point(point), (math.inf, math.inf, -1)
        for k in np.argsort(away, kind="stable").tolist():
            if away[k] > best[0]:
                break
            outline = self.outline(k)
            best = min(best, (float(shapely.distance(outline, place)), float(shapely.area(outline)), k))
        return best[2] if best[2] >= 0 else None


def _at_the_neck(a: Floats, b: Floats, outlines: Sequence[_Areas]) -> tuple[Floats, Floats]:
    """Return the nearest points of the areas round two points at the first level that parts them.

    Args:
        outlines: of the areas at rising levels.
    """
    for areas in outlines:
        one, other = (areas.nearest(point) for point in (a, b))
        if one is None or other is None:
            return a, b
        if one != other:
            ends = shapely.get_coordinates(shapely.shortest_line(areas.outline(one), areas.outline(other)))
            return (ends[0], ends[1]) if np.any(ends[0] != ends[1]) else (a, b)
    return a, b


class _Neck(NamedTuple):
    """A narrow place: where it is, (2,), and how far from the drawing, mm."""

    place: Floats
    room: float


class _Way(NamedTuple):
    """A way: its points (n, 2), and how far they may be from where they should be, mm."""

    points: Floats
    reach: float


class _Window(NamedTuple):
    """A square grid round two points: half its side, in distances of the two, and its points along a side."""

    half: float
    side: int


_WINDOWS = (_Window(0.8, 25), _Window(0.8, 161), _Window(2.0, 161), _Window(6.0, 161))
"""One after the other: a neck may lie far off, or be much narrower."""


def _narrowest(a: Floats, b: Floats, field: DistanceField) -> _Neck:
    """Return the neck between two points: where the widest way is narrowest."""
    way, reach = next(
        (widest for window in _WINDOWS if len((widest := _widest_way(a, b, window, field)).points)),
        _Way(a + (b - a) * np.linspace(0, 1, 65)[:, None], float(np.hypot(*(b - a))) / 16),
    )
    for _ in range(_REFINED):
        way = _to_the_middle(way, reach, field)
        room = field.nearest(way)[0]
        k = int(np.argmin(room))
        found = _Neck(way[k], float(room[k]))
        before, after, part = way[max(k - 1, 0)], way[min(k + 1, len(way) - 1)], np.linspace(0, 1, 5)[:, None]
        way = np.concatenate([before + (way[k] - before) * part, (way[k] + (after - way[k]) * part)[1:]])
        reach /= 2
    return found


def _to_the_middle(way: Floats, reach: float, field: DistanceField) -> Floats:
    """Return the points (n, 2) of a way moved across it, by `reach` mm or less, to where they have most room; over no
    wall.
    """
    along = np.gradient(way, axis=0)
    size = np.hypot(*along.T)
    across = np.stack([-along[:, 1], along[:, 0]], 1) / np.where(size > 0, size, 1.0)[:, None]
    for _ in range(5):
        steps = np.linspace(-reach, reach, 9)
        places = way[:, None] + across[:, None] * steps[:, None]
        room = field.nearest(places.reshape(-1, 2))[0].reshape(len(way), -1)
        room[field.nearest(way)[0][:, None] + room <= np.abs(steps)] = -1.0
        way = places[np.arange(len(way)), np.argmax(room, axis=1)]
        reach /= 3
    return way


def _widest_way(a: Floats, b: Floats, window: _Window, field: DistanceField) -> _Way:
    """Return the way over a grid round two points that keeps most distance; it may be off by the pitch of the grid.

    Two grid points are neighbours when their discs without a wall overlap, so no way crosses one; n = 0 without such a
    way.
    """
    half, side = window.half * float(np.hypot(*(b - a))), window.side
    axis, pitch = np.linspace(-half, half, side), 2 * half / (side - 1)
    points = (a + b) / 2 + np.stack(np.meshgrid(axis, axis, indexing="ij"), -1).reshape(-1, 2)
    room = field.nearest(points)[0]
    start, end = (int(np.argmin(np.hypot(*(points - point).T))) for point in (a, b))
    way = widest_way(room, side, pitch, start, end)
    return _Way(points[way[::-1]], pitch)
