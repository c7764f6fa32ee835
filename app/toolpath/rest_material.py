"""What paths have left of an area within reach of a cutter: cells of a grid that together hold all of it.

Two places are told apart. Where the cutter's centre may be, all metal is within reach, and its depth in what the paths
have left decides. Nearer to the walls only what lies beside a ring that still cuts something can be left: the straight
walls that a larger tool has followed are clean, and are not looked at again.
"""

from __future__ import annotations

import math
from bisect import bisect_left
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass, field
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from ..core import tolerances
from ..core.memory import MemoryRemedy, ask, fitting, portion
from ..core.pool import in_bands
from ..core.progress import Progress
from ..geometry.distance import DistanceField
from ..geometry.kernels import build_tree
from ..geometry.primitives import Indices, Rows, boxes, pack, points_at, within_half_turn
from ..model.curves import Point
from ..model.tool import Tool
from . import cleared_kernels as kernels
from . import rest_kernels
from .machining_areas import MachiningArea

LEAST = 4e-3
"""mm; metal in which no disc of this radius fits is none: it is thinner than what the measure of coverage counts."""

_SAME = 5e-4
"""mm by which a cutter's rim may go beyond what a path has cut and still cut nothing."""

_WORTH_ASKING = 1e8
"""Bytes from which on it is worth to look how many squares will really be found."""

_AT_A_TIME, _SQUARE_BYTES = 1 << 20, 150
"""Squares that are looked at together, few enough to be stopped between them, and what one takes meanwhile."""

CELL_BYTES, CHUNK_BYTES = 100, 250
"""What a cell in which metal is left takes until it is cleared, and a short row of a ring."""

Floats = NDArray[np.float64]


@dataclass(frozen=True, eq=False)
class CutGround:
    """What paths have cut.

    Attributes:
        tree: rows (n, 8), orders and nodes of one tree a cutter, and (k, 3) the radius of each, mm, with where the next
            one's begin.
    """

    tree: tuple[Rows, Indices, Rows, Floats]

    @staticmethod
    def of(paths: Sequence[tuple[Rows, float]]) -> CutGround:
        """Return the ground that paths (rows (n, 8), radius of the cutter, mm) have cut."""
        rows, order, nodes = [np.zeros((0, 8))], [np.zeros(0, np.int64)], [np.zeros((0, 4))]
        cutters: list[tuple[float, int, int]] = []
        for radius in sorted({radius for _, radius in paths}, reverse=True):
            parts = [path for path, wide in paths if wide == radius and len(path)]
            if not parts:
                continue
            field = DistanceField.of(within_half_turn(np.concatenate(parts)))
            order.append(field.order + sum(map(len, rows)))
            rows.append(field.rows)
            nodes.append(field.nodes)
            cutters.append((radius, sum(map(len, order)), sum(map(len, nodes))))
        return CutGround(
            (np.concatenate(rows), np.concatenate(order), np.concatenate(nodes), np.array(cutters).reshape(-1, 3))
        )

    def depth(self, points: Floats, limit: float) -> Floats:
        """Return how deep points (m, 2) lie in what is left, mm, at most `limit`; not above 0 where it is cut."""
        points, out = np.ascontiguousarray(points), np.empty(len(points))

        def look(band: slice) -> None:
            rest_kernels.depths_left(*self.tree, points[band], limit, out[band])

        in_bands(look, len(points))
        return out

    def holds(self, points: Floats, around: float) -> NDArray[np.bool_]:
        """Return for points (m, 2) whether all within `around` of them, mm, is cut by one stretch of a path; less than
        0: whether anything is that is no farther away.
        """
        points, out = np.ascontiguousarray(points), np.empty(len(points), np.bool_)

        def look(band: slice) -> None:
            rest_kernels.hold(*self.tree, points[band], around, out[band])

        in_bands(look, len(points))
        return out

    def in_air(self, rows: Rows, radius: float, tolerance: float = _SAME) -> NDArray[np.bool_]:
        """Return for short rows (n, 8) whether a cutter of this radius, mm, cuts nothing along them."""
        places = np.hstack([rows[:, :2], points_at(rows, np.full(len(rows), 0.5)), rows[:, 2:4]])
        places, out = np.ascontiguousarray(places), np.empty(len(rows), np.bool_)

        def look(band: slice) -> None:
            rest_kernels.in_air(*self.tree, places[band], np.array([radius, tolerance]), out[band])

        in_bands(look, len(rows))
        return out


