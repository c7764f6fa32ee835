"""The areas that each operation's cutter may be in, with their walls: of its curves, on its side of the lines, without
the clamps.
"""

from __future__ import annotations

import threading
from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass, field, replace
from functools import cached_property
from typing import NamedTuple

import numpy as np
import shapely
from numpy.typing import NDArray

from ..core import tolerances
from ..core.progress import NO_PROGRESS, Progress
from ..geometry.distance import DistanceField
from ..geometry.even_odd import even_odd
from ..geometry.near_points import near_together
from ..geometry.offset.offset import OffsetLevel, Ring, grown_lines, offset_levels
from ..geometry.outlines import Outlines, nested, polygon_contour, polygons
from ..geometry.overlay.overlay import differing, without_crossings, without_outlines
from ..geometry.primitives import TURN, Primitives, Rows, contour_rows, pack, points_at, reversed_rows
from ..model.curve_selectors import Selector
from ..model.entry import Lead
from ..model.finding import Finding
from ..model.hole_operations import HoleOperation
from ..model.job import Job
from ..model.moves import Area
from ..model.operation import Direction, Operation, Side, SideStrip
from ..model.part import Contour, Region
from ..model.stock_box import extent
from .drawn_contours import DrawnContours, selected
from .drill_holes import CircleHole, hole_regions, made_by_drills, without_drilled
from .leads.contour_path import ContourPath
from .leads.lead import lead_size, straight_way
from .open_strips import strips
from .witness import grown_findings, region_findings

_ON_CLAMP = 2e-5
"""mm; a wall all of which is this near to a clamp's outline is the clamp's: ends that meet are put together by as
much.
"""

_ROOM = 4.0
"""Tool diameters round the drawing in which the paths outside of it lie, unless their leads ask for more; beyond is
nothing that concerns them.
"""

_SPARE = 1.0
"""mm that the frame is farther off than the leads need."""

_SAME = 1e-9
"""mm by which a slot may be wider than the tool that goes along its middle alone."""


@dataclass(frozen=True, eq=False)
class MachiningArea:
    """An area and its walls.

    Attributes:
        regions: where the cutter may be, with all of its width.
        primitives, distances: all that bounds them, as rows, and distances from it.
        bare: (n,) True where a row bounds a clamp, or is the frame round the area outside: it is kept off, not
            followed.
        lines: contours that a path on the line follows, open and closed.
        outlines: of clamps and frame, and of what lies beyond the stock's open edges.
        air: of the last alone.
    """

    regions: tuple[Region, ...]
    primitives: Primitives
    distances: DistanceField
    bare: NDArray[np.bool_]
    lines: tuple[Contour, ...] = ()
    outlines: tuple[Contour, ...] = ()
    air: tuple[Contour, ...] = ()
    _frames: dict[float, OffsetLevel] = field(default_factory=dict, repr=False)
    _making: threading.Lock = field(default_factory=threading.Lock, repr=False)

    def frame(self, distance: float, progress: Progress = NO_PROGRESS) -> OffsetLevel:
        """Return the outermost frame of a cutter, its centre at a distance from the walls, mm, see `offset_levels`.

        What is left is looked for along the frame that contours follow later, or are prepared along meanwhile: it is
        made once.

        Raises:
            Cancelled: by progress.
        """
        with self._making:
            if distance not in self._frames:
                (self._frames[distance],) = offset_levels(self.primitives, [distance], progress, frame=True)
            return self._frames[distance]

    def parts(self, most: int, distance: float, progress: Progress = NO_PROGRESS) -> list[MachiningArea]:
        """Return it in parts of regions that lie near one another, each with its frame at a distance; itself where it
        has not so many regions that one part would not do.

        Inside a region its own walls are the nearest, so each part tells the same of places in it as the whole.

        Args:
            most: regions a part. distance: as of `frame`, mm.

        Raises:
            Cancelled: by progress.
        """
        if len(self.regions) <= most:
            return [self]
        rings, numbers = self.frame(distance, progress).rings, np.array([each.number for each in self.regions])
        rows, ring_region = self.primitives, np.array([ring.region for ring in rings], np.int64)
        order = np.argsort(numbers, kind="stable")
        region = order[np.searchsorted(numbers[order], rows.region)]
        count = np.maximum(np.bincount(region, minlength=len(numbers)), 1)
        middle = np.column_stack([np.bincount(region, rows.rows[:, k], len(numbers)) / count for k in (0, 1)])
        parts = []
        for some in near_together(middle, most):
            own = np.flatnonzero(np.isin(ring_region, numbers[some]))
            frame = OffsetLevel(distance, tuple(rings[k] for k in own.tolist()))
            parts.append(self._part(some, np.isin(rows.region, numbers[some]), frame))
        return parts

    def _part(self, regions: NDArray[np.int64], rows: NDArray[np.bool_], frame: OffsetLevel) -> MachiningArea:
        """Return some of its regions, with those rows (n,) that bound them and their frame."""
        number = np.cumsum(rows) - 1
        whole = self.primitives
        own = Primitives(np.ascontiguousarray(whole.rows[rows]), number[whole.previous[rows]], whole.region[rows])
        return replace(
            self,
            regions=tuple(self.regions[k] for k in regions.tolist()),
            primitives=own,
            distances=DistanceField.of(own.rows),
            bare=self.bare[rows],
            _frames={frame.distance: frame},
            _making=threading.Lock(),
        )

    def follows_bare(self, rows: NDArray[np.float64]) -> NDArray[np.bool_]:
        """Return for each row (n, 8) of a ring whether what it follows at its middle is bare."""
        if not self.bare.any():
            return np.zeros(len(rows), np.bool_)
        nearest: NDArray[np.bool_] = self.bare[self.distances.nearest(points_at(rows, np.full(len(rows), 0.5)))[1]]
        return nearest


