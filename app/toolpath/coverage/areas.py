"""Areas of many parts put together, cut and taken from one another: only parts whose boxes meet are brought to the
library.

An overlay takes what n log n takes for all edges of both its operands, though most parts of a drawing have nothing to
do with most others. Parts of one area have no inside in common; they may touch.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass

import numpy as np
import shapely
from numpy.typing import NDArray
from shapely import Geometry as Shape

from ...core import tolerances
from ...core.pool import in_bands
from ...geometry.buffer import buffered
from ...geometry.distance import DistanceField
from ...geometry.outlines import Outlines, polygons
from ...geometry.primitives import TURN, R, Rows, pack, points_of, sweeps
from ...model.moves import MoveKind, Moves
from ...model.part import Region
from . import reachable_kernels as kernels

Shapes = NDArray[np.object_]

_AT_A_TIME = 1024
"""Regions that are made polygons of together: chords and rings of all at once would be several times the polygons."""

_WORTH_TWO_CORES = 32
"""Overlays from which a second core is worth its start."""

_GRID = 1e-9
"""mm; where rounding leaves the library without an answer, one on this grid is found."""


def united(shapes: Iterable[Shape] | Shapes | Shape) -> Shape:
    """Return what any of some areas covers."""
    parts = _parts(shapes)
    if len(parts) < 2:
        return gathered(parts)
    first, second = shapely.STRtree(parts).query(parts)
    if np.all(first == second):
        return gathered(parts)
    try:
        return shapely.disjoint_subset_union_all(parts)
    except shapely.errors.GEOSException:
        return shapely.union_all(shapely.make_valid(parts), grid_size=_GRID)


def common(one: Shape, other: Shape) -> Shape:
    """Return what two areas have in common; lines and points along which they only touch are none of it."""
    a, b = _parts(one), _parts(other)
    if not len(a) or not len(b):
        return shapely.Polygon()
    second, first = shapely.STRtree(a).query(b)[[0, 1]]
    return gathered(each_with_each(shapely.intersection, a[first], b[second]))


def without(one: Shape, other: Shape) -> Shape:
    """Return what of an area another one does not cover."""
    a, b = _parts(one), _parts(other)
    if not len(a) or not len(b):
        return gathered(a)
    second, first = shapely.STRtree(a).query(b)
    order = np.argsort(first, kind="stable")
    met, at = np.unique(first[order], return_index=True)
    left = a.copy()
    taken = np.empty(len(met), dtype=object)
    taken[:] = [gathered(b[rows]) for rows in np.split(second[order], at[1:])]
    left[met] = each_with_each(shapely.difference, a[met], taken)
    return gathered(left)


def each_with_each(overlay: Callable[..., Shapes], one: Shapes, other: Shapes) -> Shapes:
    """Return the overlay of each shape (n,) with the one (n,) beside it, on all cores."""

    def overlaid(band: slice) -> Shapes:
        try:
            return overlay(one[band], other[band])
        except shapely.errors.GEOSException:
            return overlay(shapely.make_valid(one[band]), shapely.make_valid(other[band]), grid_size=_GRID)

    return np.concatenate(in_bands(overlaid, len(one), _WORTH_TWO_CORES))


def unions(lots: Sequence[Shapes]) -> Shapes:
    """Return what the shapes of each lot cover together, (n,), on all cores."""

    def covered(band: slice) -> Shapes:
        found = np.empty(len(lots[band]), dtype=object)
        found[:] = [shapely.union_all(lot) for lot in lots[band]]
        return found

    return np.concatenate(in_bands(covered, len(lots), _WORTH_TWO_CORES))


def opened(shapes: Shapes, by: float) -> Shapes:
    """Return what is left of areas (n,) that are shrunk by so much, mm, and grown again with sharp corners, without
    those that vanish; on all cores.
    """

    def reached(band: slice) -> Shapes:
        some = shapes[band]
        kept = shapely.buffer(some, -by, join_style="mitre")
        there = ~shapely.is_empty(kept)  # to intersect nothing with lines and areas at once makes GEOS give up
        grown = shapely.buffer(kept[there], by, join_style="mitre")
        return np.asarray(shapely.intersection(grown, some[there]), dtype=object)

    return np.concatenate(in_bands(reached, len(shapes), _WORTH_TWO_CORES))


def _parts(shapes: Iterable[Shape] | Shapes | Shape) -> Shapes:
    """Return the polygons of which areas consist."""
    several = shapes if isinstance(shapes, (Shape, np.ndarray)) else list(shapes)
    return _polygons(shapely.get_parts(several))


def _polygons(shapes: Shapes) -> Shapes:
    """Return the polygons among shapes and their parts."""
    parts = shapely.get_parts(shapely.get_parts(shapes))
    return np.asarray(
        parts[(shapely.get_type_id(parts) == shapely.GeometryType.POLYGON) & ~shapely.is_empty(parts)], dtype=object
    )


def gathered(shapes: Shapes) -> Shape:
    """Return the polygons among shapes, which have no inside in common, as one area."""
    parts = _polygons(shapes)
    if not len(parts):
        return shapely.Polygon()
    return parts[0] if len(parts) == 1 else shapely.multipolygons(parts)


# Moves and regions as shapely shapes, for measuring what was made; nothing here makes a path.


def move_rows(moves: Moves, chosen: NDArray[np.integer] | None = None) -> Rows:
    """Return moves as rows (n, 8) of `app.geometry.primitives`, seen from above; a full circle is one row.

    Args:
        moves: all of them.
        chosen: (n,) indices of those that are wanted; None = all.
    """
    at = np.arange(len(moves)) if chosen is None else chosen
    start, end = moves.end[np.maximum(at - 1, 0), :2], moves.end[at, :2]
    centre, kind = np.nan_to_num(moves.centre[at]), moves.kind[at]
    radius = (np.hypot(*(start - centre).T) + np.hypot(*(end - centre).T)) / 2
    turn = np.where(kind == MoveKind.ARC_CCW, 1.0, -1.0)
    arc = kind >= MoveKind.ARC_CW
    return np.column_stack([start, end, centre, np.where(arc, radius, 0.0), np.where(arc, turn, 0.0)])


def flattened(rows: Rows, chord: float) -> tuple[NDArray[np.int64], NDArray[np.float64]]:
    """Return (row index (m,), points (m, 2)): each row as chords that stay within `chord` mm of it, both ends
    included.
    """
    radius = np.maximum(rows[:, R], chord)
    step = 2 * np.arccos(1 - chord / radius)
    turn = np.where(rows[:, TURN] != 0, np.abs(sweeps(rows)), 0.0)
    counts = np.maximum(1, np.ceil(turn / step)).astype(np.int64)
    owner = np.repeat(np.arange(len(rows)), counts + 1)
    place = np.arange(len(owner)) - np.repeat(np.cumsum(counts + 1) - counts - 1, counts + 1)
    points = points_of(rows, owner, place / counts[owner])
    last = place == counts[owner]
    points[last] = rows[owner[last], 2:4]
    return owner, points


def lines(rows: Rows, chord: float) -> NDArray[np.object_]:
    """Return each row as a shapely line of chords that stay within `chord` mm of it; a row without a length as a point.

    Trees of shapes find nothing near a line without a length.
    """
    owner, points = flattened(rows, chord)
    found = np.asarray(shapely.linestrings(points, indices=owner), dtype=object)
    still = np.all(rows[:, :2] == rows[:, 2:4], axis=1) & (rows[:, TURN] == 0)
    found[still] = shapely.points(rows[still, :2])
    return found


def region_shapes(regions: Sequence[Region], chord: float) -> NDArray[np.object_]:
    """Return regions as polygons (n,) whose chords stay within `chord` mm of their contours.

    They stay apart, since regions that touch have a wall of no thickness between them.
    """
    some = [_some_shapes(regions[k : k + _AT_A_TIME], chord) for k in range(0, len(regions), _AT_A_TIME)]
    return np.concatenate(some) if some else np.zeros(0, dtype=object)


def _some_shapes(regions: Sequence[Region], chord: float) -> NDArray[np.object_]:
    """Return `region_shapes` of a few regions."""
    outlines = Outlines.of([contour for region in regions for contour in region.contours])
    group = np.repeat(np.arange(len(regions)), [1 + len(region.islands) for region in regions])
    parts = shapely.get_parts(shapely.get_parts(polygons(outlines, group, chord)[1]))
    return np.asarray(
        parts[(shapely.get_type_id(parts) == shapely.GeometryType.POLYGON) & ~shapely.is_empty(parts)], dtype=object
    )


def quarter_chords(radius: float, chord: float) -> int:
    """Return how many chords a quarter circle needs to stay within `chord` mm (shapely's quad_segs)."""
    if radius <= chord:
        return 1
    return max(1, int(np.ceil(np.pi / 4 / np.arccos(1 - chord / radius))))


def grown(shapes: Shape | NDArray[np.object_], distance: float, chord: float) -> Shape:
    """Return for each shape all points within `distance` mm of it; a negative distance gives the points that deep
    inside.
    """
    return buffered(shapes, distance, quarter_chords(abs(distance), chord))


# Can a cutter's centre be anywhere near a place? Decided by exact distances, in squares that are divided where it is
# doubtful.
#
# Polygons of chords let a cutter through gaps that are some micrometres too narrow for it; what they take to be within
# reach is asked here once more. The distance from the walls changes by no more than the way gone, so its value in a
# square's middle bounds it all over.


_MOST = 200_000
"""Squares for one point; points that need more count as within reach."""

_SLIVER = 0.25
"""Share of a cutter's radius below which a piece of metal is a sliver."""

_NOMINAL = tolerances.NOMINAL - 2 * tolerances.FIT
"""mm; a cutter that is too large by exactly `NOMINAL` does not fit, whatever rounding and doubt make of it: no path
goes there.
"""

_NEAR = 0.01
"""mm; so near to an area metal may lie in it, whatever chords make of its walls."""


@dataclass(frozen=True, eq=False)
class CutterInArea:
    """A cutter in an area.

    Attributes:
        regions: that it stays in.
        wall: how far its centre stays from walls, mm.
        radius: mm.
    """

    regions: tuple[Region, ...]
    wall: float
    radius: float

    def reaches(self, points: NDArray[np.float64], fields: Fields, spare: float = -_NOMINAL) -> bool:
        """Tell whether its centre may be somewhere within its radius of some point; True also where that stays in
        doubt.

        Args:
            points: (n, 2); they are asked together, as the same squares decide of points near one another.
            spare: how much farther from the walls than asked it has to stay, mm.
        """
        field, wall, most = fields.of(self.regions), self.wall + spare, _MOST * len(points)
        points = np.ascontiguousarray(points, np.float64)
        return bool(
            len(points)
            and kernels.within_reach(
                field.rows, field.order, field.nodes, points, self.radius, wall, tolerances.FIT, most
            )
        )


class Fields:
    """Distances from the walls of areas, made once each."""

    def __init__(self) -> None:
        self._kept: list[tuple[Region, ...]] = []
        self._made: dict[int, DistanceField] = {}

    def of(self, regions: tuple[Region, ...]) -> DistanceField:
        """Return the distances from all contours of some regions."""
        if id(regions) not in self._made:
            self._kept.append(regions)  # so that no other ones get its id
            self._made[id(regions)] = DistanceField.of(pack(regions).rows)
        return self._made[id(regions)]


def reached(points: NDArray[np.float64], cutters: Sequence[CutterInArea], fields: Fields, size: float) -> bool:
    """Tell whether some cutter reaches one of some points (n, 2) of a piece of metal whose largest disc has a diameter
    `size`, mm.

    A sliver counts where a cutter does that stays 1 um farther from the walls, as its paths may: in a neck that grows
    narrow slowly, a micrometre decides on tenths of a millimetre.
    """
    # a cutter of an area that the piece does not lie in has no say in what a sliver is
    cutters = [each for each in cutters if _holds(fields.of(each.regions), points)]
    spare = -_NOMINAL if any(size > _SLIVER * cutter.radius for cutter in cutters) else tolerances.LEVEL
    return any(cutter.reaches(points, fields, spare) for cutter in cutters)


def _holds(field: DistanceField, points: NDArray[np.float64]) -> bool:
    """Tell whether one of some points (n, 2) lies in an area, or so near to it that it may."""
    return bool(np.any(field.inside(points) | (field.nearest(points)[0] <= _NEAR)))
