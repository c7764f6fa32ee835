"""Many contours as one array of rows: measured, sampled and filled all at once, however many there are.

One contour is a batch of one; nothing here is asked for each of them by itself.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np
import shapely
from numpy.typing import NDArray

from ..core import tolerances
from ..model.curves import Line, Primitive, reversed_curve
from ..model.part import Contour, Region
from . import kernels
from .distance import DistanceField
from .near_points import near
from .primitives import Indices, R, Rows, boxes, lengths, points_at, rows_of_each, samples, sweeps
from .primitives import lengths as row_lengths

Floats = NDArray[np.float64]

Shapes = NDArray[np.object_]


@dataclass(frozen=True, eq=False)
class Outlines:
    """Contours, one after the other.

    Attributes:
        rows: (n, 8) of all of them, see `app.geometry.primitives`.
        first: (m + 1,) number of the first row of each; none is without rows.
    """

    rows: Rows
    first: Indices

    @staticmethod
    def of(contours: Sequence[Contour]) -> Outlines:
        """Return contours as rows."""
        return Outlines.joined(rows_of_each(contours))

    @staticmethod
    def joined(parts: Sequence[Rows]) -> Outlines:
        """Return the rows (k, 8), k > 0, of each of some paths as one array."""
        counts = np.array([len(part) for part in parts], np.int64)
        return Outlines(
            np.concatenate([np.zeros((0, 8)), *parts]), np.concatenate([np.zeros(1, np.int64), np.cumsum(counts)])
        )

    def __len__(self) -> int:
        return len(self.first) - 1

    @cached_property
    def owner(self) -> Indices:
        """(n,) number of the contour of each row."""
        return np.repeat(np.arange(len(self)), np.diff(self.first))

    @cached_property
    def following(self) -> Indices:
        """(n,) number of the row that comes after each, round and round its contour."""
        after = np.arange(1, len(self.rows) + 1)
        after[self.first[1:] - 1] = self.first[:-1]
        return after

    @cached_property
    def previous(self) -> Indices:
        """(n,) number of the row that comes before each, round and round its contour."""
        before = np.arange(-1, len(self.rows) - 1)
        before[self.first[:-1]] = self.first[1:] - 1
        return before

    @cached_property
    def sizes(self) -> Floats:
        """(n,) length of each row, mm."""
        return row_lengths(self.rows)

    @cached_property
    def lengths(self) -> Floats:
        """(m,) length of each contour, mm."""
        return self.sums(self.sizes)

    @cached_property
    def areas(self) -> Floats:
        """(m,) area that each encloses, mm2, positive when counter-clockwise (Green's theorem, exact for arcs)."""
        base = np.tile(self.rows[self.first[:-1], :2][self.owner], 2)
        x0, y0, x1, y1 = (self.rows[:, :4] - base).T  # from where each begins: what is far from zero loses digits
        turn = sweeps(self.rows)
        return self.sums(x0 * y1 - x1 * y0) / 2 + self.sums(self.rows[:, R] ** 2 * (turn - np.sin(turn))) / 2

    @cached_property
    def boxes(self) -> Floats:
        """(m, 4) box x0, y0, x1, y1 that holds each exactly, mm."""
        if not len(self):
            return np.zeros((0, 4))
        around = boxes(self.rows)
        low, high = (
            ufunc.reduceat(part, self.first[:-1])
            for ufunc, part in ((np.minimum, around[:, :2]), (np.maximum, around[:, 2:]))
        )
        return np.hstack([low, high])

    def sums(self, values: Floats) -> Floats:
        """Return the sum (m,) over each contour of values (n,) of the rows."""
        total: Floats = np.add.reduceat(values, self.first[:-1]) if len(self) else np.zeros(0)
        return total

    def enclose(self, points: Floats) -> NDArray[np.bool_]:
        """Tell for each contour whether it encloses the point (m, 2) of its own, by the even-odd rule."""
        held = np.empty(len(self), np.bool_)
        kernels.inside_own(np.ascontiguousarray(self.rows), self.first, np.ascontiguousarray(points, np.float64), held)
        return held

    def sampled(self, tolerance: float | Floats) -> tuple[Indices, Floats]:
        """Return (contour (k,), points (k, 2)) along the contours, whose chords stay within a tolerance, mm.

        Args:
            tolerance: for all of them, or (m,) for each.
        """
        row, points = samples(self.rows, np.broadcast_to(tolerance, len(self))[self.owner])
        return self.owner[row], points

    def rings(self, tolerance: float | Floats) -> tuple[Indices, Shapes]:
        """Return (contour (k,), its ring of chords within a tolerance, mm) of each but those of fewer than three
        chords.
        """
        owner, points = self.sampled(tolerance)
        wide = np.bincount(owner, minlength=len(self)) > 2
        kept = np.flatnonzero(wide)
        if not len(kept):
            return kept, np.zeros(0, object)
        number = np.cumsum(wide) - 1
        return kept, np.asarray(
            shapely.linearrings(points[wide[owner]], indices=number[owner[wide[owner]]]), dtype=object
        )


def polygons(outlines: Outlines, group: Indices, tolerance: float | Floats) -> tuple[Indices, Shapes]:
    """Return (group (k,), its polygon, valid and not empty): the first contour of a group is the boundary, the others
    are its holes.

    Args:
        outlines: the contours of a group one after the other.
        group: (m,) number of the group of each, rising.
        tolerance: of the chords, mm, for all contours or (m,) for each.
    """
    kept, rings = outlines.rings(tolerance)
    boundary = np.flatnonzero(np.diff(group, prepend=-1))
    bounded = np.isin(group, group[boundary[np.isin(boundary, kept)]])
    rings, kept = rings[bounded[kept]], kept[bounded[kept]]
    if not len(kept):
        return kept, np.zeros(0, object)
    numbers, index = np.unique(group[kept], return_inverse=True)
    shapes = np.asarray(shapely.make_valid(shapely.polygons(rings, indices=index)), dtype=object)
    there = ~shapely.is_empty(shapes)
    return numbers[there], shapes[there]


# Closed contours to regions by even-odd nesting.


_CHORD = 0.01
"""mm; an inner point of each contour is found with it, and then proven exactly. Thin contours are sampled more
finely.
"""

_ASIDE = (1.0, 0.5, 0.2, 0.05)
"""Half widths beside a curve at which an inner point is looked for where chords give none."""


@dataclass(frozen=True)
class NestingResult:
    """What closed contours bound.

    Attributes:
        regions: in the order of the drawing, boundaries counter-clockwise, islands clockwise.
        thin: boundaries of areas that are thinner than 1 um and no regions.
    """

    regions: tuple[Region, ...] = ()
    thin: tuple[Contour, ...] = ()


def nest(contours: Sequence[Contour]) -> tuple[Region, ...]:
    """Return the regions that closed contours bound by the even-odd rule; see `nested`."""
    return nested(contours).regions


def nested(contours: Sequence[Contour]) -> NestingResult:
    """Return the regions that closed contours bound by the even-odd rule.

    A contour inside an even number of others bounds an area, one inside an odd number is an island of the
    smallest contour round it; what lies in an island is an area again. Open contours bound nothing, nor do areas
    thinner than 1 um, which are left over where contours meet.

    Args:
        contours: closed ones may touch one another, but neither cross one another nor pass a point twice.
    """
    closed = [c for c in contours if c.closed]
    if not closed:
        return NestingResult()
    outlines = Outlines.of(closed)
    areas = outlines.areas
    holders = _holders(outlines)
    turned = [
        c if (area > 0) == (len(h) % 2 == 0) else reversed_contour(c)
        for c, area, h in zip(closed, areas.tolist(), holders, strict=True)
    ]
    islands: dict[int, list[Contour]] = {}
    for contour, held in zip(turned, holders, strict=True):
        if len(held) % 2 == 1:
            islands.setdefault(min(held, key=lambda i: abs(areas[i])), []).append(contour)
    outer = [i for i, held in enumerate(holders) if len(held) % 2 == 0]
    thick = _thicknesses(outlines) > tolerances.LEVEL / 2
    regions = tuple(
        Region(number, turned[i], tuple(islands.get(i, ())))
        for number, i in enumerate((i for i in outer if thick[i]), 1)
    )
    return NestingResult(regions, tuple(turned[i] for i in outer if not thick[i]))


def holders(contours: Sequence[Contour]) -> list[list[int]]:
    """Return for each closed contour which larger ones hold an inner point of it, by their indices.

    Of contours that cross, the smaller one may lie in the larger one or not, as that point of it does.
    """
    return _holders(Outlines.of(contours)) if contours else []


def _thicknesses(outlines: Outlines) -> Floats:
    """Return area / length (m,), mm: half the width of something long and thin."""
    thickness: Floats = np.abs(outlines.areas) / np.maximum(outlines.lengths, tolerances.WELD)
    return thickness


def _holders(outlines: Outlines) -> list[list[int]]:
    """Return for each contour the larger ones that hold an inner point of it: exactly, arcs as arcs."""
    points, areas = _inner_points(outlines), np.abs(outlines.areas)
    holder, held = near(shapely.STRtree(shapely.points(points)), shapely.box(*outlines.boxes.T))
    larger = areas[held] < areas[holder]
    holder, held = holder[larger], held[larger]
    order = np.lexsort((held, holder))
    found: list[list[int]] = [[] for _ in areas]
    for some in np.split(order, np.flatnonzero(np.diff(holder[order])) + 1) if len(order) else ():
        j = int(holder[some[0]])
        inside = DistanceField.of(outlines.rows[outlines.first[j] : outlines.first[j + 1]]).inside(points[held[some]])
        for i in held[some[inside]].tolist():
            found[i].append(j)
    return found


def _inner_points(outlines: Outlines) -> Floats:
    """Return a point (m, 2) that each closed contour holds."""
    chord = np.minimum(_CHORD, np.maximum(_thicknesses(outlines) / 8, tolerances.WELD))
    number, shapes = polygons(outlines, np.arange(len(outlines)), chord)
    found = np.full((len(outlines), 2), np.inf)
    found[number] = shapely.get_coordinates(shapely.point_on_surface(shapes))
    for k in np.flatnonzero(~outlines.enclose(found)).tolist():
        found[k] = _beside(Outlines.joined([outlines.rows[outlines.first[k] : outlines.first[k + 1]]]))
    return found


def _beside(outline: Outlines) -> Floats:
    """Return a point within a closed contour, close beside the middle of one of its curves; that middle itself where
    none is found.
    """
    rows, thickness = outline.rows, float(_thicknesses(outline)[0])
    middle = points_at(rows, np.full(len(rows), 0.5))
    ahead = points_at(rows, np.full(len(rows), 0.51)) - middle
    normal = np.stack([-ahead[:, 1], ahead[:, 0]], 1) / np.maximum(np.hypot(*ahead.T), 1e-300)[:, None]
    field = DistanceField.of(rows)
    for share in _ASIDE:
        aside = thickness * share * (1 if outline.areas[0] > 0 else -1)
        places = middle + normal * aside
        held = field.inside(places)
        if held.any():
            inner: Floats = places[np.argmax(np.where(held, lengths(rows), -1.0))]
            return inner
    start: Floats = middle[0]
    return start


def reversed_contour(contour: Contour) -> Contour:
    """Return the contour travelled the other way."""
    back: list[Primitive] = []
    for curve in reversed(contour.primitives):
        turned = reversed_curve(curve)
        assert not isinstance(turned, type(None))
        back.append(turned)  # type: ignore[arg-type]  # a primitive turned round is a primitive
    return replace(contour, primitives=tuple(back), entity_ids=contour.entity_ids[::-1])


def polygon_contour(points: Sequence[tuple[float, float]]) -> Contour:
    """Return the closed contour of straight lines through some points."""
    pairs = zip(points, (*points[1:], points[0]), strict=True)
    return Contour(tuple(Line((float(a[0]), float(a[1])), (float(b[0]), float(b[1]))) for a, b in pairs))