@dataclass(frozen=True)
class _AreaKey:
    """What operations have alike that share an area.

    Attributes:
        width: of slots along the lines, mm; 0 = the lines bound it.
        past: how far it goes past the stock's edges where walls lie on them, mm; 0 = these are walls.
        strip: that it is beside open lines.
    """

    curves: frozenset[Selector]
    side: Side
    width: float = 0.0
    past: float = 0.0
    strip: SideStrip | None = None


@dataclass
class MachiningAreas:
    """The areas of a job's operations; operations alike share one."""

    job: Job
    drawn: DrawnContours
    _about: list[Callable[[], Iterable[Finding]]] = field(default_factory=list)
    _made: dict[_AreaKey, MachiningArea | None] = field(default_factory=dict)

    @property
    def findings(self) -> list[Finding]:
        """Of the areas that were made so far, where they are not what was drawn."""
        return [finding for told in self._about for finding in told()]

    def of(self, operation: Operation) -> MachiningArea | None:
        """Return the area of an operation; None where it has nothing to machine."""
        tool, side = self.job.tool(operation.cut.tool), operation.wall_side or Side.INSIDE
        width = operation.line_width(tool) or 0.0
        width = width if width > tool.diameter + _SAME else 0.0
        strip = operation.beside_open(tool)
        key = _AreaKey(frozenset(operation.cut.curves), side, width, self._past(operation), strip)
        if key not in self._made:
            made = self._beside_lines(key, strip) if strip else self._slots(key) if key.width else self._sheet(key)
            self._made[key] = made
        return self._made[key]

    def areas(self) -> tuple[Area, ...]:
        """Return the area of each operation of the job, by its index."""
        return tuple(self._area(operation) for operation in self.job.operations)

    def _area(self, operation: Operation) -> Area:
        if operation.FACES:
            return Area()
        if isinstance(operation, HoleOperation):
            regions = hole_regions(self.job, self.drawn, operation) if operation.cut.enabled else ()
            return Area(regions, whole=operation.CLEARS)
        area = self.of(operation) if operation.cut.enabled else None
        if area is None:
            return Area()
        return Area(area.regions, area.lines, operation.CLEARS, area.outlines, area.air)

    def _sheet(self, key: _AreaKey) -> MachiningArea | None:
        side, found = key.side, selected(self.drawn, tuple(key.curves))
        closed, lines = self._milled(found.closed), list(found.open)
        frame = self._frame((*closed, *lines, *(c for region in self.drawn.clamps for c in region.contours)))
        if frame is None or (side is not Side.ON and not closed):
            return None
        regions = self._regions({Side.INSIDE: closed, Side.OUTSIDE: [frame, *closed], Side.ON: [frame]}[side])
        if not regions:
            return None
        air: tuple[Contour, ...] = ()
        if key.past and self.stock is not None:
            past = opened(regions, self.stock, key.past)
            air, regions = past.strips, self._opened(past) if past.strips else regions
        primitives = pack(regions)
        outlines = (*(c for region in self.drawn.clamps for c in region.contours), *air)
        outlines += () if side is Side.INSIDE else (frame,)
        bare = lies_on(primitives, outlines)
        return MachiningArea(
            regions,
            primitives,
            DistanceField.of(primitives.rows),
            bare,
            (*closed, *lines) if side is Side.ON else (),
            outlines,
            air,
        )

    def _past(self, operation: Operation) -> float:
        """Return how far an operation's area goes past the stock's edges: so far that its whole tool is beside the
        stock, also where another tool follows the walls, mm; 0 = not at all.
        """
        if not operation.opens_edges:
            return 0.0
        tools = [self.job.tool(each.cut.tool) for each in self.job.operations if each.cut.enabled]
        leave = max(each.cut.stock_to_leave for each in self.job.operations)
        tool = self.job.tool(operation.cut.tool)
        return tool.diameter + max(each.diameter for each in tools) / 2 + leave + _SPARE

    @cached_property
    def stock(self) -> BoxSides | None:
        """The sides of the stock, mm; None where nothing is drawn."""
        followed = [each.cut.curves for each in self.job.operations if each.takes_open and each.cut.enabled]
        lines = [line for curves in followed for line in selected(self.drawn, curves).open]
        box = extent((*self.drawn.closed, *lines))
        return None if box is None else BoxSides(*box).grown(self.job.stock.margin)

    def _slots(self, key: _AreaKey) -> MachiningArea | None:
        """Return what lies within half of a width of the lines, without what clamps hold."""
        found = selected(self.drawn, tuple(key.curves))
        lines = (*self._milled(found.closed), *found.open)
        grown = grown_lines(lines, key.width / 2)
        clamps = tuple(clamp.boundary for clamp in self.drawn.clamps)
        free = without_outlines(grown, clamps)
        nesting = nested(free.contours)
        about = [*grown_findings(lines, key.width / 2, grown), *free.findings]
        about += region_findings(grown, clamps, nesting)
        self._about.append(lambda: about)
        if not nesting.regions:
            return None
        primitives = pack(nesting.regions)
        outlines = tuple(c for region in self.drawn.clamps for c in region.contours)
        walls = DistanceField.of(primitives.rows)
        return MachiningArea(nesting.regions, primitives, walls, lies_on(primitives, outlines), (), outlines)

    def _beside_lines(self, key: _AreaKey, strip: SideStrip) -> MachiningArea | None:
        """Return what lies on one side of open lines, without what clamps hold."""
        found = strips(selected(self.drawn, tuple(key.curves)).open, strip)
        self._about.append(lambda: found.findings)
        regions = self._regions(found.contours)
        if not regions:
            return None
        primitives = pack(regions)
        outlines = (*(c for region in self.drawn.clamps for c in region.contours), *found.bare)
        walls = DistanceField.of(primitives.rows)
        return MachiningArea(regions, primitives, walls, lies_on(primitives, outlines), (), outlines)

    def _milled(self, contours: Sequence[Contour]) -> list[Contour]:
        """Return contours but for the circles that drills make."""
        return without_drilled(contours, self._made_by_drills)

    def _opened(self, past: OpenedArea) -> tuple[Region, ...]:
        """Return the regions of an area that goes on past the stock's edges, without what clamps hold."""
        outlines = [clamp.boundary for clamp in self.drawn.clamps]
        free = without_outlines(past.contours, outlines)
        nesting = nested(free.contours)
        about = [*past.findings, *free.findings, *region_findings(past.contours, outlines, nesting)]
        self._about.append(lambda: about)
        return nesting.regions

    def _regions(self, contours: Sequence[Contour]) -> tuple[Region, ...]:
        """Return the regions that contours bound even-odd, without what clamps hold; the witness is asked about
        them.
        """
        made = self.drawn.regions_of(contours)
        self._about.append(lambda: made.findings)
        return made.regions

    @cached_property
    def _made_by_drills(self) -> frozenset[CircleHole | None]:
        return frozenset(made_by_drills(self.job, self.drawn)) if self.job.makes_holes else frozenset()

    def _frame(self, contours: Sequence[Contour]) -> Contour | None:
        """Return a box with room for every tool round all contours, counter-clockwise; None where there is no
        contour.
        """
        box = extent(contours)
        if box is None:
            return None
        enabled = [operation for operation in self.job.operations if operation.cut.enabled]
        widest = max((self.job.tool(each.cut.tool).diameter for each in enabled), default=1.0)
        wide = _ROOM * widest + max((each.cut.stock_to_leave for each in enabled), default=0.0)
        led = (self._led(each, lead) for each in enabled if (lead := each.outer_lead) is not None)
        wide = max([wide, *led])
        x0, y0, x1, y1 = box[0] - wide, box[1] - wide, box[2] + wide, box[3] + wide
        return polygon_contour([(x0, y0), (x1, y0), (x1, y1), (x0, y1)])

    def _led(self, operation: Operation, lead: Lead) -> float:
        """Return how far round the walls there is room for whole leads, also of what is roughed: they keep off the
        frame too, mm.
        """
        tool = self.job.tool(operation.cut.tool)
        wall = tool.radius + operation.roughed_allowance
        return 2 * wall + lead_size(lead, tool) + straight_way(operation, tool) + operation.wear + _SPARE