@dataclass(frozen=True, eq=False)
class CentreReach:
    """Where a cutter's centre may be, and the grid in which metal is looked for.

    Attributes:
        area: the area and its walls.
        radius: of the cutter, mm.
        closest: its centre keeps so far off the walls, mm.
        cell: half side of the cells, mm.
    """

    area: MachiningArea
    radius: float
    closest: float
    cell: float

    @property
    def corner(self) -> float:
        """From a cell's centre to its corners, mm."""
        return self.cell * math.sqrt(2)

    def ask_memory(self, needed: float) -> None:
        """Ask for the memory, bytes, of cells and rings as fine as the tool wants them: both grow with the square of
        its fineness.

        Raises:
            MemoryShortError: there is not as much.
        """
        larger = f"{2 * self.radius / math.sqrt(fitting(needed)) * 1.05:.2g}"
        ask(
            needed,
            f"Clearing what is left with a tool of {2 * self.radius:g} mm",
            MemoryRemedy(f"use one of {larger} mm or more", "contour-tool", larger),
            MemoryRemedy(", or a smaller one before it", "pocket-tool"),
        )


@dataclass(frozen=True, eq=False)
class RestSquares:
    """Squares that may hold metal that is left; everything else is proven cut, or out of reach.

    Attributes:
        core: centres (n, 2) of those where the cutter's centre may be. rim: of those nearer to the walls.
        half: half their side, mm.
    """

    core: Floats
    rim: Floats
    half: float


def suspects(ground: CutGround, reach: CentreReach, cutting: Rows, progress: Progress) -> RestSquares:
    """Return the squares of a grid that may hold metal that is left, by ever finer squares.

    Args:
        cutting: pieces (n, 8) of the ring nearest to the walls along which the cutter still cuts: nearer to the walls
            nothing is left but beside these.
    """
    last = 2 * reach.cell
    area = _Area(DistanceField.of(pack(reach.area.regions).rows), DistanceField.of(cutting) if len(cutting) else None)
    found = [np.zeros((0, 3)), *_sifted(ground, reach, area, progress)]
    centres, walls = np.split(np.concatenate(found), [2], axis=1)
    q, near = last * math.sqrt(2), walls[:, 0]
    core = near + q >= reach.closest
    return RestSquares(centres[core], centres[near - q < reach.closest], last)


@dataclass(frozen=True, eq=False)
class _Area:
    """Edges of an area, and the pieces of the ring nearest to its walls that still cut; None: there are none."""

    edges: DistanceField
    cutting: DistanceField | None


def _sifted(ground: CutGround, reach: CentreReach, area: _Area, progress: Progress) -> Iterator[Floats]:
    """Yield the centres (n, 2) of squares of the last size, and how far from the walls they are, part after part from
    left to right.
    """
    last, found = 2 * reach.cell, 0
    low, high = area.edges.boxes[:, :2].min(axis=0), area.edges.boxes[:, 2:].max(axis=0)
    waiting = [_grid((*low, *high), last)]
    while waiting:
        centres, half = waiting.pop()
        most = min(_AT_A_TIME, portion(_SQUARE_BYTES))
        if len(centres) > most:
            waiting += [(centres[first : first + most], half) for first in reversed(range(0, len(centres), most))]
            continue
        progress.step(0.0, "Looking for what is left")
        kept = _sieved(ground, reach, area, centres, half)
        if half <= last:
            found += len(kept)
            reach.ask_memory(CELL_BYTES * found)
            yield kept
        elif len(kept):
            half /= 2
            around = np.array([[-half, -half], [half, -half], [-half, half], [half, half]])
            waiting.append(((kept[:, None, :2] + around).reshape(-1, 2), half))


def _sieved(ground: CutGround, reach: CentreReach, area: _Area, centres: Floats, half: float) -> Floats:
    """Return the squares that may hold metal that is left: their centres (m, 2), and how far from the walls.

    Args:
        ground, reach: what is left, and where the cutter's centre may be.
        area: that the squares are looked for in.
        centres, half: (n, 2) of the squares, and half their side, mm.
    """
    q = half * math.sqrt(2)
    centres = centres[~ground.holds(centres, q)]
    # no farther than where it is decided whether a cutter's centre may be anywhere in a square
    walls = reach.area.distances.nearest(centres, max(reach.closest, q) + 2 * q)[0]
    open_ = walls + q >= reach.closest
    if area.cutting is not None:
        open_[~open_] = area.cutting.nearest(centres[~open_], reach.radius + q)[1] >= 0
    centres, walls = centres[open_], walls[open_]
    alone = walls > q  # all of such a square lies on one side of the walls
    keep = ~alone
    keep[alone] = area.edges.inside(centres[alone])
    bytes_each = CELL_BYTES * (half / reach.cell) ** 2
    if np.count_nonzero(keep & alone) * bytes_each > _WORTH_ASKING:
        # all cells of such a square will be found: nothing is cut as near as its corners
        untouched = np.count_nonzero(~ground.holds(centres[keep & alone], -q))
        reach.ask_memory(float(untouched) * bytes_each)
    return np.column_stack([centres[keep], walls[keep]])


