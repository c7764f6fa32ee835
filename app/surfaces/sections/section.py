"""Sections of surfaces by upright planes, and the topmost of them: the compound surface as sequences of points."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, fields
from functools import partial
from itertools import pairwise

import numpy as np
import shapely
from numpy.typing import NDArray

from ...core.pool import pool
from ...core.progress import NO_PROGRESS, Progress
from ..patches.facets import SurfaceFacets, surface_parameters
from .compound import BoundaryPoints, CompoundSurface, CuttingPlanes, PlaneSection, SectionRun

Floats = NDArray[np.float64]
Ints = NDArray[np.int64]

_PAIRS = 4_000
"""Facets on planes that one thread cuts before it asks whether to go on."""
_GAP = 1e-9
"""mm along a plane: ends that are farther apart are two."""
_JUMP = 1e-8
"""mm; a higher step from span to span is an edge."""


_PIECE_BYTES = 300
"""What each meeting of a plane and a facet takes at a time: its piece as it is made, joined, put in order."""


@dataclass(frozen=True, eq=False)
class _Pieces:
    """Pieces of section curves on one plane, by where they begin.

    Attributes:
        rows: (m, 9), see `section_kernels`. facet: (m,) of each.
    """

    rows: Floats
    facet: Ints


def compound_surface(
    facets: SurfaceFacets,
    planes: CuttingPlanes,
    tolerance: float,
    areas: Mapping[int, shapely.Geometry] | None = None,
    progress: Progress = NO_PROGRESS,
) -> CompoundSurface:
    """Return the compound surface: on every plane the section curve of each surface, and the topmost of them.

    Points lie on their surfaces; between two of them the curve is within the tolerance of the chord. Where the topmost
    passes from one surface to another, the boundary point is solved for: there both are equally high, within 1e-9 mm.

    Args:
        tolerance: mm, > 0.
        areas: of a surface, by its number: where in XY it counts; others count everywhere.

    Raises:
        Cancelled: the job was asked to stop.
    """
    found = _cut(facets, planes, tolerance / 4, progress.part(0.0, 0.6))
    runs: list[SectionRun] = []
    curves: list[PlaneSection] = []
    marks: list[BoundaryPoints] = []
    for plane, pieces in enumerate(found):
        progress.step(0.6 + 0.4 * plane / len(found), "Finding the topmost")
        if not len(pieces.rows):
            continue
        within = _within(facets, planes, plane, pieces, areas or {})
        curves += _curves(facets, planes, plane, within, tolerance)
        here, there = _topmost(facets, planes, plane, within, tolerance)
        runs += here
        marks.append(there)
    return CompoundSurface(planes, tuple(runs), _joined(marks), tuple(curves))


def _cut(facets: SurfaceFacets, planes: CuttingPlanes, near: float, progress: Progress) -> list[_Pieces]:
    """Return the pieces on each plane, worked on by all cores."""
    from . import section_kernels as kernels

    facet, plane = _pairs(facets, planes)
    some = partial(_pieces_of_pairs, facets, planes, (facet, plane), near)
    waiting = [
        pool().submit(some, range(first, min(first + _PAIRS, len(facet)))) for first in range(0, len(facet), _PAIRS)
    ]
    parts = [(np.zeros((0, kernels.COLUMNS)), np.zeros(0, np.int64))]
    try:
        for n, each in enumerate(waiting):
            parts.append(each.result())
            progress.step((n + 1) / len(waiting), "Cutting the surfaces")
    except BaseException:
        for each in waiting:
            each.cancel()
        raise
    rows, source = (np.concatenate(column) for column in zip(*parts, strict=True))
    order = np.lexsort([rows[:, kernels.S0], plane[source]])
    rows, facet, plane = rows[order], facet[source[order]], plane[source[order]]
    edges = np.searchsorted(plane, np.arange(len(planes.offsets) + 1)).tolist()
    return [_Pieces(rows[a:b], facet[a:b]) for a, b in pairwise(edges)]


def _pieces_of_pairs(
    facets: SurfaceFacets, planes: CuttingPlanes, pairs: tuple[Ints, Ints], near: float, span: range
) -> tuple[Floats, Ints]:
    """Return the pieces of some pairs of facet and plane, and the pair of each; asked again where the room was short.

    Args:
        pairs: number of the facet and of the plane, (k,) each. span: which of them.
    """
    from . import section_kernels as kernels

    triangles, corners = facets.triangles.reshape(-1, 9), facets.corners.reshape(-1, 6)
    patches = (facets.patch, facets.error, facets.patches.control)
    places = np.array([_line(planes, n) for n in range(len(planes.offsets))])
    room = 8 * len(span) + 64
    while True:
        out, source = np.empty((room, kernels.COLUMNS)), np.empty(room, np.int64)
        facet, plane = pairs
        count = kernels.pieces(
            triangles, corners, *patches, facet, places, plane, near, span.start, span.stop, out, source
        )
        if count <= room:
            return out[:count], source[:count]
        room = count


def _pairs(facets: SurfaceFacets, planes: CuttingPlanes) -> tuple[Ints, Ints]:
    """Return the facets and the planes (k,) that may cut what they stand for, plane by plane."""
    (c, s), (x, y) = planes.along, planes.origin
    across = (facets.triangles[:, :, 1] - y) * c - (facets.triangles[:, :, 0] - x) * s
    offsets = np.array(planes.offsets)
    slack = facets.error + 1e-9
    first = np.searchsorted(offsets, across.min(axis=1) - slack, "left")
    count = np.maximum(np.searchsorted(offsets, across.max(axis=1) + slack, "right") - first, 0)
    planes.ask_memory(_PIECE_BYTES * float(count.sum()))
    facet = np.repeat(np.arange(len(facets)), count)
    plane = np.repeat(first, count) + np.arange(len(facet)) - np.repeat(np.cumsum(count) - count, count)
    order = np.argsort(plane, kind="stable")
    return facet[order], plane[order]


def _line(planes: CuttingPlanes, plane: int) -> Floats:
    return np.array([*planes.place(plane, 0.0), *planes.along])


def _within(
    facets: SurfaceFacets, planes: CuttingPlanes, plane: int, pieces: _Pieces, areas: Mapping[int, shapely.Geometry]
) -> _Pieces:
    """Return what of pieces lies where their surfaces count, cut at the borders."""
    from .planes import stretches
    from .section_kernels import S0, S1

    if not areas or not len(pieces.rows):
        return pieces
    owner, line = facets.owner[pieces.facet], _line(planes, plane)
    whole = (float(pieces.rows[:, S0].min()) - 1.0, float(pieces.rows[:, S1].max()) + 1.0)
    free = ~np.isin(owner, list(areas))
    rows, facet = [pieces.rows[free]], [pieces.facet[free]]
    for number, area in areas.items():
        mine = np.flatnonzero(owner == number)
        for low, high in stretches(planes, plane, whole, area):
            inside = mine[(pieces.rows[mine, S1] >= low) & (pieces.rows[mine, S0] <= high)]
            chosen = _Pieces(pieces.rows[inside], pieces.facet[inside])
            rows.append(_cut_off(facets, chosen, line, (low, high)))
            facet.append(chosen.facet)
    every, numbers = np.concatenate(rows), np.concatenate(facet)
    order = np.argsort(every[:, S0], kind="stable")
    return _Pieces(every[order], numbers[order])


def _cut_off(facets: SurfaceFacets, pieces: _Pieces, line: Floats, within: tuple[float, float]) -> Floats:
    """Return the rows of pieces without what of them lies beyond two places of their plane's line.

    Args:
        line: a place of it and its direction. within: mm along it; each piece has some of itself between them.
    """
    from .envelope_kernels import over
    from .section_kernels import S0, S1, Z0, Z1

    part, (low, high) = pieces.rows.copy(), within
    for n in np.flatnonzero((part[:, S0] < low) | (part[:, S1] > high)).tolist():
        patch = int(facets.patch[pieces.facet[n]])
        for column, level, border in ((S0, Z0, max(low, part[n, S0])), (S1, Z1, min(high, part[n, S1]))):
            if part[n, column] != border:
                part[n, level : level + 3] = over(facets.patches.control, patch, pieces.rows, n, line, border)
                part[n, column] = border
    return part


def _topmost(
    facets: SurfaceFacets, planes: CuttingPlanes, plane: int, pieces: _Pieces, tolerance: float
) -> tuple[list[SectionRun], BoundaryPoints]:
    """Return the runs of the topmost on one plane, and its boundary points."""
    from . import envelope_kernels as kernels

    patch, owner = facets.patch[pieces.facet], facets.owner[pieces.facet]
    room = 4 * len(pieces.rows) + 64
    while True:
        spans, marks = np.empty((room, kernels.SPANS)), np.empty((room, kernels.MARKS))
        count, marked = kernels.envelope(
            pieces.rows, patch, owner, facets.patches.control, _line(planes, plane), spans, marks
        )
        if count >= 0:
            break
        room *= 4
    runs = _runs(planes, plane, spans[:count], owner, tolerance)
    return runs, _boundaries(facets, planes, plane, pieces, marks[:marked])


def _runs(planes: CuttingPlanes, plane: int, spans: Floats, owner: Ints, tolerance: float) -> list[SectionRun]:
    """Return spans without a gap or a jump between them as runs; of points on one surface only those that the tolerance
    needs.
    """
    from .envelope_kernels import FROM, PIECE, TO, Z_FROM, Z_TO

    if not len(spans):
        return []
    number = owner[spans[:, PIECE].astype(np.int64)]
    apart = (spans[1:, FROM] - spans[:-1, TO] > _GAP) | (np.abs(spans[1:, Z_FROM] - spans[:-1, Z_TO]) > _JUMP)
    breaks = [0, *(np.flatnonzero(apart) + 1).tolist(), len(spans)]
    runs = []
    for first, stop in pairwise(breaks):
        parts, owners = [spans[first : first + 1, [FROM, Z_FROM]]], []
        changes = first + 1 + np.flatnonzero(np.diff(number[first:stop]))
        for a, b in pairwise([first, *changes.tolist(), stop]):
            line = np.concatenate([parts[-1][-1:], spans[a:b, [TO, Z_TO]]])
            kept = shapely.get_coordinates(
                shapely.simplify(shapely.LineString(line), tolerance / 2, preserve_topology=False)
            )
            parts.append(kept[1:])
            owners.append(np.full(len(kept) - 1, number[a]))
        runs.append(SectionRun(plane, _places(planes, plane, np.concatenate(parts)), np.concatenate(owners)))
    return runs


def _places(planes: CuttingPlanes, plane: int, at: Floats) -> Floats:
    """Return places (n, 3) for distances along a plane and heights (n, 2)."""
    (x, y), (c, s) = planes.place(plane, 0.0), planes.along
    return np.column_stack([x + at[:, 0] * c, y + at[:, 0] * s, at[:, 1]])


def _boundaries(
    facets: SurfaceFacets, planes: CuttingPlanes, plane: int, pieces: _Pieces, marks: Floats
) -> BoundaryPoints:
    """Return marks as boundary points."""
    from . import envelope_kernels as k

    if not len(marks):
        return BoundaryPoints.none()
    before, after = (pieces.facet[marks[:, column].astype(np.int64)] for column in (k.BEFORE, k.AFTER))
    return BoundaryPoints(
        plane=np.full(len(marks), plane),
        before=facets.owner[before],
        after=facets.owner[after],
        place=_places(planes, plane, marks[:, [k.AT, k.HERE]]),
        end=_places(planes, plane, marks[:, [k.UNTIL, k.THERE]]),
        before_at=surface_parameters(facets, before, marks[:, [k.BU, k.BV]]),
        after_at=surface_parameters(facets, after, marks[:, [k.AU, k.AV]]),
        kind=marks[:, k.KIND].astype(np.uint8),
    )


def _joined(parts: Sequence[BoundaryPoints]) -> BoundaryPoints:
    """Return boundary points of several planes, one after the other."""
    every = [BoundaryPoints.none(), *parts]
    return BoundaryPoints(
        *(np.concatenate([getattr(part, field.name) for part in every]) for field in fields(BoundaryPoints))
    )


def _curves(
    facets: SurfaceFacets, planes: CuttingPlanes, plane: int, pieces: _Pieces, tolerance: float
) -> list[PlaneSection]:
    """Return the section curve of each surface on one plane, in one part or several; points that the tolerance
    needs.
    """
    from .section_kernels import S0, S1, U0, V0, V1, Z0, Z1, chains

    owner = facets.owner[pieces.facet]
    found: list[PlaneSection] = []
    for number in np.unique(owner).tolist():
        mine = np.flatnonzero(owner == number)
        rows = pieces.rows[mine]
        ends = np.concatenate([rows[:, [S0, Z0]], rows[:, [S1, Z1]]])
        at = surface_parameters(
            facets, np.tile(pieces.facet[mine], 2), np.concatenate([rows[:, U0 : V0 + 1], rows[:, V1 - 1 : V1 + 1]])
        )
        along, up = np.ascontiguousarray(ends.T)
        out, starts = np.empty(len(ends), np.int64), np.empty(len(rows) + 1, np.int64)
        count = chains(along, up, np.argsort(along, kind="stable"), _GAP, out, starts)
        for first, stop in pairwise(starts[: count + 1].tolist()):
            chain = np.append(out[first:stop:2], out[stop - 1])
            kept = _needed(ends[chain], tolerance / 2)
            found.append(PlaneSection(plane, number, _places(planes, plane, ends[chain][kept]), at[chain][kept]))
    return found


def _needed(line: Floats, tolerance: float) -> Ints:
    """Return which points (n, 2) of a line keep it within a tolerance."""
    numbered = np.column_stack([line, np.arange(len(line))])
    kept = shapely.get_coordinates(
        shapely.simplify(shapely.LineString(numbered), tolerance, preserve_topology=False), include_z=True
    )
    found: Ints = kept[:, 2].astype(np.int64)
    return found
