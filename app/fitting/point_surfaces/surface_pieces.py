"""The smooth pieces of a compound surface behind points of passes: parted where its facets turn at once.

Facets of one smooth piece turn little from each to the next, and about as much everywhere; where two pieces meet at an
edge they turn much more. Places on the true shape are looked for in each piece by itself: where an edge of one piece's
polyhedron meets the next piece is no corner of either.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from ...core.progress import NO_PROGRESS, Progress
from ...model.motion import Floats
from ..point_curves.effective_points import PointState
from ..point_curves.facets import CloudFacets, distinct_pairs
from .facet_corners import FacetCorners, FacetPlanes, ShapePlace, crossed_edges, met_corners, row_facets

Ints = NDArray[np.int64]

_CREASE = math.radians(12.0)
"""Facets that turn by less are of one piece, however flat the rest of it is."""
_TURNS = 5.0
"""Times the usual turn from facet to facet: more is an edge."""
_LEAST = 16
"""Points, and places, that say what a piece is."""
_PLANE_PLACES = 600
"""Points of a plane that stand for all of them."""
NO_PIECE = -1
"""Number of the piece of points that belong to none."""


@dataclass(frozen=True, eq=False)
class SurfacePieces:
    """The smooth pieces that n points lie on.

    Attributes:
        piece: (n,) number of each point's piece; NO_PIECE: of none, as on a rolled edge, whose facets are slivers.
        corners: of each piece the places on the true shape.
        facets: of all pieces.
    """

    piece: Ints
    corners: tuple[FacetCorners, ...]
    facets: int


def surface_pieces(rows: Sequence[Floats], epsilon: float, progress: Progress = NO_PROGRESS) -> SurfacePieces:
    """Part points of passes into smooth pieces.

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
    progress.step(0.4, "Looking for the edges between surfaces")
    group = _smooth_groups(found, pairs, planes)
    piece = np.full(len(points), NO_PIECE, np.int64)
    corners: list[FacetCorners] = []
    sizes = np.bincount(group[found.facet][planes.known[found.facet]], minlength=int(group.max(initial=-1)) + 1)
    for number in np.argsort(-sizes, kind="stable").tolist():
        if sizes[number] < _LEAST:
            break
        progress.step(0.5, f"Surface {len(corners) + 1}")
        own = replace(planes, known=planes.known & (group == number))
        on = own.known[found.facet]
        places = _places(rows, _PieceTask(found, pairs, own, reach), on)
        if len(places.places) >= _LEAST:
            piece[on] = len(corners)
            corners.append(places)
    return SurfacePieces(piece, tuple(corners), int(planes.known.sum()))


@dataclass(frozen=True, eq=False)
class _PieceTask:
    """What the places of one piece are looked for by; of `planes` only its own are known."""

    found: CloudFacets
    pairs: Ints
    planes: FacetPlanes
    reach: float


def _smooth_groups(found: CloudFacets, pairs: Ints, planes: FacetPlanes) -> Ints:
    """Return of each facet (f,) the number of the smooth piece that it is of."""
    from scipy.sparse import coo_matrix
    from scipy.sparse.csgraph import connected_components

    beside = np.sort(found.facet[pairs], axis=1)
    beside = distinct_pairs(beside[(beside[:, 0] != beside[:, 1]) & planes.known[beside].all(axis=1)])
    cosine = np.einsum("ij,ij->i", planes.normals[beside[:, 0]], planes.normals[beside[:, 1]])
    turns = np.arccos(np.clip(cosine, -1.0, 1.0))
    limit = max(_CREASE, _TURNS * float(np.median(turns))) if len(turns) else _CREASE
    beside = beside[turns <= limit]
    links = coo_matrix((np.ones(len(beside)), (beside[:, 0], beside[:, 1])), (len(planes.known),) * 2)
    return np.asarray(connected_components(links, directed=False)[1], np.int64)


def _places(rows: Sequence[Floats], task: _PieceTask, on: NDArray[np.bool_]) -> FacetCorners:
    """Return what of a piece lies on the true shape: corners, places on edges, effective points; all of a plane."""
    found, planes, count = task.found, task.planes, int(on.sum())
    points, facets = np.concatenate(rows), int(planes.known.sum())
    if facets == 1:
        some = points[np.flatnonzero(on)[:: max(1, count // _PLANE_PLACES)]]
        return FacetCorners(some, np.ones(len(some)), ShapePlace.POINT, 1, count)
    places, weights = met_corners(found, task.pairs, planes, task.reach)
    if len(places) >= max(facets // 4, _LEAST):
        return FacetCorners(places, weights, ShapePlace.CORNER, facets, count)
    places, weights = crossed_edges(rows, found, planes, task.reach)
    if len(places) >= max(2 * (facets - 1), _LEAST):
        return FacetCorners(places, weights, ShapePlace.EDGE, facets, count)
    effective = points[on & (found.state == PointState.EFFECTIVE)]
    return FacetCorners(effective, np.ones(len(effective)), ShapePlace.POINT, facets, count)
