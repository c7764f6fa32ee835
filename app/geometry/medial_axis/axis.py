"""The medial axis of regions of lines and arcs, exact: the way of a sharp cutter that touches both walls.

Method: the cell of a boundary element, the points nearest to it, ends where the largest disc that touches the element
at a foot touches another site. Its radius is a closed form of the foot, for lines, arcs and vertices, and exact for
arcs, so a cell is the envelope of a few closed forms (`cell_kernels`). Each piece of the axis is found from both of its
sides.

Regions that a translation brings onto one another, as equal letters are, have one axis, which is found and proven once:
all that is measured of it is measured about the middle of the region.

Nothing is believed that is not proven by other means: the areas of the cells add up to the area of the region, and the
distance field, which knows nothing of cells, is as large at points of every piece as the piece says.
"""

from __future__ import annotations

from collections.abc import Hashable
from dataclasses import dataclass, replace
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from ...core.errors import GeometryError
from ...core.progress import NO_PROGRESS, Progress
from ...core.wording import in_plane
from ..distance import DistanceField
from ..offset import offset_kernels
from ..primitives import CX, TURN, X0, X1, Y0, Y1, Indices, Primitives, R, Rows, boxes, signed_area
from . import cell_kernels

Floats = NDArray[np.float64]

_SHORTEST = 2e-6
"""mm; pieces of the axis that are shorter are no way, and ill-conditioned."""

_AREA = 1e-6
"""Of a region's area; what the areas of its cells may differ by."""

_FIELD = 1e-6
"""mm; what the distance field may differ by from a radius, a thousandth of what a path may."""

_CRACKS = (0.0, 1e-8, 1e-6)
"""mm by which rows are taken as longer at both ends, tried in turn until the axis is proven right: where rows that were
rounded go on smoothly, a disc that touches both, as an arc's own does, slips through between them. As much as a radius
may be off.
"""

_PROBES = np.array([0.02, 0.1, 0.3, 0.5, 0.7, 0.9, 0.98])
"""Shares of a piece of the axis at which its discs are held against the walls."""

_ALIKE = 1e-9
"""mm; regions whose rows lie so near to one another about their middles have one axis. A distance from walls that are
moved by so much changes by no more, so what is proven of one holds for the other but for that: a thousandth of _FIELD.
"""

_NODES, _WEIGHTS = np.polynomial.legendre.leggauss(12)
"""Gauss's rule of 12 nodes for an area along a piece: exact for polynomials up to degree 23."""

_HALVINGS = 24
"""Times a piece is halved at most while its area is integrated."""


@dataclass(frozen=True)
class MedialAxis:
    """All centres of discs in one region that touch its boundary in two places and hold no point of it.

    Attributes:
        region: number of the region.
        rows: (n, 8) the region's boundary, mm, about `middle`.
        angles: (2 n, 2) start angle and signed sweep, radians, of each row and of each vertex's normals.
        pieces: (m, 4) element, site, from and to as fractions of the element. Element and site below n are rows, n + i
            is the vertex at which row i starts; a counter-clockwise arc that is its own site ends at its centre.
        middle: (2,) mm.

    Of regions that are alike all but `region` and `middle` is the same, not just equal.
    """

    region: int
    rows: Rows
    angles: Floats
    pieces: Floats
    middle: Floats

    def discs(self, fractions: Floats) -> Floats:
        """Return the (m, k, 3) centres x, y and radii, mm, of the discs at fractions (k,) in [0, 1] of each piece."""
        found = np.empty((len(self.pieces), len(fractions), 3))
        cell_kernels.centres(self.rows, self.angles, self.pieces, np.ascontiguousarray(fractions), found)
        found[:, :, :2] += self.middle
        return found