def _grid(bounds: tuple[float, float, float, float], last: float) -> tuple[Floats, float]:
    """Return (centres (n, 2), half side) of the first squares, a power of two times the last ones' size."""
    x0, y0, x1, y1 = bounds
    half = last * 2.0 ** max(0, math.ceil(math.log2(max(x1 - x0, y1 - y0) / 32 / (2 * last))))
    x, y = (
        np.arange(math.floor(low / half / 2), math.ceil(high / half / 2)) * 2 * half + half
        for low, high in ((x0, x1), (y0, y1))
    )
    return np.stack(np.meshgrid(x, y), -1).reshape(-1, 2), half


def core_cells(ground: CutGround, reach: CentreReach, found: RestSquares) -> Floats:
    """Return the centres (n, 2) of the cells that hold all metal left where the cutter's centre may be."""
    return _cells(ground, reach, found.core, found.half, _core(reach))


def rim_cells(ground: CutGround, reach: CentreReach, found: RestSquares, cutting: Rows) -> Floats:
    """Return the centres (n, 2) of the cells that hold all metal left nearer to the walls.

    Args:
        cutting: pieces (n, 8) of the ring nearest to the walls along which the cutter still cuts.
    """
    if not len(cutting) or not len(found.rim):
        return np.zeros((0, 2))
    rule = _rim(reach, cutting)
    near = rule.bound.nearest(found.rim, reach.radius + found.half * math.sqrt(2))[1] >= 0
    return _cells(ground, reach, found.rim[near], found.half, rule)


def left_of(
    ground: CutGround, reach: CentreReach, cells: tuple[Floats, Floats], cutting: Rows
) -> tuple[Floats, Floats]:
    """Return which cells of the core and of the rim still hold metal when more is cut; args as `rim_cells`."""
    core, rim = cells
    left = _cells(ground, reach, core, reach.cell, _core(reach))
    return left, _cells(ground, reach, rim, reach.cell, _rim(reach, cutting)) if len(rim) else rim


@dataclass(frozen=True, eq=False)
class _Rule:
    """Only points at which base + sign * distance from some rows is more than 0 count."""

    bound: DistanceField
    base: float
    sign: float


def _core(reach: CentreReach) -> _Rule:
    return _Rule(reach.area.distances, LEAST - reach.closest, 1.0)


def _rim(reach: CentreReach, cutting: Rows) -> _Rule:
    return _Rule(DistanceField.of(cutting), reach.radius, -1.0)


def _cells(ground: CutGround, reach: CentreReach, centres: Floats, half: float, rule: _Rule) -> Floats:
    """Return the cells, their centres (m, 2), in which metal is left, of squares with centres (n, 2) and half a side,
    mm.
    """
    each = round(half / reach.cell) ** 2
    centres, out = np.ascontiguousarray(centres), np.empty((len(centres) * each, 2))

    def look(band: slice) -> Floats:
        room = out[band.start * each : band.stop * each]
        count = rest_kernels.left_cells(
            *ground.tree,
            rule.bound.rows,
            rule.bound.order,
            rule.bound.nodes,
            np.array([rule.base, rule.sign]),
            centres[band],
            np.array([half, reach.cell, LEAST]),
            room,
        )
        return room[:count]

    return np.concatenate(in_bands(look, len(centres)))


# Ground that is cut already, and how deep: what a cutter may go down to, or go over, without touching metal.


_SLACK = 0.01
"""Of a cutter's radius: so thin a skin may stand on ground that counts as cut; at least 1 um."""

_BUDGET = 4_000
"""Squares that one way is divided into at most; about 2 ms."""

_LOOSE = 128
"""Rows that are looked at one by one before they get a tree."""

_SAME_HEIGHT = 1e-9
"""mm; ground that is no higher than this above the tip has been cleared to it."""

Row = NDArray[np.float64]
"""(8,) a line or an arc, see `app.geometry.primitives`."""


