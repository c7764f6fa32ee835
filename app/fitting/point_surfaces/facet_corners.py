"""Method D on a surface: the corners of its facets, which alone lie on the true shape.

On a path the ends of a range are effective, for there two facets meet. Passes over a polyhedron cross its edges, and an
edge is a chord itself: what lies on the true shape is where three facets meet. No point of the program need be there,
but the planes of the facets say where it is.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from enum import Enum
from itertools import combinations, pairwise
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from ...core.progress import NO_PROGRESS, Progress
from ...model.motion import Floats
from ..point_curves.effective_points import PointState
from ..point_curves.facets import CloudFacets, distinct_pairs, facets_of_rows, row_neighbours

Ints = NDArray[np.int64]

_FEWEST = 4
"""Points of a facet whose plane is believed."""
_WIDE = 0.2
"""Of the reach: how wide the points of such a facet lie at least, as their second singular value."""
_UPRIGHT = 1e-5
"""Determinant of three normals from which on their planes are said to meet in a place."""
_LEAST = 16
"""Places that say what a surface is."""
_REACH = 1.5
"""Times the distance of neighbouring points: so near to points of all three facets their corner lies."""
_SPACING = 90.0
"""Percentile of the distances that the reach goes by: a few long gaps are none."""
_MOST = 24
"""Neighbours of one facet that are brought together; a plane beside more than that is no facet of a polyhedron."""


class ShapePlace(Enum):
    """What lies on the true shape: corners where three facets meet; of strips, whose edges lie on it, where passes
    cross these; else the effective points of method D.
    """

    CORNER = "corners"
    EDGE = "places on edges"
    POINT = "effective points"


@dataclass(frozen=True, eq=False)
class FacetCorners:
    """What stands for the true surface among points of passes.

    Attributes:
        places: (n, 3) mm. weights: (n,) how well each is known, about 1. kind: what they are.
        facets: how many facets there are. points: how many points lie on them.
    """

    places: Floats
    weights: Floats
    kind: ShapePlace
    facets: int
    points: int


def facet_corners(rows: Sequence[Floats], epsilon: float, progress: Progress = NO_PROGRESS) -> FacetCorners:
    """Return the places on the true surface that points of passes over a polyhedron tell of.

    Args:
        rows: (n, 3) mm each, n >= 2, beside one another in their order, two at least.
        epsilon: points so near to one plane are a facet, mm, > 0.
        progress: told of how much is done.

    Raises:
        GeometryError: rows are too few or too short. ParameterError: epsilon out of its range.
        Cancelled: the job was asked to stop.
    """
    progress.step(0.0, "Looking for facets")
    found, points, pairs, reach, planes = row_facets(rows, epsilon)
    progress.step(0.4, "Looking for their corners")
    facets = len(found.planes)
    places, weights = met_corners(found, pairs, planes, reach)
    if len(places) >= max(facets // 4, _LEAST):
        return FacetCorners(places, weights, ShapePlace.CORNER, facets, len(points))
    places, weights = crossed_edges(rows, found, planes, reach)
    if len(places) >= max(len(rows) * min(facets - 1, 2), _LEAST):
        return FacetCorners(places, weights, ShapePlace.EDGE, facets, len(points))
    effective = points[found.state == PointState.EFFECTIVE]
    return FacetCorners(effective, np.ones(len(effective)), ShapePlace.POINT, facets, len(points))


class RowFacets(NamedTuple):
    """The facets that n points of passes lie on.

    Attributes:
        found: of each point its facet. points: (n, 3) mm. pairs: neighbours, as `row_neighbours` has them.
        reach: as `spacing_of` has it, mm. planes: of the facets.
    """

    found: CloudFacets
    points: Floats
    pairs: Ints
    reach: float
    planes: FacetPlanes


def row_facets(rows: Sequence[Floats], epsilon: float) -> RowFacets:
    """Return the facets of points of passes; args and errors as `facet_corners` has them."""
    found, points, reach = facets_of_rows(rows, epsilon), np.concatenate(rows), spacing_of(rows)
    return RowFacets(found, points, row_neighbours(rows), reach, planes_of(points, found, reach))


def spacing_of(rows: Sequence[Floats]) -> float:
    """Return within which distance of points of all its facets a corner lies, mm: by how far neighbours are apart, in a
    row or from row to row.
    """
    along = np.concatenate([np.linalg.norm(np.diff(row, axis=0), axis=1) for row in rows])
    near = [np.linalg.norm(one - other[len(other) // 2], axis=1).min() for one, other in pairwise(rows)]
    return _REACH * float(max(np.percentile(along, _SPACING), np.percentile(near, _SPACING)))


@dataclass(frozen=True, eq=False)
class FacetPlanes:
    """The facets whose planes are believed: (f, 3) upward normals, (f,) heights along them, (f,) whether one is, and of
    each its points in the plane.
    """

    normals: Floats
    offsets: Floats
    known: NDArray[np.bool_]
    points: list[Floats]


def planes_of(points: Floats, found: CloudFacets, reach: float) -> FacetPlanes:
    """Return the planes of facets; those of few points, or of points along one line, are not believed."""
    count = len(found.planes)
    order = np.argsort(found.facet, kind="stable")
    begin = np.searchsorted(found.facet[order], np.arange(count + 1))
    normals, offsets, known = np.zeros((count, 3)), np.zeros(count), np.zeros(count, np.bool_)
    own = [points[order[begin[k] : begin[k + 1]]] for k in range(count)]
    for k, each in enumerate(own):
        if len(each) < _FEWEST:
            continue
        middle = each.mean(axis=0)
        _, sizes, axes = np.linalg.svd(each - middle, full_matrices=False)
        normal = axes[2] * (1.0 if axes[2, 2] >= 0 else -1.0)
        normals[k], offsets[k], known[k] = normal, normal @ middle, sizes[1] >= _WIDE * reach and normal[2] > 0.1
    return FacetPlanes(normals, offsets, known, own)


def crossed_edges(
    rows: Sequence[Floats], found: CloudFacets, planes: FacetPlanes, reach: float
) -> tuple[Floats, Floats]:
    """Return the places where passes, upright planes through two of their points, cross the edge of two facets, and how
    well each is known.
    """
    points = np.concatenate(rows)
    number = np.repeat(np.arange(len(rows)), [len(row) for row in rows])
    at = np.flatnonzero((found.facet[1:] != found.facet[:-1]) & (number[1:] == number[:-1]))
    one, other = found.facet[at], found.facet[at + 1]
    some = planes.known[one] & planes.known[other]
    at, one, other = at[some], one[some], other[some]
    ahead = points[at + 1] - points[at]
    upright = np.column_stack([-ahead[:, 1], ahead[:, 0], np.zeros(len(at))])
    upright /= np.maximum(np.linalg.norm(upright, axis=1), 1e-300)[:, None]
    normals = np.stack([planes.normals[one], planes.normals[other], upright], axis=1)
    sharp = np.abs(np.linalg.det(normals)) if len(at) else np.zeros(0)
    some = sharp > _UPRIGHT
    at, one, other, normals, sharp = at[some], one[some], other[some], normals[some], sharp[some]
    beside = np.einsum("ij,ij->i", normals[:, 2], points[at])
    offsets = np.column_stack([planes.offsets[one], planes.offsets[other], beside])
    places = np.linalg.solve(normals, offsets[:, :, None])[:, :, 0]
    near = np.minimum(*(np.linalg.norm(places - points[at + k], axis=1) for k in (0, 1))) < reach
    places, sharp = places[near], sharp[near]
    return places, np.clip(sharp / np.median(sharp), 0.05, 3.0) if len(sharp) else sharp


def met_corners(found: CloudFacets, pairs: Ints, planes: FacetPlanes, reach: float) -> tuple[Floats, Floats]:
    """Return the places where three facets meet, and how well each is known."""
    triples = _triples(found, pairs, planes.known)
    normals = planes.normals[triples]
    sharp = np.abs(np.linalg.det(normals)) if len(triples) else np.zeros(0)
    some = sharp > _UPRIGHT
    triples, normals, sharp = triples[some], normals[some], sharp[some]
    if not len(triples):
        return np.zeros((0, 3)), np.zeros(0)
    places = np.linalg.solve(normals, planes.offsets[triples][:, :, None])[:, :, 0]
    near = _near_all(places, triples, planes, reach)
    return _merged(places[near], sharp[near], reach)


def _triples(found: CloudFacets, pairs: Ints, known: NDArray[np.bool_]) -> Ints:
    """Return the numbers (t, 3) of facets of which one is beside both others."""
    beside = np.sort(found.facet[pairs], axis=1)
    beside = distinct_pairs(beside[(beside[:, 0] != beside[:, 1]) & known[beside].all(axis=1)])
    around: dict[int, list[int]] = {}
    for one, other in beside.tolist():
        around.setdefault(one, []).append(other)
        around.setdefault(other, []).append(one)
    triples = {
        tuple(sorted((facet, one, other)))
        for facet, others in around.items()
        if len(others) <= _MOST
        for one, other in combinations(others, 2)
    }
    return np.array(sorted(triples), np.int64).reshape(-1, 3)


def _near_all(places: Floats, triples: Ints, planes: FacetPlanes, reach: float) -> NDArray[np.bool_]:
    """Tell which places lie within reach of points of all their facets."""
    from scipy.spatial import KDTree

    near = np.ones(len(places), np.bool_)
    for column in range(3):
        for facet in np.unique(triples[:, column]).tolist():
            rows = np.flatnonzero((triples[:, column] == facet) & near)
            if len(rows):
                near[rows] = KDTree(planes.points[facet]).query(places[rows])[0] < reach
    return near


def _merged(places: Floats, sharp: Floats, reach: float) -> tuple[Floats, Floats]:
    """Return places of which those that stand for one corner are one: what the sharpest of them say counts most."""
    from scipy.sparse import coo_matrix
    from scipy.sparse.csgraph import connected_components
    from scipy.spatial import KDTree

    if not len(places):
        return places, sharp
    pairs = KDTree(places).query_pairs(reach / 3, output_type="ndarray")
    links = coo_matrix((np.ones(len(pairs)), (pairs[:, 0], pairs[:, 1])), (len(places), len(places)))
    count, group = connected_components(links, directed=False)
    weights = sharp**2
    total = np.bincount(group, weights, count)
    merged = np.column_stack([np.bincount(group, weights * places[:, axis], count) for axis in range(3)])
    best = np.zeros(count)
    np.maximum.at(best, group, sharp)
    return merged / total[:, None], np.clip(best / np.median(best), 0.05, 3.0)