def lies_on(primitives: Primitives, contours: Sequence[Contour]) -> NDArray[np.bool_]:
    """Return (n,) which rows lie on some contours, by their ends and middles."""
    if not contours:
        return np.zeros(len(primitives.rows), np.bool_)
    rows, outlines = primitives.rows, DistanceField.of(np.concatenate([contour_rows(contour) for contour in contours]))
    near = [outlines.nearest(points_at(rows, np.full(len(rows), part)), 1.0)[0] < _ON_CLAMP for part in (0.0, 0.5, 1.0)]
    lying: NDArray[np.bool_] = near[0] & near[1] & near[2]
    return lying


# Walls that lie on the stock's edges, and how an area goes on past them, where there is no metal.
#
# Past each such wall the area is a strip along the stock's edge: as far out as asked for, and as far on to both sides,
# so that a tool goes round the ends of the walls that meet the edge at whatever angle they do.


class BoxSides(NamedTuple):
    """The sides of a box, mm."""

    x0: float
    y0: float
    x1: float
    y1: float

    def grown(self, by: float) -> BoxSides:
        """Return the sides of a box that is so much larger all round, mm."""
        return BoxSides(self.x0 - by, self.y0 - by, self.x1 + by, self.y1 + by)

    def mirrored(self) -> BoxSides:
        """Return them with x of the other sign."""
        return BoxSides(-self.x1, self.y0, -self.x0, self.y1)

    def away(self, points: NDArray[np.float64]) -> NDArray[np.float64]:
        """Return (n,) how far points (n, 2) are from the box, mm; 0 within it."""
        x, y = points.T
        beyond: NDArray[np.float64] = np.hypot(
            np.maximum(np.maximum(self.x0 - x, x - self.x1), 0.0), np.maximum(np.maximum(self.y0 - y, y - self.y1), 0.0)
        )
        return beyond