class Disc(NamedTuple):
    """A disc by its centre and radius, mm."""

    x: float
    y: float
    radius: float


class _RowTree(NamedTuple):
    """Rows that share a tree, as the kernels read it: the first of them, how many, its first node, its leaves; without
    leaves there is no tree yet.
    """

    first: int
    rows: int
    node: int
    leaves: int


class _FlatCuts:
    """What flat ends have cut: rows, how deep, and how far beside them."""

    def __init__(self) -> None:
        self._rows, self._reach, self._boxes = np.empty((256, 8)), np.empty((256, 2)), np.empty((256, 4))
        self._order, self._nodes, self._best = np.empty(256, np.int64), np.empty((256, 4)), np.empty((256, 2))
        self._count = 0
        self._trees: list[_RowTree] = []
        self._forest: tuple[NDArray[Any], ...] | None = None
        self._deep: list[float] = []

    def add(self, rows: Rows, z: NDArray[np.float64], radius: float) -> None:
        """Take rows (n, 8), each cut down to its z (n,) by a disc of a radius, mm."""
        first, self._count = self._count, self._count + len(rows)
        if self._count > len(self._rows):
            size = 2 * self._count
            self._rows, self._reach, self._boxes = (
                _longer(each, size) for each in (self._rows, self._reach, self._boxes)
            )
            self._order = _longer(self._order, size)
        self._rows[first : self._count] = rows
        self._reach[first : self._count, 0], self._reach[first : self._count, 1] = z, radius
        for height in set(z.tolist()):
            self._note(height)
        last = self._trees.pop() if self._trees and not self._trees[-1].leaves else None
        loose = last or _RowTree(first, 0, self._nodes_used(), 0)
        self._trees.append(loose._replace(rows=self._count - loose.first))
        if self._count - loose.first > _LOOSE:
            self._plant()
        self._forest = None

    def beyond(self, place: Point, z: float, enough: float) -> tuple[float, Row | None]:
        """Return how far a place is from ground cut down to z, mm, negative within it, and the row that it is nearest
        to.
        """
        if not self._count:
            return np.inf, None
        gap, row = kernels.beyond(*self._arrays(), *place, z, enough, np.inf)
        return float(gap), self._rows[row] if row >= 0 else None

    def covers(self, a: Point, b: Point, radius: float, z: float) -> bool:
        """Tell whether a disc stays on ground cut down to z on its straight way from a to b."""
        slack = max(_SLACK * radius, tolerances.LEVEL)
        way, z = np.array([*a, *b], np.float64), z + _SAME_HEIGHT
        return bool(self._count and kernels.covers(*self._arrays(), way, radius, z, slack, _BUDGET, np.empty(2)))

    def covered_after(self, places: NDArray[np.float64], k: int, radius: float, z: float) -> int:
        """Return the first place (m, 2) from number k on at which a disc lies on ground cut down to z; -1 where there
        is none.
        """
        if not self._count:
            return -1
        slack = max(_SLACK * radius, tolerances.LEVEL)
        return int(kernels.covered_after(*self._arrays(), places, k, radius, z + _SAME_HEIGHT, slack, _BUDGET))

    def depths(self) -> list[float]:
        """Return how deep it was cut anywhere, mm below Z 0, the least first."""
        return self._deep

    def _note(self, height: float) -> None:
        k = bisect_left(self._deep, -height - _SAME_HEIGHT)
        if k == len(self._deep) or self._deep[k] > -height + _SAME_HEIGHT:
            self._deep.insert(k, -height)

    def _nodes_used(self) -> int:
        return self._trees[-1].node + max(0, 2 * self._trees[-1].leaves - 1) if self._trees else 0

    def _plant(self) -> None:
        """Make one tree of the loose rows and of all trees before them that are no larger."""
        first, count, node, _ = self._trees.pop()
        self._boxes[first : self._count] = boxes(self._rows[first : self._count])
        while self._trees and self._trees[-1].rows <= count:
            first, more, node, _ = self._trees.pop()
            count += more
        order, nodes = build_tree(self._boxes[first : self._count])
        leaves = (len(nodes) + 1) // 2
        if node + len(nodes) > len(self._nodes):
            size = 2 * (node + len(nodes))
            self._nodes, self._best = _longer(self._nodes, size), _longer(self._best, size)
        self._order[first : self._count] = order
        self._nodes[node : node + len(nodes)] = nodes
        self._best[node : node + len(nodes)] = kernels.bounds(self._reach[first : self._count], order, leaves)
        self._trees.append(_RowTree(first, count, node, leaves))

    def _arrays(self) -> tuple[NDArray[Any], ...]:
        if self._forest is None:
            trees = np.array(self._trees, np.int64).reshape(-1, 4)
            self._forest = (self._rows, self._reach, self._order, self._nodes, self._best, trees)
        return self._forest