def medial_axes(primitives: Primitives, progress: Progress = NO_PROGRESS) -> tuple[MedialAxis, ...]:
    """Return the medial axis of each region of a drawing.

    Args:
        primitives: closed contours, the area to the left, arcs below half a turn; contours may touch, not cross.
        progress: looked at before each region.

    Returns:
        One a region, in order of their numbers.

    Raises:
        GeometryError: the axis of a region is not proven right; names a place.
        Cancelled: by progress.
    """
    order = np.argsort(primitives.region, kind="stable")
    numbers, begins = np.unique(primitives.region[order], return_index=True)
    place = np.empty(len(order), np.int64)
    found: list[MedialAxis] = []
    alike: dict[Hashable, list[_KnownAxis]] = {}
    for k, (number, here) in enumerate(zip(numbers.tolist(), np.split(order, begins[1:]), strict=True)):
        progress.step(k / len(numbers), "Medial axis")
        place[here] = np.arange(len(here))
        found.append(_axis_of(_region(primitives, here, place), number, alike))
    return tuple(found)


class _RegionRows(NamedTuple):
    """The rows of one region about its middle, mm, and (2, n) which come before and after each."""

    rows: Rows
    links: Indices
    middle: Floats


class _KnownAxis(NamedTuple):
    """A region's rows (n, 8) about its middle, mm, and its axis."""

    rows: Rows
    axis: MedialAxis


def _region(primitives: Primitives, here: Indices, place: Indices) -> _RegionRows:
    """Return the rows `here`; `place` tells of each what number it has among them."""
    rows, previous = primitives.rows[here].copy(), place[primitives.previous[here]]
    ends = rows[:, :4].reshape(-1, 2)
    middle = (ends.min(axis=0) + ends.max(axis=0)) / 2
    rows[:, X0:CX] -= np.tile(middle, 2)
    rows[rows[:, TURN] != 0, CX:R] -= middle
    return _RegionRows(rows, np.stack([previous, np.argsort(previous)]), middle)


def _axis_of(region: _RegionRows, number: int, alike: dict[Hashable, list[_KnownAxis]]) -> MedialAxis:
    """Return the axis of a region: that of one which is alike, moved, or one that is found and proven here."""
    rows, links, middle = region
    size = tuple(np.round(rows[:, :2].max(axis=0), 6).tolist())  # or all shapes would be compared with all others
    known = alike.setdefault((links.tobytes(), rows[:, TURN].tobytes(), size), [])
    for each in known:
        if np.abs(each.rows - rows).max() <= _ALIKE:
            return replace(each.axis, region=number, middle=middle)
    axis = _found(region, number)
    known.append(_KnownAxis(rows, axis))
    return axis


def _found(region: _RegionRows, number: int) -> MedialAxis:
    """Return the axis of a region by the narrowest cracks with which it is proven.

    Raises:
        GeometryError: it is with none; names a place.
    """
    for crack in _CRACKS[:-1]:
        try:
            return _by_cells(region, number, crack)
        except GeometryError:
            continue
    return _by_cells(region, number, _CRACKS[-1])


def _by_cells(region: _RegionRows, number: int, crack: float) -> MedialAxis:
    rows, links, middle = region
    angles, turns = np.empty((2 * len(rows), 2)), np.empty(len(rows))
    offset_kernels.element_angles(rows, links[0], angles)
    cell_kernels.vertex_turns(rows, links, turns)
    contours, firsts = _contours(links[1])
    around, places = np.ascontiguousarray(boxes(rows)), np.ascontiguousarray(rows[firsts, :2])
    pieces, failed = cell_kernels.cells(rows, around, angles, turns, links, crack, contours, places)
    axis = MedialAxis(number, rows, angles, pieces, middle)
    if failed or not _adds_up(axis):
        raise _unproven(axis)
    axis = MedialAxis(number, rows, angles, _worth_going(axis), middle)
    _prove_radii(axis)
    return axis


