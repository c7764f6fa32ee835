"""Surfaces that rounding has torn: corners that nearly coincide become one, and a corner on another triangle's edge
splits it.

Only open edges are looked at, so that a surface that is closed stays as it is to the bit; and nothing moves by more
than what a file of single precision rounds its numbers by, so that a gap which anybody has drawn stays one.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

Floats = NDArray[np.float64]
Ints = NDArray[np.int64]

ROUNDED = 8 * 2.0**-24
"""Of the greatest coordinate: how far apart corners may be that are one. Half a unit in the last place, on both sides,
some times over.
"""

_MOST, _PAIRS = 10_000, 2_000_000
"""Open edges from which on a surface is not torn but open, and pairs of near places that are looked at: damaged files
may have any.
"""

_SIDES = 3
"""Rounds of splitting: one for each side of a triangle."""


@dataclass(frozen=True, eq=False)
class SewnMesh:
    """A surface without open edges.

    Attributes:
        triangles: (k, 3, 3) mm. origin: (k,) which of those that were given each is, or is a part of.
    """

    triangles: Floats
    origin: Ints


def sew_mesh(triangles: Floats) -> SewnMesh | None:
    """Return a torn surface sewn together; None where edges stay open."""
    from .edges import MeshEdges

    within = ROUNDED * float(np.abs(triangles).max())
    found = SewnMesh(triangles, np.arange(len(triangles)))
    uses = MeshEdges.of(triangles).open_uses()
    if len(uses) > _MOST:
        return None
    welded = _welded(triangles, uses, within)
    if welded is None:
        return None
    found = SewnMesh(welded, found.origin)
    for _ in range(_SIDES):
        uses = _real(found.triangles, MeshEdges.of(found.triangles).open_uses())
        if not len(uses):
            break
        split = _split(found, uses, within)
        if split is None:
            return None
        found = split
    found = _with_area(found)
    return None if len(MeshEdges.of(found.triangles).open_uses()) else found


def _ends(triangles: Floats, uses: Ints) -> tuple[Floats, Floats]:
    """Return both ends (m, 3) of edges by their uses."""
    face, k = np.divmod(uses, 3)
    return triangles[face, k], triangles[face, (k + 1) % 3]


def _real(triangles: Floats, uses: Ints) -> Ints:
    """Return those uses of edges whose triangle has corners at three places."""
    sides = triangles[uses // 3]
    return uses[np.all(np.any(sides != np.roll(sides, -1, axis=1), axis=2), axis=1)]


def _with_area(found: SewnMesh) -> SewnMesh:
    """Return a surface without the triangles that have lost their area by welding."""
    some = np.all(np.any(found.triangles != np.roll(found.triangles, -1, axis=1), axis=2), axis=1)
    return SewnMesh(found.triangles[some], found.origin[some])


def _welded(triangles: Floats, uses: Ints, within: float) -> Floats | None:
    """Return triangles whose corners on open edges are one where they are no farther apart than `within`; None: far too
    many are.
    """
    from scipy.sparse import coo_array
    from scipy.sparse.csgraph import connected_components
    from scipy.spatial import cKDTree

    places = np.unique(np.concatenate(_ends(triangles, uses)), axis=0)
    tree = cKDTree(places)
    if tree.count_neighbors(tree, within) > _PAIRS:
        return None
    pairs = tree.query_pairs(within, output_type="ndarray")
    if not len(pairs):
        return triangles
    size = len(places)
    _, number = connected_components(coo_array((np.ones(len(pairs)), pairs.T), shape=(size, size)), directed=False)
    _, first = np.unique(number, return_index=True)
    one, at = np.unique(triangles.reshape(-1, 3), axis=0, return_inverse=True)
    _, rows = cKDTree(one).query(places)
    one[rows] = places[first[number]]
    return np.ascontiguousarray(one[at.ravel()].reshape(-1, 3, 3))


def _split(found: SewnMesh, uses: Ints, within: float) -> SewnMesh | None:
    """Return a surface whose triangles are split at the corners that lie on one open edge of each; None: there are far
    too many.
    """
    from scipy.spatial import cKDTree

    begin, end = _ends(found.triangles, uses)
    places = np.unique(np.concatenate([begin, end]), axis=0)
    tree, middle, reach = cKDTree(places), (begin + end) / 2, np.linalg.norm(end - begin, axis=1) / 2 + within
    if int(np.sum(tree.query_ball_point(middle, reach, return_length=True))) > _PAIRS:
        return None
    near = tree.query_ball_point(middle, reach)
    parts, rows, gone = [], [], np.zeros(len(found.triangles), np.bool_)
    for use, a, b, around in zip(uses.tolist(), begin, end, near, strict=True):
        face, k = divmod(use, 3)
        on = _on(a, b, places[around], within)
        if gone[face] or not len(on):
            continue
        gone[face], chain = True, np.concatenate([a[None], on, b[None]])
        tip = np.broadcast_to(found.triangles[face, (k + 2) % 3], (len(chain) - 1, 3))
        parts.append(np.stack([chain[:-1], chain[1:], tip], axis=1))
        rows.append(np.full(len(chain) - 1, found.origin[face]))
    if not parts:
        return found
    return SewnMesh(np.concatenate([found.triangles[~gone], *parts]), np.concatenate([found.origin[~gone], *rows]))


def _on(begin: Floats, end: Floats, places: Floats, within: float) -> Floats:
    """Return the places (k, 3) that lie on an edge between its ends, in its order."""
    way = end - begin
    length = float(np.linalg.norm(way))
    if not length > 2 * within:
        return np.zeros((0, 3))
    along = (places - begin) @ way / length
    off = np.linalg.norm(places - begin - along[:, None] * (way / length), axis=1)
    some = (off <= within) & (along > within) & (along < length - within)
    return np.asarray(places[some][np.argsort(along[some], kind="stable")])