@dataclass(frozen=True, eq=False)
class OpenedArea:
    """An area that goes on past the stock's edges.

    Attributes:
        contours: that bound it, even-odd. strips: outlines of what of it lies past the edges.
        findings: where areas on the way there are not what they should be.
    """

    contours: tuple[Contour, ...]
    strips: tuple[Contour, ...]
    findings: tuple[Finding, ...] = ()


def opened(regions: Sequence[Region], stock: BoxSides, past: float) -> OpenedArea:
    """Return an area that goes on past all of its walls that lie on the stock's edges.

    It is what of stock and strips is left without the metal that stands in the stock beside the area. So edges that
    area and strips have together are no walls, and every other wall stays as it is.

    Args:
        regions: within the stock. stock: its sides.
        past: how far it goes on, mm, > 0.
    """
    contours = tuple(contour for region in regions for contour in region.contours)
    boxes = _strips(pack(regions).rows, stock, past)
    if not boxes:
        return OpenedArea(contours, ())
    block = shapely.box(*stock)
    strips = shapely.difference(shapely.union_all(boxes), block)
    standing = without_crossings([*_outlines(block), *contours])
    made = without_crossings([*_outlines(shapely.union(strips, block)), *standing.contours])
    grown = differing(even_odd(contours), even_odd(made.contours).area - float(strips.area), contours)
    return OpenedArea(made.contours, _outlines(strips), (*standing.findings, *made.findings, *grown))