def _contours(following: Indices) -> tuple[Indices, Indices]:
    """Return the number (n,) of each row's contour, and the first row (c,) of each contour."""
    number = np.full(len(following), -1)
    firsts: list[int] = []
    for first in range(len(following)):
        if number[first] >= 0:
            continue
        row = first
        while number[row] < 0:
            number[row], row = len(firsts), int(following[row])
        firsts.append(first)
    return number, np.array(firsts)


def cells_area(axis: MedialAxis) -> float:
    """Return the area, mm2, of all cells whose pieces an axis lists from both sides: line integral of the radius, for
    arcs and vertices of what lies between them and the radius; pieces are halved until halves agree.
    """
    pieces, total = axis.pieces, 0.0
    # of all cells together: against what waits alone, the last digits of tiny pieces would never agree
    agree = 1e-12 * max(float(np.abs(_areas(axis, pieces)).sum()), 1e-300)
    for _ in range(_HALVINGS):
        if not len(pieces):
            break
        both = (pieces[:, 2] + pieces[:, 3]) / 2
        first, second = pieces.copy(), pieces.copy()
        first[:, 3], second[:, 2] = both, both
        whole = _areas(axis, pieces)
        halves = _areas(axis, first) + _areas(axis, second)
        again = np.abs(whole - halves) > agree
        total += float(halves[~again].sum())
        pieces = np.concatenate([first[again], second[again]])
    return total + float(_areas(axis, pieces).sum())


def _areas(axis: MedialAxis, pieces: Floats) -> Floats:
    some = MedialAxis(axis.region, axis.rows, axis.angles, np.ascontiguousarray(pieces), axis.middle)
    r = some.discs((_NODES + 1) / 2)[:, :, 2]
    e, n = pieces[:, 0].astype(np.int64), len(axis.rows)
    row = axis.rows[e % n]
    length = np.hypot(row[:, X1] - row[:, X0], row[:, Y1] - row[:, Y0])[:, None]
    sweep = np.abs(axis.angles[e, 1])[:, None]
    of_arc = sweep * (row[:, R, None] * r - row[:, TURN, None] * r * r / 2)
    density = np.where((e >= n)[:, None], sweep * r * r / 2, np.where(row[:, TURN, None] == 0, length * r, of_arc))
    areas: Floats = (density @ _WEIGHTS) / 2 * (pieces[:, 3] - pieces[:, 2])
    return areas


def _adds_up(axis: MedialAxis) -> bool:
    area = signed_area(axis.rows)
    return abs(cells_area(axis) - area) <= _AREA * abs(area)


def _worth_going(axis: MedialAxis) -> Floats:
    """Return the pieces that are longer than nothing, each from one of its sides."""
    e, s = axis.pieces[:, 0], axis.pieces[:, 1]
    points = axis.discs(np.linspace(0.0, 1.0, 5))
    long = np.hypot(*np.diff(points[:, :, :2], axis=1).transpose(2, 0, 1)).sum(axis=1) > _SHORTEST
    kept: Floats = np.ascontiguousarray(axis.pieces[(e < s) & long])
    return kept


def _prove_radii(axis: MedialAxis) -> None:
    """Ask the distance field for the radii.

    Raises:
        GeometryError: it says something else.
    """
    if not len(axis.pieces):
        return
    discs = axis.discs(_PROBES).reshape(-1, 3)
    centres = discs[:, :2] - axis.middle
    measured = DistanceField.of(axis.rows).nearest(centres)[0]
    wrong = np.abs(measured - discs[:, 2])
    if wrong.max() > _FIELD:
        raise _unproven(axis, discs[int(wrong.argmax()), :2])


def _unproven(axis: MedialAxis, at: Floats | None = None) -> GeometryError:
    x, y = (axis.rows[0, :2] + axis.middle if at is None else at).tolist()
    return GeometryError(
        f"The medial axis of region {axis.region} is not proven right near {in_plane(x, y)}; look there for edges "
        "that cross or lie on one another, and mend them."
    )