def _longer(array: NDArray[Any], size: int) -> NDArray[Any]:
    longer = np.empty((size, *array.shape[1:]), array.dtype)
    longer[: len(array)] = array
    return longer


@dataclass
class ClearedGround:
    """Ground cut so far, by all tools.

    A flat end clears all that it sweeps. A cutter of another shape is not as wide at its tip, so beside what its flat
    part sweeps only the very places it has been at are clear, and only for itself.
    """

    wells: dict[Disc, float] = field(default_factory=dict)
    """Heights down to which discs were cleared by helices, mm."""
    _flat: _FlatCuts = field(default_factory=_FlatCuts)
    _own: dict[int, _FlatCuts] = field(default_factory=dict)
    _floors: dict[tuple[int, Point, float], float] = field(default_factory=dict)
    """Floors that were asked for since something was added: a way to a place asks for them again and again."""

    def add(self, tool: Tool, rows: Rows, z: NDArray[np.float64]) -> None:
        """Take a path as cut.

        Args:
            rows: (n, 8) of its centre; arcs sweep less than pi.
            z: (n,) how deep each row was cut, mm; for a row along which it changes, the height of its higher end.
        """
        deep = z < 0
        if not deep.all():
            rows, z = rows[deep], z[deep]
        if not len(rows):
            return
        self._floors.clear()
        if flat_radius(tool) > 0:
            self._flat.add(rows, z, flat_radius(tool))
        if not tool.kind.square:
            self._own.setdefault(tool.number, _FlatCuts()).add(rows, z, 0.0)

    def floor(self, tool: Tool, place: Point, more: float = 0.0) -> float:
        """Return down to which height all ground under a cutter at a place is cut, mm, <= 0.

        Args:
            more: mm, >= 0, that is asked about beyond the cutter's radius.
        """
        key = tool.number, place, tool.radius + more
        if key not in self._floors:
            self._floors[key] = self._floor(tool, place, more)
        return self._floors[key]

    def _floor(self, tool: Tool, place: Point, more: float) -> float:
        radius = tool.radius + more
        flat = _deepest(self._flat, lambda z: self._flat.covers(place, place, radius, z))
        own = self._own.get(tool.number)
        if own is None or more:
            return flat
        return min(
            flat, _deepest(own, lambda z: own.beyond(place, z + _SAME_HEIGHT, tolerances.WELD)[0] <= tolerances.WELD)
        )

    def nearest(self, place: Point, z: float) -> tuple[float, Row | None]:
        """Return how far a place is from ground that flat ends have cut down to z, mm, and the path (8,) there.

        The distance is negative within that ground; (inf, None) where there is none.
        """
        return self._flat.beyond(place, z + _SAME_HEIGHT, -np.inf)

    def is_clear(self, tool: Tool, a: Point, b: Point, z: float) -> bool:
        """Tell whether a cutter with its tip at height z touches no metal on its straight way from a to b."""
        return z >= 0 or self._flat.covers(a, b, tool.radius, z)

    def clear_places(self, tool: Tool, places: Sequence[Point], z: float) -> Iterator[int]:
        """Give the numbers of the places at which a cutter with its tip at height z touches no metal, in order, each as
        it is asked for.
        """
        if z >= 0:
            yield from range(len(places))
            return
        table = np.array(places, np.float64).reshape(-1, 2)
        k = self._flat.covered_after(table, 0, tool.radius, z)
        while k >= 0:
            yield k
            k = self._flat.covered_after(table, k + 1, tool.radius, z)


def flat_radius(tool: Tool) -> float:
    """Return the radius, mm, of the level ground that a tool leaves under its axis."""
    return tool.profile.flat


def _deepest(ground: _FlatCuts, is_clear: Callable[[float], bool]) -> float:
    """Return the lowest of a ground's heights that is clear, 0 where none is; what is clear at one is at all higher
    ones.
    """
    depths = ground.depths()
    low, high = 0, len(depths)
    while low < high:
        middle = (low + high) // 2
        if is_clear(-depths[middle]):
            low = middle + 1
        else:
            high = middle
    return -depths[low - 1] if low else 0.0