def _strips(rows: Rows, stock: BoxSides, past: float) -> list[shapely.Geometry]:
    """Return boxes past all rows that lie on sides of the stock."""
    boxes = []
    for number, side in enumerate(stock):
        axis = number % 2
        on = (rows[:, TURN] == 0) & (np.abs(rows[:, [axis, axis + 2]] - side) <= tolerances.WELD).all(axis=1)
        across = sorted((side, side + (past if number > 1 else -past)))
        for low, high in np.sort(rows[on][:, [1 - axis, 3 - axis]], axis=1).tolist():
            along = [low - past, high + past]
            (x0, x1), (y0, y1) = (across, along) if axis == 0 else (along, across)
            boxes.append(shapely.box(x0, y0, x1, y1))
    return boxes


def _outlines(shape: shapely.Geometry) -> tuple[Contour, ...]:
    """Return the outlines of polygons."""
    parts = [each for each in shapely.get_parts(shape) if each.geom_type == "Polygon"]
    rings = [ring for each in parts for ring in (each.exterior, *each.interiors)]
    return tuple(polygon_contour(shapely.get_coordinates(shapely.simplify(ring, 0.0))[:-1].tolist()) for ring in rings)


# Which way along the walls a cutter goes: rings, cut open where they run beside clamps, in the order that frees parts
# last.


_CHORD = 0.01
"""mm; only which ring lies in which depends on it."""


def wall_paths(level: OffsetLevel, area: MachiningArea, direction: Direction) -> tuple[ContourPath, ...]:
    """Return the paths along all walls that a level's rings follow, but not along clamps or the frame.

    A ring has the area to machine on its left, inside and outside alike, and so the metal that stays on its right: its
    own direction is climb milling.

    Args:
        level: rings at tool radius + stock to leave.
    """
    paths: list[ContourPath] = []
    for ring, rank in zip(level.rings, ranks([ring.rows for ring in level.rings]), strict=True):
        paths.extend(_along_walls(ring, area, rank))
    if direction is Direction.CLIMB:
        return tuple(paths)
    return tuple(
        ContourPath(reversed_rows(path.rows), path.closed, path.region, path.rank, path.area) for path in paths
    )


def _along_walls(ring: Ring, area: MachiningArea, rank: int) -> list[ContourPath]:
    bare = area.follows_bare(ring.rows)
    if not bare.any():
        return [ContourPath(ring.rows, closed=True, region=ring.region, rank=rank, area=ring.area)]
    if bare.all():
        return []
    # begin beside something bare, so that no run is cut in two by the ring's own beginning
    first = int(np.argmax(bare))
    rows, bare = np.roll(ring.rows, -first, axis=0), np.roll(bare, -first)
    edges = np.flatnonzero(np.diff(np.concatenate([[True], bare, [True]]).astype(np.int8)))
    return [
        ContourPath(rows[a:b], closed=False, region=ring.region, rank=rank, area=ring.area)
        for a, b in edges.reshape(-1, 2).tolist()
    ]


def ranks(loops: Sequence[np.ndarray]) -> list[int]:
    """Return how many of some closed loops of rows lie round each of them."""
    if len(loops) < 2:
        return [0] * len(loops)
    outlines = Outlines.joined(loops)
    shapes = np.asarray(shapely.points(outlines.rows[outlines.first[:-1], :2]), dtype=object)
    places = shapes.copy()
    number, wide = polygons(outlines, np.arange(len(outlines)), _CHORD)
    shapes[number] = wide
    held = shapely.STRtree(shapes).query(places, predicate="within")
    size = shapely.area(shapes)
    inside = held[:, (held[0] != held[1]) & (size[held[0]] < size[held[1]])]
    return [int(count) for count in np.bincount(inside[0], minlength=len(loops))]
